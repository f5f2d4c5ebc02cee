# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat parts of a mirror, for `planar`: which planes it has, and which one faces the eye."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays

MOST_PLANES = 16
"""Of the largest ones"""
DIRECTIONS = 64
"""Normals are told apart in steps of about 1/64, offsets in steps of 1/64 of the shape's size"""

type Plane = tuple[Float64Array, float]
"""Unit normal (3,), offset d in the map frame (n . p = d), both times the area of the part; see `flat_parts`"""


def flat_parts(mesh: MeshArrays, instance: InstanceArrays, world_to_map: Float64Array) -> list[Plane]:
    """Planes of a mesh's triangles in the map frame, those of the largest area first.

    Triangles of about the same plane make one part, whose plane is their mean weighed by area; on a curved mesh parts
    are small, and the plane is a stand-in for the shape. A mirror reflects on both sides, so each part comes twice.
    """
    to_map = world_to_map @ instance.matrix
    positions = mesh.positions.astype(np.float64) @ to_map[:3, :3].T + to_map[:3, 3]
    corners = positions[mesh.corner_vertex[mesh.triangles]]
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(crossed, axis=1)
    normals = crossed / np.maximum(areas, 1e-300)[:, None]
    offsets = np.einsum("ij,ij->i", normals, corners.mean(axis=1))
    size = max(float(np.abs(positions).max()), 1e-300)
    keys = np.rint(np.column_stack([normals, offsets / size]) * DIRECTIONS).astype(np.int64)
    # One number per row: offsets are less than twice the largest coordinate, so each key is within 2 DIRECTIONS of 0.
    span = 4 * DIRECTIONS
    _, part = np.unique((keys + span // 2) @ span ** np.arange(3, -1, -1), return_inverse=True)
    total = np.bincount(part, areas)
    largest = np.argsort(total)[::-1][:MOST_PLANES]
    parts: list[Plane] = []
    for number in largest[total[largest] > 0.0].tolist():
        here = part == number
        normal = (areas[here, None] * normals[here]).sum(axis=0)
        normal /= np.linalg.norm(normal)
        middle = (areas[here, None] * corners[here].mean(axis=1)).sum(axis=0) / total[number]
        offset = float(normal @ middle)
        parts += [(total[number] * normal, total[number] * offset), (-total[number] * normal, -total[number] * offset)]
    return parts


def facing_plane(parts: Sequence[Plane], eye: Float64Array) -> tuple[float, float, float, float]:
    """Normal and offset of the part whose area, seen from the homogeneous eye (4,) of the map frame, is largest."""

    def seen(part: Plane) -> float:
        normal, offset = part
        return float(normal @ eye[:3] - offset * eye[3]) / max(float(np.linalg.norm(eye[:3])), 1e-30)

    normal, offset = max(parts, key=seen)
    area = float(np.linalg.norm(normal))
    x, y, z = (normal / area).tolist()
    return x, y, z, offset / area
