# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated Blender scene to frozen arrays: the only place that walks the depsgraph.

A `SceneReader` reads a scene again and again and does only what the changes ask for: what did not change is the same
object as in the last `SceneArrays`, and the renderer goes by that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import bpy
import numpy as np

from ..pacing.reading_time import ReadingTime
from .arrays import MaterialArrays, SceneArrays, WorldArrays
from .changes import Changes
from .finite import problem_of_place
from .instances.alone import objects_alone
from .instances.linking import LightLinks
from .instances.parts import parts_of, uid_of_part
from .instances.values import comparable, values_of_instance
from .materials.color_spaces import working_space
from .materials.images import ImageReader
from .meshes.mesh_store import MeshStore
from .programs.images import ProgramImages
from .programs.material_reader import MaterialReader, ReadMaterial
from .reads import (
    Bounces,
    PlainObject,
    ShownInstance,
    bounces_of,
    has_links,
    listing_of,
    needs_of,
    oddities,
    only_of,
    placed_instance,
    require_reflectors,
    shown_light,
    slot_materials,
    uid_of_block,
    unplaced,
    with_kept,
)
from .remarks import Remark, of_kind, sentences
from .strands.particles import HairSystem
from .strands.reading import has_no_faces
from .unseen import of_view_layer, unseen
from .visibility import rays_of
from .world import read_world

UNREAD = -1
"""In place of a world's `session_uid`"""


def extract_scene(
    depsgraph: bpy.types.Depsgraph,
    scene: bpy.types.Scene,
    reflectors: Sequence[bpy.types.Object],
) -> SceneArrays:
    """Read everything that can be seen or that lights what is seen, at the depsgraph's frame.

    What is there, and how fine, is the depsgraph's: a viewport's or a render's. Instances of one mesh share its
    arrays. Raises InputError where a reflector cannot be one: hidden, no faces, coordinates that are not finite, a
    singular matrix. Elsewhere such parts are left out with a warning.
    """
    return SceneReader().read(depsgraph, scene, reflectors, Changes(everything=True))


