# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a transparent film is covered where light goes straight on: as in Cycles 1 less what gets through."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize(
    ("alpha", "tint", "covered"),
    [
        (0.5, (1.0, 1.0, 1.0), 0.5),
        (0.0, (1.0, 0.5, 0.3), 0.4),
        (0.5, (1.0, 0.5, 0.3), 0.7),
        (1.0, (1.0, 1.0, 1.0), 1.0),
    ],
    ids=str,
)
def test_a_pane_covers_what_it_stops(alpha: float, tint: tuple[float, float, float], covered: float) -> None:
    room = Room()
    room.add_mirror(Ellipsoid(), 32)
    room.add_rectangle((0.0, -3.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    arrays = room.arrays()
    pane = MaterialArrays("pane", (0.5, 0.5, 0.5), specular_level=0.0, alpha=alpha, transparent_tint=tint)
    instances = (arrays.instances[0], replace(arrays.instances[1], materials=(2,)))
    scene = replace(arrays, instances=instances, materials=(*arrays.materials, pane))
    renderer = Renderer(scene, Settings(method="exact", samples=16, film_transparent=True))
    # (Past the mirror, which stands behind the pane.)
    view = look_at(np.array([2.5, -6.0, 0.0]), np.array([2.5, 0.0, 0.0]), 24, 18, 0.2)
    picture = renderer.render(view).color()
    renderer.free()
    assert picture[..., 3].mean() == pytest.approx(covered, abs=0.01)


def test_a_hole_behind_a_pane_is_one() -> None:
    room = Room()
    room.add_mirror(Ellipsoid(), 32)
    room.add_rectangle((0.0, -3.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    room.add_rectangle((0.0, 3.0, 0.0), (40.0, 0.0, 0.0), (0.0, 0.0, 40.0))
    arrays = room.arrays()
    pane = MaterialArrays("pane", (0.5, 0.5, 0.5), specular_level=0.0, alpha=0.25)
    instances = (
        arrays.instances[0],
        replace(arrays.instances[1], materials=(2,)),
        replace(arrays.instances[2], holdout=True),
    )
    scene = replace(arrays, instances=instances, materials=(*arrays.materials, pane))
    renderer = Renderer(scene, Settings(method="exact", samples=16))
    view = look_at(np.array([2.5, -6.0, 0.0]), np.array([2.5, 0.0, 0.0]), 24, 18, 0.2)
    picture = renderer.render(view).color()
    renderer.free()
    assert picture[..., 3].mean() == pytest.approx(0.25, abs=0.01)
