# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as seen by shadow maps: the planes on its hull, and few points that enclose each part. Pure numpy.

A plane on the hull of a scene is on the hull of every mesh that has triangles in it. So planes are looked for once per
mesh, in object space, and a scene only has to test those of its meshes.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import outcome
from ...scene.arrays import Float64Array, Int32Array, MeshArrays

MOST_PLANES = 12
"""How many of a mesh's largest planes are tested for lying on its hull"""
SMALLEST_PLANE = 1e-3
"""Area of a plane's triangles over the mesh's squared size"""
MANY_TRIANGLES = 20_000
"""In meshes of more only the sides of the box around them are looked at"""
FLAT = 1e-4
"""Distance from a plane, over the mesh's size, that counts as none"""
OUTLINE_DIRECTIONS = 128
OUTLINE_SLACK = 1.01
"""Grows an outline of many points, which may lie inside of the true one by half the directions' spacing squared"""
ROOM_TO_DEFORM = 0.05
"""Share of its box that what deforms may grow by, on each side"""
_BLOCK = 1 << 13
_BOX_ROW = 512
_GROUP = 64


@dataclass(frozen=True, slots=True)
class MeshPieces:
    """Piece 0 is what lies in no plane, piece k what lies in plane k - 1. Object space."""

    triangle_piece: NDArray[np.int8]
    """(triangles,)"""
    normals: Float64Array
    """(planes, 3) unit; the mesh lies on one side, whichever"""
    areas: Float64Array
    """(planes,)"""
    outlines: tuple[Float64Array, ...]
    """Per piece (n, 3) points whose hull holds it, but for OUTLINE_SLACK; none of a piece without triangles"""


