# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV map that looks are on: every face that has the material has a place of its own in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np

from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.scene.programs.looks import UV_MAP

ISLAND_MARGIN = 0.01
"""Between islands, of the image's width"""
RASTER = 512
"""Places along a side at which overlaps are looked for"""
MOST_UV_MAPS = 8


def add_maps(objects: Sequence[Any], material: bpy.types.Material) -> list[bpy.types.Mesh]:
    """Lay out the faces with the material of all objects (one for each mesh) beside one another.

    The layout of the map that renders use is taken over where it is one already. Answers the meshes that got a map.
    Raises InputError where a mesh has no room for one.
    """
    for item in objects:
        layers = item.data.uv_layers
        if UV_MAP not in layers and len(layers) >= MOST_UV_MAPS:
            raise InputError(f'"{item.name}" has {MOST_UV_MAPS} UV maps, the most there can be: remove one.')
    layouts = _own_layout(objects, material) or _projected(objects, material)
    added = []
    for item, (uv, mask) in zip(objects, layouts, strict=True):
        if UV_MAP not in item.data.uv_layers:
            added.append(item.data)
            _new_layer(item.data)
        layer = item.data.uv_layers[UV_MAP]
        whole = _uv_of(layer)
        # (Other materials' faces keep their place in their own looks.)
        whole[mask] = uv[mask]
        layer.uv.foreach_set("vector", whole.ravel())
        item.data.update()
    return added


def remove_maps(meshes: Sequence[Any]) -> None:
    """Take back what `add_maps` has added."""
    for mesh in meshes:
        mesh.uv_layers.remove(mesh.uv_layers[UV_MAP])


def _new_layer(mesh: Any) -> None:
    """Without a change of which map is active, and which renders use."""
    layers = mesh.uv_layers
    active, used = layers.active_index, next((layer.name for layer in layers if layer.active_render), None)
    layers.new(name=UV_MAP, do_init=False)
    if used is not None:
        layers.active_index = active
        layers[used].active_render = True


def _uv_of(layer: Any) -> np.ndarray:
    """(loops, 2)"""
    uv = np.zeros(2 * len(layer.uv), np.float32)
    layer.uv.foreach_get("vector", uv)
    return uv.reshape(-1, 2)


def _loops_with(item: Any, material: bpy.types.Material) -> np.ndarray:
    """(loops,) whether a corner's face has the material."""
    mesh = item.data
    slots = np.zeros(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", slots)
    has = np.array([slot.material == material for slot in item.material_slots], bool)
    starts, counts = np.zeros_like(slots), np.zeros_like(slots)
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.polygons.foreach_get("loop_total", counts)
    mask = np.zeros(len(mesh.loops), bool)
    faces = has[np.minimum(slots, len(has) - 1)]
    # (Faces lie one after the other.)
    mask[np.repeat(starts, counts) + np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)] = (
        np.repeat(faces, counts)
    )
    return mask


def _own_layout(objects: Sequence[Any], material: bpy.types.Material) -> list[tuple[np.ndarray, np.ndarray]] | None:
    """Of a single mesh whose map gives each face its own place."""
    if len(objects) != 1:
        return None
    mesh = objects[0].data
    layer = next((layer for layer in mesh.uv_layers if layer.active_render and layer.name != UV_MAP), None)
    if layer is None:
        return None
    uv, mask = _uv_of(layer), _loops_with(objects[0], material)
    mesh.calc_loop_triangles()
    triangles = np.zeros(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", triangles)
    corners = triangles.reshape(-1, 3)
    return [(uv, mask)] if is_layout(uv[corners[mask[corners[:, 0]]]]) else None


def is_layout(triangles: np.ndarray) -> bool:
    """Whether (n, 3, 2) UVs are inside the image, and next to nothing lies on something else."""
    if len(triangles) == 0 or triangles.min() < -1e-4 or triangles.max() > 1.0001:
        return False
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    areas = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    if np.count_nonzero(areas < 1e-9) > 0.01 * len(areas):
        return False
    # (What is covered is as much as all triangles together where nothing is covered twice.)
    covered = np.zeros((RASTER, RASTER), bool)
    for triangle in triangles * RASTER:
        low = np.clip(np.floor(triangle.min(axis=0)), 0, RASTER - 1).astype(int)
        high = np.clip(np.ceil(triangle.max(axis=0)), 1, RASTER).astype(int)
        x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
        inside = np.ones(x.shape, bool)
        turn = np.sign(np.cross(*np.append(triangle[1:] - triangle[0], np.zeros((2, 1)), axis=1))[2])
        for k in range(3):
            p, q = triangle[k], triangle[(k + 1) % 3]
            inside &= turn * ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) >= 0.0
        covered[low[1] : high[1], low[0] : high[0]] |= inside
    return bool(areas.sum() <= covered.mean() * 1.03 + 4.0 * np.sqrt(areas.sum()) / RASTER)


def _projected(objects: Sequence[Any], material: bpy.types.Material) -> list[tuple[np.ndarray, np.ndarray]]:
    """Blender's Smart UV Project, of copies in a scene of their own: the user's selection stays."""
    scene = bpy.data.scenes.new("Curvrefl unwrap")
    masks = [_loops_with(item, material) for item in objects]
    copies: list[Any] = []
    try:
        view_layer = scene.view_layers[0]
        for item, mask in zip(objects, masks, strict=True):
            mesh = item.data.copy()
            copy = bpy.data.objects.new("Curvrefl unwrap", mesh)
            copy.matrix_world = item.matrix_world
            copies.append(copy)
            scene.collection.objects.link(copy)
            if UV_MAP not in mesh.uv_layers:
                mesh.uv_layers.new(name=UV_MAP, do_init=False)
            mesh.uv_layers.active = mesh.uv_layers[UV_MAP]
            _select(mesh, mask)
            copy.select_set(True, view_layer=view_layer)
        view_layer.objects.active = copies[0]
        of_all: dict[str, Any] = {
            "scene": scene,
            "view_layer": view_layer,
            "active_object": copies[0],
            "object": copies[0],
        }
        of_all |= {"selected_objects": copies, "selected_editable_objects": copies}
        with bpy.context.temp_override(**of_all):
            bpy.ops.object.mode_set(mode="EDIT")
        with bpy.context.temp_override(**of_all, edit_object=copies[0], objects_in_mode=copies):
            bpy.ops.uv.smart_project(island_margin=ISLAND_MARGIN, scale_to_bounds=False)
            bpy.ops.object.mode_set(mode="OBJECT")
        return [(_uv_of(copy.data.uv_layers[UV_MAP]), mask) for copy, mask in zip(copies, masks, strict=True)]
    finally:
        meshes = [copy.data for copy in copies]
        for copy in copies:
            bpy.data.objects.remove(copy)
        for mesh in meshes:
            bpy.data.meshes.remove(mesh)
        bpy.data.scenes.remove(scene)


def _select(mesh: Any, mask: np.ndarray) -> None:
    """The faces of these corners alone; others are hidden."""
    chosen = np.array([mask[polygon.loop_start] for polygon in mesh.polygons], bool)
    mesh.polygons.foreach_set("hide", ~chosen)
    for elements in (mesh.vertices, mesh.edges):
        elements.foreach_set("hide", np.zeros(len(elements), bool))
        elements.foreach_set("select", np.zeros(len(elements), bool))
    mesh.polygons.foreach_set("select", chosen)
    vertices = np.zeros(len(mesh.vertices), bool)
    corners = np.zeros(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    vertices[corners[mask]] = True
    mesh.vertices.foreach_set("select", vertices)
