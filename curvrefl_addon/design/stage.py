# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a design needs of the open scene: mirrors, surfaces, an eye, and whatever rays meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from ..errors import InputError
from ..options import marked_mirrors
from ..scene.arrays import Float64Array, MeshArrays, SceneArrays
from ..scene.camera.view import View
from ..scene.changes import Changes
from ..scene.extract import SceneReader
from ..scene.meshes.meshes import MeshNeeds, mirrored, read_mesh
from ..scene.opened.blend_file import find_camera, find_reflectors, view_of_camera
from ..scene.opened.render_depsgraph import with_render_depsgraph


@dataclass(frozen=True, slots=True)
class ChosenSurface:
    """A surface that something is put on."""

    name: str
    object_id: int
    mesh: MeshArrays
    """With the chosen UV map, where one is wanted"""
    matrices: tuple[Float64Array, ...]
    """(4, 4) object to world, of each place where it stands"""

    def chart_places(self) -> Float64Array:
        """(corners, 2) of the UV map."""
        assert self.mesh.corner_uv is not None, "a UV map was asked for"
        return self.mesh.corner_uv.astype(np.float64)


@dataclass(frozen=True, slots=True)
class Stage:
    """A state of the scene, and who is looking."""

    scene: SceneArrays
    view: View
    mirrors: dict[int, str]
    """By object_id the names of the mirrors that were chosen"""
    surfaces: tuple[ChosenSurface, ...]
    warnings: tuple[str, ...]
    """What is not as it would be drawn, one sentence each"""

    @property
    def middle(self) -> Float64Array:
        """(3,) of the chosen mirrors, world space."""
        places = [_middle(self.scene, index) for index in self._of_mirrors()]
        return np.mean(places, axis=0) if places else np.zeros(3)

    def _of_mirrors(self) -> list[int]:
        return [index for index, item in enumerate(self.scene.instances) if item.object_id in self.mirrors]

    @property
    def mirror_names(self) -> str:
        """As they stand in a sentence."""
        return quoted(list(self.mirrors.values()))


def quoted(names: Sequence[str]) -> str:
    """Names as they stand in a sentence."""
    marked = [f'"{name}"' for name in names]
    return marked[0] if len(marked) == 1 else f"{', '.join(marked[:-1])} and {marked[-1]}"


def read_stage(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    mirrors: Sequence[str],
    surfaces: Sequence[str],
    camera: str | None,
    size: tuple[int, int],
    uv_map: str | None = None,
) -> Stage:
    """The scene as it renders, seen by a camera (the scene's where it is None) in a picture of `size` pixels.

    `uv_map`: of the surfaces, "" for the one that is active for rendering, None where none is needed. Other mirrors
    that are marked reflect, too. Raises InputError for what the user can put right: names, a surface that is a mirror,
    that is hidden or has no UV map.
    """
    chosen, placed = _chosen(scene, mirrors, surfaces)
    seen_by = find_camera(scene, camera)

    def read(depsgraph: bpy.types.Depsgraph) -> Stage:
        return _read(depsgraph, scene, chosen, placed, view_of_camera(scene, seen_by, *size, depsgraph), uv_map)

    return with_render_depsgraph(scene, view_layer, read, *size, seen_by)


def read_viewed_stage(
    depsgraph: bpy.types.Depsgraph,
    scene: bpy.types.Scene,
    mirrors: Sequence[str],
    surfaces: Sequence[str],
    view: View,
    uv_map: str | None = None,
) -> Stage:
    """The same as a viewport shows it, seen by its own eye."""
    chosen, placed = _chosen(scene, mirrors, surfaces)
    return _read(depsgraph, scene, chosen, placed, view, uv_map)


