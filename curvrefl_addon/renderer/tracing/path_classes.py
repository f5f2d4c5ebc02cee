# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is to do at each pixel of a path's vertex, as a depth: see `surfaces/pixel_classes.py`."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..surfaces.canvas import Canvas
from ..surfaces.pixel_classes import CHOSEN_MIRRORS, CLASS_COUNT
from ..surfaces.surface_buffer import SEEN_THROUGH, SurfaceBuffer
from ..surfaces.windows import Window
from .path_vertices import PathVertices


class PathClass(IntEnum):
    """Of a vertex."""

    MISSES = 1
    """There is none: the path has met nothing"""
    STOPS = 2
    """A surface on which it ends"""
    GOES_ON = 3
    """One from which another step follows it"""


class PathClasses:
    """Depth textures of the size of a picture: of what the eye sees, and of two steps in turn."""

    def __init__(self, depths: list[Any]) -> None:
        self._depths = depths
        self._targets = [frame_buffer(depth=depth) for depth in depths]
        self._parts: Canvas | None = None
        """Made when first asked for"""

    def depth(self, step: int) -> Any:
        """Of what the step has met; 0: what the eye sees."""
        return self._depths[place_of(step)]

    def any_left(self, step: int) -> bool:
        """Whether a path goes on from what the step has met; waits for the GPU."""
        if self._parts is None:
            self._parts = Canvas.of_size(PARTS_ACROSS, PARTS_ACROSS)
        with drawing_state(), self._parts.frame_buffer.bind():
            set_viewport(0, 0, PARTS_ACROSS, PARTS_ACROSS)
            shader = _any_left_shader()
            shader.bind()
            shader.uniform_sampler("classes", self.depth(step))
            full_screen_triangle().draw(shader)
        return bool(self._parts.pixels().any())

    def sort_seen(self, seen: SurfaceBuffer, window: Window, chosen: Any, sees_through: bool) -> None:
        """Find where paths begin: at all mirrors, or those `chosen` (record texture by mirrors' numbers), and where it
        `sees_through` at other surfaces that do not stop the light."""
        shader = _shader(False, chosen is not None)
        with drawing_state("ALWAYS", depth_write=True), self._targets[0].bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            shader.uniform_float("seen_through", float(sees_through))
            shader.uniform_sampler("vertex_color", seen.color)
            if chosen is not None:
                shader.uniform_sampler("chosen_mirrors", chosen)
            full_screen_triangle().draw(shader)

    def sort_met(self, step: int, met: PathVertices, window: Window) -> None:
        """Of what a step has met."""
        shader = _shader(True, False)
        with drawing_state("ALWAYS", depth_write=True), self._targets[place_of(step)].bind(), scissored(window):
            set_viewport(0, 0, met.width, met.height)
            shader.bind()
            shader.uniform_sampler("vertex_color", met.color)
            shader.uniform_sampler("vertex_position", met.position)
            shader.uniform_sampler("path_throughput", met.throughput)
            shader.uniform_sampler("classes_before", self.depth(step - 1))
            full_screen_triangle().draw(shader)


PARTS_ACROSS = 32
"""In which paths that are left are looked for"""


def place_of(step: int) -> int:
    """Of buffers of which the first is kept and two others take turns."""
    return 0 if step == 0 else 1 + step % 2


BUFFERS = 3
"""Places there are"""


@gpu_cache
def _any_left_shader() -> Any:
    return build_shader(
        "any left",
        FULL_SCREEN,
        Piece(
            samplers={"classes": "DEPTH_2D"},
            outputs={"color": "VEC4"},
            defines={
                "CLASS_COUNT": float(CLASS_COUNT),
                "GOES_ON": float(PathClass.GOES_ON),
                "PARTS_ACROSS": PARTS_ACROSS,
            },
            fragment="paths/any_left.frag.glsl",
        ),
    )


@gpu_cache
def _shader(on_path: bool, with_choice: bool) -> Any:
    path = Piece(
        samplers={**named("FLOAT_2D", "vertex_position", "path_throughput"), "classes_before": "DEPTH_2D"},
        defines=flags("ON_PATH"),
    )
    return build_shader(
        "path classes",
        FULL_SCREEN,
        Piece(
            samplers={"vertex_color": "FLOAT_2D"},
            constants={} if on_path else {"seen_through": "FLOAT"},
            defines={
                "CLASS_COUNT": float(CLASS_COUNT),
                "SEEN_THROUGH": SEEN_THROUGH,
                **{kind.name: float(kind) for kind in PathClass},
            },
            writes_depth=True,
            fragment="paths/path_classes.frag.glsl",
        ),
        *((path,) if on_path else ()),
        *((CHOSEN_MIRRORS,) if with_choice else ()),
    )
