# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals that lean too far for the facet they are on, as Cycles raises them. float64."""

from __future__ import annotations

import numpy as np

from .surfaces.radial_surfaces import Float64Array

LEAST_SINE = 0.01
"""Of a mirrored ray over the facet; less where the line of sight itself is flatter"""


def reflecting_outward(facing: Float64Array, to_eye: Float64Array, bent: Float64Array) -> Float64Array:
    """Unit normals (n, 3): the steepest towards `bent` whose mirrored rays leave the facets.

    All (n, 3), unit, and on one side of the surface: geometric normals, directions to the eye, shading normals. The
    reference of surfaces/reflecting_outward.glsl (Cycles' ensure_valid_specular_reflection).
    """
    eye_z = np.einsum("ij,ij->i", to_eye, facing)
    least = np.minimum(0.9 * eye_z, LEAST_SINE)
    mirrored = 2.0 * np.einsum("ij,ij->i", bent, to_eye)[:, None] * bent - to_eye
    is_low = np.einsum("ij,ij->i", facing, mirrored) < least
    if not is_low.any():
        return bent
    aside = bent - np.einsum("ij,ij->i", bent, facing)[:, None] * facing
    length = np.linalg.norm(aside, axis=1)
    aside = aside / np.where(length > 0.0, length, 1.0)[:, None]
    eye_x = np.einsum("ij,ij->i", to_eye, aside)
    a = eye_x**2 + eye_z**2
    b = 2.0 * (a + eye_z * least)
    c = (least + eye_z) ** 2
    root = np.sqrt(np.maximum(b**2 - 4.0 * a * c, 0.0))
    z = np.clip(0.25 * np.where(eye_x < 0.0, b + root, b - root) / np.maximum(a, 1e-300), 0.0, 1.0)
    raised = np.sqrt(1.0 - z)[:, None] * aside + np.sqrt(z)[:, None] * facing
    raised = np.where((length**2 < 1e-12)[:, None], facing, raised)
    return np.where(is_low[:, None], raised, bent)
