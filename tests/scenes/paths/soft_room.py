# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror ball among colored balls on a floor, under an area lamp and a dim sky: what many sub-frames are for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, MaterialArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.lens import Lens
from curvrefl.curvrefl_addon.scene.camera.view import View

from ..mirror_room import Room
from ..views import look_at

BALLS = (
    ((1.8, -1.0, -0.6), 0.5, (0.8, 0.2, 0.1)),
    ((-1.9, -0.8, -0.5), 0.6, (0.1, 0.7, 0.2)),
    ((0.4, -2.2, -0.8), 0.3, (0.2, 0.3, 0.9)),
)
TARGET = (0.0, 0.0, -0.2)


def soft_room(roughness: float = 0.0, with_lamp: bool = True) -> SceneArrays:
    """The mirror has this roughness."""
    room = Room()
    room.add_mirror(Ellipsoid(), 64)
    room.add_rectangle((0.0, 0.0, -1.2), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    for center, radius, _ in BALLS:
        room.add_ball(center, radius)
    arrays = room.arrays()
    materials, instances = list(arrays.materials), list(arrays.instances)
    materials[1] = replace(materials[1], roughness=roughness)
    for number, (_, _, color) in enumerate(BALLS):
        instances[2 + number] = replace(instances[2 + number], materials=(len(materials),))
        materials.append(MaterialArrays(f"paint {number}", color))
    matrix = np.eye(4)
    matrix[:3, 3] = (1.5, -2.0, 4.0)
    lamp = LightArrays("lamp", "AREA", (200.0, 190.0, 170.0), matrix, size=(1.5, 1.5))
    return replace(
        arrays,
        materials=tuple(materials),
        instances=tuple(instances),
        lights=(lamp,) if with_lamp else (),
        world=WorldArrays((0.15, 0.2, 0.25)),
    )


def soft_view(width: int, height: int, lens: Lens | None = None, turn: float = 0.0) -> View:
    """From before the mirror; `turn`: degrees round it."""
    angle = np.radians(turn)
    eye = (5.5 * np.sin(angle), -5.5 * np.cos(angle), 1.6)
    return replace(look_at(eye, TARGET, width, height, np.radians(40.0)), lens=lens)
