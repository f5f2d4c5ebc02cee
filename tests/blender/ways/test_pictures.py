# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures drawn on devices that lack something agree with the usual ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, only_features
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import Room
from scenes.radial_maps import SURFACES
from scenes.views import look_at
from ways.lacking import LACKING, WHOLE

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = 96, 72
ROUNDED = 2e-3
"""A triangle's edge may fall on the other side of a pixel where points are rounded otherwise: so many pixels differ"""


def room(roughness: float = 0.0) -> SceneArrays:
    """A mirror over a floor, balls around it, under an even sky whose light they keep off each other."""
    things = Room()
    things.add_mirror(SURFACES["ellipsoid"], 64)
    things.add_rectangle((0.0, 0.0, -0.4), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0))
    things.add_ball((1.4, -0.9, 0.1), 0.4)
    things.add_ball((-0.6, -1.5, -0.1), 0.3)
    scene = things.arrays()
    gray, chrome = scene.materials
    return replace(scene, materials=(gray, replace(chrome, roughness=roughness)))


def view() -> View:
    return look_at(np.array([2.3, -2.9, 1.8]), np.zeros(3), *SIZE, np.radians(40))


def drawn(device: Features, scene: SceneArrays, method: str, samples: int) -> np.ndarray:
    """(h, w, 3)"""
    with only_features(device):
        renderer = Renderer(scene, Settings(method=method, samples=samples))
        try:
            return renderer.render(view()).color()[..., :3]
        finally:
            renderer.free()


@pytest.mark.parametrize("lacks", ["compute", "atomics"])
@pytest.mark.parametrize("method", ["newton", "exact", "auto"])
def test_without_compute_or_atomics(method: str, lacks: str) -> None:
    usual, found = (drawn(device, room(), method, 1) for device in (WHOLE, LACKING[lacks]))
    assert (np.abs(found - usual).max(axis=-1) > 1e-3).mean() <= ROUNDED
    assert np.ptp(usual) > 0.1


@pytest.mark.parametrize(("roughness", "samples"), [(0.0, 1), (0.0, 16), (0.2, 16)])
def test_without_quads_each_pixel_looks_up_all_directions(roughness: float, samples: int) -> None:
    """Where a shadow's edge crosses a quad its pixels have no mean of four places, but their own."""
    usual, found = (drawn(device, room(roughness), "exact", samples) for device in (WHOLE, LACKING["quads"]))
    off = np.abs(found - usual).max(axis=-1)
    assert 0.0 < off.mean() < 6e-3
    assert (off > 0.02).mean() < 0.08
    assert abs(found.mean() - usual.mean()) < 1e-3
