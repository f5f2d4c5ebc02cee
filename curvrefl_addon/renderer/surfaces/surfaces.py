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

import numpy as np

from ..device.frame_buffers import frame_buffer, wait_for
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, hide_faces, scissored, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..geometry.chunk import CHUNK, Batches, Chunk
from ..vertices.solve import SolvedChunk
from .materials import PLAIN, RELIEF, TEXTURED, Materials
from .view_block import VIEW

STRETCHED = float(np.cos(np.radians(8.0)))
"""Cosine of the largest angle between a pixel's own reflected ray and the direction to what it shows"""
STRETCHED_IN_REGION = float(np.cos(np.radians(3.0)))
"""The same for further images: near folds neighbouring vertices may be in different ones"""

type Window = tuple[int, int, int, int]
"""x, y, width and height of pixels"""
SURFACE_OUTPUTS = Piece(outputs=named("VEC4", "surface_position", "surface_normal", "surface_color_out"))
"""Color targets of a SurfaceBuffer"""


class SurfaceBuffer:
    """Render targets of one geometry pass."""

    def __init__(self, width: int, height: int) -> None:
        self.position = empty_texture(width, height)
        """xyz world, object_id (0: nothing here)"""
        self.normal = empty_texture(width, height)
        """xyz unit shading normal, material index"""
        self.color = empty_texture(width, height, "RGBA16F")
        """Base colour; the solver's iterations (reflected), or (primary) the mirror's number, -1 of other surfaces, -2
        of a hole in the picture, 0 where nothing is seen"""
        self.depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.position, self.normal, self.color, depth=self.depth)
        self.width, self.height = width, height

    def clear(self) -> None:
        """Nothing anywhere."""
        with self.frame_buffer.bind():
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        wait_for(self.frame_buffer)


class BackFaces:
    """Distance from the eye to a reflector's nearest back face, 0 where there is none."""

    def __init__(self, width: int, height: int) -> None:
        self.distance = empty_texture(width, height, "R32F")
        self._depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.distance, depth=self._depth)
        self.width, self.height = width, height

    def draw(self, surface: tuple[Chunk, Batches], view_uniforms: Any) -> None:
        """Fill from the reflector's triangles (closed, counter-clockwise from outside)."""
        chunk, batches = surface
        shader = _back_faces_shader()
        with drawing_state("LESS_EQUAL", depth_write=True), self.frame_buffer.bind():
            set_viewport(0, 0, self.width, self.height)
            hide_faces("FRONT")
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
    with_reliefs: bool = False,
) -> None:
    """Fill `target` with what the eye sees directly, in `window` alone if given: nothing elsewhere.

    `hidden_faces` says which side of a chunk's triangles need not be drawn: 'BACK', 'FRONT' or 'NONE'. `with_reliefs`:
    the normals of mirrors are those of their bumps and normal maps, else of the smooth surface.
    """
    with drawing_state("LESS_EQUAL", depth_write=True), target.frame_buffer.bind():
        set_viewport(0, 0, target.width, target.height)
        target.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        with scissored(window):
            reliefs = {
                material
                for _, batches in seen
                for material, _ in batches
                if with_reliefs and materials.has_relief(material)
            }
            for kind in ("PLAIN", "TEXTURED", *(("RELIEF",) if reliefs else ())):
                shader = _primary_shader(kind)
                shader.bind()
                shader.uniform_block("view", view_uniforms)
                for chunk, batches in seen:
                    hide_faces(hidden_faces(chunk))
                    shader.uniform_sampler("positions", chunk.positions)
                    shader.uniform_sampler("corners", chunk.corners)
                    if kind != "RELIEF":
                        smooth = tuple(item for item in batches if item[0] not in reliefs)
                        _draw_batches(shader, smooth, materials, kind == "PLAIN")
                        continue
                    for material, batch in batches:
                        if material not in reliefs:
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
        set_viewport(0, 0, target.width, target.height)
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


@cache
def _primary_shader(kind: str) -> Any:
    """For batches of one kind: PLAIN, TEXTURED or RELIEF."""
    return build_shader(
        f"primary {kind}",
        VIEW,
        CHUNK,
        PLAIN if kind == "PLAIN" else TEXTURED,
        *((RELIEF,) if kind == "RELIEF" else ()),
        SURFACE_OUTPUTS,
        Piece(
            smooth=named("VEC3", "world_position", "world_normal"),
            flat={"ids": "VEC2"},
            vertex="surfaces/primary.vert.glsl",
            fragment="surfaces/primary.frag.glsl",
        ),
    )


@cache
def _reflected_shader(with_back_faces: bool, is_plain: bool) -> Any:
    back_faces = Piece(samplers={"back_faces": "FLOAT_2D"}, defines=flags("BACK_FACES"))
    return build_shader(
        f"reflected {with_back_faces} {is_plain}",
        VIEW,
        CHUNK,
        PLAIN if is_plain else TEXTURED,
        SURFACE_OUTPUTS,
        Piece(
            samplers=named(
                "FLOAT_2D", "reflection_points", "virtual_positions", "mirror_position", "mirror_normal", "mirror_color"
            ),
            constants=named("FLOAT", "mirror", "depth_scale", "stretched"),
            smooth={
                **named("VEC3", "world_position", "world_normal", "reflection_point"),
                "iterations": "FLOAT",
                "rejected": "VEC2",
            },
            flat={"object_id": "FLOAT"},
            writes_depth=True,
            vertex="surfaces/reflected.vert.glsl",
            fragment="surfaces/reflected.frag.glsl",
        ),
        *((back_faces,) if with_back_faces else ()),
    )


@cache
def _back_faces_shader() -> Any:
    return build_shader(
        "back faces",
        VIEW,
        CHUNK,
        Piece(
            smooth={"world_position": "VEC3"},
            outputs={"eye_distance": "FLOAT"},
            vertex="surfaces/back_faces.vert.glsl",
            fragment="surfaces/back_faces.frag.glsl",
        ),
    )
