# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The aperture of a camera: where on it the sub-frames of a picture with depth of field look from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Float64Array
from .sampling import scattered_points

if TYPE_CHECKING:
    import bpy

LEAST_FSTOP = 1e-5


@dataclass(frozen=True, slots=True)
class Lens:
    """As Cycles takes Blender's settings."""

    radius: float
    """Of the aperture, meters"""
    focus: float
    """Distance along the camera's axis of the plane that is sharp, meters"""
    blades: int = 0
    """Corners of the aperture; round below 3"""
    rotation: float = 0.0
    """Of its corners, radians"""
    ratio: float = 1.0
    """Of its height to its width"""

    def points(self, samples: int) -> Float64Array:
        """(samples, 2) places on the aperture, meters along the camera's x and y; all stand for equal areas."""
        if samples == 1:
            return np.zeros((1, 2))
        points = scattered_points(samples)
        places = _on_disk(points) if self.blades < 3 else _on_polygon(points, self.blades, self.rotation)
        places[:, 0] /= self.ratio
        return places * self.radius


def lens_of(
    camera: bpy.types.Camera, placed: Float64Array, depsgraph: bpy.types.Depsgraph | None = None
) -> Lens | None:
    """Of an evaluated camera placed by `placed` (4, 4), orthonormal; None without depth of field.

    Distances to objects that the camera focuses on are along its axis.
    """
    dof = camera.dof
    if not dof.use_dof:
        return None
    focus = dof.focus_distance
    if dof.focus_object is not None:
        target = dof.focus_object if depsgraph is None else dof.focus_object.evaluated_get(depsgraph)
        place = target.matrix_world
        if dof.focus_subtarget and target.pose is not None and dof.focus_subtarget in target.pose.bones:
            place = place @ target.pose.bones[dof.focus_subtarget].matrix
        focus = abs(float((placed[:3, 3] - np.array(place.translation, np.float64)) @ placed[:3, 2]))
    fstop = max(dof.aperture_fstop, LEAST_FSTOP)
    radius = 0.5 / fstop if camera.type == "ORTHO" else 0.5e-3 * camera.lens / fstop
    return Lens(radius, max(focus, 1e-5), dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio)


def _on_disk(points: Float64Array) -> Float64Array:
    """(n, 2) in the unit disk of (n, 2) in the unit square: Shirley and Chiu's map, which keeps areas and neighbors."""
    x, y = (2.0 * points - 1.0).T
    is_wide = np.abs(x) > np.abs(y)
    radius = np.where(is_wide, x, y)
    over = np.where(radius != 0.0, radius, 1.0)
    angle = np.where(is_wide, 0.25 * np.pi * y / over, 0.5 * np.pi - 0.25 * np.pi * x / over)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def _on_polygon(points: Float64Array, corners: int, rotation: float) -> Float64Array:
    """(n, 2) in the regular polygon with a corner at `rotation` radians and its corners on the unit circle."""
    scaled = points[:, 0] * corners
    corner = np.minimum(np.floor(scaled), corners - 1)
    root = np.sqrt(scaled - corner)
    u, v = 1.0 - root, points[:, 1] * root
    half = np.pi / corners
    x, y = (u + v) * np.cos(half), (u - v) * np.sin(half)
    angle = rotation + corner * 2.0 * half
    return np.column_stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y])
