# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How smoothly two surfaces meet along edges: gap (G0), angle (G1), difference of curvature (G2).

Each side is measured without the other (`cut_mesh`). Along the edge itself both bend alike where their normals agree,
so that what counts is the curvature across it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .curvature import Float64Array, normal_curvature
from .cut_mesh import CutMesh, Edges, border_edges
from .jets import Jet

FLAT = 0.1
"""A radius of curvature of ten times the size of what is looked at counts as none"""
GRADES = ("Gap", "G0", "G1", "G2")
"""From bad to good: apart, touching, with one tangent plane, with one curvature"""
BLOCK = 1 << 20
"""Distances at a time"""


@dataclass(frozen=True, slots=True)
class Joints:
    """What was measured at n edges; NaN is what could not be."""

    edges: Float64Array
    """(n, 2, 3) their ends"""
    normals: Float64Array
    """(n, 3) halfway between the normals of both sides"""
    gap: Float64Array
    """(n,) length"""
    angle: Float64Array
    """(n,) between the normals of both sides, radians"""
    curvature: Float64Array
    """(n, 2) of each side across the edge, 1 / length"""
    size: float
    """Of what is looked at: the diagonal of a box around it"""

    @property
    def difference(self) -> Float64Array:
        """(n,) of the curvatures, 1 / length."""
        return np.abs(self.curvature[:, 0] - self.curvature[:, 1])

    @property
    def relative_difference(self) -> Float64Array:
        """(n,) over the larger curvature, or that which counts as none."""
        return self.difference / np.maximum(np.abs(self.curvature).max(axis=1), FLAT / max(self.size, 1e-30))

    def grades(self, gap: float, angle: float, curvature: float) -> NDArray[np.int64]:
        """(n,) places in GRADES by the largest gap, angle (radians) and relative difference that count as none.

        -1: the angle could not be measured. A curvature that could not leaves G1.
        """
        with np.errstate(invalid="ignore"):
            grade = np.where(self.relative_difference <= curvature, 3, 2)
            grade = np.where(self.angle <= angle, grade, 1)
        grade = np.where(np.isnan(self.angle), -1, grade)
        return np.where(self.gap > gap, 0, grade)


def joints_of_edges(positions: Float64Array, triangles: NDArray[np.integer], edges: Edges) -> tuple[Joints, int]:
    """Of edges (k, 2) between two triangles of one mesh: vertices (n, 3), triangles (m, 3).

    And how many edges are left out, because not just two triangles have them.
    """
    mesh = CutMesh(positions, triangles, edges)
    found: list[_Measured] = []
    ends = []
    left_out = 0
    for edge, sides in zip(mesh.cut, mesh.sides_of_edges, strict=True):
        if len(sides) != 2:
            left_out += 1
            continue
        at_ends = [(mesh.jet(one), mesh.jet(other)) for one, other in zip(*sides, strict=True) if one != other]
        direction = positions[edge[1]] - positions[edge[0]]
        found.append(_measured([(one, other) for one, other in at_ends if one and other], direction))
        ends.append(positions[edge])
    return _joints(ends, [0.0] * len(ends), found, positions), left_out


def joints_of_borders(
    positions: Float64Array,
    triangles: NDArray[np.integer],
    other_positions: Float64Array,
    other_triangles: NDArray[np.integer],
    reach: float,
) -> Joints:
    """Of edges at the border of a mesh both of whose ends have the border of another mesh within `reach`.

    Vertices (n, 3) and triangles (m, 3) of each, in one space.
    """
    border, other_border = border_edges(triangles), border_edges(other_triangles)
    ends: list[Float64Array] = []
    gaps: list[float] = []
    found: list[_Measured] = []
    if len(border) and len(other_border):
        mesh, other = CutMesh(positions, triangles, border), CutMesh(other_positions, other_triangles, other_border)
        vertices = np.unique(border)
        nearest, share, distance = _nearest_on_edges(positions[vertices], other_positions[other.cut])
        place = {vertex: index for index, vertex in enumerate(vertices.tolist())}
        for edge, sides in zip(mesh.cut, mesh.sides_of_edges, strict=True):
            at = [place[vertex] for vertex in edge.tolist()]
            if distance[at].max() > reach:
                continue
            pairs = []
            for index, side in zip(at, sides[0], strict=True):
                one, there = mesh.jet(side), _between(other, int(nearest[index]), float(share[index]))
                if one is not None and there is not None:
                    pairs.append((one, there))
            found.append(_measured(pairs, positions[edge[1]] - positions[edge[0]]))
            ends.append(positions[edge])
            gaps.append(float(distance[at].mean()))
    return _joints(ends, gaps, found, np.concatenate([positions, other_positions]))


