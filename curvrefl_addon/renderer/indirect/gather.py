# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Final gather: a ray for each pixel and sub-frame from what it shows to the surfaces that send light there.

Where it gets to the light of patches is looked up (Reichert, "A two-pass radiosity method driven by lights and viewer
position", 1992); lobes see that lit as what mirrors show, as edges are seen in them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...optics.scattering.sampler import path_point
from ..cells.lookup import At
from ..device.batches import full_screen_triangle
from ..device.frame_buffers import FrameBuffers, frame_buffer
from ..device.shaders import flags, knows
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..lighting.lighting import Features, Lighting
from ..programs.buffers import MaterialBuffers
from ..rays.material_pass import Hits, MaterialPass
from ..rays.ray_scene import RayScene
from ..surfaces.by_size import BySize
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.pixel_classes import CLASS_COUNT
from ..surfaces.surface_buffer import SURFACE_SAMPLERS, SurfaceBuffer
from ..surfaces.windows import Window
from .emitters import Emitters
from .gather_shaders import (
    LANES,
    Kind,
    Source,
    classes_shader,
    gather_shader,
    kinds_shader,
    lane_of,
    light_shader,
)
from .irradiance import Irradiance

NO_FEATURES: Features = frozenset()
GATHERED, SKY_GATHERED, ASKS_EMITTERS = "GATHERED", "SKY_GATHERED", "ASKS_EMITTERS"
"""Among `Gathering.features`: what rays find needs no light of patches, and no directions of the world; some rays go to
where light comes from"""
GATHER_BOUNCE = 61
"""Number of the random numbers of these rays, among those of paths' bounces"""
LARGEST = 1e30
MOST_SIZES = 3
"""Of pictures whose targets are kept"""
MOST_DEPTHS = 8
"""Frame buffers that each keeps"""


@dataclass(frozen=True, slots=True)
class SharedGather:
    """Light of rays that pixels share."""

    by: Gathering
    light: Any
    way: Any
    lane: tuple[int, int]
    by_quads: bool
    """One for each quad of pixels, else one for each"""

    def bind(self, shader: Any) -> None:
        """Set what `shared_piece` names, and the light of patches."""
        shader.uniform_sampler("gather_light", self.light)
        shader.uniform_sampler("gather_way", self.way)
        shader.uniform_int("share_turn", self.by.sub_frame)
        if self.by_quads:
            shader.uniform_int("lane", self.lane)
        if self.by.irradiance is not None:
            self.by.irradiance.bind(shader, At.ENDS_UNDER_SKY if self.by.has_sky else At.ENDS)


@dataclass(frozen=True, slots=True)
class Gathering:
    """What sub-frames of one picture gather by."""

    irradiance: Irradiance | None
    """None where light bounces off no surface"""
    emitters: Emitters | None
    has_sky: bool
    """The world is among what rays find, in place of its directions' shadows"""
    pool: BySize[GatherPicture]
    rays: RayScene
    materials: Materials
    lighting: Lighting
    view_uniforms: Any
    sub_frame: int
    has_caustics: bool = True
    """What reflects takes part in the light that goes on from surface to surface"""
    clamp: float = 0.0
    """The most that a ray which has met a surface brings, mean of red, green and blue; 0: any"""

    @property
    def features(self) -> Features:
        """Beside those of the lighting."""
        names = {
            GATHERED: self.irradiance is not None,
            SKY_GATHERED: self.has_sky,
            ASKS_EMITTERS: self.emitters is not None,
        }
        return frozenset(name for name, is_so in names.items() if is_so)

    def shared(self, seen: SurfaceBuffer) -> SharedGather:
        """Rays of what the eye sees itself, one for each quad of pixels."""
        picture = self.picture((seen.width + 1) // 2, (seen.height + 1) // 2, None)
        return picture.share(self, Source.SEEN, (seen.position, seen.normal, seen.color), seen.made)

    def picture(self, width: int, height: int, window: Window | None) -> GatherPicture:
        """To begin with, without any ray."""
        picture = self.pool.of(width, height)
        picture.begin(window, self.materials.has_programs)
        return picture


def features_of(gathers: Gathering | None) -> Features:
    """Of what is left to rays."""
    return NO_FEATURES if gathers is None else gathers.features


class GatherPicture:
    """What rays have met, one for each pixel."""

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._position, self._normal = empty_texture(width, height), empty_texture(width, height)
        self._color = empty_texture(width, height, "RGBA16F")
        self._way, self._weight = empty_texture(width, height), empty_texture(width, height)
        self._made = MaterialBuffers(width, height)
        self._hits: Any = None
        self._depth = depth_texture(width, height)
        self._classes = frame_buffer(depth=self._depth)
        self._weights = frame_buffer(self._weight)
        self._frame_buffers = self._made_frame_buffers()
        self._pass = MaterialPass(width, height)
        self._window: Window | None = None
        self._light: Canvas | None = None
        """Made where pixels share rays"""

    def begin(self, window: Window | None, has_programs: bool) -> None:
        self._window = window
        if has_programs != (self._hits is not None):
            self._hits = empty_texture(self.width, self.height) if has_programs else None
            self._frame_buffers = self._made_frame_buffers()
        with self._weights.bind():
            self._weights.clear(color=(0.0, 0.0, 0.0, 0.0))

    def follow(
        self,
        by: Gathering,
        source: Source,
        surface: tuple[Any, Any, Any],
        made: MaterialBuffers,
        others: tuple[Any, ...],
        classes: tuple[Any, float] | None,
        skips_mirrors: bool = False,
        shares: bool = False,
    ) -> None:
        """Follow rays from a class of pixels. `surface`: position, normal and color there; `others`: as `source` names
        them; `classes`: depth texture, and the class over CLASS_COUNT; None: all pixels. With
        `skips_mirrors` rays off mirrors go on in another pass. `shares`: see `share`."""
        lighting, materials = by.lighting, by.materials
        by_quads = shares and source is Source.SEEN
        variant = flags(*(("IS_SHARED",) if shares else ()), *(("SHARED_BY_QUADS",) if by_quads else ()))
        shader = gather_shader(
            source,
            frozenset(variant),
            materials.buffers,
            lighting.features,
            self._hits is not None,
            by.emitters is not None,
        )
        depth = None if classes is None else classes[0]
        test = "NONE" if classes is None else "EQUAL"
        with drawing_state(test), self._frame_buffers.with_depth(depth).bind(), scissored(self._window):
            set_viewport(0, 0, self.width, self.height)
            shader.bind()
            by.rays.bind(shader)
            shader.uniform_block("view", by.view_uniforms)
            if classes is not None:
                shader.uniform_float("pixel_class", classes[1] * CLASS_COUNT)
            if source is Source.SEEN:
                shader.uniform_int("lane", lane_of(by.sub_frame))
            if source is Source.LATER:
                shader.uniform_float("skips_mirrors", float(skips_mirrors))
            # (A pixel of a quad has its turn once in four sub-frames, and a sequence of its own: every fourth number of
            # one is not spread evenly.)
            turns = LANES if by_quads else 1
            number, count = by.sub_frame // turns, -(-lighting.sub_frames // turns)
            shader.uniform_int("path_point", path_point(number, GATHER_BOUNCE, count))
            shader.uniform_sampler("materials", materials.table)
            shader.uniform_sampler("lighting_ggx", lighting.ggx)
            for name, texture in zip((*SURFACE_SAMPLERS, *source.value), (*surface, *others), strict=True):
                shader.uniform_sampler(name, texture)
            made.bind(shader, materials.buffers)
            if by.emitters is not None:
                by.emitters.bind(shader)
            full_screen_triangle().draw(shader)

    def share(
        self,
        by: Gathering,
        source: Source,
        surface: tuple[Any, Any, Any],
        made: MaterialBuffers,
        others: tuple[Any, ...] = (),
        classes: tuple[Any, float] | None = None,
    ) -> SharedGather:
        """Follow and light rays that pixels share when they are lit: as for `follow`; those of what the eye sees itself
        one for each quad of a picture of twice the size."""
        if self._light is None:
            self._light = Canvas.of_size(self.width, self.height)
        self.follow(by, source, surface, made, others, classes, shares=True)
        with drawing_state(), self._light.frame_buffer.bind():
            set_viewport(0, 0, self.width, self.height)
            shader = kinds_shader()
            shader.bind()
            shader.uniform_sampler("gather_weight", self._weight)
            full_screen_triangle().draw(shader)
        self.add(by, self._light, 1.0, is_shared=True)
        return SharedGather(by, self._light.texture, self._way, lane_of(by.sub_frame), source is Source.SEEN)

    def add(self, by: Gathering, canvas: Canvas, weight: float, is_shared: bool = False) -> None:
        """Add the light of all rays, times `weight`. `is_shared`: see `share`."""
        materials = by.materials
        with drawing_state("ALWAYS", depth_write=True), self._classes.bind(), scissored(self._window):
            set_viewport(0, 0, self.width, self.height)
            shader = classes_shader()
            shader.bind()
            shader.uniform_sampler("gather_weight", self._weight)
            shader.uniform_sampler("vertex_position", self._position)
            full_screen_triangle().draw(shader)
        if self._hits is not None:
            window = self._window or (0, 0, self.width, self.height)
            hits = Hits(self._position, self._normal, self._color, self._hits, None, self._way, is_gathered=True)
            turn = (by.sub_frame, GATHER_BOUNCE)
            self._pass.draw(hits, self._made, (self._depth, -1.0), by.rays, materials, by.view_uniforms, window, turn)
        target = canvas.with_depth(self._depth)
        blend = "NONE" if is_shared else "ADDITIVE_PREMULT"
        with drawing_state("EQUAL", blend=blend), target.bind(), scissored(self._window):
            set_viewport(0, 0, self.width, self.height)
            for kind in self._kinds(by):
                features, has_patches = by.lighting.features, by.irradiance is not None
                shader = light_shader(
                    kind, materials.buffers, features, by.emitters is not None, has_patches, is_shared
                )
                shader.bind()
                shader.uniform_float("pixel_class", float(kind))
                if not is_shared:
                    shader.uniform_float("weight", weight)
                if knows(shader, "has_caustics"):
                    shader.uniform_float("has_caustics", float(by.has_caustics))
                if knows(shader, "clamp_most"):
                    shader.uniform_float("clamp_most", by.clamp or LARGEST)
                shader.uniform_sampler("materials", materials.table)
                for name, texture in zip(SURFACE_SAMPLERS, (self._position, self._normal, self._color), strict=True):
                    shader.uniform_sampler(name, texture)
                shader.uniform_sampler("path_way", self._way)
                shader.uniform_sampler("gather_weight", self._weight)
                shader.uniform_block("view", by.view_uniforms)
                self._made.bind(shader, materials.buffers)
                by.lighting.bind(shader)
                if by.irradiance is not None:
                    by.irradiance.bind(shader, At.HITS if kind is Kind.BASE_MEETS else At.ENDS)
                if by.emitters is not None:
                    by.emitters.bind_densities(shader)
                full_screen_triangle().draw(shader)

    @staticmethod
    def _kinds(by: Gathering) -> list[Kind]:
        """That bring light."""
        kinds = [Kind.BASE_MEETS, Kind.LOBE_MEETS]
        if by.emitters is not None:
            kinds.append(Kind.SHINES)
        if by.irradiance is not None:
            kinds.append(Kind.LOBE_MISSES)
        if by.has_sky:
            kinds.append(Kind.BASE_MISSES)
        return kinds

    def _made_frame_buffers(self) -> FrameBuffers:
        hits = [] if self._hits is None else [self._hits]
        textures = (self._position, self._normal, self._color, *hits, self._way, self._weight)
        return FrameBuffers(*textures, most=MOST_DEPTHS)


def gather_pool() -> BySize[GatherPicture]:
    return BySize(GatherPicture, MOST_SIZES)
