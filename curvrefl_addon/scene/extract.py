# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated Blender scene to frozen arrays: the only place that walks the depsgraph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..errors import InputError
from .arrays import InstanceArrays, LightArrays, MeshArrays, SceneArrays
from .lights import read_light
from .materials import MaterialReader
from .meshes import read_mesh, without_broken_triangles
from .world import read_world

SURFACE_TYPES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}


@dataclass
class _Collected:
    meshes: list[MeshArrays] = field(default_factory=list)
    instances: list[InstanceArrays] = field(default_factory=list)
    lights: list[LightArrays] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    mesh_numbers: dict[tuple[int, bool], int] = field(default_factory=dict)
    object_ids: dict[int, int] = field(default_factory=dict)


def extract_scene(
    depsgraph: bpy.types.Depsgraph,
    scene: bpy.types.Scene,
    reflectors: Sequence[bpy.types.Object],
    for_render: bool = True,
) -> SceneArrays:
    """Read everything that can be seen or that lights what is seen, at the depsgraph's frame.

    `for_render` leaves out what is hidden in renders. Raises InputError where a reflector cannot be one: nothing
    left of it to render, no triangles, coordinates that are not numbers, no extent.
    """
    found = _Collected()
    materials = MaterialReader()
    chosen = {reflector.original.session_uid: reflector.name for reflector in reflectors}
    held_out = _held_out(depsgraph.view_layer_eval)
    hidden = _hidden_collections(scene) if for_render else set()
    for instance in depsgraph.object_instances:
        source = instance.object
        if not instance.show_self or (for_render and (source.hide_render or source.original.session_uid in hidden)):
            continue
        matrix = np.array(instance.matrix_world, np.float64)
        if source.type == "LIGHT":
            found.lights.append(read_light(source.data, source, matrix, found.warnings))
        elif source.type in SURFACE_TYPES:
            _add_surface(found, materials, source, matrix, source.original.session_uid in chosen, held_out)
    seen = {found.object_ids[key] for key in chosen if key in found.object_ids}
    for key, name in chosen.items():
        if key not in found.object_ids:
            raise InputError(f'"{name}" is hidden or has no surface: make it visible or choose another reflector.')
    world = read_world(scene.world, found.warnings)
    return SceneArrays(
        tuple(found.meshes),
        tuple(found.instances),
        tuple(materials.materials),
        tuple(materials.images),
        tuple(found.lights),
        world,
        tuple(sorted(seen)),
        tuple(dict.fromkeys([*found.warnings, *materials.warnings])),
    )


def _add_surface(
    found: _Collected,
    materials: MaterialReader,
    source: bpy.types.Object,
    matrix: np.ndarray,
    is_reflector: bool,
    held_out: set[int],
) -> None:
    uid = source.original.session_uid
    number = _mesh_number(found, source, is_reflector)
    mesh = found.meshes[number] if number is not None else None
    if mesh is None or len(mesh.triangles) == 0:
        if is_reflector:
            raise InputError(f'"{source.name}" has no faces: choose a reflector with a surface.')
        return
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    volume = abs(np.linalg.det(matrix[:3, :3]))
    if not np.isfinite(matrix).all() or volume <= 1e-9 * max(float(scale.max()), 1e-30) ** 3:
        if is_reflector:
            raise InputError(f'"{source.name}" is scaled to nothing along an axis: give it a scale other than zero.')
        found.warnings.append(f'"{source.name}" is scaled to nothing along an axis and left out.')
        return
    slots = tuple(materials.index_of(slot.material) for slot in source.material_slots) or (0,)
    object_id = found.object_ids.setdefault(uid, len(found.object_ids) + 1)
    found.instances.append(
        InstanceArrays(
            object_name=source.name,
            object_id=object_id,
            mesh=number,
            matrix=matrix,
            materials=slots,
            visible_camera=source.visible_camera,
            visible_glossy=source.visible_glossy,
            visible_shadow=source.visible_shadow,
            holdout=source.is_holdout or uid in held_out,
        )
    )


def _mesh_number(found: _Collected, source: bpy.types.Object, is_reflector: bool) -> int | None:
    """Number of the object's mesh, read once for all that share it; None when there is none."""
    is_mesh = source.type == "MESH"
    key = (source.data.as_pointer(), is_mesh)
    if key in found.mesh_numbers:
        return found.mesh_numbers[key]
    mesh = source.data if is_mesh else source.to_mesh()
    if mesh is None:
        return None
    try:
        arrays = read_mesh(mesh)
    finally:
        if not is_mesh:
            source.to_mesh_clear()
    if not np.isfinite(arrays.positions).all():
        if is_reflector:
            raise InputError(f'"{source.name}" has vertices whose coordinates are not numbers: repair its mesh.')
        found.warnings.append(f'"{source.name}" has vertices whose coordinates are not numbers; their faces are left out.')
        arrays = without_broken_triangles(arrays)
    found.mesh_numbers[key] = len(found.meshes)
    found.meshes.append(arrays)
    return found.mesh_numbers[key]


def _held_out(view_layer: bpy.types.ViewLayer) -> set[int]:
    """session_uid of the objects in collections that hold out."""
    found: set[int] = set()

    def visit(layer: bpy.types.LayerCollection, above: bool) -> None:
        holds = above or layer.holdout
        if holds:
            found.update(item.original.session_uid for item in layer.collection.objects)
        for child in layer.children:
            visit(child, holds)

    visit(view_layer.layer_collection, False)
    return found


def _hidden_collections(scene: bpy.types.Scene) -> set[int]:
    """session_uid of the objects that are only in collections hidden in renders."""
    hidden: set[int] = set()
    shown: set[int] = set()

    def visit(collection: bpy.types.Collection, above: bool) -> None:
        hides = above or collection.hide_render
        (hidden if hides else shown).update(item.session_uid for item in collection.objects)
        for child in collection.children:
            visit(child, hides)

    visit(scene.collection, False)
    return hidden - shown
