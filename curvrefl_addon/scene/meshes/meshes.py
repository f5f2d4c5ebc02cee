# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated Blender meshes as arrays."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ..arrays import Float32Array, Float64Array, Int32Array, MeshArrays
from ..finite import LARGEST_LIGHT, LARGEST_PLACE, is_usable
from ..programs.program import Attribute
from ..signature import array_signature
from .attributes import attribute_data, corner_coordinates
from .program_attributes import Corners, four_numbers, generated_of, read_layers, uv_of_map
from .topology import Source, Topology, topology_of

GENERATED = "\0generated"
"""Texture space "Generated" in place of a UV map's name"""
OBJECT = "\0object"
"""Object space in place of a UV map's name"""


@dataclass(frozen=True, slots=True)
class MeshNeeds:
    """What the materials on a mesh read of it."""

    uv_map: str | None = None
    """Name of a UV map or another attribute, "" for the map active for rendering, GENERATED, OBJECT, or None for no
    texture"""
    hidden_slots: tuple[bool, ...] = ()
    """For each slot whether its faces are left out, as those of volumes; empty where none are"""
    attributes: tuple[Attribute, ...] = ()
    """What programs read, ascending"""


@dataclass(frozen=True, slots=True)
class MeshReading:
    """A mesh and what was wrong with it."""

    mesh: MeshArrays
    dropped: int = 0
    """Triangles left out because a coordinate is not finite"""
    repaired: tuple[str, ...] = ()
    """Causes of remarks: what of it was no number and has been replaced"""
    topology: Topology | None = None
    """Of a mesh of Blender's"""


def read_mesh(mesh: bpy.types.Mesh, needs: MeshNeeds, known: Topology | None = None) -> MeshReading:
    """Read an evaluated mesh, object space. Vertices that no face uses are left out.

    Normals are Blender's: smooth, flat or custom, per corner only where the mesh has them so. `known`: what it, or
    another state of it, was put together like; where it is so still, the arrays that follow from it are the same ones.
    """
    triangle_corners = _loop_triangles(mesh)
    corner_vertex = np.empty(len(mesh.loops), np.int32)
    if len(mesh.loops):
        attribute_data(mesh.attributes[".corner_vert"]).foreach_get("value", corner_vertex)
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    if len(mesh.vertices):
        attribute_data(mesh.attributes["position"]).foreach_get("vector", positions.reshape(-1))
    if len(corner_vertex) and not 0 <= corner_vertex.min() <= corner_vertex.max() < len(positions):
        raise InputError(f'Mesh "{mesh.name}" is damaged, it has faces without vertices: make it anew.')
    slots = _triangle_slots(mesh, len(triangle_corners))
    if any(needs.hidden_slots):
        shown = ~np.array(needs.hidden_slots)[np.minimum(slots, len(needs.hidden_slots) - 1)]
        triangle_corners, slots = triangle_corners[shown], slots[shown]

    dropped = 0
    if not is_usable(positions, LARGEST_PLACE):
        # (Comparisons with what is not a number are not true.)
        good_vertex = (np.abs(positions) <= LARGEST_PLACE).all(axis=1)
        good = good_vertex[corner_vertex[triangle_corners]].all(axis=1)
        dropped = int(len(good) - np.count_nonzero(good))
        triangle_corners, slots = triangle_corners[good], slots[good]

    repaired: list[str] = []
    uv = _usable(_uv(mesh, needs.uv_map, positions, corner_vertex), "Texture coordinates", repaired)
    per_vertex_normals = mesh.normals_domain == "POINT"
    normals = _normals(mesh, per_vertex_normals)
    corners = Corners(positions, corner_vertex, normals, triangle_corners)
    extra = read_layers(mesh, needs.attributes, corners, repaired)

    layers = [layer for layer in (None if per_vertex_normals else normals, uv) if layer is not None]
    layers += [layer.values for layer in extra]
    source = Source(
        len(positions),
        mesh.normals_domain,
        corner_vertex,
        triangle_corners,
        slots,
        dropped == 0 and not any(needs.hidden_slots),
    )
    topology = known
    if topology is None or not topology.source.is_same(source) or not topology.serves(layers):
        topology = topology_of(source, layers)
    positions, corner_vertex = topology.at_vertices(positions), topology.corner_vertex
    if not per_vertex_normals:
        normals = topology.at_corners(normals)
    else:
        normals = topology.at_vertices(normals)
        normals = normals if topology.models is None else normals[corner_vertex]
    if not np.isfinite(normals).all():
        normals = _repaired_normals(normals, positions, corner_vertex, topology.triangles)
    uv = None if uv is None else topology.at_corners(uv)
    attributes = four_numbers([replace(layer, values=topology.at_corners(layer.values)) for layer in extra], None)
    arrays = MeshArrays(
        name=mesh.name,
        positions=positions,
        corner_vertex=corner_vertex,
        corner_normals=normals,
        corner_uv=uv,
        triangles=topology.triangles,
        triangle_slot=topology.source.slots,
        attributes=tuple(layer.attribute for layer in extra),
        corner_attributes=attributes,
        signature=array_signature(np.array([topology.signature]), positions, normals, uv, attributes),
    )
    return MeshReading(arrays, dropped, tuple(repaired), topology)