def mean_length(positions: Float64Array, edges: Edges) -> float:
    """Of edges (k, 2), at least one, of vertices (n, 3)."""
    return float(np.linalg.norm(positions[edges[:, 1]] - positions[edges[:, 0]], axis=1).mean())


type _Measured = tuple[float, tuple[float, float], Float64Array]
"""Angle, curvatures of both sides, normal (3,)"""


def _measured(pairs: list[tuple[Jet, Jet]], direction: Float64Array) -> _Measured:
    """Of an edge along `direction` (3,): means over its ends where both sides are known; curvatures across it."""
    if not pairs:
        return float("nan"), (float("nan"), float("nan")), np.full(3, np.nan)
    angles = []
    bent = np.empty((len(pairs), 2))
    for row, pair in enumerate(pairs):
        one, other = (jet.normal for jet in pair)
        angles.append(float(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)))
        for column, jet in enumerate(pair):
            across = np.cross(jet.normal, direction)
            across /= max(float(np.linalg.norm(across)), 1e-300)
            bent[row, column] = normal_curvature(jet.tensor[None], across[None])[0]
    one_side, other_side = bent.mean(axis=0).tolist()
    normal = np.sum([jet.normal for pair in pairs for jet in pair], axis=0)
    length = float(np.linalg.norm(normal))
    return float(np.mean(angles)), (one_side, other_side), normal / max(length, 1e-300)


def _between(mesh: CutMesh, edge: int, share: float) -> Jet | None:
    """The surface at a place of a border edge."""
    first, second = (mesh.jet(side) for side in mesh.sides_of_edges[edge][0])
    if first is None or second is None:
        return None
    normal = first.normal * (1.0 - share) + second.normal * share
    return Jet(normal / np.linalg.norm(normal), first.tensor * (1.0 - share) + second.tensor * share)


def _nearest_on_edges(
    points: Float64Array, edges: Float64Array
) -> tuple[NDArray[np.int64], Float64Array, Float64Array]:
    """Of points (n, 3): the nearest of edges (k, 2, 3), how far along it (from 0 to 1), and the distance; (n,) each."""
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    squared = (along**2).sum(axis=1).clip(1e-300)
    found = []
    step = max(BLOCK // len(edges), 1)
    for first in range(0, len(points), step):
        offset = points[first : first + step, None] - start
        share = np.clip((offset * along).sum(-1) / squared, 0.0, 1.0)
        distance = np.linalg.norm(offset - share[..., None] * along, axis=-1)
        nearest = distance.argmin(axis=1)
        rows = np.arange(len(nearest))
        found.append((nearest, share[rows, nearest], distance[rows, nearest]))
    nearest, share, distance = (np.concatenate(part) for part in zip(*found, strict=True))
    return nearest, share, distance


def _joints(ends: list[Float64Array], gaps: list[float], found: list[_Measured], positions: Float64Array) -> Joints:
    size = float(np.linalg.norm(np.ptp(positions, axis=0))) if len(positions) else 0.0
    return Joints(
        np.array(ends).reshape(-1, 2, 3),
        np.array([normal for _, _, normal in found]).reshape(-1, 3),
        np.array(gaps),
        np.array([angle for angle, _, _ in found]),
        np.array([curvature for _, curvature, _ in found]).reshape(-1, 2),
        size,
    )
