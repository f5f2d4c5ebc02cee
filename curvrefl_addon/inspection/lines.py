# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of combs and joints, as draw handlers and saved pictures have them, and what their colors mean."""

from __future__ import annotations

import numpy as np

from ..diagnostics.colors import Color, DiagnosticColors, Legend
from ..optics.meshes.joints import GRADES
from ..renderer.device.overlays import draw_segments
from ..renderer.shading.combs import AWAY, BEHIND, CombSet
from ..scene.arrays import Float64Array
from ..scene.camera.srgb import linear_to_srgb
from .joints import CheckedJoints

COMB_PIXELS, JOINT_PIXELS = 1.5, 4.0
UNKNOWN: Color = (0.35, 0.35, 0.35)


def grade_colors(colors: DiagnosticColors) -> dict[str, Color]:
    """Scene-linear, by grade; told apart by lightness too."""
    return dict(zip(GRADES, (colors.failed, colors.hidden, (0.090, 0.460, 0.800), colors.converged), strict=True))


def joint_legend(checked: CheckedJoints, colors: DiagnosticColors) -> Legend:
    """What the colors of the edges mean, and how many there are of each."""
    by_grade = grade_colors(colors)
    swatches = [(by_grade[name], f"{_MEANING[name]}: {count}") for name, count in checked.counts()]
    if unknown := int((checked.grades < 0).sum()):
        swatches.append((UNKNOWN, f"Not Measured: {unknown}"))
    return Legend("Joints", tuple(swatches))


_MEANING = {"Gap": "Gap", "G0": "G0, a Crease", "G1": "G1, Curvature Jumps", "G2": "G2, Smooth"}


def draw_combs(combs: CombSet, eye: Float64Array) -> None:
    """With the matrices of a POST_VIEW handler, as seen from the homogeneous `eye` (4,)."""
    lines, colors = combs.segments(eye)
    draw_segments(lines, COMB_PIXELS, colors)


def draw_joints(checked: CheckedJoints, colors: DiagnosticColors, eye: Float64Array) -> None:
    """As `draw_combs`: edges in the colors of their grades."""
    by_grade = np.array([*grade_colors(colors).values(), UNKNOWN])
    shown = np.ones((len(checked.grades), 4))
    shown[:, :3] = linear_to_srgb(by_grade[checked.grades])
    middle = checked.joints.edges.mean(axis=1)
    to_eye = eye[:3] - eye[3] * middle
    facing = (to_eye * checked.joints.normals).sum(axis=1)
    shown[facing < AWAY * np.linalg.norm(to_eye, axis=1), 3] = BEHIND
    draw_segments(checked.joints.edges, JOINT_PIXELS, shown)
