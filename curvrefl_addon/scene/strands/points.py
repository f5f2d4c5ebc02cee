# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Point clouds as balls of triangles, with the normals of round ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Float32Array, Int32Array, MeshArrays
from ..finite import LARGEST_PLACE
from ..meshes.meshes import MeshNeeds, MeshReading
from ..meshes.program_attributes import Layer, four_numbers
from ..programs.program import GEOMETRY, Attribute
from ..signature import array_signature
from .curves import layers_of
from .strands import random_of_numbers

PLAIN_RADIUS = 0.01
"""Of points that have none"""
POINT_RADIUS, POINT_PLACE, POINT_RANDOM = ".point_radius", ".point_position", ".point_random"
"""Names of attributes that points have of themselves, as the Point Info node has them, object space"""
FINENESS = ((50, 3), (2_000, 2), (20_000, 1))
"""(points, levels): balls of no more points have 20 triangles that have been quartered so often; of more, 20"""


def read_points(cloud: Any, needs: MeshNeeds) -> MeshReading:
    """Of an evaluated point cloud, object space."""
    count = len(cloud.points)
    centers = np.zeros((count, 3), np.float32)
    if count:
        cloud.attributes["position"].data.foreach_get("vector", centers.reshape(-1))
    radii = np.full(count, PLAIN_RADIUS, np.float32)
    attribute = cloud.attributes.get("radius")
    if attribute is not None and attribute.data_type == "FLOAT":
        attribute.data.foreach_get("value", radii)
    wanted = needs.attributes
    layers = dict(layers_of(cloud, wanted))
    own = {POINT_RADIUS: radii[:, None], POINT_PLACE: centers, POINT_RANDOM: random_of_numbers(count)[:, None]}
    layers |= {item: own[item.name] for item in wanted if item.kind == GEOMETRY and item.name in own}
    good = (np.abs(centers) <= LARGEST_PLACE).all(axis=1) & (radii <= LARGEST_PLACE)
    keep = good & (radii > 0.0)
    if any(needs.hidden_slots):
        keep &= not needs.hidden_slots[0]
    layers = {item: values[keep] for item, values in layers.items()}
    arrays = balls(cloud.name, centers[keep], radii[keep], layers)
    return MeshReading(arrays, int(np.count_nonzero(~good)))


def balls(
    name: str, centers: Float32Array, radii: Float32Array, layers: Mapping[Attribute, Float32Array]
) -> MeshArrays:
    """A ball about each of these places (n, 3); `layers` are (n, k) numbers of the points."""
    count = len(centers)
    directions, faces = ball(next((levels for most, levels in FINENESS if count <= most), 0))
    # As large in the mean as the round one: the corners of triangles lie outside of it, their middles inside.
    size = np.float32(_as_large(directions, faces))
    normals = np.tile(directions, (len(centers), 1))
    positions = (centers[:, None] + size * radii[:, None, None] * directions[None]).reshape(-1, 3)
    starts = (len(directions) * np.arange(len(centers), dtype=np.int32))[:, None, None]
    triangles = (faces[None] + starts).reshape(-1, 3).astype(np.int32)
    rows = np.repeat(np.arange(len(centers), dtype=np.int32), len(directions))
    ordered = sorted(layers)
    attributes = four_numbers([Layer(item, layers[item]) for item in ordered], rows)
    corner_vertex = np.arange(len(positions), dtype=np.int32)
    triangle_slot = np.zeros(len(triangles), np.int32)
    return MeshArrays(
        name=name,
        positions=positions,
        corner_vertex=corner_vertex,
        corner_normals=normals,
        corner_uv=None,
        triangles=triangles,
        triangle_slot=triangle_slot,
        attributes=tuple(ordered),
        corner_attributes=attributes,
        signature=array_signature(positions, corner_vertex, normals, triangles, triangle_slot, attributes),
    )


def ball(levels: int) -> tuple[Float32Array, Int32Array]:
    """Corners (n, 3) of a unit icosahedron whose triangles (m, 3) have been quartered so often."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    corners = [
        (a, s * golden, 0.0)[k:] + (a, s * golden, 0.0)[:k] for k in range(3) for a in (-1.0, 1.0) for s in (-1.0, 1.0)
    ]
    places = np.array(corners)
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    near = np.linalg.norm(places[:, None] - places[None], axis=2)
    is_edge = (near > 0.0) & (near < 1.1)
    faces = np.array(
        [
            (a, b, c) if np.linalg.det(places[[a, b, c]]) > 0.0 else (a, c, b)
            for a in range(12)
            for b in range(a + 1, 12)
            for c in range(b + 1, 12)
            if is_edge[a, b] and is_edge[b, c] and is_edge[a, c]
        ]
    )
    for _ in range(levels):
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        pairs, number = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        middles = places[pairs].sum(axis=1)
        middle = number.reshape(-1, 3) + len(places)
        places = np.concatenate([places, middles / np.linalg.norm(middles, axis=1, keepdims=True)])
        a, b, c = faces.T
        ab, bc, ca = middle.T
        faces = np.concatenate(
            [np.column_stack(part) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    return places.astype(np.float32), faces.astype(np.int32)


def _as_large(directions: Float32Array, faces: Int32Array) -> float:
    """Radius of the corners with which it is seen as large, on average from all sides, as a unit ball: by Cauchy its
    surface has to be 4 pi."""
    a, b, c = (directions[faces[:, k]].astype(np.float64) for k in range(3))
    return float(np.sqrt(4.0 * np.pi / (0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())))
