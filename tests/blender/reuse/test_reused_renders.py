# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that draw on the frames before: the same whoever draws them, and cuts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from rendered import mark, pixels, render
from small_scene import build_scene

FRAMES = (5, 6, 7)


@pytest.fixture
def scene(gpu: None) -> Iterator[bpy.types.Scene]:
    """A rough ball and a block that moves, under a large lamp."""
    registration.register()
    ball = build_scene()
    scene: Any = bpy.context.scene
    mark(scene, ball.name)
    scene.curvrefl.render_samples, scene.curvrefl.reuse_frames = 2, 2
    ball.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.3
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.2
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
    lamp.data.energy, lamp.data.size, lamp.location = 300.0, 2.0, (0.0, 0.0, 4.0)
    scene.collection.objects.link(lamp)
    block = bpy.data.objects["Block"]
    for frame, place in ((1, 1.4), (10, 2.6)):
        block.location.x = place
        block.keyframe_insert("location", frame=frame)
    yield scene
    registration.unregister()


def frame_alone(scene: Any, frame: int, path: Path) -> np.ndarray:
    scene.frame_set(frame)
    return pixels(render(path))


def test_a_frame_is_the_same_whoever_has_drawn_those_before(scene: Any, tmp_path: Path) -> None:
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    alone = {frame: frame_alone(scene, frame, tmp_path / f"alone_{frame}.exr") for frame in reversed(FRAMES)}
    assert scene.frame_current == FRAMES[0]
    scene.render.filepath, scene.render.use_file_extension = str(tmp_path / "film_"), True
    bpy.ops.render.render(animation=True)
    for frame in FRAMES:
        np.testing.assert_array_equal(pixels(tmp_path / f"film_{frame:04d}.exr"), alone[frame])
    scene.curvrefl.reuse_frames = 0
    assert not np.array_equal(frame_alone(scene, FRAMES[0], tmp_path / "plain.exr"), alone[FRAMES[0]])


def test_nothing_is_drawn_on_across_a_cut(scene: Any, tmp_path: Path) -> None:
    """Another camera at the same place from the frame on: it has its own sub-frames alone, the frame after both."""
    other = bpy.data.objects.new("Other", scene.camera.data)
    other.location, other.rotation_euler = scene.camera.location, scene.camera.rotation_euler
    scene.collection.objects.link(other)
    for frame, camera in ((1, scene.camera), (6, other)):
        scene.timeline_markers.new(f"at {frame}", frame=frame).camera = camera
    cut = {frame: frame_alone(scene, frame, tmp_path / f"cut_{frame}.exr") for frame in (5, 6, 7)}
    scene.timeline_markers.clear()
    whole = {frame: frame_alone(scene, frame, tmp_path / f"whole_{frame}.exr") for frame in (5, 6, 7)}
    np.testing.assert_array_equal(cut[5], whole[5])
    for frame in (6, 7):
        assert not np.array_equal(cut[frame], whole[frame])
