# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of light from corners of patches of mirrors and glass to where they land: a pixel each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ...scene.arrays import Float32Array
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import FrameBuffers, frame_buffer
from ..device.records import record_texture
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import depth_texture, empty_texture, read_texture
from ..lighting.lighting import CAUSTICS, INDIRECT, Features, Lighting
from ..rays.material_pass import Hits
from ..rays.ray_scene import RAYS
from ..shading.features import RAY_SHADOWS, lighting_pieces
from ..surfaces.materials import TABLE
from ..surfaces.pixel_classes import CLASS, CLASS_COUNT
from ..surfaces.surface_buffer import SURFACE_OUTPUTS
from ..tracing.path_classes import BUFFERS, PathClass, PathClasses, place_of
from ..tracing.path_vertices import PathVertices
from ..tracing.step import Limits, Surroundings, follow

SIDE = 256
"""Of a picture"""
AT_ONCE = SIDE * SIDE
"""Patches"""
CORNER_RECORDS = 5
MANY = 1 << 12
"""Sub-frames that the paths' random numbers are made for: maps are fewer"""


@dataclass(frozen=True, slots=True)
class Throw:
    """What a map is thrown by."""

    around: Surroundings
    lighting: Lighting
    limits: Limits
    sub_frame: int
    """Whose points on lamps shine"""
    turn: int
    """Number of the map, of the paths' random numbers"""
    by_chance: bool
    """Light may go one way or another at a surface"""


class CornerPaths:
    """Targets; what is at the same place in two pictures has the same random numbers."""

    def __init__(self, has_programs: bool) -> None:
        self._classes = PathClasses([depth_texture(SIDE, SIDE) for _ in range(BUFFERS)])
        self._vertices = [PathVertices(SIDE, SIDE, has_programs) for _ in range(BUFFERS)]
        self._landed = [empty_texture(SIDE, SIDE) for _ in range(4)]
        self._cleared = frame_buffer(*self._landed)
        self._targets = FrameBuffers(*self._landed, most=BUFFERS)

    def follow(self, throw: Throw, corners: Float32Array) -> Iterator[None]:
        """Of these corners (n, CORNER_RECORDS, 4), at most AT_ONCE, to where they land; some work at each step."""
        around, first = throw.around, self._vertices[0]
        with self._cleared.bind():
            self._cleared.clear(color=(0.0, 0.0, 0.0, 0.0))
        self._light(throw, record_texture(corners.reshape(-1, 4)), len(corners))
        if first.hits is not None and around.materials.has_programs:
            hits = Hits(
                first.position, first.normal, first.color, first.hits, first.position, first.way, first.throughput
            )
            goes_on = (self._classes.depth(0), float(PathClass.GOES_ON) / CLASS_COUNT)
            made = (around.rays, around.materials, around.view_uniforms, around.window)
            first.material_pass.draw(hits, first.made, goes_on, *made, (throw.turn, 0))
        yield
        most = throw.limits.most_steps
        before = first
        for step in range(1, most + 1):
            met = self._vertices[place_of(step)]
            follow(around, before, self._classes.depth(step - 1), met, throw.limits, (throw.turn, MANY), step)
            self._classes.sort_met(step, met, around.window)
            self._land(met, self._classes.depth(step))
            before = met
            yield
            if step < most and not self._classes.any_left(step):
                break

    def read(self, count: int) -> list[Float32Array]:
        """Place and object_id, normal, direction and packed state, power: (count, 4) each."""
        return [read_texture(texture).reshape(-1, 4)[:count] for texture in self._landed]

    def _light(self, throw: Throw, corners: Any, count: int) -> None:
        first = self._vertices[0]
        around = throw.around
        features = (throw.lighting.features - {CAUSTICS, INDIRECT}) | {RAY_SHADOWS}
        shader = _lit_shader(features, first.hits is not None)
        # (What is drawn between steps may have prepared another.)
        throw.lighting.prepare(throw.sub_frame)
        with drawing_state("ALWAYS", depth_write=True), first.target(self._classes.depth(0)).bind():
            set_viewport(0, 0, SIDE, SIDE)
            shader.bind()
            around.rays.bind(shader)
            throw.lighting.bind(shader)
            shader.uniform_sampler("materials", around.materials.table)
            shader.uniform_sampler("corners", corners)
            shader.uniform_int("patches", count)
            full_screen_triangle().draw(shader)

    def _land(self, met: PathVertices, classes: Any) -> None:
        shader = _landed_shader()
        with drawing_state("EQUAL"), self._targets.with_depth(classes).bind():
            set_viewport(0, 0, SIDE, SIDE)
            shader.bind()
            shader.uniform_float("pixel_class", float(PathClass.STOPS))
            shader.uniform_sampler("vertex_position", met.position)
            shader.uniform_sampler("vertex_normal", met.normal)
            shader.uniform_sampler("path_way", met.way)
            shader.uniform_sampler("path_throughput", met.throughput)
            full_screen_triangle().draw(shader)


@gpu_cache
def _lit_shader(features: Features, with_hits: bool) -> Any:
    hits = Piece(outputs=named("VEC4", "hit_out"), defines=flags("WITH_HITS"))
    return build_shader(
        "corners of caustics",
        FULL_SCREEN,
        *lighting_pieces(features),
        RAYS,
        TABLE,
        SURFACE_OUTPUTS,
        *((hits,) if with_hits else ()),
        Piece(
            samplers={"corners": "FLOAT_2D"},
            constants={"patches": "INT"},
            outputs=named("VEC4", "way_out", "throughput_out"),
            defines={
                "CORNER_RECORDS": CORNER_RECORDS,
                "PICTURE_SIDE": SIDE,
                "GOES_ON": float(PathClass.GOES_ON) / CLASS_COUNT,
            },
            writes_depth=True,
            fragment="caustics/lit_corners.frag.glsl",
        ),
    )


@gpu_cache
def _landed_shader() -> Any:
    return build_shader(
        "landed light",
        CLASS,
        Piece(
            samplers=named("FLOAT_2D", "vertex_position", "vertex_normal", "path_way", "path_throughput"),
            outputs=named("VEC4", "position_out", "normal_out", "way_out", "power_out"),
            fragment="caustics/landed.frag.glsl",
        ),
    )
