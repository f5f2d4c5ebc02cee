# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact method: every mirror pixel follows its own reflected ray, from mirror to mirror, to what it shows.

A pass takes mirror pixels of one surface buffer to the surfaces that their rays hit; where these are mirrors again the
next pass goes on from them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import gpu

from ....gpu_shaders.loader import load
from ..device.gpu_objects import drawing_state, full_screen_triangle, scissored
from ..surfaces.materials import Materials
from ..surfaces.surfaces import SurfaceBuffer, Window, declare_surface_outputs
from ..surfaces.view_block import TYPEDEF
from .ray_scene import RayScene

PATH_DEPTH = 0.5
"""Of pixels whose rays are followed; exact in any depth buffer"""
IMAGES_AT_ONCE = 8
"""As in exact_images.frag.glsl"""


class PathBuffer(SurfaceBuffer):
    """Where rays have gone. `position` of what is infinitely far away is its direction, with w = 0; `color` has the
    number of the mirror that was hit."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__(width, height)
        self.direction = gpu.types.GPUTexture((width, height), format="RGBA32F")
        """xyz unit direction of the ray, nodes of hierarchies that it met"""
        self.throughput = gpu.types.GPUTexture((width, height), format="RGBA16F")
        """Product of the mirrors' reflectance on the way"""
        for texture in (self.direction, self.throughput):
            texture.filter_mode(False)
        self._mask = gpu.types.GPUFrameBuffer(depth_slot=self.depth)
        self._uv: Any = None
        """uv of the base color image and its number, -1 for none; made where there are images"""
        self._frame_buffers: dict[bool, Any] = {}
        """With direction and throughput, or without"""
        self._color_alone = gpu.types.GPUFrameBuffer(depth_slot=self.depth, color_slots=(self.color,))

    def follow(
        self,
        mirrors: SurfaceBuffer,
        rays: RayScene,
        materials: Materials,
        view_uniforms: Any,
        window: Window,
        eye_is_inside: bool,
        goes_on: bool = True,
        with_counts: bool = False,
        chosen: Any = None,
    ) -> None:
        """Follow the rays off the mirrors that `mirrors` sees, or where that is a PathBuffer off those that it has hit.

        `window` holds all of their pixels. `depth` is less than 1 where there was a ray to follow, and only there is
        anything in the other textures; in `direction` and `throughput` only if it `goes_on` from here, or has come from
        a PathBuffer. `with_counts`: `direction` gets what each ray was tested against in place of its direction: nodes,
        triangles, instances, and 1 where there is a ray. `chosen`: record texture by mirrors' numbers, 1 of those whose
        rays are followed; None is all.
        """
        path = mirrors if isinstance(mirrors, PathBuffer) else None
        if materials.images and self._uv is None:
            self._uv = gpu.types.GPUTexture((self.width, self.height), format="RGBA32F")
            self._uv.filter_mode(False)
            self._frame_buffers = {}
        if window[2] <= 0 or window[3] <= 0:
            return
        self._find_mirrors(mirrors, window, chosen)
        keeps_way = goes_on or with_counts or path is not None
        shader = _exact_shader(path is not None, self._uv is not None, keeps_way, with_counts)
        with drawing_state("EQUAL"), self._frame_buffer_for(keeps_way).bind(), scissored(window):
            gpu.state.viewport_set(0, 0, self.width, self.height)
            shader.bind()
            rays.bind(shader)
            shader.uniform_sampler("materials", materials.table)
            shader.uniform_sampler("mirror_position", mirrors.position)
            shader.uniform_sampler("mirror_normal", mirrors.normal)
            shader.uniform_sampler("mirror_color", mirrors.color)
            if path is None:
                shader.uniform_block("view", view_uniforms)
                shader.uniform_float("eye_side", -1.0 if eye_is_inside else 1.0)
            else:
                shader.uniform_sampler("path_direction", path.direction)
                shader.uniform_sampler("path_throughput", path.throughput)
            full_screen_triangle().draw(shader)
        self._look_up_images(materials.images, window)

    def _frame_buffer_for(self, keeps_way: bool) -> Any:
        if keeps_way not in self._frame_buffers:
            textures = [self.position, self.normal, self.color]
            textures += [self._uv] if self._uv is not None else []
            textures += [self.direction, self.throughput] if keeps_way else []
            self._frame_buffers[keeps_way] = gpu.types.GPUFrameBuffer(
                depth_slot=self.depth, color_slots=tuple(textures)
            )
        return self._frame_buffers[keeps_way]

    def _find_mirrors(self, mirrors: SurfaceBuffer, window: Window, chosen: Any) -> None:
        on_path = isinstance(mirrors, PathBuffer)
        shader = _mask_shader(on_path, chosen is not None)
        with drawing_state("ALWAYS", depth_write=True), self._mask.bind(), scissored(window):
            gpu.state.viewport_set(0, 0, self.width, self.height)
            shader.bind()
            shader.uniform_sampler("surface_color", mirrors.color)
            if on_path:
                shader.uniform_sampler("surface_depth", mirrors.depth)
            if chosen is not None:
                shader.uniform_sampler("chosen_mirrors", chosen)
            full_screen_triangle().draw(shader)

    def _look_up_images(self, images: list[Any], window: Window) -> None:
        """Multiply the base colors by their images."""
        for first in range(0, len(images), IMAGES_AT_ONCE):
            shader = _images_shader()
            with drawing_state("EQUAL", blend="MULTIPLY"), self._color_alone.bind(), scissored(window):
                gpu.state.viewport_set(0, 0, self.width, self.height)
                shader.bind()
                shader.uniform_int("first_image", first)
                shader.uniform_sampler("path_uv", self._uv)
                group = images[first : first + IMAGES_AT_ONCE]
                for slot in range(IMAGES_AT_ONCE):
                    shader.uniform_sampler(f"image_{slot}", group[min(slot, len(group) - 1)])
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


