# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs read of a mesh: its attributes at corners, as the numbers that Cycles takes them for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ..arrays import Float32Array, Int32Array
from ..finite import LARGEST_LIGHT, is_usable
from ..programs.program import FACTOR, GEOMETRY, TANGENT, UV, Attribute
from .attributes import PARTS, at_corners, values_of
from .tangents import corner_tangents


@dataclass(frozen=True, slots=True)
class Layer:
    """An attribute that a mesh has."""

    attribute: Attribute
    values: Float32Array
    """(corners, 1..4)"""


@dataclass(frozen=True, slots=True)
class Corners:
    """What tangents are made of."""

    positions: Float32Array
    """(vertices, 3)"""
    vertex: Int32Array
    """(corners,)"""
    normals: Float32Array
    """(vertices or corners, 3)"""
    triangles: Int32Array
    """(triangles, 3)"""

    def at_corners(self, layer: Float32Array) -> Float32Array:
        """Of a layer of vertices or corners, corners' values."""
        return layer if len(layer) == len(self.vertex) else layer[self.vertex]


def read_layers(
    mesh: bpy.types.Mesh, wanted: Sequence[Attribute], corners: Corners, repaired: list[str]
) -> list[Layer]:
    """Those of the `wanted` attributes that the mesh has; `repaired` gets causes of remarks."""
    layers: list[Layer] = []
    for attribute in wanted:
        values = _read(mesh, attribute, corners)
        if values is None:
            continue
        if not is_usable(values):
            cause = "Attributes {of} that are not usable numbers are taken for 0."
            if cause not in repaired:
                repaired.append(cause)
            values = np.where(np.abs(values) <= LARGEST_LIGHT, values, np.float32(0.0))
        layers.append(Layer(attribute, values))
    return layers


def four_numbers(layers: Sequence[Layer], rows: Int32Array | None) -> Float32Array | None:
    """(corners, layers, 4) of these rows: one number as a gray, two and three with zeros and a 1 after them."""
    if not layers:
        return None
    chosen = [layer.values if rows is None else layer.values[rows] for layer in layers]
    result = np.zeros((len(chosen[0]), len(layers), 4), np.float32)
    result[:, :, 3] = 1.0
    for number, values in enumerate(chosen):
        parts = values.shape[1]
        if parts == 1:
            result[:, number, :3] = values
        else:
            result[:, number, :parts] = values
    return result


def uv_of_map(mesh: bpy.types.Mesh, name: str) -> Float32Array | None:
    """(corners, 2); `name` "": of the map that renders use. None where the mesh has no such."""
    layer = next((uv_map for uv_map in mesh.uv_layers if (uv_map.name == name if name else uv_map.active_render)), None)
    if layer is None:
        return None
    uv = np.empty((len(mesh.loops), 2), np.float32)
    if len(uv):
        layer.uv.foreach_get("vector", uv.reshape(-1))
    return uv


def generated_of(mesh: bpy.types.Mesh) -> tuple[Float32Array, Float32Array]:
    """Scale and offset (3,) from object space to generated coordinates."""
    size = np.array(mesh.texspace_size, np.float32)
    scale = np.where(size == 0.0, 1.0, 0.5 / np.where(size == 0.0, 1.0, size)).astype(np.float32)
    offset = np.float32(0.5) - scale * np.array(mesh.texspace_location, np.float32)
    return scale, offset.astype(np.float32)


def _read(mesh: bpy.types.Mesh, attribute: Attribute, corners: Corners) -> Float32Array | None:
    if attribute.kind == TANGENT:
        uv = uv_of_map(mesh, attribute.name)
        if uv is None or len(corners.triangles) == 0:
            return None
        positions, normals = corners.positions[corners.vertex], corners.at_corners(corners.normals)
        return corner_tangents(corners.triangles, positions, normals, uv)
    if attribute.kind == UV and (not attribute.name or attribute.name in mesh.uv_layers):
        return uv_of_map(mesh, attribute.name)
    values = _by_name(mesh, attribute.name, corners)
    if values is None or attribute.kind in (GEOMETRY, UV):
        return values
    assert attribute.kind == FACTOR
    # (Of two parts Cycles takes the first.)
    return values[:, :1] if values.shape[1] <= 2 else values[:, :3].mean(axis=1, keepdims=True)


def _by_name(mesh: bpy.types.Mesh, name: str, corners: Corners) -> Float32Array | None:
    """Of any attribute (corners, parts); "" is the default color attribute."""
    if name == "uv":
        return uv_of_map(mesh, "")
    if name == "generated":
        scale, offset = generated_of(mesh)
        return (corners.positions * scale + offset)[corners.vertex]
    attribute = mesh.attributes.get(name or mesh.attributes.default_color_name)
    if attribute is None or attribute.data_type not in PARTS:
        return None
    return at_corners(mesh, attribute.domain, values_of(attribute), corners.vertex)