class SceneReader:
    """Reads one scene, one view layer."""

    def __init__(self) -> None:
        self.reads_uv = False
        """All UV maps that renders use are read, not only those that something is drawn by"""
        self.counters = {"walks": 0, "objects read": 0, "worlds read": 0}
        self._images = ImageReader()
        self._program_images = ProgramImages()
        self._materials = MaterialReader(self._program_images)
        self._meshes = MeshStore()
        self._links = LightLinks()
        self._shown: dict[tuple[int, int, int], ShownInstance] = {}
        """By (object, what instances it or 0, which of these)"""
        self._instancers: set[int] = set()
        self._ids: dict[int, int] = {}
        self._world = WorldArrays()
        self._world_warnings: list[Remark] = []
        self._world_images = ProgramImages()
        self._unseen: list[Remark | str] = []
        self._world_uid = 0
        """`session_uid` of the world last read, 0 for none: a scene whose world is taken away lists only itself"""
        self._listing: tuple[Any, ...] = ()
        self._overrides: dict[int, MaterialArrays] = {}
        self._mapped: frozenset[int] = frozenset()
        """Reflectors: their UV map is read also where no material needs it, for methods that search in it"""
        self._space = working_space()
        """Of the colors in the last scene"""
        self._last: SceneArrays | None = None
        self._time = ReadingTime()

    @property
    def unread(self) -> int:
        """Objects that the last state lacks, as there was no time for them: the next `read` goes on with them."""
        return self._time.unread

    @property
    def sequences(self) -> set[int]:
        """Images (session_uid) that another frame may change."""
        return self._images.sequences | self._program_images.sequences | self._world_images.sequences

    @property
    def reads(self) -> dict[str, int]:
        """How often what was read."""
        return {
            **self.counters,
            "meshes read": self._meshes.reads,
            "materials read": self._materials.reads,
            "images read": self._images.reads + self._program_images.reads,
        }

    def read(
        self,
        depsgraph: bpy.types.Depsgraph,
        scene: bpy.types.Scene,
        reflectors: Sequence[bpy.types.Object],
        changes: Changes,
        overrides: Mapping[int, MaterialArrays] | None = None,
        seconds: float | None = None,
    ) -> SceneArrays:
        """The scene's present state, of which only the `changes` are looked at; errors as in `extract_scene`.

        `overrides`: materials in place of all of an object's own, by its session_uid. With `seconds` the reflectors are
        read, and of what has not been read before about as much as that takes, one object at least; without the world
        as long as others are `unread`.
        """
        left, self._time = self.unread, ReadingTime.of(seconds)
        view_layer = depsgraph.view_layer
        assert view_layer is not None
        if dict(overrides or {}) != self._overrides:
            self._overrides = dict(overrides or {})
            changes.instances = True
        mapped = frozenset(obj.original.session_uid for obj in reflectors)
        if mapped != self._mapped:
            self._mapped = mapped
            changes.instances = True
        if working_space() != self._space:
            self._space = working_space()
            changes.everything = True
        if changes.everything:
            self._images.forget_all()
            self._program_images.forget_all()
        if self._last is None or changes.everything or changes.frame:
            self._meshes.forget_all()
            changes.all_materials = changes.instances = True
        if changes.images:
            self._images.forget(changes.images)
            self._program_images.forget(changes.images)
            changes.all_materials = True
        if changes.all_materials:
            self._materials.forget_all()
            self._program_images.restart()
            # (Worlds show the same images.)
            changes.world = True
        changes.materials |= self._materials.that_know(changes.objects)
        self._materials.forget(changes.materials)
        meshes = self._meshes.forget(changes.geometry)
        walk = left > 0 or changes.instances or changes.all_materials or bool(changes.materials)
        if not walk and changes.listing:
            listing = listing_of(depsgraph, view_layer)
            walk = listing != self._listing
        objects = None if walk else objects_alone(changes, self._shown, self._instancers, meshes)
        if objects is None:
            self._listing = listing_of(depsgraph, view_layer)
            self._walk(depsgraph, view_layer)
        else:
            for uid, obj in objects:
                evaluated = obj.evaluated_get(depsgraph)
                placed = PlainObject(evaluated, evaluated.matrix_world)
                self._shown[uid, 0, 0] = self._read_instance(placed, uid, 0, view_layer, self._shown[uid, 0, 0])
            self._meshes.settle()
        world = (view_layer.world_override or scene.world) if view_layer.use_sky else None
        if self.unread:
            self._world_uid = UNREAD
        elif changes.world or uid_of_block(world) != self._world_uid:
            self._read_world(world)
        self._last = self._arrays(reflectors, bounces_of(scene))
        return self._last

    def only(self, scene: SceneArrays, objects: set[int]) -> SceneArrays:
        """What these objects (session_uid) show of the scene last read, themselves or by instancing."""
        return only_of(scene, [item for key, item in self._shown.items() if (key[1] or uid_of_part(key[0])) in objects])

    def uid_of(self, object_id: int) -> int | None:
        """The `session_uid` of an object by its number in the scenes that were read; None where there is none."""
        return next((uid_of_part(uid) for uid, number in self._ids.items() if number == object_id), None)

    def _id(self, uid: int) -> int:
        """The number of an object, from 1; it stays the same in all that is read."""
        return self._ids.setdefault(uid, len(self._ids) + 1)

    def _walk(self, depsgraph: bpy.types.Depsgraph, view_layer: bpy.types.ViewLayer) -> None:
        self.counters["walks"] += 1
        self._meshes.begin()
        before, self._shown = self._shown, {}
        self._instancers = set()
        self._unseen = list(of_view_layer(view_layer))
        counts: dict[tuple[int, int], int] = {}
        is_render = depsgraph.mode == "RENDER"
        for instance in depsgraph.object_instances:
            self._unseen += unseen(instance, view_layer)
            parent = instance.parent.original.session_uid if instance.is_instance else 0
            for uid, hair in parts_of(instance, view_layer, is_render):
                if parent or hair is not None:
                    # (What moves it moves others.)
                    self._instancers.add(parent or uid_of_part(uid))
                number = counts.get((uid, parent), 0)
                counts[uid, parent] = number + 1
                key = (uid, parent, number)
                self._shown[key] = self._read_instance(instance, uid, parent, view_layer, before.get(key), hair)
        self._meshes.end()

    def _read_instance(
        self,
        instance: Any,
        uid: int,
        parent: int,
        view_layer: bpy.types.ViewLayer,
        before: ShownInstance | None,
        hair: HairSystem | None = None,
    ) -> ShownInstance:
        self.counters["objects read"] += 1
        if instance.object.type == "LIGHT" and hair is None:
            return shown_light(instance, view_layer, before)
        return self._read_surface(instance, uid, parent, view_layer, before, hair)

    def _read_surface(
        self,
        instance: Any,
        uid: int,
        parent: int,
        view_layer: bpy.types.ViewLayer,
        before: ShownInstance | None,
        hair: HairSystem | None,
    ) -> ShownInstance:
        obj = instance.object
        rays = rays_of(instance, view_layer)
        if hair is None and has_no_faces(obj.data):
            return ShownInstance(has_faces=False)
        name = obj.original.name
        matrix = np.array(instance.matrix_world, dtype=np.float64)
        if (nowhere := unplaced(name, matrix, rays.any)) is not None:
            return nowhere
        is_known = uid in self._mapped or (before is not None and before.instance is not None)
        if not (is_known or self._time.is_left_for_another()):
            return ShownInstance()
        slots = self._slots(obj, uid, view_layer.material_override)
        if hair is not None:
            slots = [slots[min(hair.slot, len(slots) - 1)]]
        is_mirror = uid in self._mapped
        warnings: list[Remark | str] = [remark for slot in slots for remark in slot.remarks_as(is_mirror)]
        found = (self._materials.materials[slot.index].program for slot in slots)
        programs = tuple(program for program in found if program is not None)
        needs = needs_of(obj, slots, programs, is_mirror or self.reads_uv, warnings)
        is_mirrored = instance.matrix_world.determinant() < 0.0
        stored = self._meshes.read(hair or obj, parent or uid_of_part(uid), needs, is_mirrored)
        warnings += stored.remarks
        error = "" if isinstance(obj.data, bpy.types.Mesh) else f'"{name}" is no surface: choose another reflector.'
        if stored.dropped:
            error = f'"{name}" has vertices at no finite place or too far out: repair its mesh or choose another.'
        if problem := problem_of_place(matrix, stored.reach):
            return ShownInstance(
                warnings=(*warnings, f'"{name}" {problem} and is left out.'),
                error=error or f'"{name}" {problem}: clear its scale, or choose another.',
            )
        if len(self._meshes.meshes[stored.number].triangles) == 0:
            if any(needs.hidden_slots):
                error = f'"{name}" has no surface that could reflect: choose another reflector or give it a material.'
            return ShownInstance(warnings=tuple(warnings), has_faces=False, error=error)
        warnings += oddities(obj, hair is not None)
        materials = tuple(slot.index for slot in slots)
        asked = values_of_instance(instance, programs, view_layer)
        made_of = (name, stored.number, matrix.tobytes(), materials, rays, comparable(asked))
        made = before.instance if before is not None and before.made_of == made_of else None
        if made is None:
            made = placed_instance(name, self._id(uid), stored.number, matrix, materials, rays, asked)
        return ShownInstance(
            made, None, tuple(warnings), True, made_of, error, rays.any, name, materials, has_links(obj)
        )

    def _slots(self, obj: bpy.types.Object, uid: int, override: bpy.types.Material | None) -> list[ReadMaterial]:
        if uid in self._overrides:
            return [self._materials.plain(self._overrides[uid])]
        return [self._materials.read(material) for material in slot_materials(obj, override)]

    def _read_world(self, world: bpy.types.World | None) -> None:
        self.counters["worlds read"] += 1
        self._world_uid, self._world_warnings, self._world_images = uid_of_block(world), [], ProgramImages()
        self._world = read_world(world, self._images, self._world_warnings, self._world_images)

    @property
    def material_remarks(self) -> tuple[Remark, ...]:
        """What is not drawn of materials, each once."""
        return of_kind("material", (warning for item in self._shown.values() for warning in item.warnings))

    def _arrays(self, reflectors: Sequence[bpy.types.Object], bounces: Bounces) -> SceneArrays:
        chosen = {obj.original.session_uid: obj.name for obj in reflectors}
        require_reflectors(self._shown, chosen, self._id)
        self._links.follow(self._shown, self._materials)
        instances = [
            item.instance
            for key, item in self._shown.items()
            if item.instance is not None and (item.is_visible or key[0] in chosen)
        ]
        warnings = [warning for item in self._shown.values() if item.warnings for warning in item.warnings]
        of_images = self._images.remarks + self._program_images.remarks
        arrays = SceneArrays(
            meshes=tuple(self._meshes.meshes),
            instances=tuple(instances),
            materials=tuple(self._materials.materials),
            images=self._program_images.sources,
            lights=tuple([item.light for item in self._shown.values() if item.light is not None]),
            world=self._world,
            reflectors=tuple(self._ids[uid] for uid in chosen),
            warnings=sentences([*warnings, *self._unseen, *of_images, *self._world_warnings, *self._links.remarks]),
            most_bounces=bounces.most,
            mirror_bounces=bounces.mirror,
            transmission_bounces=bounces.transmission,
            transparent_bounces=bounces.transparent,
            diffuse_bounces=bounces.diffuse,
            indirect_clamp=bounces.clamp,
            caustics=bounces.caustics,
        )
        return arrays if self._last is None else with_kept(arrays, self._last)
