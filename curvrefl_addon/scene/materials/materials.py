# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: the nodes that the renderer can draw, the nearest constant and a warning for the rest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy

from ..arrays import ImageArrays, MaterialArrays, ReliefArrays
from ..finite import usable_image, usable_material
from ..meshes.attributes import VertexColors
from ..meshes.meshes import GENERATED, OBJECT
from ..remarks import Remark
from .images import ImageReader
from .node_links import output_source
from .reliefs import Relief
from .shaders import NOTHING, ShaderReader
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
    has_relief: bool = False
    """Bumps, that only a mirror shows"""
    is_hidden: bool = False
    """It has no surface: a volume, or full transparency"""


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

    def read(self, material: bpy.types.Material | None) -> ReadMaterial:
        """The material's place in the list; None, an empty slot, is at index 0."""
        if material is None:
            return ReadMaterial(0)
        key = material.original.session_uid
        if key not in self._read:
            notes: list[str] = []
            found, arrays = self._found(material, notes)
            self.reads += 1
            remarks = tuple(Remark(cause, "material", material.name) for cause in dict.fromkeys(notes))
            self._read[key] = replace(found, index=self._place(key, arrays), remarks=remarks)
        return self._read[key]

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

    def _found(self, material: bpy.types.Material, notes: list[str]) -> tuple[ReadMaterial, MaterialArrays]:
        """All but the index and the remarks, for which `notes` gets the causes."""
        tree = material.node_tree
        if tree is None:
            r, g, b, _ = material.diffuse_color
            plain = MaterialArrays(
                material.name, base_color=(r, g, b), metallic=material.metallic, roughness=material.roughness
            )
            return ReadMaterial(0), usable_material(plain, notes)
        if output_source(tree, "Displacement") is not None:
            notes.append("Displacement {of} is not shown.")
        source, volume = output_source(tree, "Surface"), output_source(tree, "Volume")
        if volume is not None:
            notes.append("Volumes {of} are not shown.")
        if source is not None:
            surface = ShaderReader(self._textures, notes).surface(source)
        else:
            # Without a volume Cycles shows no light at all.
            surface = replace(NOTHING, is_hidden=volume is not None)
        arrays = replace(surface.rest, name=material.name, base_color=surface.color.factor)
        found = ReadMaterial(0, colors=surface.color.vertex_colors, is_hidden=surface.is_hidden)
        texture = surface.color.texture
        if isinstance(texture, SurfaceTexture):
            space = texture.space
            arrays = replace(
                arrays,
                image=self._image_index(usable_image(texture.image, notes)),
                uv_scale=space.scale,
                uv_turn=space.turn,
                uv_offset=space.offset,
            )
            found = replace(found, uv_maps=(space.uv_map,))
        if surface.relief is not None:
            found, arrays = self._with_relief(found, arrays, surface.relief, notes)
        arrays = usable_material(arrays, notes)
        return found, replace(arrays, uses_vertex_color=found.colors is not None)

    def _with_relief(
        self, found: ReadMaterial, arrays: MaterialArrays, relief: Relief, notes: list[str]
    ) -> tuple[ReadMaterial, MaterialArrays]:
        space = relief.texture.space
        uv_maps = dict.fromkeys((*found.uv_maps, space.uv_map, relief.tangents))
        named = set(uv_maps) - {""}
        if len(named) > 1 or (len(uv_maps) > 1 and not named.isdisjoint((GENERATED, OBJECT))):
            # (A mesh has one UV map here; which one is the default, only the mesh knows.)
            notes.append("Bumps {of} are left out: they are on another UV map than its color.")
            return found, arrays
        read = ReliefArrays(
            self._image_index(usable_image(relief.texture.image, notes), arrays.image),
            relief.is_bump,
            relief.strength,
            relief.distance,
            space.scale,
            space.turn,
            space.offset,
        )
        return replace(found, uv_maps=tuple(uv_maps), has_relief=True), replace(arrays, relief=read)

    def _image_index(self, image: ImageArrays, kept: int = -1) -> int:
        """Place of an image in the list, new or of one that no material shows any more, but not `kept`."""
        for index, known in enumerate(self.images):
            if known is image:
                return index
        used = {kept, *(material.image for material in self.materials)}
        used |= {material.relief.image for material in self.materials if material.relief is not None}
        for index in range(len(self.images)):
            if index not in used:
                self.images[index] = image
                return index
        self.images.append(image)
        return len(self.images) - 1
