# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as thin tubes of triangles, with the normals of round ones. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Float32Array, Int32Array, MeshArrays
from ..meshes.program_attributes import Layer, four_numbers
from ..programs.program import Attribute
from ..signature import array_signature
from .smoothed import smoothed
from .straightened import straightened
from .strands import Strands, own_layers, tangents

FINENESS = ((1_000, 8, 4), (4_000, 6, 2), (20_000, 4, 1), (40_000, 3, 1))
"""(segments, sides, parts): with no more of the first, tubes have so many sides and segments so many parts; with more
than all, strands are ribbons

Ribbons are turned at random about their strands: of many together as much is seen, and in the mean they are as bright,
as of round strands, for a third of the triangles."""
RIBBON = 1
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
"""Multiples of it lie evenly between whole numbers"""


def fineness_of(strands: Strands) -> tuple[int, int]:
    """How many sides a tube gets, or RIBBON, and how many parts a segment."""
    segments = len(strands.points) - len(strands.slots)
    return next(((sides, parts) for most, sides, parts in FINENESS if segments <= most), (RIBBON, 1))


def radius_factor(sides: int) -> float:
    """How many radii the edges are from the axis, to be seen as wide as the round strand on average from all sides.

    What is convex is as wide as its outline is long, over pi: so is a prism, and a ribbon, whose outline has two sides.
    """
    if sides == RIBBON:
        return 0.5 * np.pi
    return float(np.pi / (sides * np.sin(np.pi / sides)))


def tubes(name: str, strands: Strands, wanted: Sequence[Attribute]) -> MeshArrays:
    """The mesh, with those of the `wanted` attributes that strands have."""
    sides, parts = fineness_of(strands)
    strands = straightened(strands) if sides == RIBBON else smoothed(strands, parts)
    along = tangents(strands)
    across = _across(strands, along)
    third = np.cross(along, across)
    normals: Float32Array
    outward: Float32Array
    if sides == RIBBON:
        normals = np.repeat(third[:, None], 2, axis=1)
        outward = np.stack([across, -across], axis=1)
    else:
        turns = 2.0 * np.pi * np.arange(sides) / sides
        cosines, sines = (of(turns).astype(np.float32)[None, :, None] for of in (np.cos, np.sin))
        outward = normals = cosines * across[:, None] + sines * third[:, None]
    edges = outward.shape[1]
    positions = strands.points[:, None] + np.float32(radius_factor(sides)) * strands.radii[:, None, None] * outward
    triangles, slots = _triangles(strands, sides)
    layers = [*own_layers(strands, wanted), *strands.layers]
    layers.sort(key=lambda item: item[0])
    of_corner = np.repeat(np.arange(len(strands.points), dtype=np.int32), edges)
    of_strand = np.repeat(strands.strand_of_point.astype(np.int32), edges)
    numbers = [
        Layer(attribute, values[of_corner if len(values) == len(strands.points) else of_strand])
        for attribute, values in layers
    ]
    attributes = four_numbers(numbers, None)
    positions = positions.reshape(-1, 3)
    corner_vertex = np.arange(len(positions), dtype=np.int32)
    return MeshArrays(
        name=name,
        positions=positions,
        corner_vertex=corner_vertex,
        corner_normals=normals.reshape(-1, 3),
        corner_uv=None,
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
    # From the axis that the strand is farthest from, and then by any angle.
    axes = np.eye(3, dtype=np.float32)[np.abs(along[roots]).argmin(axis=1)]
    first = _perpendicular(axes, along[roots])
    angles = (2.0 * np.pi * ((GOLDEN * np.arange(len(roots))) % 1.0))[:, None]
    across[roots] = np.cos(angles) * first + np.sin(angles) * np.cross(along[roots], first)
    lengths = strands.lengths
    rows = roots
    for step in range(1, int(lengths.max(initial=1))):
        rows = roots[lengths > step] + step
        # Turned as the strand is: what is only projected leans towards the axis that it turns about.
        before, both = across[rows - 1], along[rows - 1] + along[rows]
        share = 2.0 * np.einsum("ij,ij->i", before, along[rows]) / np.maximum(np.einsum("ij,ij->i", both, both), 1e-6)
        across[rows] = _perpendicular(before - share[:, None] * both, along[rows])
    return across


def _perpendicular(vectors: Float32Array, along: Float32Array) -> Float32Array:
    rest = vectors - along * np.einsum("ij,ij->i", vectors, along)[:, None]
    length = np.sqrt(np.einsum("ij,ij->i", rest, rest))[:, None]
    # (A strand that turns by a right angle: any other direction across it.)
    other = np.cross(along, vectors)
    other = np.where(np.abs(other).max(axis=1, keepdims=True) > 1e-6, other, np.roll(along, 1, axis=1))
    rest = np.where(length > 1e-3, rest, other)
    return rest / np.maximum(np.sqrt(np.einsum("ij,ij->i", rest, rest))[:, None], np.float32(1e-20))


def _triangles(strands: Strands, sides: int) -> tuple[Int32Array, Int32Array]:
    """(triangles, 3) and (triangles,) their slots; those without area at ends that close are left out."""
    is_last = np.zeros(len(strands.points), bool)
    is_last[strands.starts[1:] - 1] = True
    rings = np.flatnonzero(~is_last).astype(np.int32)
    edges = 2 if sides == RIBBON else sides
    here = (edges * rings)[:, None] + np.arange(sides, dtype=np.int32)
    beside = (edges * rings)[:, None] + ((np.arange(sides, dtype=np.int32) + 1) % edges)
    faces = np.empty((len(rings), 2, sides, 3), np.int32)
    faces[:, 0, :, 0], faces[:, 0, :, 1], faces[:, 0, :, 2] = here, beside, beside + edges
    faces[:, 1, :, 0], faces[:, 1, :, 1], faces[:, 1, :, 2] = here, beside + edges, here + edges
    slots = np.repeat(strands.slots[strands.strand_of_point[rings]], 2 * sides)
    keep = np.stack([strands.radii[rings] > 0.0, strands.radii[rings + 1] > 0.0], axis=1)
    triangles = faces.reshape(-1, 3)
    if keep.all():
        return triangles, slots
    chosen = np.repeat(keep.reshape(-1), sides)
    return triangles[chosen], slots[chosen]