def box_of(points: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Lowest and highest corner (3,) of the box around points (n, 3), n > 0."""
    # (Hundreds of points are a row: numpy is several times as fast along long ones.)
    rows = len(points) // _BOX_ROW
    many = points[: rows * _BOX_ROW].reshape(rows, 3 * _BOX_ROW)
    rest = points[rows * _BOX_ROW :]
    if rows == 0:
        return rest.min(axis=0), rest.max(axis=0)
    low, high = many.min(axis=0).reshape(-1, 3), many.max(axis=0).reshape(-1, 3)
    return np.concatenate([low, rest]).min(axis=0), np.concatenate([high, rest]).max(axis=0)


def pieces_of_box(
    low: NDArray[np.floating], high: NDArray[np.floating], triangle_piece: NDArray[np.int8]
) -> MeshPieces:
    """In place of the pieces of what deforms from frame to frame: one without planes, which holds the box about it and
    some more, so that views of shadow maps need not be found again for each frame."""
    slack = ROOM_TO_DEFORM * (high.astype(np.float64) - low)
    corners = np.where(np.indices((2, 2, 2)).reshape(3, 8).T == 1, high + slack, low - slack)
    return MeshPieces(triangle_piece, np.zeros((0, 3)), np.zeros(0), (corners,))


def mesh_pieces(mesh: MeshArrays) -> MeshPieces:
    """Find the planes and outlines of a mesh."""
    return outcome(piece_steps(mesh))


def piece_steps(mesh: MeshArrays) -> Generator[None, None, MeshPieces]:
    """The same in steps."""
    positions = mesh.positions
    triangles = mesh.triangles if is_count(mesh.corner_vertex) else mesh.corner_vertex[mesh.triangles]
    if len(triangles) == 0:
        return MeshPieces(np.zeros(0, np.int8), np.zeros((0, 3)), np.zeros(0), (np.zeros((0, 3)),))
    low, high = box_of(positions)
    size = float(np.linalg.norm(high.astype(np.float64) - low))
    if len(triangles) > MANY_TRIANGLES:
        found = _box_sides(positions, triangles, size)
    else:
        found = _hull_planes(positions.astype(np.float64), triangles, size)
    yield
    piece = np.zeros(len(triangles), np.int8)
    for number, (_, _, members) in enumerate(found, 1):
        piece[members] = number
    outlines = []
    for number in range(len(found) + 1):
        points = positions
        if found:
            used = np.zeros(len(positions), bool)
            used[triangles[piece == number].ravel()] = True
            points = positions[used]
            yield
        outlines.append(outline(points))
    normals = np.array([normal for normal, _, _ in found], np.float64).reshape(-1, 3)
    return MeshPieces(piece, normals, np.array([area for _, area, _ in found], np.float64), tuple(outlines))


def outline(points: NDArray[np.floating]) -> Float64Array:
    """(n, 3) the points themselves or, of many, those farthest out in OUTLINE_DIRECTIONS, moved out a bit."""
    if len(points) <= 4 * OUTLINE_DIRECTIONS:
        return points.astype(np.float64)
    low, high = (end.astype(np.float64) for end in box_of(points))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    # With the box made a cube, or directions would miss what stands out of a flat shape.
    scale = 1.0 / np.where(half > 0.0, half, 1.0)
    cube = ((points - middle.astype(points.dtype)) * scale.astype(points.dtype)).astype(np.float32)
    axes = np.eye(3, dtype=np.float32)
    directions = np.concatenate([_directions(), axes, -axes])
    rows = _outer_rows(cube, directions)
    best = np.full(len(directions), -np.inf, np.float32)
    farthest = np.zeros(len(directions), np.int64)
    for start in range(0, len(rows), _BLOCK):
        part = rows[start : start + _BLOCK]
        heights = directions @ cube[part].T
        values = heights.max(axis=1)
        for row in np.flatnonzero(values > best):
            best[row], farthest[row] = values[row], part[int(heights[row].argmax())]
    grown = middle + (points[np.unique(farthest)] - middle) * OUTLINE_SLACK
    # Never out of the box: what stands on a floor would reach through it.
    return np.clip(grown, low, high)


def _outer_rows(points: NDArray[np.float32], directions: NDArray[np.float32]) -> NDArray[np.int64]:
    """Rows among which the farthest in every direction are. Neighbors in the array mostly are so in space, so
    groups of them whose box ends nearer than a point of some other group can be left out."""
    whole = len(points) // _GROUP * _GROUP
    groups = points[:whole].reshape(-1, _GROUP, 3)
    # Neighbors pairwise: numpy is slow where it reduces the middle axis.
    least, most = groups, groups
    while least.shape[1] > 1:
        half = least.shape[1] // 2
        least, most = np.minimum(least[:, :half], least[:, half:]), np.maximum(most[:, :half], most[:, half:])
    least, most = least[:, 0], most[:, 0]
    reach = 0.5 * (least + most) @ directions.T + 0.5 * (most - least) @ np.abs(directions).T
    reached = (groups[:, 0] @ directions.T).max(axis=0)
    chosen = np.flatnonzero((reach >= reached - 1e-5).any(axis=1))
    return np.concatenate([(chosen[:, None] * _GROUP + np.arange(_GROUP)).ravel(), np.arange(whole, len(points))])


@cache
def _directions() -> NDArray[np.float32]:
    """(OUTLINE_DIRECTIONS, 3) spread evenly."""
    index = np.arange(OUTLINE_DIRECTIONS) + 0.5
    height = 1.0 - 2.0 * index / OUTLINE_DIRECTIONS
    turn = np.pi * (1.0 + np.sqrt(5.0)) * index
    flat = np.sqrt(1.0 - height**2)
    return np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height]).astype(np.float32)


type _Plane = tuple[Float64Array, float, NDArray[np.int64]]
"""Normal, area of the triangles in it, these triangles"""


def _hull_planes(positions: Float64Array, triangles: Int32Array, size: float) -> list[_Plane]:
    """The largest planes that have the whole mesh on one side."""
    if size == 0.0:
        return []
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    doubled_area = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(doubled_area, 1e-300)[:, None]
    # both sides of a triangle are one plane
    lead = np.argmax(np.abs(normals) > 0.5, axis=1)
    normals *= np.where(normals[np.arange(len(normals)), lead] < 0.0, -1.0, 1.0)[:, None]
    offsets = (normals * (a - positions[0])).sum(axis=1) / size
    steps = np.rint(np.column_stack([normals, offsets]) * 4096.0).astype(np.int64) + 8192
    keys = ((steps[:, 0] * 16384 + steps[:, 1]) * 16384 + steps[:, 2]) * 16384 + steps[:, 3] % 16384
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    areas = 0.5 * np.bincount(inverse, doubled_area)
    planes: list[_Plane] = []
    taken = np.zeros(len(triangles), bool)
    for group in np.argsort(areas)[::-1][:MOST_PLANES]:
        if areas[group] < SMALLEST_PLANE * size * size:
            break
        normal = normals[first[group]]
        heights = (positions - a[first[group]]) @ normal
        if heights.min() < -FLAT * size and heights.max() > FLAT * size:
            continue
        inside = np.all(np.abs(heights[triangles]) <= FLAT * size, axis=1) & ~taken
        taken |= inside
        if inside.any():
            planes.append((normal, 0.5 * float(doubled_area[inside].sum()), np.flatnonzero(inside)))
    return planes


def _box_sides(positions: NDArray[np.float32], triangles: Int32Array, size: float) -> list[_Plane]:
    """Those sides of the box around the mesh in which much of it lies."""
    planes: list[_Plane] = []
    taken = np.zeros(len(triangles), bool)
    for axis in range(3):
        column = positions[:, axis]
        for side in (float(column.min()), float(column.max())):
            near = np.abs(column - side) <= FLAT * size
            if np.count_nonzero(near) < 3:
                continue
            chosen = np.flatnonzero(near[triangles[:, 0]])
            chosen = chosen[near[triangles[chosen, 1]] & near[triangles[chosen, 2]] & ~taken[chosen]]
            a, b, c = (positions[triangles[chosen, k]].astype(np.float64) for k in range(3))
            area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) if len(chosen) else 0.0
            if area >= SMALLEST_PLANE * size * size:
                taken[chosen] = True
                planes.append((np.eye(3)[axis], area, chosen))
    return planes


def is_count(corner_vertex: Int32Array) -> bool:
    """Whether corners are the vertices themselves, in their order."""
    return bool(np.array_equal(corner_vertex, np.arange(len(corner_vertex), dtype=np.int32)))
