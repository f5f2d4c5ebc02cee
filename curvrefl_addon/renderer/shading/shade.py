# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shade pass: surface buffers in, scene-linear radiance out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import gpu

from ....gpu_shaders.loader import load
from ...scene.arrays import SceneArrays
from ..device.gpu_objects import drawing_state, full_screen_triangle, scissored
from ..lighting.lighting import SAMPLER_COUNT, Features, Lighting
from ..rays.paths import Bounce, declare_path
from ..rays.ray_scene import RayScene
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.pixel_classes import PixelClass, PixelClasses, declare_class
from ..surfaces.surfaces import SurfaceBuffer, Window
from ..surfaces.view_block import TYPEDEF
from .lookup import Environment, declare

_SEEN = ("seen_position", "seen_normal", "seen_color")
_REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")
_PATH = ("mirror_position", "path_direction", "path_throughput")
RAY_SHADOWS = "RAY_SHADOWS"
"""Beside the features of lighting: lamps' shadows by rays"""
_SHADOWS = frozenset({"LIGHTING_MAPS", "LIGHTING_CUBES"})
MOST_SIZES = 4
"""Sizes of pictures whose targets are kept"""


class ShadePass:
    """Lights surface buffers of one scene."""

    def __init__(self, scene: SceneArrays, lighting: Lighting, materials: Materials) -> None:
        self._lighting = lighting
        self._materials = materials
        self._classes: dict[tuple[int, int], PixelClasses] = {}
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        self._has_bodies = any(
            light.kind != "SUN" and (light.radius > 0.0 or light.kind == "AREA") for light in scene.lights
        )
        self._has_base = any(
            not scene.materials[index].glossy_only
            and (scene.materials[index].metallic < 1.0 or max(scene.materials[index].emission) > 0.0)
            for instance in scene.instances
            if instance.object_id in scene.reflectors
            for index in instance.materials
        )

    def add(
        self,
        canvas: Canvas,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        view_uniforms: Any,
        weight: float,
        mirrors: Window | None = None,
        later: Iterator[Bounce] | None = None,
        shadows: RayScene | None = None,
        chosen: Any = None,
        with_others: bool = True,
    ) -> None:
        """Add the lit picture of `seen`, times `weight`, to a picture of its size.

        `reflected` is the reflected scene's surface buffer, or for each mirror the environment that stands for it; None
        where mirrors show the background alone. With `mirrors`, a window that holds all of them, no other pixel is
        touched. With `later`, `reflected` is a PathBuffer, and these are the bounces after it. With `shadows`, these
        rays shadow what mirrors show. `chosen`: record texture by mirrors' numbers, 1 of those that are lit, None for
        all; `with_others`: what is no mirror is, too.
        """
        mirrors_only = mirrors is not None or not with_others
        if mirrors is not None and (mirrors[2] <= 0 or mirrors[3] <= 0):
            return
        classes = self._classes_for(seen)
        classes.sort(
            seen, reflected if isinstance(reflected, SurfaceBuffer) else None, mirrors, later is not None, chosen
        )
        target = canvas.with_depth(classes.depth)
        with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"), target.bind(), scissored(mirrors):
            gpu.state.viewport_set(0, 0, seen.width, seen.height)
            self._add_light(seen, reflected, view_uniforms, weight, mirrors_only, shadows)
            self._add_front(seen, view_uniforms, weight, mirrors_only)
        for bounce in later or ():
            self._add_path(canvas, bounce, view_uniforms, weight, shadows)

    def _add_light(
        self,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        view_uniforms: Any,
        weight: float,
        mirrors_only: bool,
        shadows: RayScene | None,
    ) -> None:
        """Background and surfaces, seen directly or in mirrors."""
        kinds = [PixelClass.MIRROR] if isinstance(reflected, SurfaceBuffer) or not reflected else []
        if not mirrors_only:
            kinds += [PixelClass.BACKGROUND, PixelClass.SURFACE]
        for kind in kinds:
            self._draw(_shade_shader(kind, self._lighting.features), kind, seen, view_uniforms, weight)
        if isinstance(reflected, SurfaceBuffer):
            for kind in (PixelClass.MIRROR_OF_SURFACE, PixelClass.MIRROR_OF_MIRROR):
                shader = _shade_shader(kind, self._features(shadows))
                shader.bind()
                if shadows is not None and RAY_SHADOWS in self._features(shadows):
                    shadows.bind(shader)
                textures = (reflected.position, reflected.normal, reflected.color)
                for name, texture in zip(_REFLECTED, textures, strict=True):
                    shader.uniform_sampler(name, texture)
                self._draw(shader, kind, seen, view_uniforms, weight)
            return
        for environment in reflected or ():
            shader = _environment_shader(environment.lookup, self._lighting.features)
            shader.bind()
            shader.uniform_float("mirror", float(environment.mirror))
            environment.bind(shader, environment.radiance)
            self._draw(shader, PixelClass.MIRROR, seen, view_uniforms, weight)

    def _add_front(self, seen: SurfaceBuffer, view_uniforms: Any, weight: float, mirrors_only: bool) -> None:
        """What adds to that in some scenes only (see `shade_front.frag.glsl`)."""
        mirrors = (PixelClass.MIRROR, PixelClass.MIRROR_OF_SURFACE, PixelClass.MIRROR_OF_MIRROR)
        if self._has_base:
            for kind in mirrors:
                self._draw(_front_shader(True, self._lighting.features), kind, seen, view_uniforms, weight)
        if mirrors_only:
            return
        kinds: list[PixelClass] = []
        if self._has_bodies:
            # (The background has shown all lamps.)
            others = {PixelClass.BACKGROUND, *(mirrors if self._has_base else ())}
            kinds = [kind for kind in PixelClass if kind not in others]
        for kind in kinds:
            self._draw(_front_shader(False, self._lighting.features), kind, seen, view_uniforms, weight)

    def _features(self, shadows: RayScene | None) -> Features:
        """Of the lighting, for what mirrors show."""
        features = self._lighting.features
        # Without anything in shadow there is no ray to follow.
        return features | {RAY_SHADOWS} if shadows is not None and features & _SHADOWS else features

    def _add_path(
        self, canvas: Canvas, bounce: Bounce, view_uniforms: Any, weight: float, shadows: RayScene | None
    ) -> None:
        """Add the light of what rays off mirrors seen in mirrors have hit."""
        features = self._features(shadows)
        shader = _path_shader(bounce.goes_on, features)
        path = bounce.path
        target = canvas.with_depth(path.depth)
        with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"), target.bind(), scissored(bounce.window):
            gpu.state.viewport_set(0, 0, path.width, path.height)
            shader.bind()
            if shadows is not None and RAY_SHADOWS in features:
                shadows.bind(shader)
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("weight", weight)
            shader.uniform_sampler("materials", self._materials.table)
            textures = (bounce.mirrors.position, path.direction, path.throughput)
            for name, texture in zip(_PATH, textures, strict=True):
                shader.uniform_sampler(name, texture)
            for name, texture in zip(_REFLECTED, (path.position, path.normal, path.color), strict=True):
                shader.uniform_sampler(name, texture)
            self._lighting.bind(shader)
            full_screen_triangle().draw(shader)

    def _draw(self, shader: Any, kind: PixelClass, seen: SurfaceBuffer, view_uniforms: Any, weight: float) -> None:
        """A full-screen triangle for the pixels of one class."""
        shader.bind()
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("weight", weight)
        shader.uniform_float("pixel_class", float(kind))
        shader.uniform_sampler("materials", self._materials.table)
        for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
            shader.uniform_sampler(name, texture)
        self._lighting.bind(shader)
        full_screen_triangle().draw(shader)

    def _classes_for(self, seen: SurfaceBuffer) -> PixelClasses:
        size = (seen.width, seen.height)
        if size not in self._classes:
            while len(self._classes) >= MOST_SIZES:
                del self._classes[next(iter(self._classes))]
            self._classes[size] = PixelClasses(*size)
        return self._classes[size]


