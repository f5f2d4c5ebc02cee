# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What patches of light become where they land: prisms along the light, as bright as their patch is larger or smaller.
Pure numpy.

The area ratio of beam tracing (Watt, "Light-water interaction using backward beam tracing", 1990): a patch's power goes
to the area across the beam that its corners have where they land. Receivers lie within the prism, however they are
bent; surfaces at different depths, as a table's edge and the floor below, have a piece of the same prism each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array

FLAT = 0.3
"""Corners lie on one surface where they leave each other's tangent planes no further, as shares of their distances"""
SAME_WAY = 0.9
"""And their normals' cosine is at least this"""
THINNEST = 0.03
"""How much flatter than its patch a piece is at least: what is folded has no height"""
SMALLEST = 0.02
"""How much smaller than its patch a piece is at least: in a focus"""
THICK = 0.1
"""How far off their plane pieces still light, as a share of their size, beside how far their normals turn"""


@dataclass(frozen=True, slots=True)
class Landed:
    """Corners of patches where they have landed; world space."""

    positions: Float64Array
    """(n, 3, 3)"""
    objects: Float64Array
    """(n, 3) 0: nowhere"""
    normals: Float64Array
    """(n, 3, 3) unit shading normals, towards where light comes from"""
    directions: Float64Array
    """(n, 3, 3) unit, of light"""
    powers: Float64Array
    """(n, 3, 3) irradiance across the light at the patch, times what is left of it on the way"""
    states: Float64Array
    """(n, 3) what happened on the way"""

    def of(self, chosen: NDArray[np.bool_]) -> Landed:
        """Some of them."""
        return Landed(*(getattr(self, field.name)[chosen] for field in fields(Landed)))

    @property
    def is_whole(self) -> NDArray[np.bool_]:
        """(n,) all corners have come the same way."""
        there = (self.objects > 0.5).all(axis=1)
        return there & (self.states == self.states[:, :1]).all(axis=1)

    @property
    def is_parted(self) -> NDArray[np.bool_]:
        """(n,) some corners have landed, but not all, or not by the same way or on the same surface."""
        return (self.objects > 0.5).any(axis=1) & ~(self.is_whole & self.on_one_surface())

    def on_one_surface(self) -> NDArray[np.bool_]:
        """(n,) the corners lie on one, as smooth as their distances allow."""
        return _joined(self.positions, self.normals).all(axis=(1, 2))


@dataclass(frozen=True, slots=True)
class Pieces:
    """Prisms of light, each with a plane across which it lies."""

    corners: Float64Array
    """(n, 3, 3) on that plane"""
    normals: Float64Array
    """(n, 3) of it"""
    directions: Float64Array
    """(n, 3) unit, of light"""
    irradiance: Float64Array
    """(n, 3) across the light"""
    thickness: Float64Array
    """(n,) how far off the plane it lights"""

    @property
    def count(self) -> int:
        return len(self.thickness)


