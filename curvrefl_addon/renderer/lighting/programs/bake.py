# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a program emits, drawn into images by directions and read back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ....scene.arrays import LARGEST_COORDINATE, Float32Array, Float64Array, ImageSource
from ....scene.programs.bits import (
    RAY_IS_CAMERA,
    RAY_IS_DIFFUSE,
    RAY_IS_GLOSSY,
    RAY_IS_REFLECTION,
    RAY_IS_SINGULAR,
    RAY_IS_TRANSMISSION,
)
from ....scene.programs.program import UV, Program
from ....scene.programs.program import Shape as ProgramShape
from ...device.batches import full_screen_triangle
from ...device.context import gpu_cache
from ...device.frame_buffers import frame_buffer
from ...device.records import record_texture
from ...device.shaders import FULL_SCREEN, Block, Piece, build_shader, flags, uniform_block
from ...device.state import drawing_state, set_viewport
from ...device.textures import empty_texture, read_texture
from ...programs.image_pages import ImagePages
from ...programs.instance_table import NEED, PLAIN_VALUES
from ...programs.programs import IMAGES, Surroundings, parameters_of, program_piece, surroundings_of

SKY, DISC, LAMP, SPOT, AREA = 0, 1, 2, 3, 4
"""Shapes of directions: an equirectangular image, a disc of the sky, all about a lamp (octahedral), in a spot's cone;
and places on an area lamp"""
CAMERA, TRANSMISSION, LIGHTING = RAY_IS_CAMERA, RAY_IS_TRANSMISSION, 0
GLOSSY, DIFFUSE = RAY_IS_REFLECTION | RAY_IS_GLOSSY | RAY_IS_SINGULAR, RAY_IS_REFLECTION | RAY_IS_DIFFUSE
"""Rays; LIGHTING: Cycles tells shaders of light nothing of the rays that ask it"""
_SHAPES = {"SKY": SKY, "DISC": DISC, "LAMP": LAMP, "SPOT": SPOT, "AREA": AREA}
BAKE_RECORDS = 7
NO_VALUES = ("",)
"""Names of values of instances: one, which is 0"""


@dataclass(frozen=True, slots=True)
class Directions:
    """In which a program is asked."""

    shape: int
    width: int
    height: int
    frame: Float64Array
    """(3, 3) rows: see `emitters/bake.frag.glsl`"""
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    """Of the lamp's ball"""


def sky_directions(width: int) -> Directions:
    """Of an equirectangular image."""
    return Directions(SKY, width, max(width // 2, 1), np.eye(3))


class Baker:
    """Bakes one program."""

    def __init__(
        self, program: Program, images: tuple[ImageSource, ...] = (), instance: Float64Array | None = None
    ) -> None:
        """`images`: those of the program's own list; `instance`: records (PLAIN_VALUES, 4) of the lamp that it is
        on."""
        self._shape = program.shape
        self._uvs = sum(1 << number for number, item in enumerate(program.attributes) if item.kind == UV)
        self._pages = ImagePages()
        self._pages.follow(images)
        self._pages.fill()
        self.warnings = self._pages.warnings
        # (Attributes and values of instances are all number 0, of which there is no value.)
        self._first = program.shape.attributes + len(program.instance_attributes)
        self._records = record_texture(parameters_of(program, [0] * self._first, self._pages))
        self._instance = record_texture(np.zeros((PLAIN_VALUES + 1, 4)) if instance is None else instance)

    def bake(self, directions: Directions, rays: int, without_suns: bool = False) -> Float32Array:
        """(height, width, 3) radiance, row 0 lowest; what is no usable number is black."""
        shader = _shader(self._shape, surroundings_of(self._pages, NO_VALUES), without_suns)
        target = empty_texture(directions.width, directions.height)
        buffer = frame_buffer(target)
        with drawing_state(), buffer.bind():
            set_viewport(0, 0, directions.width, directions.height)
            shader.bind()
            shader.uniform_sampler("program_records", self._records)
            if IMAGES in self._shape.needs:
                self._pages.bind(shader)
            if NEED in self._shape.needs:
                shader.uniform_sampler("instance_table", self._instance)
            block = uniform_block(self._numbers(directions, rays).ravel())
            shader.uniform_block("bake", block)
            full_screen_triangle().draw(shader)
        pixels = np.ascontiguousarray(read_texture(target)[..., :3])
        pixels[~(np.abs(pixels) < LARGEST_COORDINATE).all(axis=-1)] = 0.0
        return pixels

    def _numbers(self, directions: Directions, rays: int) -> Float32Array:
        """(BAKE_RECORDS, 4) as the shader takes them."""
        numbers = np.zeros((BAKE_RECORDS, 4), np.float32)
        numbers[:3, :3] = directions.frame
        numbers[3] = *directions.place, directions.radius
        numbers[4] = directions.width, directions.height, directions.shape, self._first
        numbers[5] = *_depths(rays), rays
        numbers[6, 0] = self._uvs
        return numbers


def _depths(rays: int) -> tuple[float, float, float]:
    """Bounces in all, diffuse ones, glossy ones."""
    return (0.0, 0.0, 0.0) if rays == CAMERA else (1.0, float(rays == DIFFUSE), float(rays == GLOSSY))


@gpu_cache
def _shader(shape: ProgramShape, around: Surroundings, without_suns: bool) -> Any:
    return build_shader(
        "emitting program",
        FULL_SCREEN,
        program_piece(shape, around),
        Piece(
            blocks={"bake": Block("vec4", length=BAKE_RECORDS)},
            outputs={"color": "VEC4"},
            defines={
                **(flags("PROGRAM_WITHOUT_SUNS") if without_suns else {}),
                **{f"SHAPE_{name}": number for name, number in _SHAPES.items()},
            },
            fragment="emitters/bake.frag.glsl",
        ),
    )
