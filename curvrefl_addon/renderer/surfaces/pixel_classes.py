# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each pixel of a sub-frame shows, as a depth buffer, so that a shader runs only where it has something to do.

There is no stencil, and many drivers (a software renderer among them) run all branches of a shader. A full-screen
triangle at the depth of its class is tested before its shader runs.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import depth_texture
from .surface_buffer import SurfaceBuffer
from .windows import Window

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
        self.depth = depth_texture(width, height)
        """The classes"""
        self.frame_buffer = frame_buffer(depth=self.depth)
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
            set_viewport(0, 0, self.width, self.height)
            shader.bind()
            shader.uniform_sampler("seen_color", seen.color)
            if reflected is not None:
                shader.uniform_sampler("reflected_position", reflected.position)
            if reflected is not None and tells_mirrors:
                shader.uniform_sampler("reflected_color", reflected.color)
            if chosen is not None:
                shader.uniform_sampler("chosen_mirrors", chosen)
            full_screen_triangle().draw(shader)


CHOSEN_MIRRORS = Piece(samplers={"chosen_mirrors": "FLOAT_2D"}, defines=flags("WITH_CHOICE"))
"""For `chosen_mirrors.glsl`: a pass for some of the mirrors"""
CLASS = Piece(
    inputs={"pos": "VEC2"},
    constants={"pixel_class": "FLOAT"},
    defines={"CLASS_COUNT": float(CLASS_COUNT)},
    vertex="surfaces/full_screen_of_class.vert.glsl",
)
"""A full-screen triangle at the depth of the push constant `pixel_class`"""


@gpu_cache
def _shader(shows_surfaces: bool, tells_mirrors: bool, with_choice: bool) -> Any:
    surfaces = Piece(samplers={"reflected_position": "FLOAT_2D"}, defines=flags("SHOWS_SURFACES"))
    mirrors = Piece(samplers={"reflected_color": "FLOAT_2D"}, defines=flags("TELLS_MIRRORS"))
    return build_shader(
        "pixel classes",
        FULL_SCREEN,
        Piece(
            samplers={"seen_color": "FLOAT_2D"},
            defines={"CLASS_COUNT": float(CLASS_COUNT), **{kind.name: float(kind) for kind in PixelClass}},
            writes_depth=True,
            fragment="surfaces/pixel_classes.frag.glsl",
        ),
        *((surfaces,) if shows_surfaces else ()),
        *((mirrors,) if shows_surfaces and tells_mirrors else ()),
        *((CHOSEN_MIRRORS,) if with_choice else ()),
    )
