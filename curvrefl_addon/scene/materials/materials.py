# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: the nodes that the renderer can draw, the nearest constant and a warning for the rest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..arrays import ImageArrays, MaterialArrays, ReliefArrays
from ..finite import usable_image, usable_material
from ..meshes.meshes import MeshNeeds
from .images import ImageReader
from .node_colors import ColorReader, NodeColor
from .node_links import Source, find_input, source_of, surface_source
from .reliefs import Relief, read_relief
from .surface_textures import SurfaceTexture, SurfaceTextureReader

EMPTY_SLOT = MaterialArrays("default", base_color=(0.8, 0.8, 0.8), roughness=1.0, specular_level=0.0)
"""What Cycles draws without a material: a diffuse gray"""

# Inputs of the Principled BSDF that are not drawn unless they are at this value.
_IGNORED = {
    "Alpha": 1.0,
    "Subsurface Weight": 0.0,
    "Anisotropic": 0.0,
    "Transmission Weight": 0.0,
    "Coat Weight": 0.0,
    "Sheen Weight": 0.0,
    "Thin Film Thickness": 0.0,
    "Diffuse Roughness": 0.0,
}


@dataclass(frozen=True, slots=True)
class _Surface:
    """A material whose base color may still have textures."""

    color: NodeColor
    rest: MaterialArrays
    """All but the base color and the relief"""
    relief: Relief | None = None


@dataclass(frozen=True, slots=True)
class ReadMaterial:
    """A material of the scene."""

    index: int
    """Into `MaterialReader.materials`"""
    needs: MeshNeeds
    """What it reads of the meshes it is on"""
    warning: str = ""
    """What is drawn only roughly"""
    has_relief: bool = False
    """Bumps, that only a mirror shows"""


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
            return ReadMaterial(0, MeshNeeds())
        key = material.original.session_uid
        if key not in self._read:
            notes: list[str] = []
            arrays, needs = self._arrays(material, notes)
            self.reads += 1
            warning = (
                f'Material "{material.name}" is drawn roughly: {"; ".join(dict.fromkeys(notes))}.' if notes else ""
            )
            self._read[key] = ReadMaterial(self._place(key, arrays), needs, warning, arrays.relief is not None)
        return self._read[key]

    def plain(self, arrays: MaterialArrays) -> ReadMaterial:
        """Place of a material without textures that is not the scene's."""
        return ReadMaterial(self._place(arrays, arrays), MeshNeeds())

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

    def _arrays(self, material: bpy.types.Material, notes: list[str]) -> tuple[MaterialArrays, MeshNeeds]:
        source = surface_source(material.node_tree)
        if source is None:
            r, g, b, _ = material.diffuse_color
            plain = MaterialArrays(
                material.name, base_color=(r, g, b), metallic=material.metallic, roughness=material.roughness
            )
            return usable_material(plain, notes), MeshNeeds()
        surface = _ShaderReader(self._textures, notes).surface(source)
        arrays = replace(surface.rest, name=material.name, base_color=surface.color.factor)
        needs = MeshNeeds(colors=surface.color.vertex_colors)
        texture = surface.color.texture
        if isinstance(texture, SurfaceTexture):
            arrays = replace(
                arrays,
                image=self._image_index(usable_image(texture.image, notes)),
                uv_scale=texture.space.scale,
                uv_offset=texture.space.offset,
            )
            needs = replace(needs, uv_map=texture.space.uv_map)
        if surface.relief is not None:
            arrays, needs = self._with_relief(arrays, needs, surface.relief, notes)
        arrays = usable_material(arrays, notes)
        return replace(arrays, uses_vertex_color=needs.colors is not None), needs

    def _with_relief(
        self, arrays: MaterialArrays, needs: MeshNeeds, relief: Relief, notes: list[str]
    ) -> tuple[MaterialArrays, MeshNeeds]:
        space = relief.texture.space
        if needs.uv_map not in (None, space.uv_map):
            # (a mesh has one UV map here)
            notes.append("its bumps are left out: they are on another UV map than its color")
            return arrays, needs
        found = ReliefArrays(
            self._image_index(usable_image(relief.texture.image, notes), arrays.image),
            relief.is_bump,
            relief.strength,
            relief.distance,
            space.scale,
            space.offset,
        )
        return replace(arrays, relief=found), replace(needs, uv_map=space.uv_map)

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


