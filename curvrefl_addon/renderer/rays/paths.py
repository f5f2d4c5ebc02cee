# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact method: every mirror pixel follows its own reflected ray, from mirror to mirror, to what it shows.

A pass takes mirror pixels of one surface buffer to the surfaces that their rays hit; where these are mirrors again the
next pass goes on from them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import empty_texture
from ..surfaces.materials import TABLE, Materials
from ..surfaces.pixel_classes import CHOSEN_MIRRORS
from ..surfaces.surface_buffer import SURFACE_OUTPUTS, SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window
from .escapes import ESCAPES
from .material_pass import Hits, MaterialPass
from .ray_scene import RAYS, RayScene

PATH_DEPTH = 0.5
"""Of pixels whose rays are followed; exact in any depth buffer"""

type Enclosing = tuple[float, float]
"""Number of a closed mirror that holds the eye, and how far in from its surface rays start, meters"""
IN_THE_OPEN: Enclosing = (0.0, 0.0)
"""No mirror holds the eye"""


class PathBuffer(SurfaceBuffer):
    """Where rays have gone. `position` of what is infinitely far away is its direction, with w = 0; `color` has the
    number of the mirror that was hit."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__(width, height)
        self.direction = empty_texture(width, height)
        """xyz unit direction of the ray, nodes of hierarchies that it met"""
        self.throughput = empty_texture(width, height, "RGBA16F")
        """Product of the mirrors' reflectance on the way"""
        self.before: Any = None
        """xyz where the ray set out to what it has met last, how many surfaces it has met; made for what goes on at
        once"""
        self._mask = frame_buffer(depth=self.depth)
        self.hits: Any = None
        """What was hit (`packed_hit` in `ray_surface.glsl`); made for programs of materials, and where it is kept"""
        self._frame_buffers: dict[tuple[bool, bool, bool], Any] = {}
        """With hits or without; with direction and throughput, or with `before` and throughput, or without"""
        self._pass = MaterialPass(width, height)

    def follow(
        self,
        mirrors: SurfaceBuffer,
        rays: RayScene,
        materials: Materials,
        view_uniforms: Any,
        window: Window,
        enclosing: Enclosing,
        goes_on: bool = True,
        with_counts: bool = False,
        chosen: Any = None,
        turn: tuple[int, int] = (0, 0),
        most_hits: int = 1,
        keeps_hits: bool = False,
    ) -> None:
        """Follow the rays off the mirrors that `mirrors` sees, or where that is a PathBuffer off those that it has hit.

        With `most_hits` above 1 rays go on from mirror to mirror at once, to the first surface that is none, or the
        last of so many: `before` says from where, `throughput` has all mirrors but the first, and the number of `color`
        is 1 where it was not the first surface. None of these mirrors has a program, and none holds the eye.

        `window` holds all of their pixels. `depth` is less than 1 where there was a ray to follow, and only there is
        anything in the other textures; in `direction` and `throughput` only if it `goes_on` from here, or has come from
        a PathBuffer. `with_counts`: `direction` gets what each ray was tested against in place of its direction: nodes,
        triangles, instances, and 1 where there is a ray. `chosen`: record texture by mirrors' numbers, 1 of those whose
        rays are followed; None is all. `enclosing`: the mirror in which all rays are, if any. `turn`: numbers of
        the sub-frame and of the bounce. With `keeps_hits` there is `hits`, whatever the materials.
        """
        path = mirrors if isinstance(mirrors, PathBuffer) else None
        with_hits = materials.has_programs or keeps_hits
        if with_hits and self.hits is None:
            self.hits = empty_texture(self.width, self.height)
        if window[2] <= 0 or window[3] <= 0:
            return
        self._find_mirrors(mirrors, window, chosen)
        keeps_way = goes_on or with_counts or path is not None
        at_once = most_hits > 1
        shader = _exact_shader(
            path is not None,
            with_hits,
            keeps_way,
            with_counts,
            materials.links,
            at_once,
            rays.escapes.are_known,
        )
        with drawing_state("EQUAL"), self._frame_buffer_for(with_hits, keeps_way, at_once).bind(), scissored(window):
            set_viewport(0, 0, self.width, self.height)
            shader.bind()
            rays.bind(shader)
            if rays.escapes.are_known:
                rays.escapes.bind(shader)
            shader.uniform_sampler("materials", materials.table)
            shader.uniform_sampler("mirror_position", mirrors.position)
            shader.uniform_sampler("mirror_normal", mirrors.normal)
            shader.uniform_sampler("mirror_color", mirrors.color)
            shader.uniform_float("enclosing", (*enclosing, 0.0 if goes_on else 1.0))
            if at_once:
                shader.uniform_float("most_hits", float(most_hits))
            if path is None:
                shader.uniform_block("view", view_uniforms)
            else:
                shader.uniform_sampler("path_direction", path.direction)
                shader.uniform_sampler("path_throughput", path.throughput)
            full_screen_triangle().draw(shader)
        if materials.has_programs:
            followed = (self.depth, PATH_DEPTH)
            before = self.before if at_once else mirrors.position
            hits = Hits(self.position, self.normal, self.color, self.hits, before, counts_hits=at_once)
            self._pass.draw(hits, self.made, followed, rays, materials, view_uniforms, window, turn)

    def _frame_buffer_for(self, with_hits: bool, keeps_way: bool, at_once: bool) -> Any:
        if at_once and self.before is None:
            self.before = empty_texture(self.width, self.height)
        if (with_hits, keeps_way, at_once) not in self._frame_buffers:
            textures = [self.position, self.normal, self.color]
            textures += [self.hits] if with_hits else []
            textures += [self.direction, self.throughput] if keeps_way else []
            textures += [self.before, self.throughput] if at_once else []
            self._frame_buffers[with_hits, keeps_way, at_once] = frame_buffer(*textures, depth=self.depth)
        return self._frame_buffers[with_hits, keeps_way, at_once]

    def _find_mirrors(self, mirrors: SurfaceBuffer, window: Window, chosen: Any) -> None:
        on_path = isinstance(mirrors, PathBuffer)
        shader = _mask_shader(on_path, chosen is not None)
        with drawing_state("ALWAYS", depth_write=True), self._mask.bind(), scissored(window):
            set_viewport(0, 0, self.width, self.height)
            shader.bind()
            shader.uniform_sampler("surface_color", mirrors.color)
            if on_path:
                shader.uniform_sampler("surface_depth", mirrors.depth)
            if chosen is not None:
                shader.uniform_sampler("chosen_mirrors", chosen)
            full_screen_triangle().draw(shader)


