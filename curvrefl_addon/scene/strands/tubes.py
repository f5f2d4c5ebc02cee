# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as thin tubes of triangles, with the normals of round ones. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array, Int32Array, MeshArrays
from ..meshes.program_attributes import Layer, four_numbers
from ..programs.program import Attribute
from ..signature import array_signature
from .strands import Strands, own_layers, tangents

SIDES = 3
"""Of a tube: few, as strands are many and thinner than a pixel"""
AS_WIDE = 2.0 * np.pi / (2.0 * SIDES * np.sin(np.pi / SIDES))
"""A prism whose corners lie so many radii from its axis is seen, on average from all sides, as wide as the round tube:
what is convex is as wide as its outline is long, over pi"""


def tubes(name: str, strands: Strands, wanted: Sequence[Attribute]) -> MeshArrays:
    """The mesh, with those of the `wanted` attributes that strands have."""
    along = tangents(strands)
    across = _across(strands, along)
    third = np.cross(along, across)
    turns = 2.0 * np.pi * np.arange(SIDES) / SIDES
    normals = np.cos(turns)[None, :, None] * across[:, None] + np.sin(turns)[None, :, None] * third[:, None]
    normals = normals.astype(np.float32)
    positions = strands.points[:, None] + np.float32(AS_WIDE) * strands.radii[:, None, None] * normals
    triangles, slots = _triangles(strands)
    layers = [*own_layers(strands, wanted), *strands.layers]
    layers.sort(key=lambda item: item[0])
    of_corner = np.repeat(np.arange(len(strands.points), dtype=np.int32), SIDES)
    of_strand = np.repeat(strands.strand_of_point.astype(np.int32), SIDES)
    numbers = [
        Layer(attribute, values[of_corner if len(values) == len(strands.points) else of_strand])
        for attribute, values in layers
    ]
    attributes = four_numbers(numbers, None)
    positions, normals = positions.reshape(-1, 3), normals.reshape(-1, 3)
    corner_vertex = np.arange(len(positions), dtype=np.int32)
    return MeshArrays(
        name=name,
        positions=positions,
        corner_vertex=corner_vertex,
        corner_normals=normals,
        corner_uv=None,
        corner_color=None,
        triangles=triangles,
        triangle_slot=slots,
        attributes=tuple(attribute for attribute, _ in layers),
        corner_attributes=attributes,
        signature=array_signature(positions, corner_vertex, normals, triangles, slots, attributes),
    )


def _across(strands: Strands, along: Float32Array) -> Float32Array:
    """(n, 3) unit vectors across the strands, each turned as little as can be from the one before."""
    across = np.empty_like(along)
    roots = strands.starts[:-1]
    # From the axis that the strand is farthest from.
    axes = np.eye(3, dtype=np.float32)[np.abs(along[roots]).argmin(axis=1)]
    across[roots] = _perpendicular(axes, along[roots])
    lengths = strands.lengths
    rows = roots
    for step in range(1, int(lengths.max(initial=1))):
        rows = roots[lengths > step] + step
        across[rows] = _perpendicular(across[rows - 1], along[rows])
    return across


def _perpendicular(vectors: Float32Array, along: Float32Array) -> Float32Array:
    rest = vectors - along * np.einsum("ij,ij->i", vectors, along)[:, None]
    length = np.sqrt(np.einsum("ij,ij->i", rest, rest))[:, None]
    # (A strand that turns by a right angle: any other direction across it.)
    other = np.cross(along, vectors)
    other = np.where(np.abs(other).max(axis=1, keepdims=True) > 1e-6, other, np.roll(along, 1, axis=1))
    rest = np.where(length > 1e-3, rest, other)
    return rest / np.maximum(np.sqrt(np.einsum("ij,ij->i", rest, rest))[:, None], np.float32(1e-20))


def _triangles(strands: Strands) -> tuple[Int32Array, Int32Array]:
    """(triangles, 3) and (triangles,) their slots; those without area at tips that close are left out."""
    is_last = np.zeros(len(strands.points), bool)
    is_last[strands.starts[1:] - 1] = True
    rings = np.flatnonzero(~is_last)
    first = (SIDES * rings)[:, None] + np.arange(SIDES)
    after = (SIDES * rings)[:, None] + (np.arange(SIDES) + 1) % SIDES
    faces = np.stack(
        [
            np.stack([first, after, after + SIDES], axis=2),
            np.stack([first, after + SIDES, first + SIDES], axis=2),
        ],
        axis=1,
    ).astype(np.int32)
    slots = np.repeat(strands.slots[strands.strand_of_point[rings]], 2 * SIDES)
    closes = strands.radii[rings + 1] == 0.0
    starts_closed = strands.radii[rings] == 0.0
    keep: NDArray[np.bool_] = np.stack([~starts_closed, ~closes], axis=1)
    keep = np.repeat(keep, SIDES, axis=1).reshape(-1)
    triangles = faces.reshape(-1, 3)
    return (triangles, slots) if keep.all() else (triangles[keep], slots[keep])
