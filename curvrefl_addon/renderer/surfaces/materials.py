# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials on the GPU: base colours per batch, the rest as a record texture that the shade pass looks up."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import ImageArrays, MaterialArrays, SceneArrays
from ..device.gpu_objects import record_texture, texture_2d
from ..geometry.chunk import HOLDOUT

RECORDS = 5
"""Per material, as in material_records.glsl"""
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
            record[4, 0] = material.image
        self.table = record_texture(records.reshape(-1, 4))

    @property
    def images(self) -> list[Any]:
        """Textures, as `SceneArrays.images`."""
        return [texture for _, texture in self._images]

    def _of(self, index: int) -> MaterialArrays:
        return _HOLDOUT if index == HOLDOUT else self._materials[index]

    @staticmethod
    def declare(info: Any, sampler: int, is_plain: bool) -> None:
        """What `surface_color.glsl` needs, in a shader's create info; `sampler` is the slot of the base image.

        With `is_plain` for materials of that kind: without an image, UV and vertex colour to interpolate.
        """
        info.push_constant("VEC3", "base_color")
        info.push_constant("FLOAT", "material")
        if is_plain:
            info.define("PLAIN")
            return
        info.push_constant("VEC4", "uv_transform")
        info.push_constant("FLOAT", "uses_vertex_color")
        info.sampler(sampler, "FLOAT_2D", "base_image")

    def is_plain(self, index: int) -> bool:
        """Whether a material is the same everywhere."""
        material = self._of(index)
        return material.image < 0 and not material.uses_vertex_color and material.relief is None

    def has_relief(self, index: int) -> bool:
        """Whether its normals are bent."""
        return self._of(index).relief is not None

    @staticmethod
    def declare_relief(info: Any, sampler: int) -> None:
        """What `relief.glsl` needs."""
        info.push_constant("VEC4", "relief")
        info.push_constant("VEC4", "relief_transform")
        info.sampler(sampler, "FLOAT_2D", "relief_image")

    def bind_relief(self, shader: Any, index: int) -> None:
        """Set what `declare_relief` declared."""
        relief = self._of(index).relief
        assert relief is not None
        shader.uniform_float("relief", (float(relief.is_bump), relief.strength, relief.distance, 0.0))
        shader.uniform_float("relief_transform", (*relief.uv_scale, *relief.uv_offset))
        shader.uniform_sampler("relief_image", self._images[relief.image][1])

    def bind(self, shader: Any, index: int) -> None:
        """Set what `declare` declared to material `index` on the bound shader, one for its kind (`is_plain`)."""
        material = self._of(index)
        shader.uniform_float("base_color", material.base_color)
        shader.uniform_float("material", float(index))
        if self.is_plain(index):
            return
        shader.uniform_float("uv_transform", (*material.uv_scale, *material.uv_offset))
        shader.uniform_float("uses_vertex_color", float(material.uses_vertex_color))
        shader.uniform_sampler("base_image", self._white if material.image < 0 else self._images[material.image][1])


def _texture(image: ImageArrays) -> Any:
    fmt = "RGBA16F" if image.pixels.max(initial=0.0) < 6e4 else "RGBA32F"
    return texture_2d(image.pixels, fmt, not image.nearest, image.repeat)
