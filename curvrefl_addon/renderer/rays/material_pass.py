# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What materials' programs make of the surfaces that rays have hit: each program once, at its own pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...scene.programs.program import Shape
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import depth_texture
from ..programs.buffers import Buffers, MaterialBuffers, fills
from ..programs.programs import MOST_PROGRAMS, Surroundings, program_piece
from ..surfaces.materials import TABLE, Materials
from ..surfaces.surface_buffer import SEEN_THROUGH
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window
from .ray_scene import RAYS, RayScene

PROGRAM_STEPS = float(MOST_PROGRAMS + 1)
"""A power of two: the depths of programs are exact"""


@dataclass(frozen=True, slots=True)
class Hits:
    """Textures of what rays have hit."""

    position: Any
    normal: Any
    color: Any
    hits: Any
    """Of `packed_hit` (`ray_surface.glsl`)"""
    before: Any
    """Positions where the rays began; None where the way says how far they are"""
    way: Any = None
    throughput: Any = None
    """Of paths; None of rays from mirror to mirror"""
    is_gathered: bool = False
    """By rays for the light between surfaces: the last number of the way is how far they have gone"""
    counts_hits: bool = False
    """The last number of `before` is how many surfaces the ray has met"""


class MaterialPass:
    """Targets of the size of a picture."""

    def __init__(self, width: int, height: int) -> None:
        self._size = (width, height)
        self._depth: Any = None
        """Numbers of programs; made when first asked for, as its frame buffer"""
        self._classes: Any = None
        self._targets: list[tuple[Any, Buffers, Any]] = []

    def draw(
        self,
        hits: Hits,
        made: MaterialBuffers,
        followed: tuple[Any, float],
        rays: RayScene,
        materials: Materials,
        view_uniforms: Any,
        window: Window,
        turn: tuple[int, int],
    ) -> None:
        """Fill base color, normal and `made` where rays have just hit something with a program.

        `followed`: a depth texture, and what it holds where a ray was followed (-1: anything less than 1); `turn`:
        numbers of the sub-frame and of the bounce.
        """
        if self._depth is None:
            self._depth = depth_texture(*self._size)
            self._classes = frame_buffer(depth=self._depth)
        with drawing_state("ALWAYS", depth_write=True), self._classes.bind(), scissored(window):
            set_viewport(0, 0, *self._size)
            shader = _classes_shader()
            shader.bind()
            shader.uniform_sampler("followed", followed[0])
            shader.uniform_float("followed_depth", followed[1])
            shader.uniform_sampler("materials", materials.table)
            shader.uniform_sampler("vertex_position", hits.position)
            shader.uniform_sampler("vertex_normal", hits.normal)
            full_screen_triangle().draw(shader)
        target = self._target(hits, made, materials.buffers)
        with drawing_state("EQUAL"), target.bind(), scissored(window):
            set_viewport(0, 0, *self._size)
            for number, shape in materials.programs.admitted:
                shader = _pass_shader(
                    shape, materials.programs.around, hits.way is not None, hits.is_gathered, hits.counts_hits
                )
                shader.bind()
                rays.bind(shader)
                materials.bind_program(shader, shape, turn)
                shader.uniform_float("program_number", float(number))
                shader.uniform_block("view", view_uniforms)
                shader.uniform_sampler("vertex_position", hits.position)
                shader.uniform_sampler("path_hit", hits.hits)
                if hits.before is not None:
                    shader.uniform_sampler("before_position", hits.before)
                if hits.way is not None:
                    shader.uniform_sampler("path_way", hits.way)
                if hits.throughput is not None:
                    shader.uniform_sampler("path_throughput", hits.throughput)
                full_screen_triangle().draw(shader)

    def _target(self, hits: Hits, made: MaterialBuffers, buffers: Buffers) -> Any:
        for normal, known, target in self._targets:
            if normal is hits.normal and known == buffers:
                return target
        target = frame_buffer(hits.normal, hits.color, *made.textures(buffers), depth=self._depth)
        self._targets = [*self._targets[-3:], (hits.normal, buffers, target)]
        return target


@gpu_cache
def _classes_shader() -> Any:
    return build_shader(
        "program classes",
        FULL_SCREEN,
        TABLE,
        Piece(
            samplers={"followed": "DEPTH_2D", **named("FLOAT_2D", "vertex_position", "vertex_normal")},
            constants={"followed_depth": "FLOAT"},
            defines={"PROGRAM_STEPS": PROGRAM_STEPS},
            writes_depth=True,
            fragment="rays/program_classes.frag.glsl",
        ),
    )


@gpu_cache
def _pass_shader(shape: Shape, around: Surroundings, of_paths: bool, is_gathered: bool, counts_hits: bool) -> Any:
    gathered = Piece(samplers={"path_way": "FLOAT_2D"}, defines=flags("IS_GATHERED"))
    before = Piece(samplers={"before_position": "FLOAT_2D"}, defines=flags("AT_ONCE") if counts_hits else {})
    paths = Piece(
        samplers=named("FLOAT_2D", "path_way", "path_throughput"),
        defines={**flags("OF_PATHS", "PATH_STEP"), "SEEN_THROUGH": SEEN_THROUGH},
    )
    return build_shader(
        "material pass",
        Piece(inputs={"pos": "VEC2"}, vertex="rays/full_screen_of_program.vert.glsl"),
        program_piece(shape, around),
        VIEW,
        RAYS,
        TABLE,
        Piece(outputs=named("VEC4", "surface_normal", "surface_color_out")),
        fills(around.buffers),
        *((gathered,) if is_gathered else (before,)),
        *((paths,) if of_paths and not is_gathered else ()),
        Piece(
            samplers=named("FLOAT_2D", "vertex_position", "path_hit"),
            constants={"program_number": "FLOAT", "turn": "IVEC2"},
            defines={"PROGRAM_STEPS": PROGRAM_STEPS, **flags("WITH_HITS")},
            fragment="rays/material_pass.frag.glsl",
        ),
    )
