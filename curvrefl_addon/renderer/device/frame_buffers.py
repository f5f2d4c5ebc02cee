# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame buffers: what is drawn to.

A frame buffer of OpenGL belongs to a context. Blender makes a context for each render and takes it down at the end; of
a frame buffer that is freed only then, it frees the number in whatever context comes next, which loses one of its own.
So frame buffers are made where they are bound first, and a render lets go of its own before it ends.
"""

from __future__ import annotations

import threading
import weakref
from contextlib import AbstractContextManager
from typing import Any

import gpu
import numpy as np

from ...scene.arrays import Float32Array


class _Made(threading.local):
    """What a thread has made; contexts are never shared between two."""

    def __init__(self) -> None:
        self.frame_buffers: weakref.WeakSet[FrameBuffer] = weakref.WeakSet()


_made = _Made()


class FrameBuffer:
    """Of textures, in the context in which it is bound first, until that lets go of it."""

    def __init__(self, **slots: Any) -> None:
        self._slots = slots
        self._made: Any = None

    def bind(self) -> AbstractContextManager[Any]:
        """Draw to it inside of `with`, then to what was drawn to before."""
        return self._here().bind()

    def clear(self, **values: Any) -> None:
        """Fill it, while it is bound: `color`, and `depth`."""
        self._here().clear(**values)

    def read_color(self, *place: Any) -> Any:
        """As `gpu.types.GPUFrameBuffer.read_color`, while it is bound."""
        return self._here().read_color(*place)

    def read_depth(self, *place: Any) -> Any:
        """As `gpu.types.GPUFrameBuffer.read_depth`, while it is bound."""
        return self._here().read_depth(*place)

    def let_go(self) -> None:
        """Be made anew where it is bound next."""
        self._made = None

    def _here(self) -> Any:
        if self._made is None:
            self._made = gpu.types.GPUFrameBuffer(**self._slots)
            _made.frame_buffers.add(self)
        return self._made


def let_go_of_frame_buffers() -> None:
    """Before a context goes: of all that this thread has made. None is bound."""
    for target in tuple(_made.frame_buffers):
        target.let_go()
    _made.frame_buffers.clear()


def frame_buffers_made() -> int:
    """How many this thread has made and not let go of."""
    return len(_made.frame_buffers)


def frame_buffer(*colors: Any, depth: Any = None) -> FrameBuffer:
    """Of color textures, in the order of a shader's outputs, and a depth texture; any may be a `layer_of` one."""
    if depth is None:
        return FrameBuffer(color_slots=colors)
    if not colors:
        return FrameBuffer(depth_slot=depth)
    return FrameBuffer(depth_slot=depth, color_slots=colors)


class FrameBuffers:
    """Of the same color textures with one depth texture or another."""

    def __init__(self, *colors: Any, most: int) -> None:
        """As for `frame_buffer`; `most`: frame buffers that are kept."""
        self._colors, self._most = colors, most
        self._held: list[tuple[Any, FrameBuffer]] = []

    def with_depth(self, depth: Any) -> FrameBuffer:
        """Made when first asked for; those that were made the longest ago go."""
        for known, target in self._held:
            if known is depth:
                return target
        target = frame_buffer(*self._colors, depth=depth)
        self._held = [*self._held[1 - self._most :], (depth, target)]
        return target


def layer_of(texture: Any, layer: int) -> Any:
    """A layer of an array texture or a face of a cube map, for `frame_buffer`."""
    return {"texture": texture, "layer": layer}


def read_colors(target: Any, width: int, height: int, slot: int = 0) -> Float32Array:
    """(height, width, 4) copy of a color of the frame buffer that is bound; waits for the GPU."""
    buffer = target.read_color(0, 0, width, height, 4, slot, "FLOAT")
    buffer.dimensions = width * height * 4
    return np.array(buffer, np.float32).reshape(height, width, 4)


def wait_for(target: Any) -> None:
    """Return when the GPU has finished drawing to a frame buffer."""
    with target.bind():
        target.read_color(0, 0, 1, 1, 4, 0, "FLOAT")


def active_frame_buffer() -> Any:
    """That which is bound now."""
    return gpu.state.active_framebuffer_get()
