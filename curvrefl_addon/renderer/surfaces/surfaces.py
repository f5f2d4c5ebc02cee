# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry passes: what the eye sees directly, and what it sees in a reflector, as surface buffers.

A surface buffer holds for every pixel the surface there, unlit: world position and object, shading normal and
material, base colour. Lighting is done once per pixel afterwards (`shade.py`), for what is visible only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import gpu
import numpy as np

from ....gpu_shaders.loader import load
from ..device.gpu_objects import drawing_state, scissored
from ..geometry.chunk import Batches, Chunk
from ..vertices.solve import SolvedChunk
from .materials import Materials
from .view_block import TYPEDEF

STRETCHED = float(np.cos(np.radians(8.0)))
"""Cosine of the largest angle between a pixel's own reflected ray and the direction to what it shows"""
STRETCHED_IN_REGION = float(np.cos(np.radians(3.0)))
"""The same for further images: near folds neighbouring vertices may be in different ones"""

type Window = tuple[int, int, int, int]
"""x, y, width and height of pixels"""


class SurfaceBuffer:
    """Render targets of one geometry pass."""

    def __init__(self, width: int, height: int) -> None:
        self.position = gpu.types.GPUTexture((width, height), format="RGBA32F")
        """xyz world, object_id (0: nothing here)"""
        self.normal = gpu.types.GPUTexture((width, height), format="RGBA32F")
        """xyz unit shading normal, material index"""
        self.color = gpu.types.GPUTexture((width, height), format="RGBA16F")
        """Base colour; the solver's iterations (reflected), or (primary) the mirror's number, -1 of other surfaces, -2
        of a hole in the picture, 0 where nothing is seen"""
        self.depth = gpu.types.GPUTexture((width, height), format="DEPTH_COMPONENT32F")
        for texture in (self.position, self.normal, self.color):
            texture.filter_mode(False)
        self.frame_buffer = gpu.types.GPUFrameBuffer(
            depth_slot=self.depth, color_slots=(self.position, self.normal, self.color)
        )
        self.width, self.height = width, height

    def clear(self) -> None:
        """Nothing anywhere."""
        with self.frame_buffer.bind():
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        with self.frame_buffer.bind():
            self.frame_buffer.read_color(0, 0, 1, 1, 4, 0, "FLOAT")


class BackFaces:
    """Distance from the eye to a reflector's nearest back face, 0 where there is none."""

    def __init__(self, width: int, height: int) -> None:
        self.distance = gpu.types.GPUTexture((width, height), format="R32F")
        self.distance.filter_mode(False)
        self._depth = gpu.types.GPUTexture((width, height), format="DEPTH_COMPONENT32F")
        self.frame_buffer = gpu.types.GPUFrameBuffer(depth_slot=self._depth, color_slots=(self.distance,))
        self.width, self.height = width, height

    def draw(self, surface: tuple[Chunk, Batches], view_uniforms: Any) -> None:
        """Fill from the reflector's triangles (closed, counter-clockwise from outside)."""
        chunk, batches = surface
        shader = _back_faces_shader()
        with drawing_state("LESS_EQUAL", depth_write=True), self.frame_buffer.bind():
            gpu.state.viewport_set(0, 0, self.width, self.height)
            gpu.state.face_culling_set("FRONT")
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_sampler("positions", chunk.positions)
            shader.uniform_sampler("corners", chunk.corners)
            for _, batch in batches:
                batch.draw(shader)


def draw_primary(
    target: SurfaceBuffer,
    seen: Sequence[tuple[Chunk, Batches]],
    materials: Materials,
    view_uniforms: Any,
    window: Window | None = None,
    hidden_faces: Callable[[Chunk], str] = lambda _chunk: "NONE",
    with_reliefs: Callable[[Chunk], bool] = lambda _chunk: False,
) -> None:
    """Fill `target` with what the eye sees directly, in `window` alone if given: nothing elsewhere.

    `hidden_faces` says which side of a chunk's triangles need not be drawn: 'BACK', 'FRONT' or 'NONE'. Of a
    mirror `with_reliefs` the normals are those of its bumps and normal maps, else of the smooth surface.
    """
    with drawing_state("LESS_EQUAL", depth_write=True), target.frame_buffer.bind():
        gpu.state.viewport_set(0, 0, target.width, target.height)
        target.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        with scissored(window):
            reliefs = {
                (id(chunk), material)
                for chunk, batches in seen
                for material, _ in batches
                if materials.has_relief(material) and with_reliefs(chunk)
            }
            for kind in ("PLAIN", "TEXTURED", *(("RELIEF",) if reliefs else ())):
                shader = _primary_shader(kind)
                shader.bind()
                shader.uniform_block("view", view_uniforms)
                for chunk, batches in seen:
                    gpu.state.face_culling_set(hidden_faces(chunk))
                    shader.uniform_sampler("positions", chunk.positions)
                    shader.uniform_sampler("corners", chunk.corners)
                    if kind != "RELIEF":
                        smooth = tuple(item for item in batches if (id(chunk), item[0]) not in reliefs)
                        _draw_batches(shader, smooth, materials, kind == "PLAIN")
                        continue
                    for material, batch in batches:
                        if (id(chunk), material) not in reliefs:
                            continue
                        materials.bind(shader, material)
                        materials.bind_relief(shader, material)
                        batch.draw(shader)


