# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways that the pixels of a quad share, where rough surfaces scatter them."""

from __future__ import annotations

from typing import Any

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, named
from ..device.state import drawing_state, scissored, set_viewport
from ..surfaces.canvas import Canvas
from ..surfaces.pixel_classes import CLASS
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from .path_classes import PathClass
from .path_vertices import PathVertices
from .step import Surroundings, bind_vertices, vertex_pieces


def add_shared(
    around: Surroundings,
    canvas: Canvas,
    weight: float,
    seen: SurfaceBuffer,
    scalars: Any,
    classes: Any,
    met: PathVertices,
    arriving: Canvas,
) -> None:
    """Add what arrives along the first ways, which lead to `met`, times the lobes of the surfaces that are `seen`."""
    shader = _shader(around.features)
    target = canvas.with_depth(classes)
    with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"), target.bind(), scissored(around.window):
        set_viewport(0, 0, seen.width, seen.height)
        shader.bind()
        bind_vertices(shader, around, seen, scalars)
        shader.uniform_block("view", around.view_uniforms)
        shader.uniform_float("weight", weight)
        shader.uniform_float("pixel_class", float(PathClass.GOES_ON))
        shader.uniform_sampler("path_way", met.way)
        shader.uniform_sampler("path_throughput", met.throughput)
        shader.uniform_sampler("path_light", arriving.texture)
        full_screen_triangle().draw(shader)


@gpu_cache
def _shader(features: frozenset[str]) -> Any:
    return build_shader(
        "shared ways",
        CLASS,
        VIEW,
        *vertex_pieces(features),
        Piece(
            samplers=named("FLOAT_2D", "path_way", "path_throughput", "path_light"),
            constants={"weight": "FLOAT"},
            outputs={"color": "VEC4"},
            fragment="paths/reuse.frag.glsl",
        ),
    )
