# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnaces: rows of white things in a white world. What takes no light away is as bright as the world.

Things of a row are far behind each other, so that none takes light from another. Of glass there are single sheets,
outside above and inside below: what goes into a ball of glass may be reflected in it more often than is followed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object
from curvrefl.curvrefl_addon.demo.shapes import plane

from .registry import add_scene
from .stage import Place, clear, empty, of_principled, put_ball

ROUGHNESSES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
METALLICS = (0.0, 0.5, 1.0)
IORS = (1.1, 1.5, 2.4)
FURNACE_WORLD = 0.5
APART = 25.0
"""Meters from one thing to the next, away from the eye"""


def ball_name(row: int, column: int) -> str:
    return f"Ball {row} {column}"


def _rows(make: Callable[..., Any], values: Sequence[float], put: Callable[..., Any] = put_ball) -> None:
    """A thing of `make(value, roughness)` each, rows from the bottom; the eye is far off and nothing hides another."""
    scene = empty((FURNACE_WORLD, FURNACE_WORLD, FURNACE_WORLD))
    columns, rows = len(ROUGHNESSES), len(values)
    for row, value in enumerate(values):
        for column, roughness in enumerate(ROUGHNESSES):
            across, up = 2.6 * (column - 0.5 * (columns - 1)), 2.6 * (row - 0.5 * (rows - 1))
            place = (across, APART * (row * columns + column), up)
            put(make(value, roughness), ball_name(row, column), place).visible_shadow = False
    add_camera((0.0, -60.0, 0.0), (0.0, 0.0, 0.0), orthographic_width=2.6 * columns, clip=(1.0, 2000.0))
    scene.render.resolution_x, scene.render.resolution_y = 24 * columns, 24 * rows


def _put_sheet(material: Any, name: str, place: Place) -> Any:
    """Seen at 50 degrees from outside, or from inside where the name says so."""
    from_inside = int(name.split()[1]) >= len(IORS)
    turn = np.pi / 2.0 + (np.pi if from_inside else 0.0)
    return add_object(name, plane((2.0, 2.0)), material, location=place, rotation=(turn, 0.0, 0.9))


def names(rows: int) -> tuple[str, ...]:
    return tuple(ball_name(row, column) for row in range(rows) for column in range(len(ROUGHNESSES)))


def _white(**inputs: Any) -> Any:
    return of_principled("White", Base_Color=(1.0, 1.0, 1.0, 1.0), **inputs)


def _metallic() -> None:
    _rows(lambda value, roughness: _white(Metallic=value, Roughness=roughness), METALLICS)


def _dielectric() -> None:
    _rows(lambda value, roughness: _white(IOR=value, Roughness=roughness), IORS)


def _glass() -> None:
    _rows(clear, (*IORS, *IORS), _put_sheet)


def _coat() -> None:
    def coated(value: float, roughness: float) -> Any:
        return _white(Metallic=value, Roughness=0.4, Coat_Weight=1.0, Coat_Roughness=roughness)

    _rows(coated, (0.0, 1.0))


def _anisotropic() -> None:
    _rows(lambda value, roughness: _white(Metallic=1.0, Anisotropic=value, Roughness=roughness), (0.5, 1.0))


for _name, _text, _build, _count in (
    ("furnace_metallic", "white balls: roughness along, metallic 0, 0.5 and 1 upward", _metallic, 3),
    ("furnace_dielectric", "white dielectrics: roughness along, IOR 1.1, 1.5 and 2.4 upward", _dielectric, 3),
    ("furnace_glass", "clear glass: roughness along, IOR 1.1, 1.5, 2.4 upward, outside and inside", _glass, 6),
    ("furnace_coat", "coated white: the coat's roughness along, metallic 0 and 1 upward", _coat, 2),
    ("furnace_anisotropic", "white metal: roughness along, anisotropy 0.5 and 1 upward", _anisotropic, 2),
):
    add_scene(_name, _text, _build, mirrors=names(_count), samples=256)
