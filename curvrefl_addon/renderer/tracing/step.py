# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The step of paths: what a surface does to them, and the next surface on their ways."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...optics.scattering.sampler import path_point
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..lighting.ggx import GGX_DEFINES
from ..paths.features import ABSORPTION, ANISOTROPY
from ..programs.buffers import Buffers, reads
from ..rays.material_pass import Hits
from ..rays.ray_scene import RAYS, RayScene
from ..surfaces.materials import TABLE, Materials
from ..surfaces.pixel_classes import CLASS, CLASS_COUNT
from ..surfaces.surface_buffer import HOLE, SEEN_THROUGH, SURFACE_OUTPUTS, SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window
from .media import ABSORBING
from .object_frames import OBJECT_FRAMES
from .path_classes import PathClass
from .path_vertices import PathVertices

SAMPLER = Piece(constants={"path_point": "IVEC4"})
"""What `random.glsl` needs"""


@dataclass(frozen=True, slots=True)
class Limits:
    """How far paths are followed."""

    reflections: int
    interfaces: int
    """That let light through"""
    transparent: int
    """Surfaces that light goes straight through"""
    bounces: int
    """Reflections and interfaces together"""

    @property
    def most_steps(self) -> int:
        """After the last that is counted comes one that shows what shines by itself."""
        return min(self.bounces, self.reflections + self.interfaces) + self.transparent + 1


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What the shaders of paths have bound."""

    features: frozenset[str]
    """Defines"""
    materials: Materials
    rays: RayScene
    ggx: Any
    """Texture of `lighting/ggx.py`"""
    frames: Any
    """Record texture of `object_frames.py`, None where no material is anisotropic"""
    absorbing: Any
    """Record texture of `media.py`, None where no medium absorbs"""
    view_uniforms: Any
    window: Window


def follow(
    around: Surroundings,
    vertices: SurfaceBuffer | PathVertices,
    classes: Any,
    met: PathVertices,
    limits: Limits,
    sub_frame: tuple[int, int],
    step: int,
) -> None:
    """Follow all paths that go on from `vertices` to what they meet.

    `classes`: depth texture of the vertices' classes. `sub_frame`: its
    number, and how many there are. `step`: 1 for the first, whose vertices are what the eye sees.
    """
    before = vertices if isinstance(vertices, PathVertices) else None
    shader = _step_shader(around.features, around.materials.buffers, before is not None, met.hits is not None)
    with drawing_state("EQUAL"), met.target(classes).bind(), scissored(around.window):
        set_viewport(0, 0, met.width, met.height)
        shader.bind()
        around.rays.bind(shader)
        bind_vertices(shader, around, vertices)
        shader.uniform_float("pixel_class", float(PathClass.GOES_ON))
        shader.uniform_float("limits", (limits.reflections, limits.interfaces, limits.transparent, limits.bounces))
        shader.uniform_int("path_point", path_point(sub_frame[0], step - 1, sub_frame[1]))
        if around.absorbing is not None:
            shader.uniform_sampler("absorbing", around.absorbing)
        if before is None:
            shader.uniform_block("view", around.view_uniforms)
        else:
            shader.uniform_sampler("path_way", before.way)
            shader.uniform_sampler("path_throughput", before.throughput)
        full_screen_triangle().draw(shader)
    if met.hits is not None and around.materials.has_programs:
        hits = Hits(met.position, met.normal, met.color, met.hits, vertices.position, met.way, met.throughput)
        followed = (classes, float(PathClass.GOES_ON) / CLASS_COUNT)
        met.material_pass.draw(
            hits,
            met.made,
            followed,
            around.rays,
            around.materials,
            around.view_uniforms,
            around.window,
            (sub_frame[0], step),
        )


def bind_vertices(shader: Any, around: Surroundings, vertices: SurfaceBuffer | PathVertices) -> None:
    """Set what `vertex_pieces` names."""
    shader.uniform_sampler("materials", around.materials.table)
    shader.uniform_sampler("lighting_ggx", around.ggx)
    shader.uniform_sampler("vertex_position", vertices.position)
    shader.uniform_sampler("vertex_normal", vertices.normal)
    shader.uniform_sampler("vertex_color", vertices.color)
    vertices.made.bind(shader, around.materials.buffers)
    if around.frames is not None:
        shader.uniform_sampler("object_frames", around.frames)


def vertex_pieces(features: frozenset[str], buffers: Buffers) -> tuple[Piece, ...]:
    """What `path_vertex.glsl` needs."""
    samplers = named("FLOAT_2D", "vertex_position", "vertex_normal", "vertex_color", "lighting_ggx")
    return (
        TABLE,
        Piece(
            samplers=samplers,
            defines={**flags(*sorted(features)), **GGX_DEFINES, "SEEN_THROUGH": SEEN_THROUGH, "HOLE": HOLE},
        ),
        reads(buffers),
        *((OBJECT_FRAMES,) if ANISOTROPY in features else ()),
    )


@gpu_cache
def _step_shader(features: frozenset[str], buffers: Buffers, on_path: bool, with_hits: bool) -> Any:
    outputs = {**(named("VEC4", "hit_out") if with_hits else {}), **named("VEC4", "way_out", "throughput_out")}
    names = ["PATH_STEP", *(("WITH_HITS",) if with_hits else ())]
    way = Piece(samplers=named("FLOAT_2D", "path_way", "path_throughput"), defines=flags("ON_PATH"))
    return build_shader(
        "path step",
        CLASS,
        RAYS,
        *vertex_pieces(features, buffers),
        SAMPLER,
        *((ABSORBING,) if ABSORPTION in features else ()),
        way if on_path else VIEW,
        SURFACE_OUTPUTS,
        Piece(constants={"limits": "VEC4"}, outputs=outputs, defines=flags(*names), fragment="paths/step.frag.glsl"),
    )
