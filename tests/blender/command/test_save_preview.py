# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews: stills and frame ranges, without a window."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.report.images import load_exr

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def scene(tmp_path: Path) -> Iterator[None]:
    """A chrome ball, a red cube that moves, a camera, 40 x 30 pixels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = "Mirror"
    chrome = bpy.data.materials.new("Chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    bpy.context.object.data.materials.append(chrome)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(1.0, -2.0, 0.0))
    cube = bpy.context.object
    cube.name = "Cube"
    cube.keyframe_insert("location", frame=1)
    cube.location.x = -1.0
    cube.keyframe_insert("location", frame=3)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -6.0, 0.0), (np.pi / 2, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 80, 60, 50
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 3
    bpy.context.scene.frame_set(2)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    yield
    registration.unregister()


def test_still_of_the_marked_mirror(tmp_path: Path) -> None:
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    assert bpy.ops.curvrefl.save_preview(filepath="//still.exr", samples=2) == {"FINISHED"}
    pixels = load_exr(tmp_path / "still.exr")
    assert pixels.shape[:2] == (30, 40)
    assert bpy.context.scene.frame_current == 2


def test_png_goes_through_the_view_transform(tmp_path: Path) -> None:
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    pictures = []
    for transform in ("Standard", "AgX"):
        bpy.context.scene.view_settings.view_transform = transform
        bpy.ops.curvrefl.save_preview(filepath=f"//{transform}.png", samples=1)
        image = bpy.data.images.load(str(tmp_path / f"{transform}.png"))
        pictures.append(np.array(image.pixels))
        bpy.data.images.remove(image)
    assert np.abs(pictures[0] - pictures[1]).max() > 0.02
    assert bpy.context.scene.render.image_settings.file_format == "PNG"
    assert not bpy.data.images, "nothing is left in the file"


def test_frame_range_follows_the_animation(tmp_path: Path) -> None:
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    assert bpy.ops.curvrefl.save_preview(filepath="//p_##.exr", animation=True, samples=1) == {"FINISHED"}
    frames = [load_exr(tmp_path / f"p_{number:02}.exr") for number in (1, 2, 3)]
    assert np.abs(frames[0] - frames[1]).mean() > 1e-3 and np.abs(frames[1] - frames[2]).mean() > 1e-3
    # The cube goes from right to left past the mirror's middle: the last frame is the first one's mirror image.
    assert np.abs(frames[0] - frames[2][:, ::-1]).mean() < 0.1 * np.abs(frames[0] - frames[2]).mean()
    assert bpy.context.scene.frame_current == 2
    bpy.ops.curvrefl.save_preview(filepath="//still.exr", samples=1)
    np.testing.assert_allclose(load_exr(tmp_path / "still.exr"), frames[1], atol=1e-3)


def test_override_is_in_the_preview(tmp_path: Path) -> None:
    settings = bpy.data.objects["Mirror"].curvrefl
    settings.is_mirror = True
    bpy.context.scene.frame_set(1)  # the cube stands to the right of the ball
    bpy.ops.curvrefl.save_preview(filepath="//plain.exr", samples=1)
    settings.override, settings.tint, settings.fresnel = True, (1.0, 0.0, 0.0), "CONSTANT"
    bpy.ops.curvrefl.save_preview(filepath="//red.exr", samples=1)
    plain, red = load_exr(tmp_path / "plain.exr"), load_exr(tmp_path / "red.exr")
    assert plain[15, 14, 1] > 0.01 > 1e-4 > red[15, 14, 1]
    assert red[15, 14, 0] > 0.01


def test_selected_mesh_without_a_marked_one(tmp_path: Path) -> None:
    for obj in bpy.context.scene.objects:
        obj.select_set(obj.name == "Mirror")
    assert bpy.ops.curvrefl.save_preview(filepath="//p.png", animation=True, samples=1) == {"FINISHED"}
    assert sorted(path.name for path in tmp_path.glob("*.png")) == ["p_0001.png", "p_0002.png", "p_0003.png"]


def test_mistakes_are_told_and_leave_nothing(tmp_path: Path) -> None:
    for obj in bpy.context.scene.objects:
        obj.select_set(False)
    with pytest.raises(RuntimeError, match="mark one, or select a mesh"):
        bpy.ops.curvrefl.save_preview(filepath="//p.png")
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    with pytest.raises(RuntimeError, match="must end in"):
        bpy.ops.curvrefl.save_preview(filepath="//p.jpg")
    bpy.context.scene.camera = None
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvrefl.save_preview(filepath="//p.png")
    assert not list(tmp_path.glob("p*"))