class _ShaderReader:
    """One material's shader nodes."""

    def __init__(self, textures: SurfaceTextureReader, notes: list[str]) -> None:
        self._notes = notes
        self._colors = ColorReader(lambda source: textures.read(source, notes), notes)

    def surface(self, source: Source) -> _Surface:
        """The surface of a shader node. What it lacks for a true picture goes into the notes."""
        node = source.node
        kind = "" if node is None else node.type
        if node is None or node.mute:
            return _Surface(NodeColor((0.0, 0.0, 0.0)), _matt())
        if kind == "BSDF_PRINCIPLED":
            return self._principled(source)
        if kind == "BSDF_DIFFUSE":
            if self._number(source, "Roughness") > 0.0:
                self._notes.append("its diffuse roughness is left out")
            return _Surface(self._color(source, "Color"), _matt(), self._relief(source))
        if kind == "BSDF_GLOSSY":
            if self._number(source, "Anisotropy") != 0.0:
                self._notes.append("its anisotropy is left out")
            return _Surface(
                self._color(source, "Color"),
                MaterialArrays("", metallic=1.0, roughness=self._number(source, "Roughness"), glossy_only=True),
                self._relief(source),
            )
        if kind == "BSDF_METALLIC":
            return self._metallic(source)
        if kind == "EMISSION":
            emission = self._emission(source, "Color", "Strength")
            return _Surface(NodeColor((0.0, 0.0, 0.0)), replace(_matt(), emission=emission))
        if kind == "MIX_SHADER":
            return self._mix(source)
        if kind == "ADD_SHADER":
            return self._add(source)
        return self._unsupported(source)

    def _principled(self, source: Source) -> _Surface:
        ignored = [name for name, neutral in _IGNORED.items() if not self._is_at(source, name, neutral)]
        tint = self._colors.color(source.input("Specular Tint"))
        if tint != NodeColor():
            ignored.append("Specular Tint")
        if ignored:
            self._notes.append("not drawn: " + ", ".join(ignored))
        rest = MaterialArrays(
            "",
            metallic=min(max(self._number(source, "Metallic"), 0.0), 1.0),
            roughness=min(max(self._number(source, "Roughness"), 0.0), 1.0),
            ior=max(self._number(source, "IOR"), 1e-5),
            specular_level=max(self._number(source, "Specular IOR Level"), 0.0),
            emission=self._emission(source, "Emission Color", "Emission Strength"),
        )
        return _Surface(self._color(source, "Base Color"), rest, self._relief(source))

    def _metallic(self, source: Source) -> _Surface:
        node = source.node
        assert node is not None
        color = self._color(source, "Base Color")
        if node.fresnel_type == "PHYSICAL_CONDUCTOR":
            ior, extinction = (np.array(self._colors.color(source.input(n)).mean()) for n in ("IOR", "Extinction"))
            squared = extinction**2
            r, g, b = (((ior - 1.0) ** 2 + squared) / ((ior + 1.0) ** 2 + squared)).tolist()
            color = NodeColor((r, g, b))
        elif self._colors.color(source.input("Edge Tint")) != NodeColor():
            self._notes.append("its edge tint is left out")
        rest = MaterialArrays("", metallic=1.0, roughness=self._number(source, "Roughness"))
        return _Surface(color, rest, self._relief(source))

    def _mix(self, source: Source) -> _Surface:
        factor = min(max(self._colors.number(source.input("Fac"), "mix factor"), 0.0), 1.0)
        first, second = source.input("Shader"), source.input("Shader_001")
        if 0.0 < factor < 1.0 or source.input("Fac").node is not None:
            self._notes.append("of its mixed shaders only the stronger one is drawn")
        return self.surface(second if factor > 0.5 else first)

    def _add(self, source: Source) -> _Surface:
        surfaces = [self.surface(source.input(name)) for name in ("Shader", "Shader_001")]
        first, second = surfaces
        if _only_emits(first):
            first, second = second, first
        if not _only_emits(second):
            self._notes.append("of its added shaders only the first one is drawn")
            return first
        r, g, b = np.add(first.rest.emission, second.rest.emission).tolist()
        return replace(first, rest=replace(first.rest, emission=(r, g, b)))

    def _unsupported(self, source: Source) -> _Surface:
        node = source.node
        assert node is not None
        self._notes.append(f'shader "{node.name}" is drawn as the nearest plain surface')
        inputs = {socket.identifier for socket in node.inputs}
        color = self._color(source, "Color") if "Color" in inputs else NodeColor((0.0, 0.0, 0.0))
        if node.type in ("BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSPARENT", "HOLDOUT"):
            # Nothing of its light comes from a diffuse layer.
            color = NodeColor((0.0, 0.0, 0.0))
        if node.type == "BSDF_GLASS":
            rest = MaterialArrays("", roughness=self._number(source, "Roughness"), ior=self._number(source, "IOR"))
            return _Surface(color, rest)
        return _Surface(color, _matt())

    def _color(self, source: Source, name: str) -> NodeColor:
        return self._colors.color(source.input(name))

    def _number(self, source: Source, name: str) -> float:
        return self._colors.number(source.input(name), name.lower())

    def _emission(self, source: Source, color_name: str, strength_name: str) -> tuple[float, float, float]:
        strength = self._number(source, strength_name)
        if strength == 0.0:
            return 0.0, 0.0, 0.0
        color = self._color(source, color_name).scaled((strength, strength, strength))
        if not color.is_constant and any(color.factor):
            self._notes.append("its emission varies, the mean is used")
        return color.mean()

    def _is_at(self, source: Source, name: str, value: float) -> bool:
        found = source.input(name)
        return found.node is None and float(found.socket.default_value) == value

    def _relief(self, source: Source) -> Relief | None:
        node = source.node
        assert node is not None
        normal = source_of(find_input(node, "Normal"), source.groups)
        return read_relief(normal, self._colors, self._notes)


def _matt() -> MaterialArrays:
    """A surface without gloss."""
    return MaterialArrays("", roughness=1.0, specular_level=0.0)


def _only_emits(surface: _Surface) -> bool:
    return surface.color == NodeColor((0.0, 0.0, 0.0)) and surface.rest.specular_level == 0.0
