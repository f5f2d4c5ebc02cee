# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shade pass: surface buffers in, scene-linear radiance out."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import gpu

from ...gpu_shaders.loader import load
from ..scene.arrays import SceneArrays
from .environment import Environment, declare
from .exact import PathBuffer, Window
from .gpu_objects import drawing_state, full_screen_triangle, scissored
from .lighting import Lighting
from .materials import Materials
from .surfaces import SurfaceBuffer
from .view_block import TYPEDEF

_SEEN = ("seen_position", "seen_normal", "seen_color")
_REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")
_PATH = ("mirror_position", "mirror_color", "path_direction", "path_throughput")
_NO_MIRRORS = "no mirrors"


class ShadePass:
    """Lights surface buffers of one scene."""

    def __init__(self, scene: SceneArrays, lighting: Lighting, materials: Materials) -> None:
        self._lighting = lighting
        self._materials = materials
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        self._has_bodies = any(light.radius > 0.0 or light.kind in ("AREA", "SUN") for light in scene.lights)
        self._has_base = any(
            not scene.materials[index].glossy_only
            and (scene.materials[index].metallic < 1.0 or max(scene.materials[index].emission) > 0.0)
            for instance in scene.instances
            if instance.object_id in scene.reflectors
            for index in instance.materials
        )

    def add(
        self,
        target: Any,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        view_uniforms: Any,
        weight: float,
        mirrors_only: bool = False,
    ) -> None:
        """Add the lit picture of `seen`, times `weight`, to the frame buffer `target`.

        `reflected` is the reflected scene's surface buffer, or for each mirror the environment that stands for it, or
        None where `add_path` will add what mirrors show. With `mirrors_only` no other pixel is touched.
        """
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind():
            gpu.state.viewport_set(0, 0, seen.width, seen.height)
            if reflected is None:
                if not mirrors_only:
                    shader = self._bound(_shade_shader(_NO_MIRRORS), seen, view_uniforms, weight)
                    shader.uniform_float("mirrors_only", 0.0)
                    full_screen_triangle().draw(shader)
            elif isinstance(reflected, SurfaceBuffer):
                shader = self._bound(_shade_shader(""), seen, view_uniforms, weight)
                shader.uniform_float("mirrors_only", float(mirrors_only))
                textures = (reflected.position, reflected.normal, reflected.color)
                for name, texture in zip(_REFLECTED, textures, strict=True):
                    shader.uniform_sampler(name, texture)
                full_screen_triangle().draw(shader)
            else:
                for number, environment in enumerate(reflected, 1):
                    shader = self._bound(_shade_shader(environment.lookup), seen, view_uniforms, weight)
                    shader.uniform_float("mirrors_only", float(mirrors_only))
                    shader.uniform_float("mirror", float(number))
                    environment.bind(shader, environment.radiance)
                    full_screen_triangle().draw(shader)
            if self._has_base or (self._has_bodies and not mirrors_only):
                shader = self._bound(_front_shader(self._has_base), seen, view_uniforms, weight)
                shader.uniform_float("mirrors_only", float(mirrors_only))
                full_screen_triangle().draw(shader)

    def add_path(
        self,
        target: Any,
        mirrors: SurfaceBuffer,
        path: PathBuffer,
        view_uniforms: Any,
        weight: float,
        window: Window,
        is_first: bool,
        goes_on: bool,
    ) -> None:
        """Add the light of what rays off the `mirrors` have hit, times `weight`; `window` holds their pixels.

        `is_first`: these are the mirrors that the eye sees. `goes_on`: another pass follows the rays off mirrors hit.
        """
        if window[2] <= 0 or window[3] <= 0:
            return
        shader = _path_shader(goes_on)
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind(), scissored(window):
            gpu.state.viewport_set(0, 0, path.width, path.height)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("weight", weight)
            shader.uniform_float("alpha", float(is_first))
            shader.uniform_sampler("materials", self._materials.table)
            textures = (mirrors.position, mirrors.color, path.direction, path.throughput)
            for name, texture in zip(_PATH, textures, strict=True):
                shader.uniform_sampler(name, texture)
            for name, texture in zip(_REFLECTED, (path.position, path.normal, path.color), strict=True):
                shader.uniform_sampler(name, texture)
            self._lighting.bind(shader)
            full_screen_triangle().draw(shader)

    def _bound(self, shader: Any, seen: SurfaceBuffer, view_uniforms: Any, weight: float) -> Any:
        shader.bind()
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("weight", weight)
        shader.uniform_sampler("materials", self._materials.table)
        for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
            shader.uniform_sampler(name, texture)
        self._lighting.bind(shader)
        return shader


def _info() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(TYPEDEF)
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.uniform_buf(0, "ViewBlock", "view")
    info.push_constant("FLOAT", "weight")
    info.push_constant("FLOAT", "mirrors_only")
    info.sampler(0, "FLOAT_2D", "materials")
    for slot, name in enumerate(_SEEN, 1):
        info.sampler(slot, "FLOAT_2D", name)
    info.vertex_source(load("full_screen.vert.glsl"))
    return info


@cache
def _shade_shader(lookup: str) -> Any:
    """With the name of an environment's lookup, nothing for reflected surface buffers, or _NO_MIRRORS."""
    info = _info()
    source = ""
    if lookup == _NO_MIRRORS:
        info.define("NO_MIRRORS")
        used = 4
    elif lookup:
        info.push_constant("FLOAT", "mirror")
        source = declare(info, lookup, 4)
        used = 5
    else:
        for slot, name in enumerate(_REFLECTED, 4):
            info.sampler(slot, "FLOAT_2D", name)
        used = 7
    Lighting.declare(info, used)
    info.fragment_source(source + load("shade.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _path_shader(goes_on: bool) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(TYPEDEF)
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.uniform_buf(0, "ViewBlock", "view")
    info.push_constant("FLOAT", "weight")
    info.push_constant("FLOAT", "alpha")
    if goes_on:
        info.define("GOES_ON")
    names = ("materials", *_PATH, *_REFLECTED)
    for slot, name in enumerate(names):
        info.sampler(slot, "FLOAT_2D", name)
    Lighting.declare(info, len(names))
    info.vertex_source(load("full_screen.vert.glsl"))
    info.fragment_source(load("shade_path.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _front_shader(has_base: bool) -> Any:
    info = _info()
    if has_base:
        info.define("MIRROR_BASE")
    Lighting.declare(info, 4)
    info.fragment_source(load("shade_front.frag.glsl"))
    return gpu.shader.create_from_info(info)
