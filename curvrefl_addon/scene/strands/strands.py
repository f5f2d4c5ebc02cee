# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as arrays, whatever they come from. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array, Int32Array
from ..meshes.jenkins import hashed_to_unit
from ..programs.program import GEOMETRY, Attribute

IS_STRAND, INTERCEPT, LENGTH = ".curve_is_strand", ".curve_intercept", ".curve_length"
THICKNESS, TANGENT_ALONG, RANDOM = ".curve_thickness", ".curve_tangent", ".curve_random"
"""Names of attributes that strands have of themselves, as the Curves Info node has them: 1; share of the way from root
to tip; of the whole strand; across; unit direction from root to tip, object space; a number of its own from 0 to 1"""


@dataclass(frozen=True, slots=True)
class Strands:
    """Strands of one object, object space: one after the other, each with two points at least."""

    points: Float32Array
    """(n, 3) from root to tip"""
    radii: Float32Array
    """(n,)"""
    starts: NDArray[np.int64]
    """(strands + 1,) the first point of each, and n"""
    slots: Int32Array
    """(strands,) material slot"""
    layers: tuple[tuple[Attribute, Float32Array], ...] = field(default=())
    """Attributes with (n, k) values at points or (strands, k)"""

    @property
    def lengths(self) -> NDArray[np.int64]:
        """(strands,) how many points each has."""
        return np.diff(self.starts)

    @property
    def strand_of_point(self) -> NDArray[np.int64]:
        """(n,)"""
        return np.repeat(np.arange(len(self.slots)), self.lengths)

    def chosen(self, keep: NDArray[np.bool_]) -> Strands:
        """Those of the strands that `keep` (strands,) says."""
        if keep.all():
            return self
        of_points = np.repeat(keep, self.lengths)
        layers = tuple(
            (attribute, values[of_points if len(values) == len(self.points) else keep])
            for attribute, values in self.layers
        )
        starts = np.concatenate([[0], np.cumsum(self.lengths[keep])])
        return Strands(self.points[of_points], self.radii[of_points], starts, self.slots[keep], layers)


def tangents(strands: Strands) -> Float32Array:
    """(n, 3) unit directions from root to tip; between two pieces half way."""
    ahead = np.zeros_like(strands.points)
    np.subtract(strands.points[1:], strands.points[:-1], out=ahead[:-1])
    lasts = strands.starts[1:] - 1
    ahead[lasts] = 0.0
    lengths = np.sqrt(np.einsum("ij,ij->i", ahead, ahead))[:, None]
    np.divide(ahead, lengths, out=ahead, where=lengths > 0.0)
    total = ahead.copy()
    total[1:] += ahead[:-1]
    # (Of points that lie on each other there is no direction: any will do.)
    lengths = np.sqrt(np.einsum("ij,ij->i", total, total))[:, None]
    total = np.where(lengths > 1e-6, total / np.maximum(lengths, 1e-6), np.array([0.0, 0.0, 1.0], np.float32))
    return total.astype(np.float32)


def ways(strands: Strands) -> tuple[Float32Array, Float32Array]:
    """(n,) how far along its strand a point is, and (strands,) how long the strands are."""
    steps = np.zeros(len(strands.points), np.float64)
    apart = np.diff(strands.points, axis=0)
    steps[1:] = np.sqrt(np.einsum("ij,ij->i", apart, apart))
    steps[strands.starts[:-1]] = 0.0
    total = np.cumsum(steps)
    along = total - np.repeat(total[strands.starts[:-1]], strands.lengths)
    return along.astype(np.float32), along[strands.starts[1:] - 1].astype(np.float32)


def own_layers(strands: Strands, wanted: Sequence[Attribute]) -> tuple[tuple[Attribute, Float32Array], ...]:
    """Those of the `wanted` attributes that strands have of themselves."""
    names = {attribute.name for attribute in wanted if attribute.kind == GEOMETRY}
    if not names & {IS_STRAND, INTERCEPT, LENGTH, THICKNESS, TANGENT_ALONG, RANDOM}:
        return ()
    along, length = ways(strands)
    whole = np.repeat(length, strands.lengths)
    count = len(strands.slots)
    made = {
        IS_STRAND: np.ones((count, 1), np.float32),
        INTERCEPT: np.divide(along, whole, out=np.zeros_like(along), where=whole > 0.0)[:, None],
        LENGTH: length[:, None],
        THICKNESS: 2.0 * strands.radii[:, None],
        TANGENT_ALONG: tangents(strands),
        RANDOM: random_of_numbers(count)[:, None],
    }
    return tuple((Attribute(GEOMETRY, name), values) for name, values in made.items() if name in names)


def random_of_numbers(count: int) -> Float32Array:
    """(count,) Cycles' hash_uint2_to_float(number, 0) of 0, 1, ..."""
    return hashed_to_unit(np.arange(count, dtype=np.uint32), words=2)
