# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostic views and passes of mirrors that paths draw: those of the same mirror, sharp and opaque."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import MODES
from curvrefl.curvrefl_addon.engine.passes import OF_MIRRORS
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.reflection import Diagnostic
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 64, 48, 0.5)
MADE_OF: dict[str, dict[str, Any]] = {
    "rough": {"roughness": 0.3},
    "glass": {"metallic": 0.0, "transmission": 1.0},
    "clear": {"alpha": 0.5},
}


def scene_of(**mirror: Any) -> SceneArrays:
    """A mirror before a floor and a ball, which lets light straight on where the mirror is not plain."""
    room = Room()
    room.add_mirror(Ellipsoid(), 64)
    room.add_rectangle((0.0, 0.0, -1.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))
    room.add_ball((1.3, -1.6, 0.1), 0.5)
    arrays = room.arrays()
    clear = replace(arrays.materials[0], alpha=0.5 if mirror else 1.0)
    instances = (*arrays.instances[:2], replace(arrays.instances[2], materials=(2,)))
    materials = (arrays.materials[0], replace(arrays.materials[1], **mirror), clear)
    return replace(arrays, instances=instances, materials=materials)


def explained(scene: SceneArrays) -> dict[str, np.ndarray]:
    """Every diagnostic view, and every pass of what the mirror shows."""
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    reflection = renderer.reflect(VIEW)
    found = {}
    for mode in MODES:
        canvas = Canvas.of_size(VIEW.width, VIEW.height)
        renderer.add_sub_frame(canvas, reflection, 0, 1.0, diagnostic=Diagnostic(mode))
        found[mode] = read_texture(canvas.texture)
    frame = renderer.render(VIEW)
    for name, item in OF_MIRRORS.items():
        found[name] = item.pixels(frame)
    found["mask"] = frame.mask()
    mirrors = Canvas.of_size(VIEW.width, VIEW.height)
    renderer.render(VIEW, mirrors_alone=mirrors)
    found["cover"] = read_texture(mirrors.texture)[..., 3]
    renderer.free()
    return found


@pytest.fixture(scope="module")
def plain(gpu: None) -> dict[str, np.ndarray]:
    return explained(scene_of())


@pytest.mark.parametrize("kind", MADE_OF)
def test_they_follow_the_sharp_mirrors_ray(kind: str, plain: dict[str, np.ndarray]) -> None:
    found = explained(scene_of(**MADE_OF[kind]))
    assert found.keys() == plain.keys() and (plain["mask"] > 0).sum() > 200
    for name, picture in plain.items():
        assert np.array_equal(found[name], picture), name
