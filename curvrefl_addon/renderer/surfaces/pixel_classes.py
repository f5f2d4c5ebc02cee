# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each pixel of a sub-frame shows, as a depth buffer, so that a shader runs only where it has something to do.

There is no stencil, and many drivers (a software renderer among them) run all branches of a shader. A full-screen
triangle at the depth of its class is tested before its shader runs.
"""

from __future__ import annotations

from enum import IntEnum
from functools import cache
from typing import Any

import gpu

from ....gpu_shaders.loader import load
from ..device.gpu_objects import drawing_state, full_screen_triangle, scissored
from .surfaces import SurfaceBuffer, Window

CLASS_COUNT = 8
"""A power of two: the depths of classes are exact"""


class PixelClass(IntEnum):
    """What there is to light at a pixel."""

    NOTHING = 0
    """A hole in the picture"""
    BACKGROUND = 1
    SURFACE = 2
    """Seen directly, no mirror"""
    MIRROR = 3
    """One that shows the background, or whose environment stands for all it shows"""
    MIRROR_OF_SURFACE = 4
    MIRROR_OF_MIRROR = 5
    """One that shows a mirror, whose own reflection is to follow"""


class PixelClasses:
    """Targets of the size of a picture."""

    def __init__(self, width: int, height: int) -> None:
        self.depth = gpu.types.GPUTexture((width, height), format="DEPTH_COMPONENT32F")
        """The classes"""
        self.frame_buffer = gpu.types.GPUFrameBuffer(depth_slot=self.depth)
        self.width, self.height = width, height

    def sort(
        self,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | None,
        window: Window | None = None,
        tells_mirrors: bool = False,
        chosen: Any = None,
    ) -> None:
        """Find the class of every pixel in `window`; `reflected` has what mirrors show, if surfaces. With
        `tells_mirrors` its alpha is the number of a mirror, or 0 for other surfaces. `chosen`: record texture by
        mirrors' numbers, 1 of those that count; pixels of others are NOTHING, and None is all."""
        shader = _shader(reflected is not None, tells_mirrors, chosen is not None)
        with drawing_state("ALWAYS", depth_write=True), self.frame_buffer.bind(), scissored(window):
            gpu.state.viewport_set(0, 0, self.width, self.height)
            shader.bind()
            shader.uniform_sampler("seen_color", seen.color)
            if reflected is not None:
                shader.uniform_sampler("reflected_position", reflected.position)
            if reflected is not None and tells_mirrors:
                shader.uniform_sampler("reflected_color", reflected.color)
            if chosen is not None:
                shader.uniform_sampler("chosen_mirrors", chosen)
            full_screen_triangle().draw(shader)


def declare_class(info: Any) -> None:
    """Make a shader's full-screen triangle stand at the depth of the push constant `pixel_class`."""
    info.push_constant("FLOAT", "pixel_class")
    info.define("CLASS_COUNT", f"{CLASS_COUNT}.0")
    info.vertex_source(load("surfaces/full_screen_of_class.vert.glsl"))


@cache
def _shader(shows_surfaces: bool, tells_mirrors: bool, with_choice: bool) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "pos")
    info.depth_write("ANY")
    info.define("CLASS_COUNT", f"{CLASS_COUNT}.0")
    for kind in PixelClass:
        info.define(kind.name, f"{kind.value}.0")
    names = ["seen_color"]
    if shows_surfaces:
        info.define("SHOWS_SURFACES")
        names.append("reflected_position")
    if shows_surfaces and tells_mirrors:
        info.define("TELLS_MIRRORS")
        names.append("reflected_color")
    if with_choice:
        info.define("WITH_CHOICE")
        names.append("chosen_mirrors")
    for slot, name in enumerate(names):
        info.sampler(slot, "FLOAT_2D", name)
    info.vertex_source(load("common/full_screen.vert.glsl"))
    info.fragment_source(load("surfaces/pixel_classes.frag.glsl"))
    return gpu.shader.create_from_info(info)
