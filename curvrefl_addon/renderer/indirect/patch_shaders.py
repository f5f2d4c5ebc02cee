# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of patches: where their rays get to, what light goes between them."""

from __future__ import annotations

from typing import Any

from ..cells.lookup import CELLS
from ..device.context import gpu_cache
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..lighting.ggx import GGX_DEFINES
from ..lighting.lighting import Features, lighting_piece
from ..paths.surface_features import SURFACE_FEATURES
from ..programs.buffers import Buffers, reads
from ..rays.ray_scene import RAYS
from ..surfaces.materials import TABLE
from ..surfaces.surface_buffer import SURFACE_OUTPUTS, SURFACE_SAMPLERS
from .emitters import EMITTERS, SHINES
from .points import POINTS

RAYS_AT_ONCE = 16
"""Of each patch in a batch"""
PICTURE_WIDTH = 1024
"""Of the picture that has a pixel for each ray of a batch"""
LINK_NOTHING, LINK_WITHIN = -1, -2
"""In place of the number of a patch: a ray has met nothing, or has begun inside of something solid"""
LINK_CLOSE = 0.25
"""More where it has met something close by"""
_POINTS = Piece(samplers={"patch_points": "FLOAT_2D"}, constants={"patches": "INT"}, defines={"PATCH_POINTS": POINTS})
_BATCH = {
    "RAYS_AT_ONCE": RAYS_AT_ONCE,
    "PICTURE_WIDTH": PICTURE_WIDTH,
    "LINK_NOTHING": LINK_NOTHING,
    "LINK_WITHIN": LINK_WITHIN,
    "LINK_CLOSE": LINK_CLOSE,
}


@gpu_cache
def light_shader(features: Features, of_sky: bool) -> Any:
    return build_shader(
        "light of patches",
        FULL_SCREEN,
        lighting_piece(features),
        _POINTS,
        Piece(
            constants={"weight": "FLOAT"},
            outputs={"color": "VEC4"},
            defines=flags("OF_SKY") if of_sky else {},
            fragment="patches/patch_light.frag.glsl",
        ),
    )


@gpu_cache
def walls_shader() -> Any:
    return build_shader(
        "walls of patches",
        FULL_SCREEN,
        RAYS,
        TABLE,
        CELLS,
        _POINTS,
        Piece(outputs={"wall_out": "VEC4"}, fragment="patches/patch_walls.frag.glsl"),
    )


@gpu_cache
def rays_shader(with_hits: bool, to_emitters: bool, links: frozenset[str]) -> Any:
    outputs = {**(named("VEC4", "hit_out") if with_hits else {}), **named("VEC4", "way_out")}
    return build_shader(
        "rays of patches",
        FULL_SCREEN,
        RAYS,
        TABLE,
        SURFACE_OUTPUTS,
        _POINTS,
        *((EMITTERS,) if to_emitters else ()),
        Piece(
            samplers={"solids": "FLOAT_2D"},
            constants={"batch": "INT"},
            outputs=outputs,
            defines={**_BATCH, **GGX_DEFINES, **(flags("WITH_HITS") if with_hits else {}), **flags(*sorted(links))},
            fragment="patches/patch_rays.frag.glsl",
        ),
    )


def sent_on_piece(features: Features) -> Piece:
    """What `gather/sent_on.glsl` needs about what the rays of a `PatchPicture` have met, beside materials."""
    return Piece(
        samplers=named("FLOAT_2D", *SURFACE_SAMPLERS, "path_way", "lighting_ggx"),
        constants={"has_caustics": "FLOAT"},
        defines={**GGX_DEFINES, **flags(*sorted(features & SURFACE_FEATURES))},
    )


@gpu_cache
def links_shader(buffers: Buffers, features: Features) -> Any:
    return build_shader(
        "links of patches",
        FULL_SCREEN,
        TABLE,
        reads(buffers),
        CELLS,
        sent_on_piece(features),
        Piece(outputs={"link_out": "VEC4"}, defines=_BATCH, fragment="patches/links.frag.glsl"),
    )


@gpu_cache
def weights_shader() -> Any:
    return _sum_over_rays("openness of points", "patches/point_weights.frag.glsl")


@gpu_cache
def sweep_shader() -> Any:
    return _sum_over_rays("sweep", "patches/sweep.frag.glsl", "patch_sent", "point_weights")


@gpu_cache
def emitter_sum_shader() -> Any:
    return _sum_over_rays("sum of emitters", "patches/emitter_sum.frag.glsl", "point_weights")


def _sum_over_rays(name: str, fragment: str, *samplers: str) -> Any:
    """Of each patch, over its rays of the batch whose `links` are bound."""
    return build_shader(
        name,
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "links", *samplers),
            constants={"patches": "INT"},
            outputs={"color": "VEC4"},
            defines={**_BATCH, "PATCH_POINTS": POINTS},
            fragment=fragment,
        ),
    )


@gpu_cache
def emitter_links_shader(buffers: Buffers, of_hemisphere: bool, links: frozenset[str]) -> Any:
    points = Piece(samplers={"patch_points": "FLOAT_2D"}, defines={"PATCH_POINTS": POINTS, **flags("OF_HEMISPHERE")})
    return build_shader(
        "light of emitters",
        FULL_SCREEN,
        TABLE,
        reads(buffers),
        *((points, SHINES) if of_hemisphere else ()),
        Piece(
            samplers=named("FLOAT_2D", *SURFACE_SAMPLERS, "path_way"),
            outputs={"link_out": "VEC4"},
            defines={**_BATCH, **flags(*sorted(links))},
            fragment="patches/emitter_links.frag.glsl",
        ),
    )


@gpu_cache
def sum_shader(with_emitters: bool) -> Any:
    shone = ("patch_shone",) if with_emitters else ()
    return build_shader(
        "sum of patches",
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "patch_swept", "patch_lamps", "patch_sky", "point_weights", *shone),
            constants={"patches": "INT"},
            outputs=named("VEC4", "sent_out", "arriving_out", "under_sky_out"),
            defines={**_BATCH, "PATCH_POINTS": POINTS, **(EMITTERS.defines if with_emitters else {})},
            fragment="patches/patch_sum.frag.glsl",
        ),
    )
