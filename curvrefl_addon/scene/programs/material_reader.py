# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of the scene: their node trees as constants and programs, with a remark for what is not drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..arrays import EVERY_SET, MaterialArrays
from ..finite import usable_material
from ..materials.color_spaces import luminance_weights
from ..materials.node_links import Source, output_source
from ..remarks import Remark
from .builder import Builder, Handler, Images
from .looks import OUT_OF_DATE, look_of
from .nodes.values.bumps import displacement_as_bump
from .program import Program
from .registry import HANDLERS
from .shaders.closure import BLACK, Closure, clear, matt
from .shaders.made_material import made_material
from .shaders.surfaces import surface_of
from .shaders.volumes import read_absorption

EMPTY_SLOT = MaterialArrays("default", base_color=(0.8, 0.8, 0.8), roughness=1.0, specular_level=0.0)
"""What Cycles draws without a material: a diffuse gray"""

type Copy = tuple[int, int, int, int]
"""Of the material at an index: the light set of its objects, bits of those that it shines on, and of shadow sets"""


@dataclass(frozen=True, slots=True)
class ReadMaterial:
    """A material of the scene."""

    index: int
    """Into `MaterialReader.materials`"""
    remarks: tuple[Remark, ...] = ()
    """What is not drawn as it is"""
    scenery_remarks: tuple[Remark, ...] = ()
    """What is not where it is neither a mirror nor seen through"""
    is_hidden: bool = False
    """It has no surface: a volume, or full transparency"""
    is_seen_through: bool = False
    objects: frozenset[int] = frozenset()
    """Objects (session_uid) whose place it knows"""

    def remarks_as(self, is_mirror: bool) -> tuple[Remark, ...]:
        """All remarks where it is a mirror's or scenery's."""
        return self.remarks + (() if is_mirror or self.is_seen_through else self.scenery_remarks)


