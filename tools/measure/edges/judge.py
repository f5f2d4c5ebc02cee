# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of a mirror, what its pixels show in them, and where points are truly reflected."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.mirrors.baked_shape import BakedShape
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, Float64Array
from curvrefl.curvrefl_addon.scene.camera.view import View

VIEWS = ((0.0, 1.0), (90.0, 1.0), (200.0, 1.0), (300.0, 0.6))
"""Degrees about the mirror's vertical axis, share of the camera's distance"""
JUDGED_TO = 0.02
"""Pixels"""
NEAR = 0.1
"""Of the mirror's size: a point is seen at a pixel whose own point is nearer"""


class Judge:
    """Reflection points in one view by `newton`, better than anything that is measured."""

    def __init__(self, mirror: Mirror, shape: BakedShape, view: View) -> None:
        self.view = view
        self._reflector = Reflector(shape.world_to_map, shape.bound, {"radial": shape.radial}, mirror.side(view, shape))

    def points(self, places: Float64Array, start: Float64Array | None = None) -> tuple[Float64Array, np.ndarray]:
        """P (n, 3) of world places (n, 3), searched for from `start`, and whether (n,) each is reflected."""
        before = None
        if start is not None:
            texture = _records(start)
            before = VertexSolution(texture, texture, len(start))
        solution = solve_vertices(
            "newton", self.view, self._reflector, _records(places), len(places), tolerance=JUDGED_TO, previous=before
        )
        points, code, _, _ = solution.read()
        return points.astype(np.float64), code == status.REFLECTED


def _records(places: np.ndarray) -> Any:
    records = np.zeros((len(places), 4), np.float32)
    records[:, :3] = places
    return record_texture(records)


@dataclass(frozen=True)
class Seen:
    """What mirror pixels show."""

    view: View
    surfaces: dict[str, Float32Array]
    near: float

    @property
    def mirror(self) -> np.ndarray:
        """(h, w)"""
        return self.surfaces["seen_color"][..., 3] > 0.5

    @property
    def objects(self) -> np.ndarray:
        """(h, w) shown by mirror pixels, 0 elsewhere and for the background."""
        return np.where(self.mirror, np.rint(self.surfaces["reflected_position"][..., 3]), 0).astype(int)

    def shows(self, points: Float64Array) -> np.ndarray:
        """(n,) whether points of the mirror (n, 3) are at a pixel of it."""
        pixels = np.floor(self.view.project(points))
        inside = ((pixels >= 0.0) & (pixels < (self.view.width, self.view.height))).all(axis=1)
        column, row = np.where(inside[:, None], pixels, 0.0).astype(int).T
        off = np.linalg.norm(self.surfaces["seen_position"][row, column, :3] - points, axis=1)
        return inside & self.mirror[row, column] & (off < self.near)

    def errors(self, judge: Judge) -> Float64Array:
        """(n,) pixels, of those that show an object."""
        shown = self.objects > 0
        points, is_reflected = judge.points(
            self.surfaces["reflected_position"][shown][:, :3].astype(np.float64),
            self.surfaces["seen_position"][shown][:, :3].astype(np.float64),
        )
        row, column = np.nonzero(shown)
        off = self.view.project(points) - np.column_stack([column + 0.5, row + 0.5])
        return np.linalg.norm(off, axis=1)[is_reflected]


def turned(view: View, center: Float64Array, degrees: float, closer: float) -> View:
    """The eye turned about the vertical axis through `center`, then brought closer to it."""
    angle = np.radians(degrees)
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    turn[:3, 3] = center - turn[:3, :3] @ center
    world_to_view = view.world_to_view @ np.linalg.inv(turn)
    world_to_view[:3, 3] -= (1.0 - closer) * (world_to_view @ np.append(center, 1.0))[:3]
    return replace(view, world_to_view=world_to_view)


def numbers(values: Float64Array, percents: tuple[float, ...]) -> str:
    return " ".join(f"{value:7.3f}" for value in np.percentile(values, percents))
