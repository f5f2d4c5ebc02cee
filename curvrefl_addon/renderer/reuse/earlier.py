# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame's picture with those of the frames before it, each drawn where it has shown the same scene point.

Others estimate where a reflection was a frame before, by the mirror's own motion or by an image behind it (Zeng et al.,
"Temporally Reliable Motion Vectors for Real-time Ray Tracing", 2021). Here each frame keeps the scene point that every
pixel shows, whatever the method that has found it, so the place is solved for.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.records import record_texture
from ..device.shaders import FULL_SCREEN, Piece, build_shader, named, set_matrix
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture
from ..surfaces.canvas import Canvas
from ..surfaces.surface_buffer import SurfaceBuffer
from .kept_frame import SERVES_NONE, SHOWS_SEVERAL, STEP_SHARE, KeptFrame
from .motion import MOTION_RECORDS, is_same_light, is_same_scenery, mirror_numbers, motion_records

RINGS = 6
"""Of eight places each about the first one that is tried, each twice as wide as the one before: 32 pixels the last"""
STEPS = 8
"""Of the search, at most"""
LONGEST = 8.0
"""Pixels that a step goes at most"""
NEAR = 1.0
"""Pixels from a center within which derivatives serve"""
FAR = 1.0
"""In pixels: how far off the point that was shown there may be"""
COARSEST = 4.0
"""Times as much, by area, that a pixel of an earlier frame may have shown"""
LEAST_WHOLE = 0.5
"""Of the four pixels about a place, by their weights: so much has to show the same thing"""
DARKEST_TINT = 1e-3
CLAMP = 1.5
"""Standard deviations of the pixels around, where things have moved"""


def with_earlier(
    now: KeptFrame, seen: SurfaceBuffer, earlier: Sequence[KeptFrame]
) -> tuple[Canvas, Canvas | None, list[Any]]:
    """The picture and the mirrors alone, and for each of the frames used a texture of the places in it (x, y, 1) that
    were found, pixels from the bottom left; (0, 0, 0) where none was.

    `seen`: what the eye sees now through the pixels' centers. Frames in another light are left out: what has not moved
    looks otherwise in them.
    """
    used = [frame for frame in earlier if _serves(now, frame)]
    if not used:
        return now.picture, now.mirrors_alone, []
    places = [_found(now, seen, frame) for frame in used]
    alone = None
    if now.mirrors_alone is not None:
        pictures = [frame.mirrors_alone for frame in used]
        alone = _mean(now, now.mirrors_alone, used, places, [one for one in pictures if one is not None], True)
    return _mean(now, now.picture, used, places, [one.picture for one in used], False), alone, places


def _serves(now: KeptFrame, frame: KeptFrame) -> bool:
    has_all = now.mirrors_alone is None or frame.mirrors_alone is not None
    size = (now.view.width, now.view.height)
    return has_all and size == (frame.view.width, frame.view.height) and is_same_light(now.scene, frame.scene)


def _found(now: KeptFrame, seen: SurfaceBuffer, then: KeptFrame) -> Any:
    found = empty_texture(seen.width, seen.height)
    motions = record_texture(motion_records(now.scene, then.scene, now.origin, then.origin).astype(np.float32))
    numbers = record_texture(mirror_numbers(now.scene, now.mirrors, then.scene, then.mirrors).astype(np.float32))
    shader = _find_shader()
    with drawing_state(), frame_buffer(found).bind():
        set_viewport(0, 0, seen.width, seen.height)
        shader.bind()
        set_matrix(shader, "then_to_clip", then.view.world_to_clip)
        for name, texture in (
            ("motions", motions),
            ("mirror_numbers", numbers),
            ("seen_position", seen.position),
            ("now_shown", now.shown),
            ("now_tint", now.tint),
            ("then_shown", then.shown),
            ("then_tint", then.tint),
        ):
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    return found


def _mean(
    now: KeptFrame,
    picture: Canvas,
    used: Sequence[KeptFrame],
    places: Sequence[Any],
    pictures: Sequence[Canvas],
    mirrors_only: bool,
) -> Canvas:
    width, height = now.view.width, now.view.height
    added, count = empty_texture(width, height), empty_texture(width, height)
    target = frame_buffer(added, count)
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
    shader = _add_shader()
    for frame, place, texels in zip(used, places, pictures, strict=True):
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind():
            set_viewport(0, 0, width, height)
            shader.bind()
            shader.uniform_float("mirrors_only", float(mirrors_only))
            shader.uniform_float("has_moved", float(not is_same_scenery(now.scene, frame.scene)))
            for name, texture in (
                ("found_before", place),
                ("now_picture", picture.texture),
                ("now_shown", now.shown),
                ("now_tint", now.tint),
                ("then_shown", frame.shown),
                ("then_tint", frame.tint),
                ("then_picture", texels.texture),
            ):
                shader.uniform_sampler(name, texture)
            full_screen_triangle().draw(shader)
    result = Canvas.of_size(width, height)
    shader = _mean_shader()
    with drawing_state(), result.frame_buffer.bind():
        set_viewport(0, 0, width, height)
        shader.bind()
        for name, texture in (("now_picture", picture.texture), ("added_before", added), ("count_before", count)):
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    return result


_OF_EARLIER = Piece(
    samplers=named("FLOAT_2D", "then_shown", "then_tint"),
    defines={"STEP_SHARE": STEP_SHARE, "SERVES_NONE": SERVES_NONE, "SHOWS_SEVERAL": SHOWS_SEVERAL},
)


@gpu_cache
def _find_shader() -> Any:
    return build_shader(
        "find before",
        FULL_SCREEN,
        _OF_EARLIER,
        Piece(
            samplers=named("FLOAT_2D", "motions", "mirror_numbers", "seen_position", "now_shown", "now_tint"),
            constants={"then_to_clip": "MAT4"},
            defines={
                "MOTION_RECORDS": MOTION_RECORDS,
                "RINGS": RINGS,
                "STEPS": STEPS,
                "LONGEST": LONGEST,
                "NEAR": NEAR,
                "FAR": FAR,
                "COARSEST": COARSEST,
            },
            outputs={"found_at": "VEC4"},
            fragment="reuse/find_before.frag.glsl",
        ),
    )


@gpu_cache
def _add_shader() -> Any:
    return build_shader(
        "add before",
        FULL_SCREEN,
        _OF_EARLIER,
        Piece(
            samplers=named("FLOAT_2D", "found_before", "now_picture", "now_shown", "now_tint", "then_picture"),
            constants=named("FLOAT", "mirrors_only", "has_moved"),
            defines={"DARKEST_TINT": DARKEST_TINT, "LEAST_WHOLE": LEAST_WHOLE, "CLAMP": CLAMP},
            outputs=named("VEC4", "added", "count"),
            fragment="reuse/add_before.frag.glsl",
        ),
    )


@gpu_cache
def _mean_shader() -> Any:
    return build_shader(
        "mean of frames",
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "now_picture", "added_before", "count_before"),
            outputs={"color": "VEC4"},
            fragment="reuse/mean_of_frames.frag.glsl",
        ),
    )