class MaterialReader:
    """Reads each material once, and again after `forget`."""

    def __init__(self, images: Images, handlers: Mapping[str, Handler] = HANDLERS) -> None:
        self.materials: list[MaterialArrays] = [EMPTY_SLOT]
        """A material keeps its place in it"""
        self.reads = 0
        """How many materials have been read"""
        self._images = images
        self._handlers = handlers
        self._read: dict[int, ReadMaterial] = {}
        self._places: dict[int | MaterialArrays | Copy, int] = {}
        self._copies: dict[Copy, tuple[MaterialArrays, int]] = {}
        """What each was made of, and its place"""
        self._used_copies: set[Copy] = set()

    def read(self, material: bpy.types.Material | None) -> ReadMaterial:
        """The material's place in the list; None, an empty slot, is at index 0."""
        if material is None:
            return ReadMaterial(0)
        key = material.original.session_uid
        if key not in self._read:
            self.reads += 1
            self._read[key] = self._read_anew(material, key)
        return self._read[key]

    def plain(self, arrays: MaterialArrays) -> ReadMaterial:
        """Place of a material without a program that is not the scene's."""
        return ReadMaterial(self._place(arrays, arrays))

    def linked(self, index: int, light_set: int, shines_on: int, blocked_by: int) -> int:
        """Place of the material at `index` as objects of a light set have it; the others are as `MaterialArrays`'."""
        base = self.materials[index]
        if not base.may_be("emission"):
            shines_on = blocked_by = EVERY_SET
        if light_set == 0 and shines_on == blocked_by == EVERY_SET:
            return index
        copy = (index, light_set, shines_on, blocked_by)
        self._used_copies.add(copy)
        if copy not in self._copies or self._copies[copy][0] is not base:
            place = self._place(copy, replace(base, light_set=light_set, shines_on=shines_on, blocked_by=blocked_by))
            self._copies[copy] = (base, place)
        return self._copies[copy][1]

    def drop_unused_copies(self) -> None:
        """What `linked` has not asked for since the last call is empty."""
        for copy in self._copies.keys() - self._used_copies:
            self.materials[self._copies.pop(copy)[1]] = EMPTY_SLOT
        self._used_copies = set()

    def forget(self, materials: set[int]) -> None:
        """These materials (session_uid) changed."""
        for key in materials:
            self._read.pop(key, None)

    def that_know(self, objects: set[int]) -> set[int]:
        """Materials (session_uid) that know the place of one of these objects."""
        return {key for key, found in self._read.items() if not found.objects.isdisjoint(objects)}

    def forget_all(self) -> None:
        """Any may have changed, or the images they show."""
        self._read.clear()
        # (Those that no object shows any more are not read again, and may not ask for images that are gone.)
        self.materials = [replace(arrays, program=None, ranges=()) for arrays in self.materials]

    def _read_anew(self, material: bpy.types.Material, key: int) -> ReadMaterial:
        notes: list[str] = []
        objects: set[int] = set()
        arrays, is_hidden = self._arrays(material, notes, objects)
        arrays = usable_material(arrays, notes)
        if arrays.program is not None:
            arrays = replace(arrays, program=_usable(arrays.program, notes))
        if arrays.range_of("alpha")[0] < 1.0 and not is_hidden and not material.use_transparent_shadow:
            notes.append("Shadows {of} let light through, though its settings turn that off.")
        always, on_scenery = (
            tuple(Remark(cause, "material", material.name) for cause in dict.fromkeys(causes))
            for causes in (notes, _left_out_of_scenery(arrays))
        )
        index, is_seen_through = self._place(key, arrays), arrays.is_seen_through
        return ReadMaterial(index, always, on_scenery, is_hidden, is_seen_through, frozenset(objects))

    def _arrays(self, material: bpy.types.Material, notes: list[str], objects: set[int]) -> tuple[MaterialArrays, bool]:
        """The material, and whether it has no surface; the lists get causes of remarks, `objects` those whose place it
        knows (session_uid)."""
        tree = material.node_tree
        if tree is None:
            red, green, blue, _ = material.diffuse_color
            plain = MaterialArrays(
                material.name, base_color=(red, green, blue), metallic=material.metallic, roughness=material.roughness
            )
            return plain, False
        b = self._builder(notes)
        shown = tree
        if (look := look_of(material)) is not None:
            if look.is_current and look.material.node_tree is not None:
                shown = look.material.node_tree
            else:
                notes.append(OUT_OF_DATE)
        is_bent = self._displaced(b, shown, material)
        surface = self._surface(b, shown)
        arrays = made_material(b, surface, material.name, is_bent)
        objects |= b.objects
        volume = output_source(tree, "Volume")
        if volume is not None:
            arrays = self._with_volume(arrays, volume, notes, surface)
        return arrays, surface.is_hidden

    def _builder(self, notes: list[str]) -> Builder:
        return Builder(self._handlers, self._images, notes, luminance_weights().tolist())

    @staticmethod
    def _displaced(b: Builder, tree: bpy.types.NodeTree, material: bpy.types.Material) -> bool:
        """Bend the normals of what the tree displaces; whether it does."""
        source = output_source(tree, "Displacement")
        if source is None:
            return False
        if material.displacement_method != "BUMP":
            # (Modifiers displace meshes, and these are drawn so.)
            b.note("Displacement {of} is drawn as bumps: the mesh stays where it is.")
        return displacement_as_bump(b, source) is not None

    @staticmethod
    def _surface(b: Builder, tree: bpy.types.NodeTree) -> Closure:
        source = output_source(tree, "Surface")
        if source is None:
            # Without a volume Cycles shows no light at all.
            return matt(BLACK) if output_source(tree, "Volume") is None else clear()
        return surface_of(b, source)

    def _with_volume(
        self, arrays: MaterialArrays, volume: Source, notes: list[str], surface: Closure
    ) -> MaterialArrays:
        absorption = None if surface.is_hidden else read_absorption(self._builder(notes), volume)
        # (What goes straight through surfaces does not know what it is inside of.)
        is_lost = arrays.range_of("transmission")[1] == 0.0 and arrays.range_of("alpha")[0] < 1.0
        if absorption is None or (any(absorption) and is_lost):
            notes.append("Volumes {of} are not shown.")
            return arrays
        return replace(arrays, absorption=absorption)

    def _place(self, key: int | MaterialArrays | Copy, arrays: MaterialArrays) -> int:
        if key in self._places:
            self.materials[self._places[key]] = arrays
        else:
            self._places[key] = len(self.materials)
            self.materials.append(arrays)
        return self._places[key]


def _left_out_of_scenery(arrays: MaterialArrays) -> list[str]:
    """Causes of remarks: what only paths know that go on from a surface."""
    found = []
    reflects = arrays.may_be("metallic") or arrays.glossy_only or arrays.may_be("specular_level")
    if reflects and arrays.range_of("anisotropy") != (0.0, 0.0):
        found.append("Anisotropy {of} is left out where it is no mirror.")
    if arrays.may_be("film_thickness"):
        found.append("The thin film {of} is left out where it is no mirror.")
    return found


def _usable(program: Program, notes: list[str]) -> Program:
    """With zeros for parameters that single precision cannot compute with."""
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(program.records) <= 1e30)
    if not bad.any():
        return program
    notes.append("Numbers in the nodes {of} that are not usable are taken for 0.")
    return replace(program, records=np.where(bad, np.float32(0.0), program.records))
