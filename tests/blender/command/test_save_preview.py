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


def test_a_range_with_a_step_goes_on_where_it_was_stopped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    given = {"filepath": "//p_##.png", "animation": True, "samples": 1, "frame_step": 2}
    bpy.ops.curvrefl.save_preview(**given)
    assert sorted(path.name for path in tmp_path.glob("*.png")) == ["p_01.png", "p_03.png"]
    assert "Frame 3 (2 of 2), about" in capfd.readouterr().out
    first, third = tmp_path / "p_01.png", tmp_path / "p_03.png"
    whole, kept = first.read_bytes(), third.stat().st_mtime_ns
    first.write_bytes(whole[:-20])
    bpy.ops.curvrefl.save_preview(**{**given, "frame_step": 1, "resume": True})
    assert first.read_bytes() == whole and third.stat().st_mtime_ns == kept
    assert len(list(tmp_path.glob("*.png"))) == 3
    assert "Saved 2 pictures, 1 were there already" in capfd.readouterr().out


def test_cameras_are_cut_by_markers_and_the_scene_is_as_before(tmp_path: Path) -> None:
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    scene = bpy.context.scene
    eye = scene.camera
    other = bpy.data.objects.new("Other", eye.data)
    other.location, other.rotation_euler = (6.0, 0.0, 0.0), (np.pi / 2, 0.0, np.pi / 2)
    scene.collection.objects.link(other)
    for frame, camera in ((1, eye), (2, other), (3, eye)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    scene.camera = eye
    bpy.ops.curvrefl.save_preview(filepath="//cut_#.exr", animation=True, samples=1)
    assert (scene.frame_current, scene.camera) == (2, eye)
    cut = [load_exr(tmp_path / f"cut_{frame}.exr") for frame in (1, 2, 3)]
    scene.timeline_markers.clear()
    for number, (frame, camera) in enumerate(((1, eye), (2, other), (3, eye))):
        scene.camera = camera
        bpy.ops.curvrefl.save_preview(
            filepath="//p_#.exr", animation=True, frame_start=frame, frame_end=frame, samples=1
        )
        assert np.array_equal(load_exr(tmp_path / f"p_{frame}.exr"), cut[number])


def test_a_video_shows_the_pictures_as_they_are(tmp_path: Path) -> None:
    """By a codec that loses nothing, in a scene whose view transform must not come in twice."""
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    scene = bpy.context.scene
    assert scene.view_settings.view_transform == "AgX"
    scenes = len(bpy.data.scenes)
    bpy.ops.curvrefl.save_preview(filepath="//p_#.png", animation=True, samples=1)
    scene.render.image_settings.media_type = "VIDEO"
    scene.render.ffmpeg.format, scene.render.ffmpeg.codec = "MKV", "FFV1"
    # (Without an ending it is what the scene's output is.)
    bpy.ops.curvrefl.save_preview(filepath="//film", animation=True, samples=1)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.blend", "film.mkv", "p_1.png", "p_2.png", "p_3.png"]
    assert (len(bpy.data.scenes), scene.frame_current, scene.render.ffmpeg.codec) == (scenes, 2, "FFV1")
    for frame, shown in enumerate(frames_of_video(tmp_path / "film.mkv", tmp_path / "shown"), 1):
        picture = bpy.data.images.load(str(tmp_path / f"p_{frame}.png"))
        assert np.array_equal(np.array(picture.pixels), shown)
    there = (tmp_path / "film.mkv").stat().st_mtime_ns
    bpy.ops.curvrefl.save_preview(filepath="//film.mkv", animation=True, samples=1, resume=True)
    assert (tmp_path / "film.mkv").stat().st_mtime_ns == there
    bpy.ops.curvrefl.save_preview(filepath="//film.mkv", animation=True, samples=1, resume=True, frame_end=2)
    assert len(frames_of_video(tmp_path / "film.mkv", tmp_path / "again")) == 2


def frames_of_video(path: Path, folder: Path) -> list[np.ndarray]:
    """Pixels of all frames as bytes in 0..1, rows from below, by a scene that shows the video and nothing else."""
    scene = bpy.data.scenes.new("shown")
    scene.sequence_editor_create().strips.new_movie("video", str(path), 1, 1)
    clip = bpy.data.movieclips.load(str(path))
    scene.frame_end = count = clip.frame_duration
    bpy.data.movieclips.remove(clip)
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 40, 30
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = f"{folder}/"
    bpy.ops.render.render(animation=True, scene=scene.name)
    found = []
    for frame in range(1, count + 1):
        picture = bpy.data.images.load(str(folder / f"{frame:04d}.png"))
        found.append(np.array(picture.pixels))
        bpy.data.images.remove(picture)
    bpy.data.scenes.remove(scene)
    return found


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
    with pytest.raises(RuntimeError, match="is a video, which has several frames"):
        bpy.ops.curvrefl.save_preview(filepath="//p.mp4")
    with pytest.raises(RuntimeError, match="end comes before its start"):
        bpy.ops.curvrefl.save_preview(filepath="//p.png", animation=True, frame_start=5, frame_end=4)
    bpy.context.scene.camera = None
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvrefl.save_preview(filepath="//p.png")
    assert not list(tmp_path.glob("p*"))