def _draw_batches(shader: Any, batches: Batches, materials: Materials, is_plain: bool) -> None:
    """Those whose materials are plain, or the others, with a bound shader for them."""
    for material, batch in batches:
        if materials.is_plain(material) == is_plain:
            materials.bind(shader, material)
            batch.draw(shader)


def draw_reflected(
    target: SurfaceBuffer,
    mirrors: SurfaceBuffer,
    mirror: int,
    back_faces: BackFaces | None,
    scenery: Sequence[SolvedChunk],
    materials: Materials,
    view_uniforms: Any,
    depth_scale: float,
    window: Window,
) -> None:
    """Add to `target` what the mirror numbered `mirror` shows at the pixels where `mirrors` sees it.

    `back_faces` is None for a mirror that cannot hide itself. `depth_scale` is the distance that gets half of the depth
    range, metres; `window` (x, y, width, height) holds all of the mirror's pixels.
    """
    if window[2] <= 0 or window[3] <= 0:
        return
    with drawing_state("LESS_EQUAL", depth_write=True), target.frame_buffer.bind(), scissored(window):
        gpu.state.viewport_set(0, 0, target.width, target.height)
        for is_plain in (True, False):
            shader = _reflected_shader(back_faces is not None, is_plain)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("mirror", float(mirror))
            shader.uniform_float("depth_scale", depth_scale)
            for name, texture in (
                ("mirror_position", mirrors.position),
                ("mirror_normal", mirrors.normal),
                ("mirror_color", mirrors.color),
            ):
                shader.uniform_sampler(name, texture)
            if back_faces is not None:
                shader.uniform_sampler("back_faces", back_faces.distance)
            for part in scenery:
                shader.uniform_float("stretched", STRETCHED if part.image == 0 else STRETCHED_IN_REGION)
                shader.uniform_sampler("positions", part.chunk.positions)
                shader.uniform_sampler("corners", part.chunk.corners)
                shader.uniform_sampler("reflection_points", part.solution.reflection_points)
                shader.uniform_sampler("virtual_positions", part.solution.virtual_positions)
                _draw_batches(shader, part.batches, materials, is_plain)


def _colors(is_plain: bool) -> tuple[tuple[str, str], ...]:
    """What is interpolated for the base colour."""
    return () if is_plain else (("VEC2", "uv"), ("VEC3", "vertex_color"))


def declare_surface_outputs(info: Any) -> None:
    """Color targets of a SurfaceBuffer, in a GPUShaderCreateInfo."""
    info.fragment_out(0, "VEC4", "surface_position")
    info.fragment_out(1, "VEC4", "surface_normal")
    info.fragment_out(2, "VEC4", "surface_color_out")


def _geometry_inputs(info: Any) -> None:
    info.typedef_source(TYPEDEF)
    info.uniform_buf(0, "ViewBlock", "view")
    info.sampler(0, "FLOAT_2D", "positions")
    info.sampler(1, "FLOAT_2D", "corners")


@cache
def _primary_shader(kind: str) -> Any:
    """For batches of one kind: PLAIN, TEXTURED or RELIEF."""
    is_plain = kind == "PLAIN"
    info = gpu.types.GPUShaderCreateInfo()
    _geometry_inputs(info)
    Materials.declare(info, 2, is_plain)
    if kind == "RELIEF":
        info.define("RELIEF")
        Materials.declare_relief(info, 3)
    interface = gpu.types.GPUStageInterfaceInfo(f"curvrefl_primary_{kind}")
    for kind, name in (("VEC3", "world_position"), ("VEC3", "world_normal"), *_colors(is_plain)):
        interface.smooth(kind, name)
    interface.flat("VEC2", "ids")
    info.vertex_out(interface)
    declare_surface_outputs(info)
    info.vertex_source(load("surfaces/primary.vert.glsl"))
    info.fragment_source(load("surfaces/primary.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _reflected_shader(with_back_faces: bool, is_plain: bool) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    _geometry_inputs(info)
    Materials.declare(info, 2, is_plain)
    info.push_constant("FLOAT", "mirror")
    info.push_constant("FLOAT", "depth_scale")
    info.push_constant("FLOAT", "stretched")
    names = ["reflection_points", "virtual_positions", "mirror_position", "mirror_normal", "mirror_color"]
    if with_back_faces:
        info.define("BACK_FACES")
        names.append("back_faces")
    for slot, name in enumerate(names, 3):
        info.sampler(slot, "FLOAT_2D", name)
    interface = gpu.types.GPUStageInterfaceInfo(f"curvrefl_reflected_{with_back_faces}_{is_plain}")
    for kind, name in (
        ("VEC3", "world_position"),
        ("VEC3", "world_normal"),
        *_colors(is_plain),
        ("FLOAT", "iterations"),
        ("VEC3", "reflection_point"),
        ("VEC2", "rejected"),
    ):
        interface.smooth(kind, name)
    interface.flat("FLOAT", "object_id")
    info.vertex_out(interface)
    declare_surface_outputs(info)
    info.depth_write("ANY")
    info.vertex_source(load("surfaces/reflected.vert.glsl"))
    info.fragment_source(load("surfaces/reflected.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _back_faces_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    _geometry_inputs(info)
    interface = gpu.types.GPUStageInterfaceInfo("curvrefl_back_faces")
    interface.smooth("VEC3", "world_position")
    info.vertex_out(interface)
    info.fragment_out(0, "FLOAT", "eye_distance")
    info.vertex_source(load("surfaces/back_faces.vert.glsl"))
    info.fragment_source(load("surfaces/back_faces.frag.glsl"))
    return gpu.shader.create_from_info(info)
