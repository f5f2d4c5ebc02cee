# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that leave out their own mirror where they cannot meet it show the same, and look at fewer boxes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.rays.escapes import Escapes
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from scenes.mirror_halls import hall
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

VIEW = look_at(np.array((0.6, -3.0, 3.4)), np.array((0.6, 0.0, 0.0)), 160, 120, 0.7)


def torus_hall() -> SceneArrays:
    """Two tori beside each other, one turned and larger."""
    scene = hall("torus", mirrors=2)
    matrix = scene.instances[1].matrix.copy()
    matrix[:3, :3] = 1.2 * np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    matrix[:3, :3] *= np.sign(np.linalg.det(matrix[:3, :3]))
    return replace(
        scene, instances=(scene.instances[0], replace(scene.instances[1], matrix=matrix), *scene.instances[2:])
    )


def moved(scene: SceneArrays) -> SceneArrays:
    matrix = scene.instances[0].matrix.copy()
    matrix[:3, 3] += (-0.3, 0.2, 0.1)
    return replace(scene, instances=(replace(scene.instances[0], matrix=matrix), *scene.instances[1:]))


def deformed(scene: SceneArrays) -> SceneArrays:
    positions = scene.meshes[0].positions * np.float32((1.0, 0.7, 1.3))
    return replace(scene, meshes=(replace(scene.meshes[0], positions=positions), *scene.meshes[1:]))


def drawn(renderer: Renderer) -> tuple[np.ndarray, float]:
    """The picture, and boxes that mirror pixels have looked at, in the mean."""
    frame = renderer.render(VIEW)
    boxes = frame.surfaces["reflected_color"][..., 3]
    return frame.color(), float(boxes[boxes > 0.0].mean())


def fresh(scene: SceneArrays) -> Renderer:
    return Renderer(scene, Settings(method="exact", samples=1))


def test_the_picture_stays_and_fewer_boxes_are_looked_at() -> None:
    scene = torus_hall()
    renderer = fresh(scene)
    with pytest.MonkeyPatch.context() as change:
        change.setattr(Escapes, "can_improve", False)
        renderer.settle()
    before, many = drawn(renderer)
    assert not renderer.rays().escapes.are_known
    renderer.settle()
    after, few = drawn(renderer)
    assert renderer.rays().escapes.are_known and not renderer.hierarchies.can_improve
    assert np.array_equal(before, after)
    assert few < 0.9 * many
    for change_of in (moved, deformed):
        other = change_of(scene)
        renderer.update(other)
        known, _ = drawn(renderer)
        renderer.settle()
        again, _ = drawn(renderer)
        from_the_start = fresh(other)
        expected, _ = drawn(from_the_start)
        from_the_start.free()
        assert np.array_equal(known, expected) and np.array_equal(again, expected), change_of.__name__
    renderer.free()


def test_only_closed_mirrors_that_may_see_themselves_have_cones() -> None:
    for name, has_cones in (("torus", True), ("sphere", False), ("bowl", False)):
        renderer = fresh(hall(name))
        renderer.rays()
        renderer.settle()
        assert renderer.rays().escapes.are_known == has_cones, name
        renderer.free()
