# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Views without a camera of Blender's, for what is proven, measured and tested."""

from __future__ import annotations

import numpy as np

from ...optics.surfaces.radial_surfaces import unit
from ..arrays import Float64Array
from .view import View


def look_at(
    eye: Float64Array,
    target: Float64Array,
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