def joined_pieces(parts: Sequence[Pieces]) -> Pieces:
    """All, of one or more."""
    names = [field.name for field in fields(Pieces)]
    if not parts:
        return Pieces(np.empty((0, 3, 3)), np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3)), np.empty(0))
    return Pieces(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def pieces_of(landed: Landed, widths: Float64Array, sizes: Float64Array) -> Pieces:
    """Of patches (n,) that have landed whole; those that have not bring nothing. `widths`: their areas as the light
    sees them; `sizes` (n, 2): their longest sides, and heights over these."""
    whole = np.flatnonzero(landed.is_whole)
    positions, normals = landed.positions[whole], landed.normals[whole]
    direction = unit(landed.directions[whole].mean(axis=1))
    power = widths[whole, None] * landed.powers[whole].mean(axis=1)
    flat, area = _flattened(positions, direction, sizes[whole])
    irradiance = power / np.maximum(area, 1e-300)[:, None]
    joined = _joined(positions, normals)
    one = joined.all(axis=(1, 2))
    found = [_on_one(flat[one], positions[one], normals[one], direction[one], irradiance[one])]
    # (Where they lie on several each corner stands for its own, once.)
    for corner in range(3):
        mine = ~one & ~joined[:, corner, :corner].any(axis=1)
        plane = positions[mine, corner], normals[mine, corner]
        found.append(_on_plane(flat[mine], *plane, direction[mine], irradiance[mine]))
    every = joined_pieces(found)
    kept = (every.irradiance > 0.0).any(axis=1) & np.isfinite(every.corners).all(axis=(1, 2))
    kept &= np.isfinite(every.irradiance).all(axis=1)
    return Pieces(
        every.corners[kept], every.normals[kept], every.directions[kept], every.irradiance[kept], every.thickness[kept]
    )


def _joined(positions: Float64Array, normals: Float64Array) -> NDArray[np.bool_]:
    """(n, 3, 3) whether corner j lies on the surface of corner i."""
    step = positions[:, None, :, :] - positions[:, :, None, :]
    off = np.abs(np.einsum("nijc,nic->nij", step, normals))
    alike = np.einsum("nic,njc->nij", normals, normals) >= SAME_WAY
    near = (off <= FLAT * np.linalg.norm(step, axis=-1) + 1e-12) & alike
    return near & near.transpose(0, 2, 1)


def _flattened(
    positions: Float64Array, direction: Float64Array, size: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Corners (n, 3, 3) projected along the light into the plane across it through their middle, so wide that a fold
    or a focus has a finite brightness; and the area (n,) of their triangle. `size`: as `sizes` of `pieces_of`."""
    middle = positions.mean(axis=1, keepdims=True)
    step = positions - middle
    across = step - np.einsum("nkc,nc->nk", step, direction)[..., None] * direction[:, None]
    sides = np.roll(across, -1, axis=1) - across
    lengths = np.linalg.norm(sides, axis=2)
    least = SMALLEST * size[:, 0]
    flatness = THINNEST * size[:, 1] / np.maximum(size[:, 0], 1e-300)
    rows = np.arange(len(positions))
    longest = lengths.argmax(axis=1)
    along = sides[rows, longest]
    # (A point has no side: any way serves.)
    x = np.abs(direction[:, :1]) < 0.7
    aside = np.cross(direction, np.where(x, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    along = unit(np.where(lengths[rows, longest][:, None] > 1e-9 * least[:, None], along, aside))
    up = np.cross(direction, along)
    u, v = np.einsum("nkc,nc->nk", across, along), np.einsum("nkc,nc->nk", across, up)
    width = np.ptp(u, axis=1)
    width = np.maximum(width, least)
    u = _stretched(u, width, along_side=True)
    v = _stretched(v, np.maximum(np.ptp(v, axis=1), flatness * width), along_side=False)
    area = 0.5 * np.abs((u[:, 1] - u[:, 0]) * (v[:, 2] - v[:, 0]) - (u[:, 2] - u[:, 0]) * (v[:, 1] - v[:, 0]))
    return middle + u[..., None] * along[:, None] + v[..., None] * up[:, None], area


def _stretched(values: Float64Array, extent: Float64Array, along_side: bool) -> Float64Array:
    """(n, 3) with their middles where they are, over so much (n,). What is all in one place is spread as a triangle."""
    middle = values.mean(axis=1, keepdims=True)
    was = np.ptp(values, axis=1)
    factor = (extent / np.maximum(was, 1e-300))[:, None]
    spread = np.array([[-0.5, 0.5, 0.0]]) if along_side else np.array([[-1.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0]])
    is_point = (was <= 1e-9 * extent)[:, None]
    return middle + np.where(is_point, spread * extent[:, None], (values - middle) * factor)


def _on_one(
    flat: Float64Array,
    positions: Float64Array,
    normals: Float64Array,
    direction: Float64Array,
    irradiance: Float64Array,
) -> Pieces:
    """Where the corners are."""
    normal = np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    mean = unit(normals.mean(axis=1))
    longest = np.linalg.norm(np.roll(positions, -1, axis=1) - positions, axis=2).max(axis=1)
    # (Of a needle the plane is known by the surface alone.)
    is_thin = length[:, 0] < THINNEST * longest**2
    normal = np.where(is_thin[:, None], mean, normal / np.maximum(length, 1e-300))
    turns = np.linalg.norm(normals - mean[:, None], axis=2).max(axis=1)
    return _on_plane(flat, positions.mean(axis=1), normal, direction, irradiance, turns)


def _on_plane(
    flat: Float64Array,
    place: Float64Array,
    normal: Float64Array,
    direction: Float64Array,
    irradiance: Float64Array,
    turns: Float64Array | float = 0.0,
) -> Pieces:
    """Pieces moved along the light (n, 3) into planes through places (n, 3)."""
    slope = np.einsum("nc,nc->n", normal, direction)
    slope = np.where(np.abs(slope) < 1e-3, np.where(slope < 0.0, -1e-3, 1e-3), slope)
    way = np.einsum("nkc,nc->nk", place[:, None] - flat, normal) / slope[:, None]
    corners = flat + way[..., None] * direction[:, None]
    size = np.linalg.norm(np.roll(flat, -1, axis=1) - flat, axis=2).max(axis=1)
    longest = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    rounding = 1e-5 * np.abs(corners).max(axis=(1, 2), initial=0.0)
    return Pieces(corners, normal, direction, irradiance, THICK * size + turns * longest + rounding)
