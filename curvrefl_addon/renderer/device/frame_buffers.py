# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame buffers: what is drawn to."""

from __future__ import annotations

from typing import Any

import gpu
import numpy as np

from ...scene.arrays import Float32Array


def frame_buffer(*colors: Any, depth: Any = None) -> Any:
    """Of color textures, in the order of a shader's outputs, and a depth texture; any may be a `layer_of` one.

    It does not keep them: whoever has it must.
    """
    if depth is None:
        return gpu.types.GPUFrameBuffer(color_slots=colors)
    if not colors:
        return gpu.types.GPUFrameBuffer(depth_slot=depth)
    return gpu.types.GPUFrameBuffer(depth_slot=depth, color_slots=colors)


class FrameBuffers:
    """Of the same color textures with one depth texture or another."""

    def __init__(self, *colors: Any, most: int) -> None:
        """As for `frame_buffer`; `most`: frame buffers that are kept."""
        self._colors, self._most = colors, most
        self._held: list[tuple[Any, Any]] = []

    def with_depth(self, depth: Any) -> Any:
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
