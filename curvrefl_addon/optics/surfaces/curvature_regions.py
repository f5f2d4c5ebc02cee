# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a star-shaped mirror bends outwards, inwards or both ways: each such region may show a vertex once more.

A grid of directions is labeled by the signs of the principal curvatures, and its connected parts are the regions. A
mirror that is convex all over has one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..fermat import sample
from ..solvers.descent import tangent_frame
from .cube_map import nearest_texel, texel_directions
from .radial_surfaces import Float64Array, RadialSurface, unit

RESOLUTION = 32
"""Nodes along an edge of each face"""
DIFFERENCE = 0.03
"""Radians over which normals are differenced: two thirds of a node, several texels of the usual map"""
CONVEX, SADDLE, HOLLOW = 0, 1, 2
FLAT = 0.03
"""Principal curvature times radius that counts as none: the ripple of an interpolated map is smaller"""
SMALLEST = 0.003
"""Share of the sphere of directions under which a part is a speck"""
MOST = 8
SEEDS = 24
"""Directions of a region, spread over it, that a search picks its starts from"""
OVERLAP = 2
"""Nodes by which a region reaches into its neighbors: an image may cross from one into the other"""


@dataclass(frozen=True)
class Regions:
    """Largest first."""

    kinds: tuple[int, ...]
    """CONVEX, SADDLE or HOLLOW of each"""
    masks: NDArray[np.int64]
    """(6, RESOLUTION, RESOLUTION): bit k is set where region k, with its overlap, is"""
    seeds: Float64Array
    """(regions, SEEDS, 3) unit directions"""

    def __len__(self) -> int:
        return len(self.kinds)

    def holds(self, region: int, u: Float64Array) -> NDArray[np.bool_]:
        """(n,) whether unit directions (n, 3) are in a region."""
        return (self.masks[nearest_texel(RESOLUTION, u)] >> region) & 1 == 1


def curvature_kinds(surface: RadialSurface, u: Float64Array) -> NDArray[np.int64]:
    """(n,) CONVEX, SADDLE or HOLLOW at unit directions (n, 3).

    First and second fundamental forms in a tangent frame: P_i . P_j with P_i = r_i u + r e_i, and N_i . P_j.
    """
    at = sample(surface, u)
    frame = tangent_frame(u)
    moved = [(at.gradient * axis).sum(axis=1)[:, None] * u + at.radius[:, None] * axis for axis in frame]
    turned = [
        (sample(surface, unit(u + DIFFERENCE * axis)).normal - sample(surface, unit(u - DIFFERENCE * axis)).normal)
        / (2.0 * DIFFERENCE)
        for axis in frame
    ]
    first = np.array([[(p * q).sum(axis=1) for q in moved] for p in moved]).transpose(2, 0, 1)
    second = np.array([[(n * q).sum(axis=1) for q in moved] for n in turned]).transpose(2, 0, 1)
    shape = np.linalg.solve(first, 0.5 * (second + second.transpose(0, 2, 1)))
    middle = 0.5 * (shape[:, 0, 0] + shape[:, 1, 1])
    gauss = shape[:, 0, 0] * shape[:, 1, 1] - shape[:, 0, 1] * shape[:, 1, 0]
    spread = np.sqrt(np.maximum(middle**2 - gauss, 0.0))
    low, high = (middle - spread) * at.radius, (middle + spread) * at.radius
    return np.where(low > -FLAT, CONVEX, np.where(high > FLAT, SADDLE, HOLLOW))


def curvature_regions(surface: RadialSurface) -> Regions:
    """At most MOST regions of a closed mirror."""
    shape = (6, RESOLUTION, RESOLUTION)
    u = texel_directions(RESOLUTION).reshape(-1, 3)
    kinds = curvature_kinds(surface, u)
    neighbors = _neighbors(u)
    labels = _connected(kinds, neighbors)
    numbers, counts = np.unique(labels, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    chosen = [int(numbers[k]) for k in order if counts[k] >= SMALLEST * len(u)][:MOST]
    masks = np.zeros(len(u), np.int64)
    seeds = []
    for bit, number in enumerate(chosen):
        inside = labels == number
        seeds.append(_spread(u[inside]))
        for _ in range(OVERLAP):
            inside = inside | inside[neighbors].any(axis=1)
        masks |= inside.astype(np.int64) << bit
    return Regions(tuple(int(kinds[number]) for number in chosen), masks.reshape(shape), np.array(seeds))


def _neighbors(u: Float64Array) -> NDArray[np.int64]:
    """(n, 4) nodes beside each: where one would be on an endless face."""
    scale = (2.0 / RESOLUTION) * np.abs(u).max(axis=1, keepdims=True)
    found = []
    for axis in tangent_frame(u):
        for sign in (1.0, -1.0):
            face, row, column = nearest_texel(RESOLUTION, u + 1.2 * sign * scale * axis)
            found.append((face * RESOLUTION + row) * RESOLUTION + column)
    return np.stack(found, axis=1)


def _connected(kinds: NDArray[np.int64], neighbors: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) per node the smallest number of a node that it is connected to through nodes of its own kind."""
    labels = np.arange(len(kinds))
    rows = np.repeat(np.arange(len(kinds)), neighbors.shape[1])
    others = neighbors.ravel()
    same = kinds[rows] == kinds[others]
    rows, others = rows[same], others[same]
    while True:
        least = labels.copy()
        np.minimum.at(least, rows, labels[others])
        np.minimum.at(least, others, labels[rows])
        least = least[least]
        if (least == labels).all():
            return labels
        labels = least


def _spread(u: Float64Array) -> Float64Array:
    """SEEDS of directions (n, 3), each as far as can be from those before it; repeated where there are fewer."""
    chosen = [0]
    nearest = u @ u[0]
    for _ in range(min(SEEDS, len(u)) - 1):
        chosen.append(int(nearest.argmin()))
        nearest = np.maximum(nearest, u @ u[chosen[-1]])
    return u[np.resize(chosen, SEEDS)]