@dataclass(frozen=True, slots=True)
class Bounce:
    """One step of the rays' ways."""

    mirrors: SurfaceBuffer
    """Has the mirrors that they leave"""
    path: PathBuffer
    """Where they get to"""
    window: Window
    """Holds the mirrors' pixels"""
    goes_on: bool
    """Another step follows the rays off mirrors that were hit"""
    ends: bool
    """The file follows no more mirrors: what was hit shows its own light alone"""


ON_PATHS = Piece(
    inputs={"pos": "VEC2"}, defines={"PATH_DEPTH": PATH_DEPTH}, vertex="rays/full_screen_of_paths.vert.glsl"
)
"""A full-screen triangle where PathBuffers have followed rays; test depth for equality"""
AT_ONCE = Piece(constants={"most_hits": "FLOAT"}, defines=flags("AT_ONCE"))
"""Rays go on from mirror to mirror in one pass"""


@gpu_cache
def _mask_shader(on_path: bool, with_choice: bool) -> Any:
    path = Piece(samplers={"surface_depth": "DEPTH_2D"}, defines=flags("ON_PATH"))
    return build_shader(
        "path mask",
        FULL_SCREEN,
        Piece(
            samplers={"surface_color": "FLOAT_2D"},
            defines={"PATH_DEPTH": PATH_DEPTH},
            writes_depth=True,
            fragment="rays/path_mask.frag.glsl",
        ),
        *((path,) if on_path else ()),
        *((CHOSEN_MIRRORS,) if with_choice else ()),
    )


@gpu_cache
def _exact_shader(
    on_path: bool,
    with_hits: bool,
    keeps_way: bool,
    with_counts: bool,
    links: frozenset[str],
    at_once: bool,
    knows_escapes: bool,
) -> Any:
    way = Piece(samplers=named("FLOAT_2D", "path_direction", "path_throughput"), defines=flags("ON_PATH"))
    hits = Piece(outputs={"hit_out": "VEC4"}, defines=flags("WITH_HITS"))
    kept = Piece(outputs=named("VEC4", "direction_out", "throughput_out"), defines=flags("KEEPS_WAY"))
    whole = Piece(outputs=named("VEC4", "before_out", "throughput_out"))
    return build_shader(
        "exact",
        ON_PATHS,
        RAYS,
        TABLE,
        Piece(
            samplers=named("FLOAT_2D", "mirror_position", "mirror_normal", "mirror_color"),
            constants={"enclosing": "VEC3"},
            defines=flags(*(("WITH_COUNTS",) if with_counts else ()), *sorted(links)),
            fragment="rays/exact.frag.glsl",
        ),
        way if on_path else VIEW,
        SURFACE_OUTPUTS,
        *((hits,) if with_hits else ()),
        *((kept,) if keeps_way else ()),
        *((AT_ONCE, whole) if at_once else ()),
        *((ESCAPES,) if knows_escapes else ()),
    )
