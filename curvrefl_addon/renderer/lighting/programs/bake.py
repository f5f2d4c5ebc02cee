# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a program emits, drawn into images by directions and read back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .....gpu_shaders.loader import Snippet
from ....scene.arrays import LARGEST_COORDINATE, Float32Array, Float64Array, ImageSource
from ....scene.programs.program import IMAGE_RECORDS, UV, Program
from ....scene.programs.program import Shape as ProgramShape
from ...device.batches import full_screen_triangle
from ...device.context import gpu_cache
from ...device.frame_buffers import frame_buffer
from ...device.records import record_texture
from ...device.shaders import FULL_SCREEN, Block, Piece, build_shader, flags, named, uniform_block
from ...device.state import drawing_state, set_viewport
from ...device.textures import empty_texture, read_texture
from ...programs.image_pages import ImagePages
from ...programs.instance_table import NEED, PLAIN_VALUES, instance_piece

SKY, DISC, LAMP, SPOT, AREA = 0, 1, 2, 3, 4
"""Shapes of directions: an equirectangular image, a disc of the sky, all about a lamp (octahedral), in a spot's cone;
and places on an area lamp"""
CAMERA, GLOSSY, DIFFUSE, TRANSMISSION, LIGHTING = 1, 2 + 16 + 32, 2 + 8, 4, 0
"""Rays, as bits of `shading_point.glsl`; LIGHTING: Cycles tells shaders of light nothing of the rays that ask it"""
_SHAPES = {"SKY": SKY, "DISC": DISC, "LAMP": LAMP, "SPOT": SPOT, "AREA": AREA}
BAKE_RECORDS = 7


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
        # Before the parameters lie the numbers of attributes and values of instances: 0, of which there is no value.
        self._first = program.shape.attributes + len(program.instance_attributes)
        records = np.vstack([np.zeros((self._first, 4), np.float32), program.records])
        for use in program.images:
            start = self._first + use.record
            records[start : start + IMAGE_RECORDS] = self._pages.records(use.image)
        self._records = record_texture(records)
        self._instance = record_texture(np.zeros((PLAIN_VALUES + 1, 4)) if instance is None else instance)

    def bake(self, directions: Directions, rays: int, without_suns: bool = False) -> Float32Array:
        """(height, width, 3) radiance, row 0 lowest; what is no usable number is black."""
        pages = self._pages.piece
        shader = _shader(self._shape, without_suns, tuple(pages.samplers), tuple(pages.defines.items()))
        target = empty_texture(directions.width, directions.height)
        buffer = frame_buffer(target)
        with drawing_state(), buffer.bind():
            set_viewport(0, 0, directions.width, directions.height)
            shader.bind()
            shader.uniform_sampler("program_records", self._records)
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
def _shader(
    shape: ProgramShape, without_suns: bool, images: tuple[str, ...], image_defines: tuple[tuple[str, Any], ...]
) -> Any:
    text = "\n".join(
        (
            '#include "programs/shading_point.glsl"',
            '#include "programs/material.glsl"',
            *(f'#include "{file}"' for file in shape.files),
            shape.text,
        )
    )
    return build_shader(
        "emitting program",
        FULL_SCREEN,
        Piece(
            samplers={"program_records": "FLOAT_2D", **named("FLOAT_2D_ARRAY", *images)},
            blocks={"bake": Block("vec4", length=BAKE_RECORDS)},
            outputs={"color": "VEC4"},
            defines={
                **flags(*sorted(shape.needs), *(("PROGRAM_WITHOUT_SUNS",) if without_suns else ())),
                **dict(image_defines),
                "ATTRIBUTES": shape.attributes,
                **{f"SHAPE_{name}": number for name, number in _SHAPES.items()},
            },
            fragment=Snippet("emitting program", text),
        ),
        instance_piece(("",)) if NEED in shape.needs else Piece(),
        Piece(fragment="emitters/bake.frag.glsl"),
    )
