# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders that light surface buffers."""

from __future__ import annotations

from typing import Any

from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..indirect.gather import ASKS_EMITTERS
from ..indirect.gather_shaders import shared_piece
from ..lighting.lighting import Features, lighting_piece
from ..programs.buffers import Buffers, reads
from ..rays.paths import AT_ONCE, ON_PATHS
from ..surfaces.materials import TABLE
from ..surfaces.pixel_classes import CLASS, PixelClass
from ..surfaces.view_block import VIEW
from .features import lighting_pieces
from .lookup import lookup_piece

SEEN = ("seen_position", "seen_normal", "seen_color")
REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")
PATH = ("mirror_position", "path_direction", "path_throughput")
WHOLE_PATH = ("before_position", "path_throughput")
_LIGHT = Piece(constants={"weight": "FLOAT"}, outputs={"color": "VEC4"})
_OF_SEEN = (VIEW, CLASS, TABLE, Piece(samplers=named("FLOAT_2D", *SEEN)), _LIGHT)
"""Pieces of shaders that light a class of pixels of the buffers that the eye sees"""
_SEEN_BY_MIRROR = Piece(defines=flags("SEEN_BY_MIRROR"))
_OF_REFLECTED = Piece(samplers=named("FLOAT_2D", *REFLECTED))


@gpu_cache
def shade_shader(
    kind: PixelClass, features: Features, buffers: Buffers, by_camera: bool = True, is_shared: bool = False
) -> Any:
    """For a class of pixels, without environments."""
    shows_surface = kind in (PixelClass.MIRROR_OF_SURFACE, PixelClass.MIRROR_OF_MIRROR)
    return build_shader(
        f"shade {kind.name}",
        *_OF_SEEN,
        reads(buffers),
        *((_OF_REFLECTED,) if shows_surface else ()),
        *lighting_pieces(features),
        *(() if by_camera else (_SEEN_BY_MIRROR,)),
        *((shared_piece(kind is PixelClass.SURFACE, ASKS_EMITTERS in features),) if is_shared else ()),
        Piece(defines=flags(f"SHADES_{kind.name}"), fragment="lighting/shade.frag.glsl"),
    )


@gpu_cache
def environment_shader(lookup: str, features: Features) -> Any:
    """For mirrors that show an environment, with the name of its lookup."""
    return build_shader(
        f"shade {lookup}",
        *_OF_SEEN,
        lookup_piece(lookup),
        lighting_piece(features),
        Piece(constants={"mirror": "FLOAT"}, fragment="lighting/shade.frag.glsl"),
    )


@gpu_cache
def path_shader(goes_on: bool, features: Features, buffers: Buffers) -> Any:
    return build_shader(
        "shade path",
        ON_PATHS,
        VIEW,
        TABLE,
        reads(buffers),
        Piece(samplers=named("FLOAT_2D", *PATH)),
        _OF_REFLECTED,
        _LIGHT,
        *lighting_pieces(features),
        Piece(defines=flags("GOES_ON") if goes_on else {}, fragment="lighting/shade_path.frag.glsl"),
    )


@gpu_cache
def whole_path_shader(features: Features, buffers: Buffers) -> Any:
    """For pixels that show a mirror in a mirror, whose rays have gone on at once."""
    return build_shader(
        "shade whole path",
        *_OF_SEEN,
        reads(buffers),
        AT_ONCE,
        Piece(samplers=named("FLOAT_2D", *WHOLE_PATH)),
        _OF_REFLECTED,
        *lighting_pieces(features),
        Piece(fragment="lighting/shade_path.frag.glsl"),
    )


@gpu_cache
def front_shader(has_base: bool, features: Features, buffers: Buffers, by_camera: bool) -> Any:
    return build_shader(
        "shade front",
        *_OF_SEEN,
        reads(buffers),
        *lighting_pieces(features),
        *(() if by_camera else (_SEEN_BY_MIRROR,)),
        Piece(defines=flags("MIRROR_BASE") if has_base else {}, fragment="lighting/shade_front.frag.glsl"),
    )