def _chosen(
    scene: bpy.types.Scene, mirrors: Sequence[str], surfaces: Sequence[str]
) -> tuple[list[bpy.types.Object], list[bpy.types.Object]]:
    if not mirrors:
        raise InputError("No mirror is chosen: name one, or mark one as a mirror.")
    chosen = find_reflectors(scene, mirrors)
    placed = find_reflectors(scene, surfaces) if surfaces else []
    for item in placed:
        if item in chosen:
            raise InputError(f'"{item.name}" is the mirror: choose another surface for the picture.')
        if item.type != "MESH":
            raise InputError(f'"{item.name}" is not a mesh: convert it to one, or choose another surface.')
    return chosen, placed


def _read(
    depsgraph: bpy.types.Depsgraph,
    scene: bpy.types.Scene,
    mirrors: list[bpy.types.Object],
    surfaces: list[bpy.types.Object],
    view: View,
    uv_map: str | None,
) -> Stage:
    others = [item for item in _shown_mirrors(depsgraph, scene) if item not in mirrors and item not in surfaces]
    reader = SceneReader()
    arrays = reader.read(depsgraph, scene, [*mirrors, *others], Changes(everything=True))
    meshes = list(arrays.meshes)
    found = []
    for item in surfaces:
        evaluated = item.evaluated_get(depsgraph)
        data = evaluated.data
        assert isinstance(data, bpy.types.Mesh)
        if uv_map is not None and not len(data.uv_layers):
            raise InputError(f'"{item.name}" has no UV map: unwrap it, so that the picture has a place on its image.')
        if uv_map and uv_map not in data.uv_layers:
            raise InputError(f'"{item.name}" has no UV map "{uv_map}": choose one that it has.')
        mesh = read_mesh(data, MeshNeeds(uv_map)).mesh
        # (Hair on it has its own numbers.)
        instances = [
            instance
            for instance in arrays.instances
            if reader.uid_of(instance.object_id) == item.session_uid
            and len(arrays.meshes[instance.mesh].triangles) == len(mesh.triangles)
        ]
        if not instances or not len(mesh.triangles):
            raise InputError(f'"{item.name}" is hidden or has no faces: show it, or choose another surface.')
        for instance in instances:
            is_mirrored = np.linalg.det(instance.matrix[:3, :3]) < 0.0
            meshes[instance.mesh] = mirrored(mesh) if is_mirrored else mesh
        places = tuple(instance.matrix for instance in instances)
        found.append(ChosenSurface(item.name, instances[0].object_id, mesh, places))
    names = dict(zip(arrays.reflectors, [item.name for item in mirrors], strict=False))
    arrays = replace(arrays, meshes=tuple(meshes))
    return Stage(arrays, view, names, tuple(found), tuple(_left_out(arrays)))


def _shown_mirrors(depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Those that are marked, where the extension is there, and that the depsgraph shows."""
    if not hasattr(bpy.types.Object, "curvrefl"):
        return []
    instances: Any = depsgraph.object_instances
    shown = {item.object.original.session_uid for item in instances}
    return [item for item in marked_mirrors(scene) if item.session_uid in shown]


def _left_out(scene: SceneArrays) -> list[str]:
    """What mirrors show otherwise than these rays."""
    found = []
    for item in scene.instances:
        if item.object_id not in scene.reflectors:
            continue
        materials = [scene.materials[index] for index in item.materials]
        if any(material.varies("normal") for material in materials):
            found.append(f'The bumps of "{item.object_name}" are left out: its picture is that of the smooth surface.')
        if any(material.may_be("roughness") for material in materials):
            found.append(f'"{item.object_name}" is rough: it shows the picture blurred.')
    return list(dict.fromkeys(found))


def _middle(scene: SceneArrays, index: int) -> Float64Array:
    instance = scene.instances[index]
    positions = scene.meshes[instance.mesh].positions.astype(np.float64)
    middle = 0.5 * (positions.min(axis=0) + positions.max(axis=0))
    return np.asarray(instance.matrix[:3, :3] @ middle + instance.matrix[:3, 3], np.float64)
