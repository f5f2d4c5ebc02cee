# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of meshes as the colors of their corners, whatever their type and domain."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..arrays import Float32Array, Int32Array

PARTS = {
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT2": ("vector", 2),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),
    "QUATERNION": ("value", 4),
}
"""Types of attributes that Cycles reads: the property with their values, and how many these are"""


def attribute_data(attribute: bpy.types.Attribute | None) -> Any:
    """The values of an attribute; every kind has `data`, their common base has not."""
    assert attribute is not None
    return attribute.data


def corner_coordinates(mesh: bpy.types.Mesh, name: str, corner_vertex: Int32Array) -> Float32Array | None:
    """(corners, 2) of an attribute as texture coordinates; None where the mesh has no such."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.data_type not in PARTS:
        return None
    values = at_corners(mesh, attribute.domain, values_of(attribute), corner_vertex)
    return np.ascontiguousarray(values[:, :2] if values.shape[1] > 1 else np.repeat(values, 2, axis=1))


def values_of(attribute: bpy.types.Attribute) -> Float32Array:
    """(n, parts) on its own domain."""
    name, parts = PARTS[attribute.data_type]
    data = attribute_data(attribute)
    plain = np.empty(
        len(data) * parts, {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool}.get(attribute.data_type, np.float32)
    )
    if len(data):
        data.foreach_get(name, plain)
    return plain.astype(np.float32).reshape(-1, parts)


def at_corners(mesh: bpy.types.Mesh, domain: str, values: Float32Array, corner_vertex: Int32Array) -> Float32Array:
    """(corners, parts) of values on a domain; a corner's on edges are the mean of the two that meet there."""
    if domain == "POINT":
        return values[corner_vertex]
    if domain == "CORNER":
        return values
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    if domain == "FACE":
        return np.repeat(values, sizes, axis=0)
    edges = np.empty(len(corner_vertex), np.int32)
    attribute_data(mesh.attributes[".corner_edge"]).foreach_get("value", edges)
    before = np.arange(len(edges)) - 1
    starts = np.cumsum(sizes) - sizes
    before[starts] += sizes
    return np.float32(0.5) * (values[edges] + values[edges[before]])
