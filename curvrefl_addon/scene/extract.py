# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated Blender scene to frozen arrays: the only place that walks the depsgraph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np

from ..errors import InputError
from .arrays import Float64Array, InstanceArrays, LightArrays, MeshArrays, SceneArrays
from .images import ImageReader
from .lights import read_light
from .materials import MaterialReader, ReadMaterial
from .meshes import MeshNeeds, MeshReading, mirrored, read_mesh
from .visibility import Visibility
from .world import read_world

SMALLEST_STRETCH = 1e-6
"""Of a matrix: least over greatest stretch, under which it counts as singular in single precision"""


def extract_scene(
    depsgraph: bpy.types.Depsgraph,
    scene: bpy.types.Scene,
    reflectors: Sequence[bpy.types.Object],
    for_render: bool = True,
) -> SceneArrays:
    """Read everything that can be seen or that lights what is seen, at the depsgraph's frame.

    `for_render` leaves out what is hidden in renders; what is hidden in the viewport is not in a viewport's
    depsgraph. Instances of one mesh share its arrays. Raises InputError where a reflector cannot be one: hidden,
    no faces, coordinates that are not finite, a singular matrix. Elsewhere such parts are left out with a warning.
    """
    return _Extraction(depsgraph, scene, reflectors, for_render).run()


