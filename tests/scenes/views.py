# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Views for tests, without a Blender camera."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.scene.camera.looking import look_at
from curvrefl.curvrefl_addon.scene.camera.view import View

__all__ = ["lines_of_sight", "look_at"]


def lines_of_sight(view: View) -> tuple[np.ndarray, np.ndarray]:
    """Through the pixels' centers, each (h, w, 3): where they begin, on the near plane, and unit directions."""
    y, x = np.mgrid[0 : view.height, 0 : view.width]
    near, far = (
        np.stack(
            [(2 * x + 1) / view.width - 1, (2 * y + 1) / view.height - 1, np.full(x.shape, z), np.ones(x.shape)], -1
        )
        @ np.linalg.inv(view.world_to_clip).T
        for z in (-1.0, 1.0)
    )
    origin = near[..., :3] / near[..., 3:]
    return origin, unit(far[..., :3] / far[..., 3:] - origin)
