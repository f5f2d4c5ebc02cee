# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: the nodes that the renderer can draw, the nearest constant and a warning for the rest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..arrays import ImageArrays, MaterialArrays, ReliefArrays, ScalarsArrays
from ..finite import usable_image, usable_material
from ..meshes.attributes import VertexColors
from ..meshes.meshes import GENERATED, OBJECT
from ..remarks import Remark
from .images import ImageReader
from .node_links import output_source
from .reliefs import Relief
from .shaders.scalars import packed_scalars
from .shaders.shader_reader import ShaderReader
from .shaders.surface import BLACK, NOTHING, Notes, Surface, matt
from .shaders.volumes import read_absorption
from .surface_textures import SurfaceTexture, SurfaceTextureReader

EMPTY_SLOT = MaterialArrays("default", base_color=(0.8, 0.8, 0.8), roughness=1.0, specular_level=0.0)
"""What Cycles draws without a material: a diffuse gray"""


@dataclass(frozen=True, slots=True)
class ReadMaterial:
    """A material of the scene."""

    index: int
    """Into `MaterialReader.materials`"""
    uv_maps: tuple[str, ...] = ()
    """All that its textures are on, as `MeshNeeds.uv_map`: that of the color first"""
    colors: VertexColors | None = None
    """What it reads of the meshes it is on"""
    remarks: tuple[Remark, ...] = ()
    """What is not drawn as it is"""
    scenery_remarks: tuple[Remark, ...] = ()
    """What is not where it is shaded with constants: neither a mirror nor seen through"""
    path_remarks: tuple[Remark, ...] = ()
    """What is not where it is one of these"""
    has_relief: bool = False
    """Bumps, that only a mirror shows"""
    is_hidden: bool = False
    """It has no surface: a volume, or full transparency"""
    is_seen_through: bool = False
    lacks_scalars: bool = False
    """Its scalars have textures, of which only the means were read"""

    def remarks_as(self, is_mirror: bool) -> tuple[Remark, ...]:
        """All remarks where it is a mirror's or scenery's."""
        return self.remarks + (self.path_remarks if is_mirror or self.is_seen_through else self.scenery_remarks)


