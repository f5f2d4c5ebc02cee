# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials on the GPU: base colors per batch, the rest as a record texture that the shade pass looks up."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import Float32Array, Glass, ImageArrays, MaterialArrays, SceneArrays
from ...scene.materials.pixels import averaged
from ...scene.remarks import Remark, sentences
from ..device.records import record_texture
from ..device.shaders import Piece, flags, named
from ..device.textures import largest_texture, texture_2d
from ..geometry.chunk import HOLDOUT
from .surface_buffer import SEEN_THROUGH

RECORDS = 15
"""Per material"""
TABLE = Piece(
    samplers={"materials": "FLOAT_2D"},
    defines={"MATERIAL_RECORDS": RECORDS, **{f"GLASS_{kind.name}": int(kind) for kind in Glass}},
)
"""What `material_records.glsl` needs: `Materials.table`"""
PLAIN = Piece(constants={"base_color": "VEC3", "material": "FLOAT"}, defines=flags("PLAIN"))
"""What `surface_color.glsl` needs for materials without an image, UV and vertex color to interpolate"""
TEXTURED = Piece(
    constants={
        "base_color": "VEC3",
        "material": "FLOAT",
        "uv_transform": "VEC4",
        "uv_turn": "VEC2",
        "uses_vertex_color": "FLOAT",
    },
    samplers={"base_image": "FLOAT_2D"},
    smooth={"uv": "VEC2", "vertex_color": "VEC3"},
)
"""The same for the others"""
RELIEF = Piece(
    constants={**named("VEC4", "relief", "relief_transform"), "relief_turn": "VEC2"},
    samplers={"relief_image": "FLOAT_2D"},
    defines=flags("RELIEF"),
)
"""What `relief.glsl` needs"""
OF_PATHS = Piece(constants={"seen_through": "FLOAT"}, defines={"PATHS": "", "SEEN_THROUGH": SEEN_THROUGH})
"""What the primary pass needs in scenes with paths"""
NO_SCALARS = Piece(outputs={"surface_scalars": "VEC4"}, defines=flags("NO_SCALARS"))
"""Of materials without an image of scalars, in scenes with some"""
WITH_SCALARS = Piece(
    constants={"scalars_transform": "VEC4", "scalars_turn": "VEC2"},
    samplers={"scalars_image": "FLOAT_2D"},
    outputs={"surface_scalars": "VEC4"},
    defines=flags("WITH_SCALARS"),
)
"""Of materials with one; beside `TEXTURED`"""
_HOLDOUT = MaterialArrays("holdout", base_color=(0.0, 0.0, 0.0))


