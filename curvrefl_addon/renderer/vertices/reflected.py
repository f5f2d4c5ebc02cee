# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass of what the eye sees in a mirror whose scenery is solved: each vertex again, where it reflects."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...scene.programs.program import Shape
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..geometry.chunk import CHUNK, Batches
from ..programs.buffers import fills
from ..programs.programs import Surroundings
from ..surfaces.materials import DRAWN, PLAIN, Materials, forward_pieces
from ..surfaces.surface_buffer import SURFACE_OUTPUTS, SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window
from .back_faces import BackFaces
from .solution import SolvedChunk

STRETCHED_COSINE = float(np.cos(np.radians(8.0)))
"""Cosine of the largest angle between a pixel's own reflected ray and the direction to what it shows"""
STRETCHED_COSINE_IN_REGION = float(np.cos(np.radians(3.0)))
"""The same for further images: near folds neighboring vertices may be in different ones"""


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
    sub_frame: int = 0,
) -> None:
    """Add to `target` what the mirror numbered `mirror` shows at the pixels where `mirrors` sees it.

    `back_faces` is None for a mirror that cannot hide itself. `depth_scale` is the distance that gets half of the depth
    range, meters; `window` (x, y, width, height) holds all of the mirror's pixels. `sub_frame`: its number.
    """
    if window[2] <= 0 or window[3] <= 0:
        return
    groups: dict[Shape | None, list[tuple[SolvedChunk, Batches]]] = {}
    for part in scenery:
        for shape, chosen in materials.by_shape(part.batches).items():
            groups.setdefault(shape, []).append((part, chosen))
    with drawing_state("LESS_EQUAL", depth_write=True), target.target(materials.buffers).bind(), scissored(window):
        set_viewport(0, 0, target.width, target.height)
        for shape, parts in groups.items():
            shader = _reflected_shader(back_faces is not None, shape, materials.around)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("mirror", float(mirror))
            shader.uniform_float("depth_scale", depth_scale)
            if shape is not None:
                materials.bind_program(shader, shape, (sub_frame, 1))
            for name, texture in (
                ("mirror_position", mirrors.position),
                ("mirror_normal", mirrors.normal),
                ("mirror_color", mirrors.color),
            ):
                shader.uniform_sampler(name, texture)
            if back_faces is not None:
                shader.uniform_sampler("back_faces", back_faces.distance)
            for part, chosen in parts:
                shader.uniform_float("stretched", STRETCHED_COSINE if part.image == 0 else STRETCHED_COSINE_IN_REGION)
                materials.bind_triangles(shader, part.chunk, shape)
                shader.uniform_sampler("reflection_points", part.solution.reflection_points)
                shader.uniform_sampler("virtual_positions", part.solution.virtual_positions)
                for material, batch in chosen:
                    materials.bind(shader, material)
                    batch.draw(shader)


@gpu_cache
def _reflected_shader(with_back_faces: bool, shape: Shape | None, around: Surroundings | None) -> Any:
    back_faces = Piece(samplers={"back_faces": "FLOAT_2D"}, defines=flags("BACK_FACES"))
    return build_shader(
        "reflected" if shape is None else "reflected of a program",
        VIEW,
        CHUNK,
        *(() if shape is None or around is None else forward_pieces(shape, around)),
        PLAIN if shape is None else DRAWN,
        SURFACE_OUTPUTS,
        *(() if around is None else (fills(around.buffers),)),
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
            vertex="vertices/reflected.vert.glsl",
            fragment="vertices/reflected.frag.glsl",
        ),
        *((back_faces,) if with_back_faces else ()),
    )
