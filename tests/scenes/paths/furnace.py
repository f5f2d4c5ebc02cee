# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnaces: rows of white balls in a white world. What takes no light away is as bright as the world."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from curvrefl.curvrefl_addon.demo.data_blocks import add_camera

from .registry import add_scene
from .stage import clear, empty, of_principled, put_ball

ROUGHNESSES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
METALLICS = (0.0, 0.5, 1.0)
IORS = (1.1, 1.5, 2.4)
FURNACE_WORLD = 0.5


def ball_name(row: int, column: int) -> str:
    return f"Ball {row} {column}"


def _rows(make: Callable[..., Any], values: Sequence[float]) -> None:
    """A ball of `make(value, roughness)` each, rows from the bottom; the eye is far off and no ball hides another."""
    scene = empty((FURNACE_WORLD, FURNACE_WORLD, FURNACE_WORLD))
    columns, rows = len(ROUGHNESSES), len(values)
    for row, value in enumerate(values):
        for column, roughness in enumerate(ROUGHNESSES):
            place = (2.6 * (column - 0.5 * (columns - 1)), 0.0, 2.6 * (row - 0.5 * (rows - 1)))
            put_ball(make(value, roughness), ball_name(row, column), place, 1.0, 64)
    add_camera((0.0, -60.0, 0.0), (0.0, 0.0, 0.0), orthographic_width=2.6 * columns)
    scene.render.resolution_x, scene.render.resolution_y = 24 * columns, 24 * rows


def names(rows: int) -> tuple[str, ...]:
    return tuple(ball_name(row, column) for row in range(rows) for column in range(len(ROUGHNESSES)))


def _white(**inputs: Any) -> Any:
    return of_principled("White", Base_Color=(1.0, 1.0, 1.0, 1.0), **inputs)


def _metallic() -> None:
    _rows(lambda value, roughness: _white(Metallic=value, Roughness=roughness), METALLICS)


def _dielectric() -> None:
    _rows(lambda value, roughness: _white(IOR=value, Roughness=roughness), IORS)


def _glass() -> None:
    _rows(clear, IORS)


def _coat() -> None:
    def coated(value: float, roughness: float) -> Any:
        return _white(Metallic=value, Roughness=0.4, Coat_Weight=1.0, Coat_Roughness=roughness)

    _rows(coated, (0.0, 1.0))


def _anisotropic() -> None:
    _rows(lambda value, roughness: _white(Metallic=1.0, Anisotropic=value, Roughness=roughness), (0.5, 1.0))


for _name, _text, _build, _count in (
    ("furnace_metallic", "white balls: roughness along, metallic 0, 0.5 and 1 upward", _metallic, 3),
    ("furnace_dielectric", "white dielectrics: roughness along, IOR 1.1, 1.5 and 2.4 upward", _dielectric, 3),
    ("furnace_glass", "clear glass: roughness along, IOR 1.1, 1.5 and 2.4 upward", _glass, 3),
    ("furnace_coat", "coated white: the coat's roughness along, metallic 0 and 1 upward", _coat, 2),
    ("furnace_anisotropic", "white metal: roughness along, anisotropy 0.5 and 1 upward", _anisotropic, 2),
):
    add_scene(_name, _text, _build, mirrors=names(_count), samples=256)
