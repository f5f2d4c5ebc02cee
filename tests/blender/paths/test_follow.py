# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A renderer whose scene changes draws what a new one draws: paths come, go and know of what they depend on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from scenes.paths.soft_room import soft_room, soft_view

pytestmark = pytest.mark.usefixtures("gpu")

SETTINGS = Settings(method="exact", samples=2)


def glassy(scene: SceneArrays) -> SceneArrays:
    materials = [replace(item, transmission=1.0, metallic=0.0) for item in scene.materials]
    return replace(scene, materials=tuple(materials))


def moved(scene: SceneArrays) -> SceneArrays:
    shift = np.eye(4)
    shift[0, 3] = 0.2
    instances = [replace(item, matrix=shift @ item.matrix) for item in scene.instances]
    return replace(scene, instances=tuple(instances))


@pytest.mark.parametrize(
    "change",
    [
        lambda scene: soft_room(0.0),
        lambda scene: soft_room(0.5),
        glassy,
        moved,
        lambda scene: replace(scene, mirror_bounces=0),
    ],
    ids=["sharp", "rougher", "glass", "moved", "no bounces"],
)
def test_a_changed_scene_is_drawn_as_a_new_one(change: Any) -> None:
    rough = soft_room(0.3)
    view = soft_view(48, 36)
    renderer, fresh = Renderer(rough, SETTINGS), Renderer(change(rough), SETTINGS)
    try:
        first = renderer.render(view).color()
        renderer.update(change(rough))
        np.testing.assert_array_equal(renderer.render(view).color(), fresh.render(view).color())
        renderer.update(rough)
        np.testing.assert_array_equal(renderer.render(view).color(), first)
    finally:
        renderer.free()
        fresh.free()
