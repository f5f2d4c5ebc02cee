# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene reader remembers of what it has read, and small questions to Blender."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from operator import is_
from typing import Any

import bpy
import numpy as np

from ..errors import InputError
from .arrays import UNLIMITED_BOUNCES, Float64Array, InstanceArrays, LightArrays, SceneArrays
from .finite import problem_of_place
from .lights import read_light
from .meshes.meshes import MeshNeeds
from .programs.looks import NO_UV_MAP, UV_MAP
from .programs.material_reader import ReadMaterial
from .programs.program import UV, Attribute, Program
from .remarks import Remark
from .visibility import RayVisibility, rays_of

SMALLEST_STRETCH = 1e-6
"""Of a matrix: least over greatest stretch, under which it counts as singular in single precision"""


SMALLEST_SIZE = 1e-12
"""Greatest stretch under which nothing is left of a mesh"""
SURELY_REGULAR = 1e-4
"""Determinant over the cube of the matrix's norm, above which it cannot be singular; half of single precision"""


# fmt: off
DEFORMING = frozenset((
    "ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "NODES", "SHRINKWRAP",
    "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE_DEFORM", "WARP", "WAVE",
))
# fmt: on
"""Modifiers that move vertices and leave their generated coordinates where they were"""


@dataclass(frozen=True, slots=True)
class PlainObject:
    """An object as an instance of itself, as `DepsgraphObjectInstance`."""

    object: Any
    matrix_world: Any
    show_self: bool = True
    is_instance: bool = False
    parent: Any = None
    random_id: int = 0


@dataclass(slots=True)
class ShownInstance:
    """What one object of the scene, or one that instances it, shows: in the order of the depsgraph."""

    instance: InstanceArrays | None = None
    light: LightArrays | None = None
    warnings: tuple[Remark | str, ...] = ()
    has_faces: bool = True
    made_of: tuple[Any, ...] = ()
    """All that `instance` is made of"""
    error: str = ""
    """Why it cannot be a reflector"""
    is_visible: bool = False
    """Anything can see it"""
    name: str = ""
    """Of the object"""
    materials: tuple[int, ...] = ()
    """Of the instance, whatever light linking makes of them"""
    has_links: bool = False
    """The object has collections for its light (`instances/linking.py`)"""


def placed_instance(
    name: str,
    object_id: int,
    mesh: int,
    matrix: Float64Array,
    materials: tuple[int, ...],
    rays: RayVisibility,
    values: Mapping[str, Any],
) -> InstanceArrays:
    """Of an object that these rays see; `values`: what programs ask of it."""
    return InstanceArrays(
        object_name=name,
        object_id=object_id,
        mesh=mesh,
        matrix=matrix,
        materials=materials,
        visible_camera=rays.camera,
        visible_diffuse=rays.diffuse,
        visible_glossy=rays.glossy,
        visible_shadow=rays.shadow,
        visible_transmission=rays.transmission,
        holdout=rays.holdout,
        **values,
    )


def unplaced(name: str, matrix: Float64Array, is_seen: bool) -> ShownInstance | None:
    """What an object shows whose matrix (4, 4) puts it nowhere or makes it flat; None for any other."""
    if problem := problem_of_place(matrix, 0.0):
        remedy = "clear its location, rotation and scale"
    elif is_flat(matrix):
        problem, remedy = "is flattened by a zero or endless scale", "clear the scale"
    else:
        return None
    warnings = (f'"{name}" {problem} and is left out.',) if is_seen else ()
    return ShownInstance(warnings=warnings, error=f'"{name}" {problem}: {remedy}.')


def is_flat(matrix: Float64Array) -> bool:
    """Whether a matrix (4, 4) leaves no volume of what it places."""
    # A safe bound first, for scenes of thousands: least stretch >= |determinant| / greatest stretch squared.
    (a, b, c), (d, e, f), (g, h, i) = matrix[:3, :3].tolist()
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    squared = a * a + b * b + c * c + d * d + e * e + f * f + g * g + h * h + i * i
    is_surely_not = squared > 3.0 * SMALLEST_SIZE**2 and abs(determinant) > SURELY_REGULAR * squared**1.5
    return not is_surely_not and is_singular(matrix)


def object_of(uid: int, name: str) -> bpy.types.Object | None:
    """The object with this session_uid, probably the one with this name."""
    obj = bpy.data.objects.get(name)
    if obj is not None and obj.session_uid == uid:
        return obj
    return next((obj for obj in bpy.data.objects if obj.session_uid == uid), None)


