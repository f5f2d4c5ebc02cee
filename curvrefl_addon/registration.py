# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension adds to Blender while it is enabled, and takes back when it is disabled."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

import bpy

from .gpu_caches import clear_gpu_caches

OPERATORS = (
    "bake_look",
    "bake_reflector",
    "inspection.check_joints",
    "compare_with_cycles",
    "copy_report",
    "design.make_anamorphosis",
    "film",
    "measure_device",
    "mirror_settings",
    "design.place_light",
    "inspection.save_inspection",
    "save_preview",
    "trace_at_cursor",
)
"""Modules of `operators`; each lists its classes in CLASSES"""
INTERFACE = (
    *("preferences", "properties", "panel", "inspection_panel", "design", "menus", "render_panels"),
    "light_tool",
)
"""Modules of `ui`; those with `add()` and `remove()` also attach things to Blender's types and menus"""

ENGINE = "engine.engine"
"""The module of `curvrefl_addon` that is a render engine; as those of INTERFACE"""

FILM = "film.follow"
"""The module of `curvrefl_addon` that follows scenes that are filmed; likewise"""

_PACKAGE = __package__.rpartition(".")[0]
_classes: list[type] = []
_commands: list[Any] = []


def register() -> None:
    """Register everything, or nothing where a part fails."""
    try:
        modules = [_module(f"operators.{name}") for name in OPERATORS]
        modules += [_module(f"curvrefl_addon.ui.{name}") for name in INTERFACE]
        modules += [_module(f"curvrefl_addon.{name}") for name in (ENGINE, FILM)]
        for module in modules:
            for cls in module.CLASSES:
                bpy.utils.register_class(cls)
                _classes.append(cls)
        for module in modules:
            if hasattr(module, "add"):
                module.add()
        _commands.append(bpy.utils.register_cli_command("curvrefl", _run_command))
    except BaseException:
        unregister()
        raise


def unregister() -> None:
    """Undo what `register` did, last first."""
    if (tracing := sys.modules.get(f"{__package__}.viewport.tracing")) is not None:
        tracing.clear()
    if (lines := sys.modules.get(f"{__package__}.inspection.shown")) is not None:
        lines.clear_joints()
    if (viewport := sys.modules.get(f"{__package__}.viewport.handlers")) is not None:
        viewport.unregister()
    if (device_run := sys.modules.get(f"{__package__}.viewport.device_run")) is not None:
        device_run.end_session()
    for name in (FILM, ENGINE, *(f"ui.{name}" for name in reversed(INTERFACE))):
        module = sys.modules.get(f"{__package__}.{name}")
        if module is not None and hasattr(module, "remove"):
            module.remove()
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
    while _classes:
        bpy.utils.unregister_class(_classes.pop())
    clear_gpu_caches()


def _module(name: str) -> ModuleType:
    return importlib.import_module(f"{_PACKAGE}.{name}")


def _run_command(arguments: list[str]) -> int:
    from .command import cli

    return cli.main(arguments)