class MaterialReader:
    """Reads each material once, and again after `forget`."""

    def __init__(self, images: ImageReader) -> None:
        self.materials: list[MaterialArrays] = [EMPTY_SLOT]
        """A material keeps its place in it"""
        self.images: list[ImageArrays] = []
        self.reads = 0
        """How many materials have been read"""
        self._textures = SurfaceTextureReader(images)
        self._read: dict[int, ReadMaterial] = {}
        self._places: dict[int | MaterialArrays, int] = {}

    def read(self, material: bpy.types.Material | None, is_mirror: bool = False) -> ReadMaterial:
        """The material's place in the list; None, an empty slot, is at index 0.

        `is_mirror`: an image of its scalars is needed, which others need only where they are seen through.
        """
        if material is None:
            return ReadMaterial(0)
        key = material.original.session_uid
        known = self._read.get(key)
        if known is None or (is_mirror and known.lacks_scalars):
            self.reads += 1
            self._read[key] = self._read_anew(material, key, is_mirror)
        return self._read[key]

    def _read_anew(self, material: bpy.types.Material, key: int, is_fine: bool) -> ReadMaterial:
        notes = Notes()
        found, arrays = self._found(material, notes, is_fine)
        if found.lacks_scalars and found.is_seen_through:
            notes = Notes()
            found, arrays = self._found(material, notes, is_fine=True)
        always, on_scenery, on_paths = (
            tuple(Remark(cause, "material", material.name) for cause in dict.fromkeys(causes))
            for causes in (notes.always, notes.on_scenery, notes.on_paths)
        )
        return replace(
            found,
            index=self._place(key, arrays),
            remarks=always,
            scenery_remarks=on_scenery,
            path_remarks=on_paths,
        )

    def plain(self, arrays: MaterialArrays) -> ReadMaterial:
        """Place of a material without textures that is not the scene's."""
        return ReadMaterial(self._place(arrays, arrays))

    def forget(self, materials: set[int]) -> None:
        """These materials (session_uid) changed."""
        for key in materials:
            self._read.pop(key, None)

    def forget_all(self) -> None:
        """Any may have changed, or the images they show."""
        self._read.clear()
        self._textures.forget()
        self.images.clear()

    def _place(self, key: int | MaterialArrays, arrays: MaterialArrays) -> int:
        if key in self._places:
            self.materials[self._places[key]] = arrays
        else:
            self._places[key] = len(self.materials)
            self.materials.append(arrays)
        return self._places[key]

    def _found(self, material: bpy.types.Material, notes: Notes, is_fine: bool) -> tuple[ReadMaterial, MaterialArrays]:
        """All but the index and the remarks, for which `notes` gets the causes. `is_fine`: with its scalars' image."""
        tree = material.node_tree
        if tree is None:
            r, g, b, _ = material.diffuse_color
            plain = MaterialArrays(
                material.name, base_color=(r, g, b), metallic=material.metallic, roughness=material.roughness
            )
            return ReadMaterial(0), usable_material(plain, notes.always)
        if output_source(tree, "Displacement") is not None:
            notes.always.append("Displacement {of} is not shown.")
        surface = self._surface(tree, notes, is_fine)
        arrays = replace(surface.rest, name=material.name, base_color=surface.color.factor)
        found = ReadMaterial(0, colors=surface.color.vertex_colors, is_hidden=surface.is_hidden)
        texture = surface.color.texture
        if isinstance(texture, SurfaceTexture):
            space = texture.space
            arrays = replace(
                arrays,
                image=self._image_index(usable_image(texture.image, notes.always)),
                uv_scale=space.scale,
                uv_turn=space.turn,
                uv_offset=space.offset,
            )
            found = replace(found, uv_maps=(space.uv_map,))
        if surface.textures and is_fine:
            found, arrays = self._with_scalars(found, arrays, surface, notes)
        if surface.tangents is not None:
            found, arrays = self._with_tangents(found, arrays, surface.tangents, notes)
        if surface.relief is not None:
            found, arrays = self._with_relief(found, arrays, surface.relief, notes.always)
        arrays = usable_material(arrays, notes.always)
        if arrays.alpha < 1.0 and not surface.is_hidden and not material.use_transparent_shadow:
            notes.always.append("Shadows {of} let light through, though its settings turn that off.")
        found = replace(
            found, is_seen_through=arrays.is_seen_through, lacks_scalars=bool(surface.textures) and not is_fine
        )
        return found, replace(arrays, uses_vertex_color=found.colors is not None)

    def _surface(self, tree: bpy.types.NodeTree, notes: Notes, is_fine: bool) -> Surface:
        source, volume = output_source(tree, "Surface"), output_source(tree, "Volume")
        reader = ShaderReader(self._textures, notes, is_fine)
        if source is None:
            if volume is None:
                # Cycles shows no light at all then.
                return Surface(BLACK, matt())
            notes.always.append("Volumes {of} are not shown.")
            return NOTHING
        surface = reader.surface(source)
        if volume is None:
            return surface
        absorption = read_absorption(volume, reader.inputs)
        # (What goes straight through surfaces does not know what it is inside of.)
        if absorption is None or (any(absorption) and surface.rest.transmission == 0.0 and not surface.is_opaque):
            notes.always.append("Volumes {of} are not shown.")
            return surface
        return replace(surface, rest=replace(surface.rest, absorption=absorption))

    def _with_scalars(
        self, found: ReadMaterial, arrays: MaterialArrays, surface: Surface, notes: Notes
    ) -> tuple[ReadMaterial, MaterialArrays]:
        packed = packed_scalars(surface, notes.on_paths)
        if packed is None:
            return found, arrays
        space = packed.space
        uv_maps = tuple(dict.fromkeys((*found.uv_maps, space.uv_map)))
        if not _is_one_map(uv_maps):
            notes.on_paths.append(
                "Roughness, metallic, transmission and alpha {of} are their means: they are on another UV map than its "
                "color."
            )
            return found, arrays
        image = self._known(usable_image(packed.image, notes.always))
        index = self._image_index(image, arrays.image)
        scalars = ScalarsArrays(index, space.scale, space.turn, space.offset)
        return replace(found, uv_maps=uv_maps), replace(arrays, scalars=scalars)

    def _with_tangents(
        self, found: ReadMaterial, arrays: MaterialArrays, tangents: str, notes: Notes
    ) -> tuple[ReadMaterial, MaterialArrays]:
        uv_maps = tuple(dict.fromkeys((*found.uv_maps, tangents)))
        if not _is_one_map(uv_maps):
            notes.on_paths.append(
                "Tangents {of} are drawn about the Z axis: they are on another UV map than its color."
            )
            return found, replace(arrays, tangent_by_uv=False)
        # (Paths have no axes of a UV map yet.)
        notes.on_paths.append("Tangents {of} are drawn about the Z axis.")
        return replace(found, uv_maps=uv_maps), arrays

    def _with_relief(
        self, found: ReadMaterial, arrays: MaterialArrays, relief: Relief, notes: list[str]
    ) -> tuple[ReadMaterial, MaterialArrays]:
        space = relief.texture.space
        uv_maps = tuple(dict.fromkeys((*found.uv_maps, space.uv_map, relief.tangents)))
        if not _is_one_map(uv_maps):
            notes.append("Bumps {of} are left out: they are on another UV map than its color.")
            return found, arrays
        read = ReliefArrays(
            self._image_index(usable_image(relief.texture.image, notes), arrays.image, _scalars_image(arrays)),
            relief.is_bump,
            relief.strength,
            relief.distance,
            space.scale,
            space.turn,
            space.offset,
        )
        return replace(found, uv_maps=uv_maps, has_relief=True), replace(arrays, relief=read)

    def _known(self, image: ImageArrays) -> ImageArrays:
        """An image in the list that is the same, if there is one: so that it is not uploaded again."""
        for known in self.images:
            if _plain(known) == _plain(image) and np.array_equal(known.pixels, image.pixels):
                return known
        return image

    def _image_index(self, image: ImageArrays, *kept: int) -> int:
        """Place of an image in the list, new or of one that no material shows any more, but none of `kept`."""
        for index, known in enumerate(self.images):
            if known is image:
                return index
        used = {*kept, *(material.image for material in self.materials)}
        used |= {_scalars_image(material) for material in self.materials}
        used |= {material.relief.image for material in self.materials if material.relief is not None}
        for index in range(len(self.images)):
            if index not in used:
                self.images[index] = image
                return index
        self.images.append(image)
        return len(self.images) - 1


def _scalars_image(material: MaterialArrays) -> int:
    return -1 if material.scalars is None else material.scalars.image


def _is_one_map(uv_maps: tuple[str, ...]) -> bool:
    """Whether all these may be one UV map: a mesh has one here. (Which is the default, only the mesh knows.)"""
    named = set(uv_maps) - {""}
    return len(named) <= 1 and not (len(uv_maps) > 1 and not named.isdisjoint((GENERATED, OBJECT)))


def _plain(image: ImageArrays) -> tuple[str, str, bool]:
    """All but the pixels."""
    return image.name, image.extension, image.nearest