@dataclass(frozen=True, slots=True)
class Bounces:
    """As `SceneArrays.mirror_bounces` and the like."""

    most: int = UNLIMITED_BOUNCES
    mirror: int = UNLIMITED_BOUNCES
    transmission: int = UNLIMITED_BOUNCES
    transparent: int = UNLIMITED_BOUNCES
    diffuse: int = 4
    """(What Cycles begins with, too)"""
    clamp: float = 0.0
    caustics: bool = True


def bounces_of(scene: bpy.types.Scene) -> Bounces:
    """How far Cycles follows rays in the scene's renders."""
    # Cycles is an add-on, and may be off.
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return Bounces()
    # (What light goes straight through does not count as a bounce there.)
    return Bounces(
        cycles.max_bounces,
        min(cycles.max_bounces, cycles.glossy_bounces),
        min(cycles.max_bounces, cycles.transmission_bounces),
        cycles.transparent_max_bounces,
        min(cycles.max_bounces, cycles.diffuse_bounces),
        cycles.sample_clamp_indirect,
        cycles.caustics_reflective,
    )


def uid_of_block(block: bpy.types.ID | None) -> int:
    """Its `session_uid`; 0 for none."""
    return 0 if block is None else block.original.session_uid


def listing_of(depsgraph: bpy.types.Depsgraph, view_layer: bpy.types.ViewLayer) -> tuple[Any, ...]:
    """Who is there, cheaply: the same before and after a selection, another one after hiding."""
    return (
        [(item.object.original.session_uid, item.show_self) for item in depsgraph.object_instances],
        list(layer_flags(view_layer.layer_collection)),
        uid_of_block(view_layer.material_override),
        view_layer.use_strand,
    )


def layer_flags(layer: bpy.types.LayerCollection) -> Iterable[tuple[bool, ...]]:
    yield layer.exclude, layer.holdout, layer.indirect_only, layer.hide_viewport, layer.collection.hide_render
    for child in layer.children:
        yield from layer_flags(child)


def slot_materials(obj: bpy.types.Object, override: bpy.types.Material | None) -> list[bpy.types.Material | None]:
    """What each slot shows; one empty slot where there are none."""
    data: Any = obj.data
    materials = list(data.materials)
    for index, slot in enumerate(obj.material_slots):
        if index >= len(materials):
            materials.append(slot.material)
        elif slot.link == "OBJECT":
            materials[index] = slot.material
    if override is not None:
        materials = [override] * len(materials) or [override]
    return materials or [None]


def oddities(obj: bpy.types.Object, is_hair: bool) -> list[str]:
    """What is not drawn of an object's own settings (or of its hair's), one sentence each."""
    name, last = obj.original.name, obj.original.modifiers[-1] if obj.original.modifiers else None
    found = []
    if not is_hair and isinstance(last, bpy.types.SubsurfModifier) and last.use_adaptive_subdivision:
        found.append(f'"{name}" is drawn as finely as its levels of subdivision say: adaptive ones are Cycles\' own.')
    if obj.original.is_shadow_catcher:
        found.append(f'Shadow catcher "{name}" is drawn as an ordinary object.')
    return found


def needs_of(
    obj: bpy.types.Object,
    slots: Sequence[ReadMaterial],
    programs: Sequence[Program],
    with_uv: bool,
    warnings: list[Remark | str],
) -> MeshNeeds:
    """What programs of its materials read, and `with_uv` the UV map that renders use."""
    # (Hair and points have none.)
    layers = obj.data.uv_layers if isinstance(obj.data, bpy.types.Mesh) else ()
    deforms = any(modifier.type in DEFORMING for modifier in obj.original.modifiers)
    if deforms and any("generated" in program.sampled for program in programs):
        warnings.append(
            Remark("Generated coordinates {of} are taken of its deformed shape, not of its own.", "object", obj.name)
        )
    hidden = tuple(slot.is_hidden for slot in slots)
    attributes = {attribute for program in programs for attribute in program.attributes}
    if Attribute(UV, UV_MAP) in attributes and UV_MAP not in (layer.name for layer in layers):
        warnings.append(Remark(NO_UV_MAP, "object", obj.name))
    return MeshNeeds(
        "" if with_uv and len(layers) else None,
        hidden if any(hidden) else (),
        tuple(sorted(attributes)),
    )


