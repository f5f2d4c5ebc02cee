# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflection points that follow a playing scene: started from the frame before, they are those of a fresh search."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.renderer.reflection import Reflection
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.paths.soft_room import soft_room, soft_view

pytestmark = pytest.mark.usefixtures("gpu")

FRAMES = 6
MIRROR, FLOOR, BALL = 0, 1, 2
NEWTON = Settings(method="newton", samples=1)


@cache
def room() -> SceneArrays:
    """The soft room about a mirror that bends differently everywhere. Always the same arrays, as what has not changed
    is known by its identity."""
    scene = soft_room()
    shape = replace(scene.instances[MIRROR], matrix=np.diag([1.25, 0.8, 0.95, 1.0]))
    return replace(scene, instances=(shape, *scene.instances[1:]))


def placed(scene: SceneArrays, index: int, way: tuple[float, float, float], turn: float = 0.0) -> SceneArrays:
    """With one instance elsewhere, turned about its own vertical axis."""
    matrix = scene.instances[index].matrix.copy()
    sine, cosine = np.sin(turn), np.cos(turn)
    matrix[:3, :3] = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]) @ matrix[:3, :3]
    matrix[:3, 3] += way
    item = replace(scene.instances[index], matrix=matrix)
    return replace(scene, instances=(*scene.instances[:index], item, *scene.instances[index + 1 :]))


def moving_mirror(frame: int) -> tuple[SceneArrays, View]:
    return placed(room(), MIRROR, (0.05 * frame, 0.03 * frame, 0.02 * frame), 0.05 * frame), soft_view(160, 120)


def moving_ball(frame: int) -> tuple[SceneArrays, View]:
    return placed(room(), BALL, (-0.3 * frame, -0.1 * frame, 0.1 * frame), 0.2 * frame), soft_view(160, 120)


def moving_eye(frame: int) -> tuple[SceneArrays, View]:
    return room(), soft_view(160, 120, turn=2.0 * frame)


def cutting(frame: int) -> tuple[SceneArrays, View]:
    """To the other side and back."""
    return room(), soft_view(160, 120, turn=2.0 * frame + 150.0 * (frame % 2))


def changing(frame: int) -> tuple[SceneArrays, View]:
    """The ball's mesh has as many vertices in each frame, in another order, and in every third others."""
    scene = room()
    number = scene.instances[BALL].mesh
    mesh = scene.meshes[number]
    order = np.random.default_rng(frame).permutation(len(mesh.positions))
    if frame % 3 == 2:
        mesh = scene.meshes[scene.instances[FLOOR].mesh]
        order = np.arange(len(mesh.positions))
    back = np.argsort(order).astype(np.int32)
    corners = back[mesh.corner_vertex]
    other = replace(mesh, positions=mesh.positions[order].copy(), corner_vertex=corners, signature=1000 + frame)
    return replace(scene, meshes=(*scene.meshes[:number], other, *scene.meshes[number + 1 :])), soft_view(160, 120)


def points_of(reflection: Reflection) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pixels, statuses and iterations of all vertices."""
    read = [solution.read() for solution in reflection.solutions]
    points = np.concatenate([one[0] for one in read]).astype(np.float64)
    return (
        reflection.view.project(points),
        np.concatenate([one[1] for one in read]),
        np.concatenate([one[2] for one in read]),
    )


@pytest.mark.parametrize("play", [moving_mirror, moving_ball, moving_eye, cutting, changing])
def test_points_are_those_of_a_fresh_search(play: object) -> None:
    """In no frame is a vertex elsewhere than without the frame before, nor does it pop by a pixel; and what has moved
    little needs fewer steps."""
    warm, last, steps, fresh_steps = None, None, [], []
    error_before = None
    for frame in range(FRAMES):
        scene, view = play(frame)  # type: ignore[operator]
        if warm is None:
            warm = Renderer(scene, NEWTON)
        else:
            warm.update(scene)
        last = warm.reflect(view, last=last)
        places, codes, iterations = points_of(last)
        right, right_codes, fresh_iterations = points_of(warm.reflect(view))
        assert len(codes) == len(right_codes) > 500
        assert np.mean(codes != right_codes) < 0.002, (frame, np.mean(codes != right_codes))
        both = (codes == status.REFLECTED) & (right_codes == status.REFLECTED)
        error = places - right
        assert both.sum() > 100
        assert np.linalg.norm(error[both], axis=1).max() < 0.5, (frame, np.linalg.norm(error[both], axis=1).max())
        if error_before is not None and len(error_before[0]) == len(error):
            kept = both & error_before[1]
            assert np.linalg.norm((error - error_before[0])[kept], axis=1).max(initial=0.0) < 1.0, frame
        error_before = (error, both)
        if frame:
            steps.append(iterations[both].mean())
            fresh_steps.append(fresh_iterations[both].mean())
    assert warm is not None
    warm.free()
    if play in (moving_eye, moving_ball, moving_mirror):
        assert np.mean(steps) < np.mean(fresh_steps), (steps, fresh_steps)