def declare_path(info: Any) -> None:
    """Make a shader's full-screen triangle stand where PathBuffers have followed rays; test depth for equality."""
    info.vertex_in(0, "VEC2", "pos")
    info.define("PATH_DEPTH", str(PATH_DEPTH))
    info.vertex_source(load("rays/full_screen_of_paths.vert.glsl"))


@cache
def _mask_shader(on_path: bool, with_choice: bool) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "pos")
    info.define("PATH_DEPTH", str(PATH_DEPTH))
    info.sampler(0, "FLOAT_2D", "surface_color")
    if on_path:
        info.define("ON_PATH")
        info.sampler(1, "DEPTH_2D", "surface_depth")
    if with_choice:
        info.define("WITH_CHOICE")
        info.sampler(2, "FLOAT_2D", "chosen_mirrors")
    info.depth_write("ANY")
    info.vertex_source(load("common/full_screen.vert.glsl"))
    info.fragment_source(load("rays/path_mask.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _exact_shader(on_path: bool, with_images: bool, keeps_way: bool, with_counts: bool) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    declare_path(info)
    if with_counts:
        info.define("WITH_COUNTS")
    RayScene.declare(info, 0)
    names = ["materials", "mirror_position", "mirror_normal", "mirror_color"]
    if on_path:
        info.define("ON_PATH")
        names += ["path_direction", "path_throughput"]
    else:
        info.typedef_source(TYPEDEF)
        info.uniform_buf(0, "ViewBlock", "view")
        info.push_constant("FLOAT", "eye_side")
    for slot, name in enumerate(names, 1):
        info.sampler(slot, "FLOAT_2D", name)
    declare_surface_outputs(info)
    slot = 3
    if with_images:
        info.define("WITH_IMAGES")
        info.fragment_out(slot, "VEC4", "uv_out")
        slot += 1
    if keeps_way:
        info.define("KEEPS_WAY")
        info.fragment_out(slot, "VEC4", "direction_out")
        info.fragment_out(slot + 1, "VEC4", "throughput_out")
    info.fragment_source(load("rays/exact.frag.glsl"))
    return gpu.shader.create_from_info(info)


@cache
def _images_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.define("IMAGES", str(IMAGES_AT_ONCE))
    declare_path(info)
    info.fragment_out(0, "VEC4", "color")
    info.push_constant("INT", "first_image")
    info.sampler(0, "FLOAT_2D", "path_uv")
    for slot in range(IMAGES_AT_ONCE):
        info.sampler(1 + slot, "FLOAT_2D", f"image_{slot}")
    info.fragment_source(load("rays/exact_images.frag.glsl"))
    return gpu.shader.create_from_info(info)