def has_links(obj: Any) -> bool:
    """Whether an object has collections of its own for its light."""
    linking = obj.original.light_linking
    return linking.receiver_collection is not None or linking.blocker_collection is not None


def is_same_light(one: LightArrays, other: LightArrays) -> bool:
    plain = [item.name for item in fields(LightArrays) if item.name != "matrix"]
    return np.array_equal(one.matrix, other.matrix) and all(getattr(one, n) == getattr(other, n) for n in plain)


def shown_light(instance: Any, view_layer: bpy.types.ViewLayer, before: ShownInstance | None) -> ShownInstance:
    """What a lamp shows, of a `DepsgraphObjectInstance`; the same light as `before` where it has not changed."""
    obj = instance.object
    warnings: list[Remark | str] = []
    matrix = np.array(instance.matrix_world, dtype=np.float64)
    light = read_light(obj, matrix, rays_of(instance, view_layer), warnings)
    if light is not None and before is not None and before.light is not None:
        # (What linking makes of it is found later.)
        known = before.light
        light = replace(light, lights_on=known.lights_on, blocked_by=known.blocked_by)
        light = known if is_same_light(light, known) else light
    return ShownInstance(light=light, warnings=tuple(warnings), name=obj.original.name, has_links=has_links(obj))


def with_kept(arrays: SceneArrays, last: SceneArrays) -> SceneArrays:
    """With the last state's tuples where all members are the same objects."""

    def kept[T](new: tuple[T, ...], old: tuple[T, ...]) -> tuple[T, ...]:
        return old if len(new) == len(old) and all(map(is_, new, old)) else new

    result = replace(
        arrays,
        meshes=kept(arrays.meshes, last.meshes),
        instances=kept(arrays.instances, last.instances),
        materials=kept(arrays.materials, last.materials),
        images=kept(arrays.images, last.images),
        lights=kept(arrays.lights, last.lights),
    )
    same = (
        result.meshes is last.meshes
        and result.instances is last.instances
        and result.materials is last.materials
        and result.images is last.images
        and result.lights is last.lights
        and result.world is last.world
        and result.reflectors == last.reflectors
        and result.most_bounces == last.most_bounces
        and result.mirror_bounces == last.mirror_bounces
        and result.transmission_bounces == last.transmission_bounces
        and result.transparent_bounces == last.transparent_bounces
        and result.diffuse_bounces == last.diffuse_bounces
        and result.indirect_clamp == last.indirect_clamp
        and result.caustics == last.caustics
        and result.warnings == last.warnings
    )
    return last if same else result


def only_of(scene: SceneArrays, shown: Sequence[ShownInstance]) -> SceneArrays:
    """Of a scene what these show alone."""
    kept, lights = {id(item.instance) for item in shown}, {id(item.light) for item in shown}
    instances = tuple(instance for instance in scene.instances if id(instance) in kept)
    ids = {instance.object_id for instance in instances}
    return replace(
        scene,
        instances=instances,
        lights=tuple(light for light in scene.lights if id(light) in lights),
        reflectors=tuple(number for number in scene.reflectors if number in ids),
    )


def is_singular(matrix: Float64Array) -> bool:
    """Without an inverse, or with one that single precision cannot hold."""
    if not np.isfinite(matrix).all():
        return True
    stretches = np.linalg.svd(matrix[:3, :3], compute_uv=False)
    return bool(stretches[-1] <= SMALLEST_STRETCH * stretches[0] or stretches[0] < SMALLEST_SIZE)


def require_reflectors(
    shown: Mapping[tuple[int, int, int], ShownInstance], chosen: Mapping[int, str], id_of: Callable[[int], int]
) -> None:
    """Raises InputError where a reflector cannot be one. `chosen`: names by session_uid."""
    found: dict[int, list[ShownInstance]] = {uid: [] for uid in chosen}
    for key in [key for key in shown if key[0] in found]:
        found[key[0]].append(shown[key])
    for uid, name in chosen.items():
        items = found[uid]
        for item in items:
            if item.error:
                raise InputError(item.error, id_of(uid))
        if not any(item.instance for item in items):
            problem = "is hidden or not in the scene: show it or choose another reflector."
            if items:
                problem = "has no faces: choose a reflector with a surface."
            raise InputError(f'"{name}" {problem}', id_of(uid))
