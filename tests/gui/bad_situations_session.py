# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: one bad situation after the other while the viewport draws, then the way back.

Each situation starts with the file opened and drawing. Its function causes it, waits, and puts the cause right again
where the file alone does not; then drawing is switched off and on. What was seen at both ends goes to `seen.json`.

Arguments after `--`: the zip, a .blend file with the objects Mirror Ball and Block, the folder for what was seen; after
`--only` the names of the situations to play, separated by commas, where these are not all.
"""

from __future__ import annotations

import json
import sys
import traceback
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from scripted import Script, extension, install, play
from situations.opened_file import ARCHIVE, FOLDER, SITUATIONS, Steps, drawn, opened, redraws, seen, switched_on

for module in ("objects", "shapes", "renders", "own_failures", "files"):
    import_module(f"situations.{module}")


def look(before: int) -> dict[str, Any]:
    return {
        "messages": extension("curvrefl_addon.viewport.handlers").messages(),
        "enabled": bpy.context.window_manager.curvrefl_enabled,
        "drawn": drawn() - before,
    }


def played() -> Script:
    seen["all"] = list(SITUATIONS)
    only = sys.argv[sys.argv.index("--only") + 1].split(",") if "--only" in sys.argv else list(SITUATIONS)
    for name in only:
        found: dict[str, Any] = {}
        seen["situations"][name] = found
        # Should Blender end in it, its name is the last one.
        save()
        try:
            yield from _played_one(SITUATIONS[name](), name, found)
        except Exception:
            found["error"] = traceback.format_exc()
        save()


def _played_one(steps: Steps, name: str, found: dict[str, Any]) -> Script:
    print(f"\n== opened {name}", flush=True)
    yield from opened()
    found["at start"] = look(0)
    print(f"\n== caused {name}", flush=True)
    before = drawn()
    for wait in steps:
        if not isinstance(wait, str):
            yield wait
            continue
        yield from redraws()
        found["caused"] = look(before)
        print(f"\n== repaired {name}", flush=True)
    before = drawn()
    yield from switched_on()
    yield from redraws(2)
    found["repaired"] = look(before)


def save() -> None:
    part = Path(FOLDER) / "seen.part"
    part.write_text(json.dumps(seen, indent=1), encoding="utf-8")
    # Whole at any time, for Blender may end at any time.
    part.replace(Path(FOLDER) / "seen.json")


def end(error: str) -> None:
    seen["error"] = error
    seen["finished"] = not error
    save()
    bpy.ops.wm.quit_blender()


install(ARCHIVE)
play(played(), end)
