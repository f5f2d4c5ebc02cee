# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines and boxes over the viewport by Blender's own shaders, with the matrices that its draw handlers have set."""

from __future__ import annotations

from collections.abc import Sequence

import gpu
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


def draw_segments(ends: np.ndarray, width: float, color: Color) -> None:
    """Lines (n, 2, 2 or 3) from place to place, so many pixels wide; none at all where there are none."""
    if len(ends) == 0:
        return
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    places = np.zeros((2 * len(ends), 3), np.float32)
    places[:, : ends.shape[2]] = ends.reshape(-1, ends.shape[2])
    batch = batch_for_shader(shader, "LINES", {"pos": places})
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    gpu.state.blend_set("ALPHA")
    try:
        batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")


def draw_boxes(boxes: Sequence[tuple[tuple[float, float, float, float], Color]]) -> None:
    """Filled boxes (x, y, width, height), each in its color."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]], np.float32)
    places = np.array([box for box, _ in boxes], np.float32)
    positions = (places[:, None, :2] + corners * places[:, None, 2:]).reshape(-1, 2)
    colors = np.repeat(np.array([color for _, color in boxes], np.float32), 6, axis=0)
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    shader.bind()
    vertex_batch({"pos": positions, "color": colors}).draw(shader)
