# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders of footprints."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from curvrefl.curvrefl_addon.renderer.device.shaders import Image, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.geometry.chunk import CHUNK
from curvrefl.curvrefl_addon.renderer.surfaces.materials import TABLE
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SURFACE_OUTPUTS
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import VIEW

SHADERS = Path(__file__).resolve().parent / "shaders"
GROUP = 64


@cache
def middles_shader() -> Any:
    return build_shader(
        "edge middles",
        Piece(
            constants={"edge_count": "INT"},
            samplers=named("FLOAT_2D", "edges", "positions"),
            images={"middles": Image()},
            group=GROUP,
            compute=SHADERS / "edge_middles.comp.glsl",
        ),
    )


@cache
def bounds_shader() -> Any:
    return build_shader(
        "footprint bounds",
        VIEW,
        Piece(
            constants={
                **named("INT", "triangle_count", "chunk"),
                "screen": "VEC2",
                **named("VEC4", "window", "margins"),
            },
            samplers=named("FLOAT_2D", "triangles", "positions", "corner_points", "middle_points"),
            images={"boxes": Image(), "counters": Image("R32UI", "UINT_2D_ATOMIC", is_read=True)},
            group=GROUP,
            compute=SHADERS / "footprint_bounds.comp.glsl",
        ),
    )


@cache
def draw_shader() -> Any:
    return build_shader(
        "footprint",
        VIEW,
        CHUNK,
        TABLE,
        SURFACE_OUTPUTS,
        Piece(
            constants={"screen": "VEC2", **named("FLOAT", "mirror", "depth_scale")},
            samplers=named("FLOAT_2D", "boxes", "triangles", "mirror_position", "mirror_normal", "mirror_color"),
            flat={**named("VEC3", "corner_a", "edge_b", "edge_c", "corner_numbers"), "about": "VEC2"},
            defines={"OVERLAP": 2e-6},
            writes_depth=True,
            vertex=SHADERS / "footprint.vert.glsl",
            fragment=SHADERS / "footprint.frag.glsl",
        ),
    )
