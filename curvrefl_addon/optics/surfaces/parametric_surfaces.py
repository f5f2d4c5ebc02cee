# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectors as surfaces f(u, v): formulas, and what a bake samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from . import radial_surfaces
from .cube_map import CubeMapSurface, nearest_texel
from .radial_surfaces import Float64Array, RadialSurface, unit


@dataclass(frozen=True)
class ParametricSample:
    """The reflector at n pairs of parameters, relative to the center."""

    position: Float64Array
    """(n, 3)"""
    du: Float64Array
    """(n, 3) change of the position for a unit of u, perpendicular to the normal"""
    dv: Float64Array
    """(n, 3) the same of v"""
    normal: Float64Array
    """(n, 3) outward unit shading normal"""


class ParametricSurface(Protocol):
    """A surface f(u, v) for u and v from 0 to 1."""

    @property
    def wraps(self) -> tuple[bool, bool]:
        """Whether u = 1 is u = 0 again, and the same of v."""
        ...

    @property
    def is_open(self) -> bool:
        """It has borders and reflects on both sides: the side of the eye counts."""
        ...

    @property
    def solid(self) -> RadialSurface | None:
        """The same surface as a radius, where it is closed and star-shaped about the center."""
        ...

    def sample(self, uv: Float64Array) -> ParametricSample:
        """At parameters (n, 2); those that wrap may have any value."""
        ...

    def uv_of_direction(self, directions: Float64Array) -> Float64Array:
        """Parameters (n, 2) of the points where rays from the center along directions (n, 3) leave, or near there."""
        ...


@dataclass(frozen=True)
class EllipsoidMap:
    """Longitude and latitude: u runs around z, v from pole to pole."""

    a: float = 1.0
    b: float = 1.0
    c: float = 1.0

    wraps = (True, False)
    is_open = False

    @property
    def solid(self) -> RadialSurface:
        return radial_surfaces.Ellipsoid(self.a, self.b, self.c)

    def sample(self, uv: Float64Array) -> ParametricSample:
        longitude, latitude = 2.0 * np.pi * uv[:, 0], np.pi * (uv[:, 1] - 0.5)
        axes = np.array([self.a, self.b, self.c])
        around = np.column_stack([np.cos(longitude), np.sin(longitude), np.zeros(len(uv))])
        aside = np.column_stack([-np.sin(longitude), np.cos(longitude), np.zeros(len(uv))])
        up = np.array([0.0, 0.0, 1.0])
        cosine, sine = np.cos(latitude)[:, None], np.sin(latitude)[:, None]
        on_sphere = cosine * around + sine * up
        return ParametricSample(
            axes * on_sphere,
            2.0 * np.pi * axes * cosine * aside,
            np.pi * axes * (cosine * up - sine * around),
            unit(on_sphere / axes),
        )

    def uv_of_direction(self, directions: Float64Array) -> Float64Array:
        x, y, z = (directions / [self.a, self.b, self.c]).T
        u = np.arctan2(y, x) / (2.0 * np.pi)
        return np.column_stack([u - np.floor(u), np.arctan2(z, np.hypot(x, y)) / np.pi + 0.5])


@dataclass(frozen=True)
class TorusSection:
    """Part of a ring about z, cut at both ends; the center is on the middle of its tube, on the x axis.

    u runs along the ring, v around the tube.
    """

    ring: float = 2.0
    tube: float = 0.5
    angle: float = np.pi / 2.0
    """Radians of the ring that are there"""

    wraps = (False, True)
    is_open = True
    solid = None
    _TABLE = 64

    def sample(self, uv: Float64Array) -> ParametricSample:
        along, around = self.angle * (uv[:, 0] - 0.5), 2.0 * np.pi * uv[:, 1]
        zero, one = np.zeros(len(uv)), np.ones(len(uv))
        outwards = np.column_stack([np.cos(along), np.sin(along), zero])
        ahead = np.column_stack([-np.sin(along), np.cos(along), zero])
        up = np.column_stack([zero, zero, one])
        cosine, sine = np.cos(around)[:, None], np.sin(around)[:, None]
        normal = cosine * outwards + sine * up
        return ParametricSample(
            self.ring * (outwards - np.array([1.0, 0.0, 0.0])) + self.tube * normal,
            self.angle * (self.ring + self.tube * cosine) * ahead,
            2.0 * np.pi * self.tube * (cosine * up - sine * outwards),
            normal,
        )

    def uv_of_direction(self, directions: Float64Array) -> Float64Array:
        """Of the nearest in a table of directions: rays may leave a ring's part more than once, or never."""
        uv, table = self._table
        return uv[np.concatenate([(part @ table.T).argmax(axis=1) for part in _parts(directions)])]

    @cached_property
    def _table(self) -> tuple[Float64Array, Float64Array]:
        steps = (np.arange(self._TABLE) + 0.5) / self._TABLE
        uv = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
        return uv, unit(self.sample(uv).position)


