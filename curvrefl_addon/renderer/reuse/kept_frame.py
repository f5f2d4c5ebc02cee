# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame's picture with what its pixels show, kept for the frames after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...scene.arrays import Float64Array, SceneArrays
from ...scene.camera.view import View
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture
from ..paths.features import has_base
from ..shading.shade_shaders import SEEN
from ..shown.rays import ShownRays, steps
from ..shown.shown import Shown, SubFrame, chosen_mirrors
from ..shown.vertices import ShownVertices
from ..surfaces.canvas import Canvas
from ..surfaces.materials import TABLE
from ..surfaces.pixel_classes import CHOSEN_MIRRORS
from ..surfaces.surface_buffer import HOLE, SurfaceBuffer
from ..surfaces.view_block import VIEW

SERVES_NONE, SHOWS_SEVERAL = -1.0, -2.0
STEP_SHARE = 1.0 / 128.0
"""Of each mirror on the way after the first, beside an object's number"""


@dataclass(frozen=True, slots=True, eq=False)
class KeptFrame:
    """Of one frame. What is shown is that at the pixels' centers."""

    scene: SceneArrays
    """In the world"""
    view: View
    """About `origin`"""
    origin: Float64Array
    mirrors: Mapping[int, int]
    """Numbers by the indices of their instances"""
    picture: Canvas
    mirrors_alone: Canvas | None
    shown: Any
    """Texture: xyz of the scene point that a pixel shows, itself or in mirrors, and its object's number with STEP_SHARE
    for each mirror after the first; of the background its unit direction, and no object"""
    tint: Any
    """Texture: what the mirror reflects there, and its number; 0 of what is seen itself; SHOWS_SEVERAL less the
    mirror's number (0 for none) where a pixel shows several things that move otherwise, which are followed with the
    surface itself; SERVES_NONE in holes"""


def keep_frame(
    scene: SceneArrays,
    origin: Float64Array,
    sub_frame: SubFrame,
    groups: list[tuple[type[Shown], list[Shown]]],
    picture: Canvas,
    mirrors_alone: Canvas | None,
) -> KeptFrame:
    """Of a frame whose primary pass `sub_frame` has drawn through the pixels' centers; `groups`: see `Reflection`."""
    seen, stage = sub_frame.targets.seen, sub_frame.stage
    shown, tint = empty_texture(seen.width, seen.height), empty_texture(seen.width, seen.height, "RGBA16F")
    fits = [one for kind, members in groups if kind in _KINDS for one in members if _shows_one_thing(scene, one)]
    serving = chosen_mirrors(fits, len(stage.mirrors))
    shader = _seen_shader()
    with drawing_state(), frame_buffer(shown, tint).bind():
        set_viewport(0, 0, seen.width, seen.height)
        shader.bind()
        shader.uniform_block("view", sub_frame.uniforms)
        shader.uniform_sampler("materials", stage.materials.table)
        shader.uniform_sampler("chosen_mirrors", serving)
        for name, texture in zip(SEEN, (seen.position, seen.normal, seen.color), strict=True):
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    target = frame_buffer(shown)
    for kind, members in groups:
        chosen = chosen_mirrors([one for one in members if one in fits], len(stage.mirrors))
        if kind is ShownRays:
            for number, bounce in enumerate(steps([one for one in members if isinstance(one, ShownRays)], sub_frame)):
                _add_shown(target, seen, bounce.path, chosen, number, bounce.path.depth)
        elif kind is ShownVertices:
            vertices = [one for one in members if isinstance(one, ShownVertices)]
            _add_shown(target, seen, ShownVertices.draw(vertices, sub_frame, of_positions=True), chosen, 0, None)
    numbers = {mirror.index: mirror.number for mirror in stage.mirrors}
    return KeptFrame(scene, sub_frame.view, origin, numbers, picture, mirrors_alone, shown, tint)


_KINDS = (ShownRays, ShownVertices)
"""Of an environment it is not known what point is shown"""


def _shows_one_thing(scene: SceneArrays, shown: Shown) -> bool:
    """Whether all that moves in a mirror's picture is what it reflects: nothing of it comes from below its surface or
    from behind."""
    materials = [scene.materials[index] for index in scene.instances[shown.mirror.index].materials]
    return not any(has_base(material) or material.is_seen_through for material in materials)


def _add_shown(target: Any, seen: SurfaceBuffer, met: SurfaceBuffer, chosen: Any, number: int, depth: Any) -> None:
    """What mirrors show after so many others; `depth`: of the pixels whose rays were followed, None for all."""
    shader = _shown_shader(depth is not None)
    with drawing_state(), target.bind():
        set_viewport(0, 0, seen.width, seen.height)
        shader.bind()
        shader.uniform_float("share", number * STEP_SHARE)
        shader.uniform_sampler("chosen_mirrors", chosen)
        shader.uniform_sampler("seen_color", seen.color)
        shader.uniform_sampler("reflected_position", met.position)
        if depth is not None:
            shader.uniform_sampler("path_depth", depth)
        full_screen_triangle().draw(shader)


@gpu_cache
def _seen_shader() -> Any:
    return build_shader(
        "keep seen",
        FULL_SCREEN,
        VIEW,
        TABLE,
        CHOSEN_MIRRORS,
        Piece(
            samplers=named("FLOAT_2D", *SEEN),
            defines={"SERVES_NONE": SERVES_NONE, "SHOWS_SEVERAL": SHOWS_SEVERAL, "HOLE": HOLE},
            outputs=named("VEC4", "shown_out", "tint_out"),
            fragment="reuse/keep_seen.frag.glsl",
        ),
    )


@gpu_cache
def _shown_shader(on_path: bool) -> Any:
    return build_shader(
        "keep shown",
        FULL_SCREEN,
        CHOSEN_MIRRORS,
        Piece(
            samplers={
                **named("FLOAT_2D", "seen_color", "reflected_position"),
                **({"path_depth": "DEPTH_2D"} if on_path else {}),
            },
            constants={"share": "FLOAT"},
            defines=flags("ON_PATH") if on_path else {},
            outputs={"shown_out": "VEC4"},
            fragment="reuse/keep_shown.frag.glsl",
        ),
    )
