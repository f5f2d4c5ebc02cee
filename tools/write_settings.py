# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/settings.md from the table of settings: call it after a change of the table."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from math import degrees
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bootstrap

bootstrap.load_package()

from curvrefl.curvrefl_addon.setting import Setting  # noqa: E402
from curvrefl.curvrefl_addon.settings_table import (  # noqa: E402
    OF_OBJECTS,
    OF_PREFERENCES,
    OF_SCENES,
    OF_VIEW_LAYERS,
    RENDERER,
)

PAGE = bootstrap.ROOT / "docs" / "settings.md"
HEAD = """\
<!-- SPDX-FileCopyrightText: 2026 Curvrefl contributors -->
<!-- SPDX-License-Identifier: GPL-3.0-or-later -->
<!-- Written by tools/write_settings.py from curvrefl_addon/settings_table.py: change that, and call the tool. -->

# Settings

All settings are declared in `curvrefl_addon/settings_table.py`. A new one is an entry there, and what uses it: the
renderer's `Settings`, the properties, the preferences, the command line and this page are made from the entries. Values
may be typed in the whole range; sliders go through the shorter one. Where an argument of the command line begins with
another value, it stands beside it.
"""
GROUPS = (
    (
        "Of scenes",
        "Properties of `Scene.curvrefl`, saved in the .blend file. The preferences hold what new scenes start with\n"
        "where *preference* is said.",
        OF_SCENES,
    ),
    (
        "Of view layers",
        "Properties of `ViewLayer.curvrefl`, saved in the .blend file: passes of renders by the engine *Curvrefl*.",
        OF_VIEW_LAYERS,
    ),
    ("Of mirrors", "Properties of `Object.curvrefl`, saved in the .blend file.", OF_OBJECTS),
    (
        "Of the renderer alone",
        "Fields of `renderer.settings.Settings` that are no property of a scene.",
        tuple(item for item in RENDERER if not item.panel),
    ),
    ("Of the preferences alone", "Beside the five colors of the diagnostic views.", OF_PREFERENCES),
)


def page() -> str:
    """The whole text."""
    return HEAD + "".join(f"\n## {title}\n\n{text}\n\n{_table(settings)}" for title, text, settings in GROUPS)


def _table(settings: Iterable[Setting]) -> str:
    rows = ["| setting | default | range | slider | where | what it is |", "|---|---|---|---|---|---|"]
    for item in settings:
        cells = (
            f"**{item.label}** `{item.name}`",
            _default(item),
            _values(item),
            _slider(item),
            _where(item),
            f"{item.text}.",
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"


def _default(item: Setting) -> str:
    if item.start is None:
        return "none"
    if isinstance(item.start, bool):
        return "on" if item.start else "off"
    if item.unit == "radians":
        return f"{degrees(item.start):g}°"
    if isinstance(item.start, tuple):
        return ", ".join(f"{number:g}" for number in item.start)
    own = f"; `Settings()`: {item.default}" if item.start != item.default else ""
    return f"{item.start}{own}"


def _values(item: Setting) -> str:
    if item.choices:
        return ", ".join(choice.name for choice in item.choices)
    unit = item.unit if item.unit not in {"color", "direction"} and item.range_text else ""
    return f"{item.range_text} {unit}".strip()


def _slider(item: Setting) -> str:
    if item.soft == (None, None):
        return ""
    ends = [hard if soft is None else soft for soft, hard in zip(item.soft, item.hard, strict=True)]
    shown = [f"{degrees(end):g}°" if item.unit == "radians" else f"{end:g}" for end in ends if end is not None]
    return " to ".join(shown)


def _where(item: Setting) -> str:
    places = [f"panel *{item.panel}*"] if item.panel else []
    places += ["preference"] if item.preference else []
    for flag in item.flags:
        value = item.flag_value(flag)
        default = "" if value == item.start else f" ({value})"
        places.append(f"`{flag.verb} {flag.spelling}`{default}")
    return ", ".join(places)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE.relative_to(bootstrap.ROOT))
