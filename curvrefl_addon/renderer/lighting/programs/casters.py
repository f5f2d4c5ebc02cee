# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The alpha that a material's program gives, as an image on its UV map: shadows look it up where no program runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ....scene.arrays import Float32Array, SceneArrays
from ....scene.programs.program import UV, Program, Shape
from ...device.batches import full_screen_triangle
from ...device.context import gpu_cache
from ...device.frame_buffers import frame_buffer
from ...device.shaders import FULL_SCREEN, Piece, build_shader, knows
from ...device.state import drawing_state, set_viewport
from ...device.textures import empty_texture, read_texture
from ...geometry.chunk_attributes import attributes_of
from ...programs.programs import Surroundings, program_piece
from ...surfaces.materials import DRAWN, TABLE, Materials

LARGEST, SMALLEST = 2048, 64
"""Texels along a side"""
TEXELS_PER_UNIT = 1024
"""Of texture coordinates"""
STEP = 1.0 / 512.0
"""From 0 or 1, within which alpha counts as that"""


@dataclass(frozen=True, slots=True)
class CasterImage:
    """Alpha on a part of a UV map."""

    alpha: Float32Array
    """(h, w), row 0 at the lowest v"""
    attribute: int
    """Number of the UV map among what the scene's programs read; -1: it is on none, and only the mean counts"""
    low: tuple[float, float] = (0.0, 0.0)
    """Texture coordinates where it begins"""
    size: tuple[float, float] = (1.0, 1.0)

    @property
    def is_binary(self) -> bool:
        """All is there or not."""
        return bool((np.minimum(self.alpha, 1.0 - self.alpha) < STEP).mean() > 0.98)


class CasterBake:
    """Runs programs on their UV maps."""

    def __init__(self, materials: Materials) -> None:
        self._materials = materials

    def is_known(self, index: int) -> bool:
        """Whether a material's program, and its images, are there already."""
        return self._materials.programs.is_whole(index)

    def __call__(self, scene: SceneArrays, index: int) -> CasterImage:
        """Of a material whose program sets alpha."""
        program = scene.materials[index].program
        assert program is not None
        maps = [attribute for attribute in program.attributes if attribute.kind == UV]
        low, high = np.zeros(2), np.ones(2)
        is_on_map = len(maps) == 1 == len(program.attributes) and not program.sampled & {"position", "ray", "instance"}
        if is_on_map:
            low, high = _reach(scene, index, program)
        size = np.clip(np.ceil(TEXELS_PER_UNIT * (high - low)), SMALLEST, LARGEST if is_on_map else 256)
        alpha = self._baked(index, program, low, high - low, (int(size[0]), int(size[1])))
        attribute = attributes_of(scene).index(maps[0]) if is_on_map else -1
        return CasterImage(
            alpha, attribute, (float(low[0]), float(low[1])), (float(high[0] - low[0]), float(high[1] - low[1]))
        )

    def _baked(self, index: int, program: Program, low: Any, size: Any, pixels: tuple[int, int]) -> Float32Array:
        texture = empty_texture(*pixels)
        shader = _alpha_shader(program.shape, self._materials.programs.around)
        target = frame_buffer(texture)
        with drawing_state(), target.bind():
            set_viewport(0, 0, *pixels)
            shader.bind()
            self._materials.bind_program(shader, program.shape, (0, 0))
            if knows(shader, "material"):
                shader.uniform_float("material", float(index))
            if knows(shader, "program_first"):
                shader.uniform_int("program_first", self._materials.programs.firsts[index])
            # (Alpha may look at no texture coordinates.)
            for name, value in (("part", (*low, *size)), ("pixels", pixels)):
                if knows(shader, name):
                    shader.uniform_float(name, value)
            full_screen_triangle().draw(shader)
        return np.clip(read_texture(texture)[..., 0], 0.0, 1.0)


def _reach(scene: SceneArrays, index: int, program: Program) -> tuple[Any, Any]:
    """Lowest and highest texture coordinates (2,) of what has the material."""
    lows, highs = [], []
    for mesh in {instance.mesh for instance in scene.instances if index in instance.materials}:
        arrays = scene.meshes[mesh]
        if (
            arrays.corner_attributes is None
            or program.attributes[0] not in arrays.attributes
            or not len(arrays.triangles)
        ):
            continue
        uv = arrays.corner_attributes[:, arrays.attributes.index(program.attributes[0]), :2]
        uv = uv[np.isfinite(uv).all(axis=1)]
        if len(uv):
            lows.append(uv.min(axis=0))
            highs.append(uv.max(axis=0))
    if not lows:
        return np.zeros(2), np.ones(2)
    low, high = np.min(lows, axis=0).astype(np.float64), np.max(highs, axis=0).astype(np.float64)
    return low, np.maximum(high, low + 1e-4)


@gpu_cache
def _alpha_shader(shape: Shape, around: Surroundings) -> Any:
    return build_shader(
        "alpha of casters",
        FULL_SCREEN,
        program_piece(shape, around),
        TABLE,
        Piece(
            constants={"part": "VEC4", "pixels": "VEC2", "program_first": "INT", "turn": "IVEC2", **DRAWN.constants},
            outputs={"color": "VEC4"},
            fragment="bake/caster_alpha.frag.glsl",
        ),
    )