class Materials:
    """GPU side of `SceneArrays.materials` and `.images`."""

    def __init__(self, scene: SceneArrays) -> None:
        self._white = texture_2d(np.ones((1, 1, 4), np.float32))
        self._images: list[tuple[ImageArrays, Any]] = []
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Take over the materials of another state of the scene; images that were there are not uploaded again."""
        known = {id(image): texture for image, texture in self._images}
        self._images = [(image, known.get(id(image)) or _texture(image)) for image in scene.images]
        self._materials = scene.materials
        records = np.zeros((len(scene.materials), RECORDS, 4), np.float32)
        for record, material in zip(records, scene.materials, strict=True):
            record[0] = (material.metallic, material.roughness, material.ior, material.specular_level)
            record[1] = (*material.emission, float(material.glossy_only))
            record[2] = (*material.base_color, float(material.uses_vertex_color))
            record[3] = (*material.uv_scale, *material.uv_offset)
            record[4, :3] = (material.image, *material.uv_turn)
            _fill_path_records(record[5:], material)
        self.table = record_texture(records.reshape(-1, 4))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is not drawn as it is, one sentence each."""
        largest = largest_texture()
        cause = "Fewer pixels {of} are drawn than there are: as many as the graphics driver takes."
        return sentences(
            Remark(cause, "image", image.name) for image, _ in self._images if max(image.pixels.shape[:2]) > largest
        )

    @property
    def images(self) -> list[Any]:
        """Textures, as `SceneArrays.images`."""
        return [texture for _, texture in self._images]

    def _of(self, index: int) -> MaterialArrays:
        return _HOLDOUT if index == HOLDOUT else self._materials[index]

    def is_plain(self, index: int) -> bool:
        """Whether a material is the same everywhere."""
        material = self._of(index)
        return material.image < 0 and not material.uses_vertex_color and material.relief is None

    def has_relief(self, index: int) -> bool:
        """Whether its normals are bent."""
        return self._of(index).relief is not None

    def has_scalars(self, index: int) -> bool:
        """Whether an image says how rough, metallic, transmitting or transparent it is."""
        return self._of(index).scalars is not None

    def bind_scalars(self, shader: Any, index: int) -> None:
        """Set what `WITH_SCALARS` names."""
        scalars = self._of(index).scalars
        assert scalars is not None
        shader.uniform_float("scalars_transform", (*scalars.uv_scale, *scalars.uv_offset))
        shader.uniform_float("scalars_turn", scalars.uv_turn)
        shader.uniform_sampler("scalars_image", self._images[scalars.image][1])

    def bind_for_paths(self, shader: Any, index: int) -> None:
        """Set what `OF_PATHS` names."""
        shader.uniform_float("seen_through", float(self._of(index).is_seen_through))

    def bind_relief(self, shader: Any, index: int) -> None:
        """Set what `RELIEF` names."""
        relief = self._of(index).relief
        assert relief is not None
        shader.uniform_float("relief", (float(relief.is_bump), relief.strength, relief.distance, 0.0))
        shader.uniform_float("relief_transform", (*relief.uv_scale, *relief.uv_offset))
        shader.uniform_float("relief_turn", relief.uv_turn)
        shader.uniform_sampler("relief_image", self._images[relief.image][1])

    def bind(self, shader: Any, index: int, is_textured: bool = False) -> None:
        """Set a bound shader with `PLAIN` or `TEXTURED`, as the material is (`is_plain`), to material `index`.

        `is_textured`: the shader is, whatever the material is.
        """
        material = self._of(index)
        shader.uniform_float("base_color", material.base_color)
        shader.uniform_float("material", float(index))
        if self.is_plain(index) and not is_textured:
            return
        shader.uniform_float("uv_transform", (*material.uv_scale, *material.uv_offset))
        shader.uniform_float("uv_turn", material.uv_turn)
        shader.uniform_float("uses_vertex_color", float(material.uses_vertex_color))
        shader.uniform_sampler("base_image", self._white if material.image < 0 else self._images[material.image][1])


def _fill_path_records(record: Float32Array, material: MaterialArrays) -> None:
    """What only paths need to know (`path_material.glsl`)."""
    flags = material.thin_wall + 2 * material.tangent_by_uv + 4 * material.alpha_inverted
    record[0] = (material.coat_weight, material.coat_roughness, material.coat_ior, material.transmission)
    record[1] = (*material.coat_tint, float(material.glass))
    record[2] = (*material.specular_tint, material.film_thickness)
    record[3] = (*material.absorption, material.film_ior)
    record[4] = (*material.transparent_tint, material.alpha)
    record[5] = (material.alpha_threshold, material.anisotropy, material.anisotropic_rotation, float(flags))
    record[7] = (-1.0, 0.0, 0.0, float(material.is_seen_through))
    record[8] = (*(material.sheen_weight * part for part in material.sheen_tint), material.sheen_roughness)
    record[9, :3] = (material.diffuse_roughness, material.subsurface, material.translucency)
    if (scalars := material.scalars) is not None:
        record[6] = (*scalars.uv_scale, *scalars.uv_offset)
        record[7, :3] = (scalars.image, *scalars.uv_turn)


def _texture(image: ImageArrays) -> Any:
    pixels = image.pixels
    largest = largest_texture()
    if max(pixels.shape[:2]) > largest:
        pixels = np.asarray(averaged(pixels, largest, largest), np.float32)
    fmt = "RGBA16F" if pixels.max(initial=0.0) < 6e4 and pixels.min(initial=0.0) > -6e4 else "RGBA32F"
    return texture_2d(pixels, fmt, not image.nearest, image.extension)
