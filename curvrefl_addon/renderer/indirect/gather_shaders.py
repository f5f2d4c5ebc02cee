# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of rays for the light between surfaces, and what they are told."""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import Any

from ..cells.lookup import CELLS
from ..device.context import gpu_cache
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..lighting.ggx import GGX_DEFINES
from ..lighting.lighting import Features, lighting_piece
from ..paths.surface_features import SURFACE_FEATURES
from ..programs.buffers import Buffers, reads
from ..rays.ray_scene import RAYS
from ..surfaces.light_sets import LINKED, SHADOWS_LINKED
from ..surfaces.materials import TABLE
from ..surfaces.pixel_classes import CLASS, CLASS_COUNT
from ..surfaces.surface_buffer import SURFACE_OUTPUTS, SURFACE_SAMPLERS
from ..surfaces.view_block import VIEW
from .emitters import EMITTERS, SHINES

EMITTER_SHARE = 0.5
"""Of the rays that go to where light comes from, in scenes with emitters"""
LANES = 4
"""Pixels of a quad"""
_OF_EMITTERS = Piece(samplers=SHINES.samplers, defines=EMITTERS.defines)


class Source(Enum):
    """Where rays begin: names of the buffers, beside the three of the surface there."""

    SEEN = ()
    SHOWN = ("mirror_position", "mirror_normal", "mirror_color")
    LATER = ("path_direction", "path_throughput")
    PATHS = ("path_way", "path_throughput")


_CONSTANTS = {Source.LATER: {"skips_mirrors": "FLOAT"}, Source.SEEN: {"lane": "IVEC2"}}


def shared_piece(by_quads: bool, with_emitters: bool) -> Piece:
    """What `shared_gather.glsl` needs."""
    return Piece(
        samplers=named("FLOAT_2D", "gather_light", "gather_way"),
        constants={"share_turn": "INT", **({"lane": "IVEC2"} if by_quads else {})},
        defines=flags(
            "GATHER_SHARED",
            *(("SHARED_BY_QUADS",) if by_quads else ()),
            *(("EMITTERS",) if with_emitters else ()),
        ),
    )


def lane_of(sub_frame: int) -> tuple[int, int]:
    """Which pixel of each quad follows a ray."""
    return ((0, 0), (1, 1), (1, 0), (0, 1))[sub_frame % LANES]


class Kind(IntEnum):
    """Of what a ray has met."""

    LOBE_MISSES = 1
    LOBE_MEETS = 2
    BASE_MEETS = 3
    BASE_MISSES = 4
    SHINES = 5
    """It went to where light comes from"""


@gpu_cache
def gather_shader(
    source: Source, variant: Features, buffers: Buffers, features: Features, with_hits: bool, with_emitters: bool
) -> Any:
    hits = named("VEC4", "hit_out") if with_hits else {}
    return build_shader(
        f"gather {source.name}",
        FULL_SCREEN if source is Source.SEEN else CLASS,
        VIEW,
        RAYS,
        TABLE,
        reads(buffers),
        SURFACE_OUTPUTS,
        *((EMITTERS,) if with_emitters else ()),
        Piece(
            samplers=named("FLOAT_2D", *SURFACE_SAMPLERS, *source.value, "lighting_ggx"),
            constants={"path_point": "IVEC4", **_CONSTANTS.get(source, {})},
            outputs={**hits, **named("VEC4", "way_out", "weight_out")},
            defines={
                **GGX_DEFINES,
                "EMITTER_SHARE": EMITTER_SHARE,
                **flags(
                    "PATHS_ROUGH",
                    f"OF_{source.name}",
                    *sorted(variant),
                    *(("WITH_HITS",) if with_hits else ()),
                    *sorted(features & (SURFACE_FEATURES | {LINKED, SHADOWS_LINKED})),
                ),
            },
            fragment="gather/gather.frag.glsl",
        ),
    )


@gpu_cache
def kinds_shader() -> Any:
    return build_shader(
        "gather kinds",
        FULL_SCREEN,
        Piece(
            samplers={"gather_weight": "FLOAT_2D"},
            outputs={"color": "VEC4"},
            fragment="gather/gather_kinds.frag.glsl",
        ),
    )


@gpu_cache
def classes_shader() -> Any:
    return build_shader(
        "gather classes",
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "gather_weight", "vertex_position"),
            defines={"CLASS_COUNT": float(CLASS_COUNT), **{kind.name: float(kind) for kind in Kind}},
            writes_depth=True,
            fragment="gather/gather_classes.frag.glsl",
        ),
    )


@gpu_cache
def light_shader(
    kind: Kind, buffers: Buffers, features: Features, with_emitters: bool, has_patches: bool, is_shared: bool
) -> Any:
    return build_shader(
        f"gathered {kind.name}",
        CLASS,
        VIEW,
        TABLE,
        reads(buffers),
        CELLS,
        *((_OF_EMITTERS,) if with_emitters else ()),
        lighting_piece(features),
        Piece(
            samplers=named("FLOAT_2D", *SURFACE_SAMPLERS, "path_way", "gather_weight", "patch_light"),
            constants={"clamp_most": "FLOAT", "has_caustics": "FLOAT", **({} if is_shared else {"weight": "FLOAT"})},
            outputs={"color": "VEC4"},
            defines={
                **flags(
                    f"LIGHTS_{kind.name}",
                    "PATH_LIGHT",
                    *(() if has_patches else ("DIRECT_ALONE",)),
                    *(("IS_SHARED",) if is_shared else ()),
                ),
                "EMITTER_SHARE": EMITTER_SHARE,
            },
            fragment="gather/gather_light.frag.glsl",
        ),
    )