def mirrored(mesh: MeshArrays) -> MeshArrays:
    """The same surface with its triangles wound the other way round, for instances of negative scale.

    In world space they then run counter-clockwise as seen from the side that the normals point to.
    """
    triangles = np.ascontiguousarray(mesh.triangles[:, (0, 2, 1)])
    return replace(mesh, triangles=triangles, signature=array_signature(np.array([mesh.signature]), triangles))


def _loop_triangles(mesh: bpy.types.Mesh) -> Int32Array:
    """(triangles, 3) index into corners.

    `foreach_get` asks for each triangle through a function call, 0.14 s for 2M of them; the array itself is one piece
    of 32-bit integers, so it is copied as such once its first and last member and its extent say so.
    """
    mesh.calc_loop_triangles()
    triangles: Any = mesh.loop_triangles
    count = len(triangles)
    if count == 0:
        return np.empty((0, 3), np.int32)
    first, last = triangles[0], triangles[count - 1]
    start = first.as_pointer()
    if last.as_pointer() - start == 12 * (count - 1):
        memory = (ctypes.c_int32 * (3 * count)).from_address(start)
        loops = np.ctypeslib.as_array(memory).reshape(-1, 3).copy()
        if tuple(loops[0]) == tuple(first.loops) and tuple(loops[-1]) == tuple(last.loops):
            return loops
    loops = np.empty((count, 3), np.int32)
    triangles.foreach_get("loops", loops.reshape(-1))
    return loops


def _triangle_slots(mesh: bpy.types.Mesh, count: int) -> Int32Array:
    attribute = mesh.attributes.get("material_index")
    if attribute is None or count == 0:
        return np.zeros(count, np.int32)
    slot_of_face = np.empty(len(mesh.polygons), np.int32)
    attribute_data(attribute).foreach_get("value", slot_of_face)
    face = np.empty(count, np.int32)
    mesh.loop_triangle_polygons.foreach_get("value", face)
    return np.maximum(slot_of_face, 0)[face]


def _normals(mesh: bpy.types.Mesh, per_vertex: bool) -> Float32Array:
    source = mesh.vertex_normals if per_vertex else mesh.corner_normals
    normals = np.empty((len(source), 3), np.float32)
    if len(source):
        source.foreach_get("vector", normals.reshape(-1))
    return normals


def _uv(
    mesh: bpy.types.Mesh, name: str | None, positions: Float32Array, corner_vertex: Int32Array
) -> Float32Array | None:
    """(corners, 2); None, which is drawn as 0, also where the mesh has no such UV map, as in Cycles."""
    if name is None:
        return None
    if name in (GENERATED, OBJECT):
        flat: Float64Array | Float32Array = positions[:, :2]
        if name == GENERATED:
            scale, offset = generated_of(mesh)
            flat = flat * scale[:2] + offset[:2]
        return np.ascontiguousarray(flat, np.float32)[corner_vertex]
    uv = uv_of_map(mesh, name)
    if uv is None and name:
        return corner_coordinates(mesh, name, corner_vertex)
    return uv


def _usable(layer: Float32Array | None, what: str, repaired: list[str]) -> Float32Array | None:
    """A layer (n, k) with 0 in place of what is no number."""
    if layer is None or is_usable(layer):
        return layer
    repaired.append(f"{what} {{of}} that are not usable numbers are taken for 0.")
    return np.where(np.abs(layer) <= LARGEST_LIGHT, layer, np.float32(0.0))


def _repaired_normals(
    normals: Float32Array, positions: Float32Array, corner_vertex: Int32Array, triangles: Int32Array
) -> Float32Array:
    """Beside a vertex without a place Blender's normals are not numbers: those become the triangles' own."""
    a, b, c = (positions[corner_vertex[triangles[:, k]]] for k in range(3))
    faces = np.cross(b - a, c - a)
    own = np.zeros_like(normals)
    for k in range(3):
        np.add.at(own, triangles[:, k], faces)
    lengths = np.linalg.norm(own, axis=1, keepdims=True)
    own = np.where(lengths > 0.0, own / np.where(lengths > 0.0, lengths, 1.0), np.array([0.0, 0.0, 1.0], np.float32))
    return np.where(np.isfinite(normals).all(axis=1, keepdims=True), normals, own).astype(np.float32)
