# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files, cameras and reflectors that users name."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, find_reflectors, open_blend, view_of_camera
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import with_render_depsgraph
from extraction import add, empty_scene, link
from mathutils import Vector


@pytest.fixture
def scene() -> bpy.types.Scene:
    return empty_scene()


def camera(**values: object) -> bpy.types.Object:
    data = bpy.data.cameras.new("camera")
    for name, value in values.items():
        setattr(data, name, value)
    obj = link(bpy.data.objects.new("camera", data))
    obj.location = (3.0, -4.0, 2.0)
    obj.rotation_euler = (1.1, 0.2, 0.6)
    obj.scale = (2.0, 3.0, 0.5)
    return obj


@pytest.mark.parametrize("size", [(64, 48), (48, 64)])
@pytest.mark.parametrize("aspect", [(1.0, 1.0), (2.0, 1.0)])
@pytest.mark.parametrize(
    "values",
    [
        {},
        {"shift_x": 0.3, "shift_y": -0.2},
        {"sensor_fit": "VERTICAL", "sensor_height": 30.0},
        {"sensor_fit": "HORIZONTAL", "lens": 20.0},
        {"type": "ORTHO", "ortho_scale": 5.0, "shift_x": 0.1},
    ],
)
def test_points_land_where_blender_says(
    scene: bpy.types.Scene, values: dict[str, object], aspect: tuple[float, float], size: tuple[int, int]
) -> None:
    eye = camera(**values)
    eye.scale = (1.0, 1.0, 1.0)  # world_to_camera_view does not take it out
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    bpy.context.view_layer.update()
    view = view_of_camera(scene, eye, *size)
    points = np.random.default_rng(1).uniform(-2.0, 2.0, (20, 3))
    expected = [world_to_camera_view(scene, eye, Vector(point))[:2] for point in points]
    np.testing.assert_allclose(view.project(points) / np.array(size), expected, atol=1e-4)
    assert view.is_orthographic == (values.get("type") == "ORTHO")


def test_the_scale_of_the_camera_does_not_count(scene: bpy.types.Scene) -> None:
    eye = camera()
    bpy.context.view_layer.update()
    scaled = view_of_camera(scene, eye, 32, 32)
    eye.scale = (1.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    np.testing.assert_allclose(scaled.world_to_clip, view_of_camera(scene, eye, 32, 32).world_to_clip, atol=1e-5)
    np.testing.assert_allclose(scaled.eye, [3.0, -4.0, 2.0, 1.0], atol=1e-6)


def test_cameras_that_cannot_be_used(scene: bpy.types.Scene) -> None:
    eye = camera(type="PANO")
    with pytest.raises(InputError, match="panoramic"):
        view_of_camera(scene, eye, 8, 8)
    eye.data.type = "PERSP"
    with pytest.raises(InputError, match="no pixels"):
        view_of_camera(scene, eye, 0, 8)
    eye.scale = (1.0, 0.0, 1.0)
    bpy.context.view_layer.update()
    with pytest.raises(InputError, match="scale"):
        view_of_camera(scene, eye, 8, 8)


def test_finding_a_camera(scene: bpy.types.Scene) -> None:
    with pytest.raises(InputError, match="has no camera"):
        find_camera(scene)
    eye = camera()
    add("cube")
    assert find_camera(scene, "camera") == eye
    with pytest.raises(InputError, match='did you mean "camera"'):
        find_camera(scene, "Camra")
    with pytest.raises(InputError, match='"cube" is not a camera'):
        find_camera(scene, "cube")
    scene.camera = eye
    assert find_camera(scene) == eye


def test_the_camera_of_a_marker(scene: bpy.types.Scene) -> None:
    scene.camera = camera()
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.engine, scene.cycles.samples = "CYCLES", 1  # (no shaders to compile)
    for frame in (10, 20, 30):
        marker = scene.timeline_markers.new(f"at {frame}", frame=frame)
        marker.camera = link(bpy.data.objects.new(f"from {frame}", bpy.data.cameras.new("eye")))
    for frame, name in ((1, "from 10"), (10, "from 10"), (19, "from 10"), (20, "from 20"), (99, "from 30")):
        scene.frame_current = frame
        assert find_camera(scene).name == name
        scene.camera = find_camera(scene)
        with_render_depsgraph(scene, bpy.context.view_layer, lambda _depsgraph: None, camera=find_camera(scene))
        assert scene.camera.name == name, "It is not the scene's again"
        bpy.ops.render.render()
        assert scene.camera.name == name, "Blender itself chooses another"


def test_finding_reflectors(scene: bpy.types.Scene) -> None:
    ball, block = add("Mirror Ball"), add("Block")
    assert find_reflectors(scene, ["Block", "Mirror Ball", "Block"]) == [block, ball]
    for name, said in (
        ("mirror bal", 'did you mean "Mirror Ball"'),
        ("zzz", 'choose from "Block", "Mirror Ball"'),
        ("camera", "not a mesh but of type camera"),
        ("bare", "no faces"),
    ):
        if name == "camera":
            camera()
        elif name == "bare":
            add("bare", [(0, 0, 0)], [])
        with pytest.raises(InputError, match=said) as caught:
            find_reflectors(scene, [name])
        assert str(caught.value).endswith((".", "?"))
    with pytest.raises(InputError, match="name at least one"):
        find_reflectors(scene, [])


def test_opening_files(scene: bpy.types.Scene, tmp_path: Path) -> None:
    add("kept")
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    empty_scene()
    open_blend(path)
    assert "kept" in bpy.data.objects
    whole = path.read_bytes()
    for content in (b"", b"BLENDER", b"something else", whole[: len(whole) // 2], b"BLENDER-v502" + bytes(1000)):
        broken = tmp_path / "broken.blend"
        broken.write_bytes(content)
        with pytest.raises(InputError, match=r"broken\.blend"):
            open_blend(broken)
    with pytest.raises(InputError, match="no file"):
        open_blend(tmp_path / "none.blend")
    with pytest.raises(InputError, match="not a file"):
        open_blend(tmp_path)
