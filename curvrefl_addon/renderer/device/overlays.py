# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines and boxes over the viewport by Blender's own shaders, with the matrices that its draw handlers have set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import gpu
import mathutils
import numpy as np

from .batches import vertex_batch

type Color = tuple[float, float, float, float]
"""sRGB and alpha, as Blender's own shaders take colors"""


def draw_line(points: Sequence[tuple[float, ...]], width: float, color: Color) -> None:
    """A line through points (x, y, z), so many pixels wide."""
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINE_STRIP", {"pos": list(points)})
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    batch.draw(shader)


def draw_segments(ends: np.ndarray, width: float, color: Color | np.ndarray) -> None:
    """Lines (n, 2, 2 or 3) from place to place, so many pixels wide, in one color or (n, 4) each in its own; none at
    all where there are none."""
    if len(ends) == 0:
        return
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    places = np.zeros((2 * len(ends), 3), np.float32)
    places[:, : ends.shape[2]] = ends.reshape(-1, ends.shape[2])
    colors = np.broadcast_to(np.asarray(color, np.float32), (len(ends), 4))
    content: dict[str, Any] = {"pos": places, "color": np.repeat(colors, 2, axis=0)}
    batch = batch_for_shader(shader, "LINES", content)
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    gpu.state.blend_set("ALPHA")
    try:
        batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")


@contextmanager
def matrices_of(world_to_view: np.ndarray, view_to_clip: np.ndarray) -> Iterator[None]:
    """As in a draw handler, for these (4, 4)."""
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_matrix(mathutils.Matrix(world_to_view.tolist()))
        gpu.matrix.load_projection_matrix(mathutils.Matrix(view_to_clip.tolist()))
        yield


def matrices_of_pixels(width: int, height: int) -> AbstractContextManager[None]:
    """As in a POST_PIXEL handler of a region of this size."""
    clip = np.diag([2.0 / width, 2.0 / height, -1.0, 1.0])
    clip[:2, 3] = -1.0
    return matrices_of(np.eye(4), clip)


def draw_boxes(boxes: Sequence[tuple[tuple[float, float, float, float], Color]]) -> None:
    """Filled boxes (x, y, width, height), each in its color."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]], np.float32)
    places = np.array([box for box, _ in boxes], np.float32)
    positions = (places[:, None, :2] + corners * places[:, None, 2:]).reshape(-1, 2)
    colors = np.repeat(np.array([color for _, color in boxes], np.float32), 6, axis=0)
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    shader.bind()
    vertex_batch({"pos": positions, "color": colors}).draw(shader)