class _Extraction:
    """One walk through the depsgraph."""

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        scene: bpy.types.Scene,
        reflectors: Sequence[bpy.types.Object],
        for_render: bool,
    ) -> None:
        view_layer = depsgraph.view_layer
        assert view_layer is not None
        self._depsgraph = depsgraph
        self._view_layer = view_layer
        self._scene = scene
        self._reflectors = {obj.original.as_pointer(): obj.name for obj in reflectors}
        self._visibility = Visibility(view_layer, for_render)
        self._override = view_layer.material_override
        self._warnings: list[str] = []
        self._images = ImageReader(self._warnings)
        self._materials = MaterialReader(self._images, self._warnings)
        self._meshes: list[MeshArrays] = []
        self._mesh_numbers: dict[tuple[int, MeshNeeds, bool], int] = {}
        self._dropped: dict[int, int] = {}
        """Triangles left out of each mesh"""
        self._instances: list[InstanceArrays] = []
        self._lights: list[LightArrays] = []
        self._ids: dict[int, int] = {}

    def run(self) -> SceneArrays:
        found_without_faces: set[int] = set()
        for instance in self._depsgraph.object_instances:
            kind = instance.object.type
            if kind not in ("LIGHT", "MESH") or not self._visibility.is_there(instance):
                continue
            if kind == "LIGHT":
                self._add_light(instance)
            elif not self._add_surface(instance):
                found_without_faces.add(instance.object.original.as_pointer())
        for key, name in self._reflectors.items():
            if key not in self._ids:
                if key in found_without_faces:
                    raise InputError(f'"{name}" has no faces: choose a reflector with a surface.')
                raise InputError(f'"{name}" is hidden or has no surface: show it or choose another reflector.')
        world = read_world(self._view_world(), self._images, self._warnings)
        return SceneArrays(
            meshes=tuple(self._meshes),
            instances=tuple(self._instances),
            materials=tuple(self._materials.materials),
            images=tuple(self._materials.images),
            lights=tuple(self._lights),
            world=world,
            reflectors=tuple(self._ids[key] for key in self._reflectors),
            warnings=tuple(dict.fromkeys(self._warnings)),
        )

    def _view_world(self) -> bpy.types.World | None:
        override = self._view_layer.world_override
        return override if override is not None else self._scene.world

    def _add_light(self, instance: Any) -> None:
        obj = instance.object
        matrix = np.array(instance.matrix_world, dtype=np.float64)
        visible_glossy = self._visibility.rays(instance).glossy
        light = read_light(obj.data, obj.name, matrix, visible_glossy, self._warnings)
        if light is not None:
            self._lights.append(light)

    def _add_surface(self, instance: Any) -> bool:
        """False for a mesh without faces."""
        # Curves, texts, surfaces, metaballs and what geometry nodes make come as instances of meshes, too.
        obj = instance.object
        rays = self._visibility.rays(instance)
        key = obj.original.as_pointer()
        is_reflector = key in self._reflectors
        if len(obj.data.polygons) == 0 and not obj.data.is_editmode:
            return False
        if not rays.any and not is_reflector:
            return True
        matrix = np.array(instance.matrix_world, dtype=np.float64)
        if _is_singular(matrix):
            if is_reflector:
                raise InputError(f'"{obj.name}" is flattened by a zero or endless scale: clear the scale.')
            self._warnings.append(f'"{obj.name}" is flattened by a zero or endless scale and left out.')
            return True
        slots = [self._materials.read(material) for material in self._slot_materials(obj)]
        number = self._mesh(obj, slots, is_mirrored=bool(np.linalg.det(matrix[:3, :3]) < 0.0))
        if is_reflector and self._dropped[number]:
            raise InputError(f'"{obj.name}" has vertices at no finite place: repair its mesh or choose another.')
        if len(self._meshes[number].triangles) == 0:
            return False
        if obj.original.is_shadow_catcher:
            self._warnings.append(f'Shadow catcher "{obj.name}" is drawn as an ordinary object.')
        self._instances.append(
            InstanceArrays(
                object_name=obj.original.name,
                object_id=self._ids.setdefault(key, len(self._ids) + 1),
                mesh=number,
                matrix=matrix,
                materials=tuple(slot.index for slot in slots),
                visible_camera=rays.camera,
                visible_glossy=rays.glossy,
                visible_shadow=rays.shadow,
                holdout=rays.holdout,
            )
        )
        return True

    def _slot_materials(self, obj: bpy.types.Object) -> list[bpy.types.Material | None]:
        """What each slot shows; one empty slot where there are none."""
        assert isinstance(obj.data, bpy.types.Mesh)
        materials = list(obj.data.materials)
        for index, slot in enumerate(obj.material_slots):
            if index >= len(materials):
                materials.append(slot.material)
            elif slot.link == "OBJECT":
                materials[index] = slot.material
        if self._override is not None:
            materials = [self._override] * len(materials) or [self._override]
        return materials or [None]

    def _mesh(self, obj: bpy.types.Object, slots: Sequence[ReadMaterial], is_mirrored: bool) -> int:
        """Number of the object's mesh arrays, read once for all that share them."""
        needs = self._needs(obj, slots)
        key = (obj.data.as_pointer(), needs, is_mirrored)
        if key not in self._mesh_numbers:
            if is_mirrored:
                plain = self._mesh(obj, slots, is_mirrored=False)
                arrays, dropped = mirrored(self._meshes[plain]), self._dropped[plain]
            else:
                reading = _read_surface(obj, needs)
                arrays, dropped = reading.mesh, reading.dropped
                if dropped:
                    self._warnings.append(
                        f'{dropped} triangles of "{obj.name}" have a corner at no finite place and are left out.'
                    )
                self._warnings += [f'"{obj.name}" has no {what} that its material needs.' for what in reading.missing]
            self._mesh_numbers[key] = len(self._meshes)
            self._dropped[len(self._meshes)] = dropped
            self._meshes.append(arrays)
        return self._mesh_numbers[key]

    def _needs(self, obj: bpy.types.Object, slots: Sequence[ReadMaterial]) -> MeshNeeds:
        """What the first slots that need a UV map or colours say: a mesh has one of each here."""
        uv_maps = [slot.needs.uv_map for slot in slots if slot.needs.uv_map is not None]
        colors = [slot.needs.colors for slot in slots if slot.needs.colors is not None]
        for wanted, what in ((uv_maps, "texture coordinates"), (colors, "vertex colours")):
            if len(set(wanted)) > 1:
                self._warnings.append(f'"{obj.name}" has several materials; the {what} of the first serve all.')
        return MeshNeeds(uv_maps[0] if uv_maps else None, colors[0] if colors else None)


def _read_surface(obj: bpy.types.Object, needs: MeshNeeds) -> MeshReading:
    assert isinstance(obj.data, bpy.types.Mesh)
    if not obj.data.is_editmode:
        return read_mesh(obj.data, needs)
    # What is being edited has its evaluated arrays only in a copy.
    mesh = obj.to_mesh()
    assert mesh is not None
    try:
        return read_mesh(mesh, needs)
    finally:
        obj.to_mesh_clear()


def _is_singular(matrix: Float64Array) -> bool:
    """Without an inverse, or with one that single precision cannot hold."""
    if not np.isfinite(matrix).all():
        return True
    stretches = np.linalg.svd(matrix[:3, :3], compute_uv=False)
    return bool(stretches[-1] <= SMALLEST_STRETCH * stretches[0])
