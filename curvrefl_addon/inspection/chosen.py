# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `Scene.curvrefl` asks to be shown of the mirrors' surfaces."""

from __future__ import annotations

from math import degrees
from typing import Any

import bpy
import numpy as np

from ..diagnostics.colors import MODES, DiagnosticOptions
from ..renderer.reflection import Diagnostic
from ..renderer.shading.combs import CombOptions
from ..setting import value_of
from ..settings_table import NAMED


def diagnostic_of(settings: Any, options: Any) -> Diagnostic | None:
    """The diagnostic view that `Scene.curvrefl` asks for, in the preferences' colors; None for the picture itself."""
    if settings.show not in MODES:
        return None
    x, y, z = settings.stripe_direction
    return Diagnostic(
        settings.show,
        DiagnosticOptions(
            axis=(x, y, z),
            lock=value_of(settings, NAMED["stripe_lock"]),
            stripes=settings.stripe_count,
            lines=settings.stripe_count,
            # (As typed: properties are of single precision.)
            line_width=round(degrees(settings.stripe_width), 5),
            softness=settings.stripe_softness,
            transparency=settings.pattern_transparency,
            curvature=value_of(settings, NAMED["curvature_kind"]),
            curvature_range=settings.curvature_range,
            directions=settings.curvature_directions,
        ),
        options.colors,
    )


def combs_of(scene: bpy.types.Scene) -> CombOptions:
    """The sections that a scene asks for, whether they are shown or not."""
    settings = scene.curvrefl
    return CombOptions(
        plane=value_of(settings, NAMED["comb_plane"]),
        axis=value_of(settings, NAMED["comb_axis"]),
        offset=settings.comb_offset,
        teeth=settings.comb_teeth,
        scale=settings.comb_scale,
        cursor=tuple(np.array(scene.cursor.matrix, np.float64).ravel().tolist()),
    )
