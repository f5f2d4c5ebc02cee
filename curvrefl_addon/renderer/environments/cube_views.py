# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The six views of a cube map."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.camera.view import View


def faces_views(center: np.ndarray, near: float, far: float, resolution: int) -> list[View]:
    """The six views (GL face order) of a cube map about `center`."""
    axes: list[tuple[Any, Any]] = [
        ((1, 0, 0), (0, -1, 0)),
        ((-1, 0, 0), (0, -1, 0)),
        ((0, 1, 0), (0, 0, 1)),
        ((0, -1, 0), (0, 0, -1)),
        ((0, 0, 1), (0, -1, 0)),
        ((0, 0, -1), (0, -1, 0)),
    ]
    projection = np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )
    views = []
    for forward, up in axes:
        world_to_view = np.eye(4)
        world_to_view[:3, :3] = np.array([np.cross(forward, up), up, np.negative(forward)])
        world_to_view[:3, 3] = -world_to_view[:3, :3] @ center
        views.append(View(world_to_view, projection, resolution, resolution).fitted(near, far))
    return views
