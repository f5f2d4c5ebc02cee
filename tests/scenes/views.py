# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Views for tests, without a Blender camera."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.scene.camera.view import View


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


def look_at(
    eye: np.ndarray,
    target: np.ndarray,
    width: int,
    height: int,
    angle: float,
    near: float = 0.05,
    far: float = 100.0,
    orthographic: bool = False,
) -> View:
    """A view from `eye` to `target`, z up; `angle` is the horizontal field of view in radians.

    The orthographic view shows at the target what the perspective one does.
    """
    forward = unit(np.asarray(target, float) - eye)
    right = unit(np.cross(forward, [0.0, 0.0, 1.0]))
    world_to_view = np.eye(4)
    world_to_view[:3, :3] = [right, np.cross(right, forward), -forward]
    world_to_view[:3, 3] = -world_to_view[:3, :3] @ eye
    half = np.tan(angle / 2)
    clip = np.zeros((4, 4))
    if orthographic:
        half *= np.linalg.norm(np.asarray(target, float) - eye)
        clip[0, 0], clip[1, 1] = 1 / half, width / height / half
        clip[2, 2], clip[2, 3], clip[3, 3] = -2 / (far - near), -(far + near) / (far - near), 1.0
    else:
        clip[0, 0], clip[1, 1] = 1 / half, width / height / half
        clip[2, 2], clip[2, 3] = -(far + near) / (far - near), -2 * far * near / (far - near)
        clip[3, 2] = -1.0
    return View(world_to_view, clip, width, height)
