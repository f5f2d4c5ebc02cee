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
from .gpu_objects import drawing_state, full_screen_triangle
from .lighting import Lighting
from .materials import Materials
from .surfaces import SurfaceBuffer
from .view_block import TYPEDEF

_SEEN = ("seen_position", "seen_normal", "seen_color")
_REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")


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
        reflected: SurfaceBuffer | Sequence[Environment],
        view_uniforms: Any,
        weight: float,
        mirrors_only: bool = False,
    ) -> None:
        """Add the lit picture of `seen`, times `weight`, to the frame buffer `target`.

        `reflected` is the reflected scene's surface buffer, or for each mirror the environment that stands for it. With
        `mirrors_only` no other pixel is touched.
        """
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind():
            gpu.state.viewport_set(0, 0, seen.width, seen.height)
            self._add_light(target, seen, reflected, view_uniforms, weight, mirrors_only)
            if self._has_base or (self._has_bodies and not mirrors_only):
                self._add_front(target, seen, view_uniforms, weight, mirrors_only)

    def _add_light(
        self,
        _target: Any,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment],
        view_uniforms: Any,
        weight: float,
        mirrors_only: bool,
    ) -> None:
        """Light on surfaces, seen directly or in mirrors."""
        if isinstance(reflected, SurfaceBuffer):
            shader = self._bound(_shade_shader(""), seen, view_uniforms, weight)
            shader.uniform_float("mirrors_only", float(mirrors_only))
            textures = (reflected.position, reflected.normal, reflected.color)
            for name, texture in zip(_REFLECTED, textures, strict=True):
                shader.uniform_sampler(name, texture)
            full_screen_triangle().draw(shader)
            return
        for number, environment in enumerate(reflected, 1):
            shader = self._bound(_shade_shader(environment.lookup), seen, view_uniforms, weight)
            shader.uniform_float("mirrors_only", float(mirrors_only))
            shader.uniform_float("mirror", float(number))
            environment.bind(shader, environment.radiance)
            full_screen_triangle().draw(shader)

    def _add_front(
        self, _target: Any, seen: SurfaceBuffer, view_uniforms: Any, weight: float, mirrors_only: bool
    ) -> None:
        """What adds to that in some scenes only (see `shade_front.frag.glsl`)."""
        shader = self._bound(_front_shader(self._has_base), seen, view_uniforms, weight)
        shader.uniform_float("mirrors_only", float(mirrors_only))
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
    """With the name of an environment's lookup, or none for reflected surface buffers."""
    info = _info()
    source = ""
    if lookup:
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
def _front_shader(has_base: bool) -> Any:
    info = _info()
    if has_base:
        info.define("MIRROR_BASE")
    Lighting.declare(info, 4)
    info.fragment_source(load("shade_front.frag.glsl"))
    return gpu.shader.create_from_info(info)