def _info() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(TYPEDEF)
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.uniform_buf(0, "ViewBlock", "view")
    info.push_constant("FLOAT", "weight")
    info.sampler(0, "FLOAT_2D", "materials")
    for slot, name in enumerate(_SEEN, 1):
        info.sampler(slot, "FLOAT_2D", name)
    declare_class(info)
    return info


def _declare_lighting(info: Any, slot: int, features: Features) -> None:
    """With the rays that shadow, where these are among the features."""
    Lighting.declare(info, slot, features)
    if RAY_SHADOWS in features:
        RayScene.declare(info, slot + SAMPLER_COUNT)


@cache
def _shade_shader(kind: PixelClass, features: Features) -> Any:
    """For a class of pixels, without environments."""
    info = _info()
    info.define(f"SHADES_{kind.name}")
    used = 4
    if kind in (PixelClass.MIRROR_OF_SURFACE, PixelClass.MIRROR_OF_MIRROR):
        for slot, name in enumerate(_REFLECTED, used):
            info.sampler(slot, "FLOAT_2D", name)
        used += len(_REFLECTED)
    _declare_lighting(info, used, features)
    info.fragment_source(load("lighting/shade.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _environment_shader(lookup: str, features: Features) -> Any:
    """For mirrors that show an environment, with the name of its lookup."""
    info = _info()
    info.push_constant("FLOAT", "mirror")
    source = declare(info, lookup, 4)
    Lighting.declare(info, 5, features)
    info.fragment_source(source + load("lighting/shade.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _path_shader(goes_on: bool, features: Features) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    declare_path(info)
    info.typedef_source(TYPEDEF)
    info.uniform_buf(0, "ViewBlock", "view")
    info.fragment_out(0, "VEC4", "color")
    info.push_constant("FLOAT", "weight")
    if goes_on:
        info.define("GOES_ON")
    names = ("materials", *_PATH, *_REFLECTED)
    for slot, name in enumerate(names):
        info.sampler(slot, "FLOAT_2D", name)
    _declare_lighting(info, len(names), features)
    info.fragment_source(load("lighting/shade_path.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _front_shader(has_base: bool, features: Features) -> Any:
    info = _info()
    if has_base:
        info.define("MIRROR_BASE")
    Lighting.declare(info, 4, features)
    info.fragment_source(load("lighting/shade_front.frag.glsl"))
    return gpu.shader.create_from_info(info)
