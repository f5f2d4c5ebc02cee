# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An artist's session in a real Blender window, on both backends.

`CURVREFL_WINDOW_BLENDER` names a command that opens a full Blender 5.2 on a screen, for instance
`xvfb-run -a -s "-screen 0 1280x800x24" blender`; without it the layer is skipped.
"""

from __future__ import annotations

import json
import os
import shlex
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

COMMAND = "CURVREFL_WINDOW_BLENDER"
SECONDS = 300
HERE = Path(__file__).resolve().parent

pytestmark = pytest.mark.skipif(
    COMMAND not in os.environ, reason=f"no Blender window: {COMMAND} names no command that opens one"
)


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with what the session saw."""
    import build_extension
    from curvrefl.curvrefl_addon.demo.scene import build_demo

    folder = tmp_path_factory.mktemp(request.param)
    (folder / "zip").mkdir()
    archive = build_extension.build(folder / "zip")
    build_demo(folder / "demo.blend")
    (folder / "home").mkdir()
    result = subprocess.run(
        [
            *shlex.split(os.environ[COMMAND]),
            "--factory-startup",
            "--gpu-backend",
            request.param,
            *("--window-geometry", "0", "0", "1280", "800"),
            "--python-exit-code",
            "1",
            *("--python", str(HERE / "artist_session.py")),
            *("--", str(archive), str(folder / "demo.blend"), str(folder)),
        ],
        env={**os.environ, "HOME": str(folder / "home"), "BLENDER_USER_RESOURCES": str(folder / "home")},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
    )
    assert (folder / "seen.json").is_file(), result.stdout[-3000:]
    assert "Traceback" not in result.stdout, result.stdout[-3000:]
    return folder


def seen(session: Path) -> dict[str, Any]:
    return json.loads((session / "seen.json").read_text(encoding="utf-8"))


def test_session_runs_to_its_end(session: Path) -> None:
    found = seen(session)
    assert "error" not in found, found.get("error")
    assert found["finished"]
    assert [step["messages"] for step in found["steps"]] == [[]] * len(found["steps"])


def test_orbit_reads_nothing_and_a_move_reads_once(session: Path) -> None:
    steps = {step["name"]: step for step in seen(session)["steps"]}
    reads = [steps[name]["counters"]["scene reads"] for name in ("enabled", "moved the view", "moved the view again")]
    assert reads == [1, 1, 1]
    solves = [steps[name]["counters"]["solves"] for name in ("enabled", "moved the view", "moved the view again")]
    assert solves == [1, 2, 3]
    assert steps["moved the camera"]["counters"]["scene reads"] == 1
    assert steps["moved an object"]["counters"]["scene reads"] == 2
    assert steps["enabled"]["counters"]["sub-frames"] >= 2


def test_disabling_leaves_no_handler(session: Path) -> None:
    steps = {step["name"]: step for step in seen(session)["steps"]}
    assert steps["enabled"]["handlers"] == 4
    assert steps["disabled"]["handlers"] == 0
    assert not steps["disabled"]["enabled"]


@pytest.mark.usefixtures("gpu")
def test_window_shows_what_the_headless_renderer_draws(session: Path) -> None:
    """On the mirror, in the demo's Standard view transform."""
    if not (session / "enabled.png").is_file():
        pytest.skip("no ImageMagick to take a picture of the window")
    import bpy
    from curvrefl.curvrefl_addon.renderer.frame import Renderer, Settings
    from curvrefl.curvrefl_addon.report.display import display_transform
    from curvrefl.curvrefl_addon.scene.blend_file import find_reflectors, open_blend
    from curvrefl.curvrefl_addon.scene.extract import extract_scene
    from curvrefl.curvrefl_addon.scene.view import View

    x, y, width, height = seen(session)["view"]["region"]
    image = bpy.data.images.load(str(session / "enabled.png"))
    pixels = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], 4)
    window = pixels[y : y + height, x : x + width, :3]

    open_blend(session / "demo.blend")
    scene = bpy.context.scene
    arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, find_reflectors(scene, ["Kettle"]), False)
    matrices = seen(session)["view"]
    view = View(np.array(matrices["view_matrix"]), np.array(matrices["window_matrix"]), width, height)
    frame = Renderer(arrays, Settings(samples=8)).render(view)
    expected = display_transform(frame.color()[..., :3])
    inner = frame.mask() > 0
    for _ in range(3):
        inner[1:-1, 1:-1] &= inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    difference = np.abs(window - expected)[inner]
    assert inner.sum() > 10_000
    assert np.median(difference) < 3 / 255
    assert np.percentile(difference, 90) < 16 / 255
