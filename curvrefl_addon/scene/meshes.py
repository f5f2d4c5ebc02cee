# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated Blender meshes to arrays."""

from __future__ import annotations

from zlib import crc32

import bpy
import numpy as np

from .arrays import Float32Array, Int32Array, MeshArrays


def read_mesh(mesh: bpy.types.Mesh) -> MeshArrays:
    """Arrays of an evaluated mesh, object space. The mesh may have no triangles at all.

    Corners are the vertices themselves where neither normals, UVs nor colours differ between faces.
    """
    positions = _floats(mesh.vertices, "co", 3)
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    slots = np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("material_index", slots)
    per_face = np.empty((count, 3), np.int32)
    uv_layer = mesh.uv_layers.active
    color_layer = mesh.color_attributes.active_color
    smooth = mesh.normals_domain == "POINT"
    point_color = color_layer is None or color_layer.domain == "POINT"
    uv = _floats(uv_layer.uv, "vector", 2) if uv_layer is not None and len(uv_layer.uv) else None
    colors = _colors(color_layer) if color_layer is not None else None

    if smooth and uv is None and point_color:
        mesh.loop_triangles.foreach_get("vertices", per_face.ravel())
        return _finished(
            mesh, positions, np.arange(len(positions), dtype=np.int32), _floats(mesh.vertex_normals, "vector", 3),
            None, colors, per_face, slots,
        )

    mesh.loop_triangles.foreach_get("loops", per_face.ravel())
    corner_vertex = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corner_vertex)
    normals = _floats(mesh.corner_normals, "vector", 3)
    if colors is not None and point_color:
        colors = colors[corner_vertex]
    corner_vertex, normals, uv, colors, per_face = _merge(
        len(positions), corner_vertex, normals, uv, colors, per_face, check_normals=not smooth
    )
    return _finished(mesh, positions, corner_vertex, normals, uv, colors, per_face, slots)


def _merge(
    vertex_count: int,
    corner_vertex: Int32Array,
    normals: Float32Array,
    uv: Float32Array | None,
    colors: Float32Array | None,
    triangles: Int32Array,
    check_normals: bool,
) -> tuple[Int32Array, Float32Array, Float32Array | None, Float32Array | None, Int32Array]:
    """One corner for all faces that agree with the vertex's last one; the others keep their own.

    Most vertices of a UV-mapped smooth mesh need one corner only: a seam needs more.
    """
    first = np.full(vertex_count, -1, np.int64)
    first[corner_vertex] = np.arange(len(corner_vertex))
    leader = first[corner_vertex]
    same = np.ones(len(corner_vertex), bool)
    if check_normals:
        same &= (np.abs(normals - normals[leader]) < 1e-6).all(axis=1)
    for attribute in (uv, colors):
        if attribute is not None:
            same &= (attribute == attribute[leader]).all(axis=1)
    kept = ~same
    kept[first[first >= 0]] = True
    number = np.cumsum(kept) - 1
    renamed = np.where(kept, number, number[leader]).astype(np.int32)
    return (
        corner_vertex[kept],
        normals[kept],
        None if uv is None else uv[kept],
        None if colors is None else colors[kept],
        renamed[triangles],
    )


def _finished(
    mesh: bpy.types.Mesh,
    positions: Float32Array,
    corner_vertex: Int32Array,
    normals: Float32Array,
    uv: Float32Array | None,
    colors: Float32Array | None,
    triangles: Int32Array,
    slots: Int32Array,
) -> MeshArrays:
    signature = 0
    for array in (positions, corner_vertex, normals, uv, colors, triangles, slots):
        if array is not None:
            signature = crc32(np.ascontiguousarray(array).data, signature)
    return MeshArrays(mesh.name, positions, corner_vertex, normals, uv, colors, triangles, slots, signature)


def without_broken_triangles(mesh: MeshArrays) -> MeshArrays:
    """The same without triangles that have a vertex that is not finite; such vertices become the origin."""
    broken = ~np.isfinite(mesh.positions).all(axis=1)
    keep = ~broken[mesh.corner_vertex[mesh.triangles]].any(axis=1)
    return MeshArrays(
        mesh.name,
        np.where(broken[:, None], np.float32(0.0), mesh.positions),
        mesh.corner_vertex,
        np.nan_to_num(mesh.corner_normals),
        mesh.corner_uv,
        mesh.corner_color,
        mesh.triangles[keep],
        mesh.triangle_slot[keep],
        mesh.signature,
    )


def _floats(collection: bpy.types.bpy_prop_collection, name: str, width: int) -> Float32Array:
    values = np.empty((len(collection), width), np.float32)
    collection.foreach_get(name, values.ravel())
    return values


def _colors(layer: bpy.types.Attribute) -> Float32Array:
    """Scene-linear colours, whatever the layer stores."""
    return _floats(layer.data, "color", 4)
