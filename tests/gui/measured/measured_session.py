# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a device at its first use, another file meanwhile, and the device at its second use.

Arguments after `--`: the zip, a small .blend file with a mirror, the folder for what was seen.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from scripted import Script, arguments, extension, install, play, rests, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
seen: dict[str, Any] = {"slices": []}


def device_run() -> Any:
    return extension("curvrefl_addon.viewport.device_run")


def viewport() -> Any:
    return extension("curvrefl_addon.viewport.handlers")


def picture() -> np.ndarray:
    (shown,) = viewport().pictures().values()
    return shown.pixels()


def open_and_show() -> None:
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    view_3d()[1].shading.type = "SOLID"
    bpy.data.objects["Mirror Ball"].curvrefl.is_mirror = True
    bpy.context.scene.curvrefl.method = "exact"
    bpy.context.window_manager.curvrefl_enabled = True


def note(name: str) -> None:
    seen[name] = {
        "rows": dict(device_run().rows()),
        "running": device_run().is_running(),
        "messages": viewport().messages(),
        "costs": extension("curvrefl_addon.renderer.costs.table").costs_in_use().pixel_by_ray,
        "enabled": bpy.context.window_manager.curvrefl_enabled,
    }


def script() -> Script:
    install(ARCHIVE, measures_devices=True)
    # (However busy the machine of the tests is.)
    device_run().MOST_UNREST = 1e9
    spread = extension("curvrefl_addon.renderer.measured.spread_run").SpreadRun
    advance = spread.advance

    def counted(self: Any) -> None:
        advance(self)
        seen["slices"].append(self.slices)

    spread.advance = counted
    open_and_show()
    yield lambda: len(seen["slices"]) > 3
    note("running")
    open_and_show()
    note("another file")
    seen["slices before"] = len(seen["slices"])
    yield lambda: len(seen["slices"]) > seen["slices before"]
    seen["first slice of another file"] = seen["slices"][seen["slices before"]]
    yield rests
    during = device_run().is_running()
    before = picture()
    yield lambda: not device_run().is_running()
    yield 0.5
    yield rests
    note("measured")
    seen["picture"] = {"was running": during, "same": bool(np.array_equal(before, picture()))}
    seen["kept"] = [
        json.loads(path.read_text()) for path in Path(FOLDER).glob("home/**/devices.json") if path.is_file()
    ]
    # A session of its own, as far as the extension can tell.
    seen["slices"].clear()
    device_run().end_session()
    open_and_show()
    yield rests
    yield 0.5
    note("again")
    seen["slices again"] = len(seen["slices"])
    seen["forgot"] = list(bpy.ops.curvrefl.forget_device())
    note("forgotten")


def end(error: str) -> None:
    seen["error"] = error
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), end)
