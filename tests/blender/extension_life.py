# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Script: installs the packed extension that argv ends with, enables and disables it, and prints what it saw."""

from __future__ import annotations

import json
import sys
from typing import Any

import bpy

# isort: split
# (with the wheel, importing Blender makes its own modules known)
import addon_utils

MODULE = "bl_ext.user_default.curvrefl"


def handlers() -> dict[str, int]:
    listed = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return {name: len(functions) for name, functions in listed.items() if isinstance(functions, list)}


def blender_types() -> list[str]:
    """Registered classes of all kinds, and properties on Blender's own types."""
    found = []
    for base in (bpy.types.Operator, bpy.types.Panel, bpy.types.PropertyGroup, bpy.types.AddonPreferences):
        found += [
            f"{base.__name__} {cls.__module__}.{cls.__name__}" for cls in base.__subclasses__() if cls.is_registered
        ]
    for owner in (bpy.types.Object, bpy.types.Scene, bpy.types.WindowManager):
        found += [f"{owner.__name__}.{name}" for name in list(owner.bl_rna.properties.keys())]
    return sorted(found)


def operators() -> list[str]:
    return sorted(name for name in dir(bpy.ops.curvrefl) if "curvrefl" in str(getattr(bpy.ops.curvrefl, name)))


def state() -> dict[str, Any]:
    return {"handlers": handlers(), "types": blender_types(), "operators": operators()}


def main() -> None:
    seen: dict[str, Any] = {"before": state()}
    bpy.ops.extensions.package_install_files(filepath=sys.argv[-1], repo="user_default", enable_on_install=False)
    seen["installed"] = MODULE in [module.__name__ for module in addon_utils.modules(refresh=True)]
    for time in ("first", "second"):
        bpy.ops.preferences.addon_enable(module=MODULE)
        # (in the preferences, loaded)
        seen[f"{time} enabled"] = addon_utils.check(MODULE)
        seen[f"{time} state"] = state()
        bpy.ops.preferences.addon_disable(module=MODULE)
        seen[f"{time} disabled"] = addon_utils.check(MODULE)
        seen[f"{time} after"] = state()
    seen["warnings"] = addon_utils._extensions_warnings_get()
    seen["outside"] = [name for name in sys.modules if "curvrefl" in name and not name.startswith(MODULE)]
    seen["gpu imported"] = f"{MODULE}.curvrefl_addon.renderer" in sys.modules
    print("SEEN " + json.dumps(seen))


main()
