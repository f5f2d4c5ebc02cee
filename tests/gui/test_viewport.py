# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An artist's session in a real Blender window, on both backends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "artist_session.py"
SIZE = (960, 640)
"""Of the window: its mirror is large enough to judge, and pixels are what a software renderer takes its time for"""
FILMS = 2
"""Handlers that hear of files with a film, for as long as the extension is there"""


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    from curvrefl.curvrefl_addon.demo.scene import build_demo

    folder = tmp_path_factory.mktemp(request.param)
    build_demo(folder / "demo.blend")
    found = in_window(SCRIPT, folder, folder / "demo.blend", folder, backend=request.param, size=SIZE)
    assert "Traceback" not in found.printed, found.printed[-3000:]
    return found


def test_session_runs_to_its_end(session: Session) -> None:
    found = session.seen
    assert "error" not in found, found.get("error")
    assert found["finished"]
    # (Reflection points show the carafe's glass as if it was opaque.)
    said = {message for step in found["steps"] for message in step["messages"]}
    glass = 'The transparency of object "Carafe" is left out in mirrors'
    assert said <= {f"{glass}: choose Automatic or Exact to see what is behind."}


def test_only_what_changed_is_done_again(session: Session) -> None:
    steps = {step["name"]: step["counters"] for step in session.seen["steps"]}
    names = [step["name"] for step in session.seen["steps"]]

    def spent(name: str) -> dict[str, int]:
        """Since the step before, of what costs."""
        before = steps[names[names.index(name) - 1]]
        return {
            key: count - before.get(key, 0)
            for key, count in steps[name].items()
            if count != before.get(key, 0) and key not in ("sub-frames", "solves", "hierarchies improved")
        }

    assert steps["enabled"]["maps baked"] == steps["enabled"]["renderers made"] == 1
    assert steps["enabled"]["sub-frames"] >= 8
    changed = spent("followed rays")
    assert changed.get("hierarchies built", 0) + steps["chose automatically"].get("hierarchies built", 0) > 1
    assert "meshes read" not in changed and "maps baked" not in changed
    changed = spent("moved an object under rays")
    assert changed == {"objects read": 1, "instances placed": 1}
    changed = spent("edited a mesh under rays")
    assert changed["hierarchies fitted"] == changed["meshes read"] == 1 and "hierarchies built" not in changed
    assert spent("moved the view") == {}
    assert spent("moved the view again") == {}
    assert spent("moved the camera") == {}
    assert spent("moved an object") == {"objects read": 1, "instances placed": 1}
    changed = spent("moved the mirror")
    # (What it has come nearer to may be split finer.)
    assert changed.keys() <= {"objects read", "instances placed", "meshes split", "chunks built"}
    assert changed["objects read"] == changed["instances placed"] == 1
    changed = spent("edited a mesh")
    assert changed["meshes read"] == 1 and "maps baked" not in changed and "renderers made" not in changed
    changed = spent("edited the mirror's mesh")
    assert changed["meshes read"] == changed["maps baked"] == 1
    assert spent("painted")["materials read"] == 1
    assert "meshes read" not in spent("painted")
    assert "meshes read" not in spent("hid an object")
    assert spent("showed zebra stripes") == {}


def test_disabling_leaves_no_handler(session: Session) -> None:
    steps = {step["name"]: step for step in session.seen["steps"]}
    assert steps["enabled"]["handlers"] == 4 + FILMS
    assert steps["disabled"]["handlers"] == FILMS
    assert not steps["disabled"]["enabled"]


@pytest.mark.usefixtures("gpu")
@pytest.mark.parametrize("picture, method", [("enabled", "secant_star"), ("exact", "exact")])
def test_window_shows_what_the_headless_renderer_draws(session: Session, picture: str, method: str) -> None:
    """On the mirror, in the demo's Standard view transform."""
    if not (session.folder / f"{picture}.png").is_file():
        pytest.skip("no ImageMagick to take a picture of the window")
    import bpy
    from curvrefl.curvrefl_addon.renderer.renderer import Renderer
    from curvrefl.curvrefl_addon.renderer.settings import Settings
    from curvrefl.curvrefl_addon.report.display import display_transform
    from curvrefl.curvrefl_addon.scene.camera.view import View
    from curvrefl.curvrefl_addon.scene.extract import extract_scene
    from curvrefl.curvrefl_addon.scene.opened.blend_file import find_reflectors, open_blend

    x, y, width, height = session.seen["view"]["region"]
    image = bpy.data.images.load(str(session.folder / f"{picture}.png"))
    pixels = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], 4)
    window = pixels[y : y + height, x : x + width, :3]

    open_blend(session.folder / "demo.blend")
    scene = bpy.context.scene
    arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, find_reflectors(scene, ["Kettle"]))
    matrices = session.seen["view"]
    view = View(np.array(matrices["view_matrix"]), np.array(matrices["window_matrix"]), width, height)
    frame = Renderer(arrays, Settings(method=method, samples=8)).render(view)
    expected = display_transform(frame.color()[..., :3])
    inner = frame.mask() > 0
    for _ in range(3):
        inner[1:-1, 1:-1] &= inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    difference = np.abs(window - expected)[inner]
    assert inner.sum() > 10_000
    assert np.median(difference) < 3 / 255
    assert np.percentile(difference, 90) < 16 / 255


@pytest.mark.usefixtures("gpu")
def test_window_agrees_with_cycles(session: Session) -> None:
    """The same view by a camera of its own, at half the size; on the mirror, which sees itself, so by rays."""
    if not (session.folder / "exact.png").is_file():
        pytest.skip("no ImageMagick to take a picture of the window")
    import bpy
    from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
    from curvrefl.curvrefl_addon.report.display import display_transform
    from curvrefl.curvrefl_addon.report.geometry_reference import render_geometry
    from curvrefl.curvrefl_addon.scene.opened.blend_file import open_blend
    from mathutils import Matrix

    x, y, width, height = session.seen["view"]["region"]
    width, height = width // 2 * 2, height // 2 * 2
    image = bpy.data.images.load(str(session.folder / "exact.png"))
    pixels = np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], 4)
    window = pixels[y : y + height, x : x + width, :3]
    window = window.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3))

    open_blend(session.folder / "demo.blend")
    scene, layer = bpy.context.scene, bpy.context.view_layer
    camera = bpy.data.objects.new("Window", bpy.data.cameras.new("Window"))
    scene.collection.objects.link(camera)
    camera.matrix_world = Matrix(session.seen["view"]["view_matrix"]).inverted()
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle_y = 2.0 * np.arctan(1.0 / session.seen["view"]["window_matrix"][1][1])
    scene.camera = camera
    layer.update()
    reference = render_reference(scene, layer, width // 2, height // 2, 128, "full")
    ids = {obj.name: number for number, obj in enumerate(scene.objects, 1)}
    inner = render_geometry(scene, layer, width // 2, height // 2, ids, (ids["Kettle"],)).mask > 0
    for _ in range(2):
        inner[1:-1, 1:-1] &= inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    difference = np.abs(window - display_transform(reference.pixels[..., :3]))[inner]
    assert inner.sum() > 3_000
    assert np.median(difference) < 10 / 255
    # (Both have the noise of what shines.)
    assert np.percentile(difference, 90) < 45 / 255
