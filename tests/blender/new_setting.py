# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Script: says where the copy of the repository that argv ends with knows the setting "glow"."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(sys.argv[-1]) / "tools"))

import bootstrap
import bpy
import write_settings

bootstrap.load_package()

from curvrefl.curvrefl_addon import options, registration  # noqa: E402
from curvrefl.curvrefl_addon.command import cli, verbs  # noqa: E402
from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings, check_settings  # noqa: E402
from curvrefl.curvrefl_addon.ui import panel, preferences, properties  # noqa: E402

ROOT = Path(sys.argv[-1])


def described(group: Any) -> list[Any]:
    item = group.bl_rna.properties["glow"]
    ends = (item.hard_min, item.hard_max, item.soft_min, item.soft_max)
    return [item.name, item.description, item.default, *(round(end, 6) for end in ends)]


def refusal(**values: Any) -> str:
    try:
        check_settings(Settings(**values))
    except InputError as error:
        return str(error)
    return ""


def parsed(*arguments: str) -> float | str:
    """Of `render`, as its renderer would get it, or why not."""
    seen: list[Settings] = []
    verbs.render = lambda found: seen.append(verbs.chosen_settings(found)) or 0  # type: ignore[assignment]
    try:
        cli.run(["render", "x.blend", "--reflector", "A", "--output", "x.png", *arguments])
    except InputError as error:
        return str(error)
    return seen[0].glow


class Layout:
    def __init__(self) -> None:
        self.shown: list[str] = []

    def prop(self, _owner: Any, name: str) -> None:
        self.shown.append(name)


def shown_in_panel() -> list[str]:
    layout = Layout()
    panel.CURVREFL_PT_quality.draw(type("Panel", (), {"layout": layout}), bpy.context)  # type: ignore[arg-type]
    return layout.shown


def main() -> None:
    registration.register()
    chosen = bpy.context.scene.curvrefl
    first = options.settings_of(chosen).glow
    chosen.glow = 3.0
    seen = {
        "copy": Path(options.__file__).is_relative_to(ROOT),
        "settings": Settings().glow,
        "refused": refusal(glow=8.5),
        "taken": refusal(glow=8.0),
        "scene": described(properties.CurvreflScene),
        "preferences": described(preferences.CurvreflPreferences),
        "new scenes": options.current_options().new_scenes["glow"],
        "rendered": [first, options.settings_of(chosen).glow],
        "panel": "glow" in shown_in_panel(),
        "command line": [parsed(), parsed("--glow", "4.5"), parsed("--glow", "9"), parsed("--glow", "much")],
        "page": "`glow`" in write_settings.page(),
    }
    registration.unregister()
    print("SEEN " + json.dumps(seen))


main()