@dataclass(frozen=True)
class SampledMap:
    """A baked reflector: what the shader sees of its textures, in float64; see `renderer.mirrors.parametric_map`."""

    surface_point: NDArray[np.floating]
    """(rows of v, columns of u, 4): f, and x of the normal"""
    surface_du: NDArray[np.floating]
    """The same of df/du, and y of the normal"""
    surface_dv: NDArray[np.floating]
    """The same of df/dv, and z of the normal"""
    directions: NDArray[np.floating]
    """(6, n, n, 4) cube map: radius, 0 where there is no `solid`; u, v; 1 if u wraps + 2 if v wraps + 4 if open"""

    @cached_property
    def _flags(self) -> int:
        return round(float(self.directions[0, 0, 0, 3]))

    @property
    def wraps(self) -> tuple[bool, bool]:
        return bool(self._flags & 1), bool(self._flags & 2)

    @property
    def is_open(self) -> bool:
        return bool(self._flags & 4)

    @cached_property
    def solid(self) -> RadialSurface | None:
        return CubeMapSurface(self.directions) if self.directions[..., 0].any() else None

    def sample(self, uv: Float64Array) -> ParametricSample:
        point, du, dv = self._bilinear(uv).transpose(1, 0, 2)
        normal = unit(np.column_stack([point[:, 3], du[:, 3], dv[:, 3]]))
        return ParametricSample(point[:, :3], _across(du[:, :3], normal), _across(dv[:, :3], normal), normal)

    def uv_of_direction(self, directions: Float64Array) -> Float64Array:
        # The center itself has no direction; any will do.
        asked = np.where(directions.any(axis=1, keepdims=True), directions, [1.0, 0.0, 0.0])
        return self.directions[nearest_texel(self.directions.shape[1], asked)][:, 1:3].astype(np.float64)

    @cached_property
    def _stacked(self) -> Float64Array:
        return np.stack([self.surface_point, self.surface_du, self.surface_dv], axis=2).astype(np.float64)

    def _bilinear(self, uv: Float64Array) -> Float64Array:
        """(n, 3, 4)"""
        indices, shares = [], []
        for axis, size in ((0, self._stacked.shape[1]), (1, self._stacked.shape[0])):
            x = uv[:, axis] * size - 0.5
            low = np.floor(x)
            pair = np.stack([low, low + 1]).astype(np.int64)
            indices.append(pair % size if self.wraps[axis] else np.clip(pair, 0, size - 1))
            shares.append((x - low)[:, None, None])
        (left, right), (below, above) = indices
        right_share, up_share = shares
        lower = self._stacked[below, left] * (1.0 - right_share) + self._stacked[below, right] * right_share
        upper = self._stacked[above, left] * (1.0 - right_share) + self._stacked[above, right] * right_share
        return lower * (1.0 - up_share) + upper * up_share


def _across(vectors: Float64Array, normals: Float64Array) -> Float64Array:
    return vectors - np.einsum("...i,...i->...", vectors, normals)[:, None] * normals


def _parts(array: Float64Array, size: int = 4096) -> list[Float64Array]:
    return [array[start : start + size] for start in range(0, max(len(array), 1), size)]
