# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that two arcs of known curvature sweep along y: what a joint must measure is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LENGTH = 1.0
"""Of either arc"""


@dataclass(frozen=True)
class Profile:
    """A mesh over a grid, and the vertices of the edges where both parts meet."""

    positions: np.ndarray
    triangles: np.ndarray
    joint: np.ndarray
    """(k, 2)"""


def arc(curvature: float, heading: float, count: int) -> np.ndarray:
    """(count, 2) from the origin along a circle that turns by curvature x length to the right; `heading` in radians."""
    s = np.linspace(0.0, LENGTH, count)
    turn = heading - curvature * s
    if curvature == 0.0:
        return s[:, None] * np.array([np.cos(heading), np.sin(heading)])
    return np.column_stack([np.sin(heading) - np.sin(turn), np.cos(turn) - np.cos(heading)]) / curvature


def swept(line: np.ndarray, rows: int = 17, skew: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A line (n, 2) of x and z, from y = -1 to 1; `skew` moves every other vertex along y."""
    count = len(line)
    y = np.linspace(-1.0, 1.0, rows)[:, None] + skew * (np.arange(count) % 2)[None]
    positions = np.dstack([np.broadcast_to(line[:, 0], y.shape), y, np.broadcast_to(line[:, 1], y.shape)])
    number = np.arange(rows * count).reshape(rows, count)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    return positions.reshape(-1, 3), np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def joined(left: float, right: float, angle: float = 0.0, count: int = 33, rows: int = 33) -> Profile:
    """Two arcs of curvatures `left` and `right` that meet in the origin at an `angle` in radians, normals upwards."""
    before = arc(-left, np.pi, count)[::-1]
    after = arc(right, -angle, count)
    positions, triangles = swept(np.concatenate([before, after[1:]]), rows, skew=0.3 * LENGTH / count)
    column = count - 1
    number = np.arange(rows) * (2 * count - 1) + column
    return Profile(positions, triangles, np.column_stack([number[:-1], number[1:]]))
