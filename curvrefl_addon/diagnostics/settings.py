# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the diagnostic views: a class of the table of settings (`settings_table`)."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from ..setting import Choice, setting
from ..settings_choices import AXIS_CHOICES, CURVATURE_CHOICES, DIAGNOSTIC_CHOICES, LOCK_CHOICES, PLANE_CHOICES


@dataclass(frozen=True, slots=True)
class DiagnosticSettings:
    """Properties of `Scene.curvrefl` that say what is drawn on the mirrors."""

    show: str = setting(
        "REFLECTION",
        label="Show",
        text="What is drawn on the mirrors",
        choices=(Choice("REFLECTION", "Reflection", "What the mirrors reflect"), *DIAGNOSTIC_CHOICES),
        panel="Diagnostic View",
    )
    stripe_count: int = setting(
        12, label="Count", text="Number of stripes, bands or lamps", hard=(1, 256), panel="Diagnostic View"
    )
    stripe_direction: tuple[float, float, float] = setting(
        (0.0, 0.0, 1.0),
        label="Direction",
        text="Axis that stripes and bands lie around and lamps run along",
        unit="direction",
        panel="Diagnostic View",
    )
    stripe_lock: str = setting(
        "WORLD",
        label="Locked to",
        text="What the pattern is fixed to",
        choices=LOCK_CHOICES,
        panel="Diagnostic View",
    )
    stripe_softness: float = setting(
        0.0,
        label="Softness",
        text="How gently dark turns to bright: 0 is an edge, 1 a wave",
        hard=(0.0, 1.0),
        panel="Diagnostic View",
    )
    stripe_width: float = setting(
        pi / 45.0,
        label="Width",
        text="Of a lamp seen from the side, or of its highlight in degrees of the normal",
        hard=(0.001, pi),
        soft=(0.01, 0.5),
        unit="radians",
        panel="Diagnostic View",
    )
    curvature_kind: str = setting(
        "MEAN",
        label="Curvature",
        text="Which curvature the colors say",
        choices=CURVATURE_CHOICES,
        panel="Diagnostic View",
    )
    curvature_range: float = setting(
        0.0,
        label="Range",
        text="Curvature at the end of the colors, one over meters (Gaussian: over square meters); 0 for what holds "
        "nineteen of twenty vertices",
        hard=(0.0, None),
        soft=(None, 100.0),
        panel="Diagnostic View",
        least_note="automatic",
    )
    curvature_directions: bool = setting(
        False,
        label="Directions",
        text="Strokes along the principal directions: dark where the surface bends outwards most, bright across",
        panel="Diagnostic View",
    )
    pattern_transparency: float = setting(
        0.0,
        label="Transparency",
        text="How much of the viewport's own picture comes through a pattern or curvature",
        hard=(0.0, 1.0),
        panel="Diagnostic View",
    )
    comb_show: bool = setting(
        False,
        label="Curvature Combs",
        text="Cut the mirrors by a plane, and show how much each section bends by teeth across it",
        panel="Inspection",
    )
    comb_plane: str = setting(
        "OBJECT", label="Plane of", text="Where the plane of a section lies", choices=PLANE_CHOICES, panel="Inspection"
    )
    comb_axis: str = setting(
        "X", label="Across", text="Which axis the plane is across", choices=AXIS_CHOICES, panel="Inspection"
    )
    comb_offset: float = setting(
        0.0,
        label="Offset",
        text="How far along that axis the plane is moved",
        soft=(-10.0, 10.0),
        unit="meters",
        panel="Inspection",
    )
    comb_teeth: int = setting(
        150,
        label="Teeth",
        text="Of each section, at equal distances",
        hard=(2, 10000),
        soft=(2, 1000),
        panel="Inspection",
    )
    comb_scale: float = setting(
        1.0,
        label="Scale",
        text="At 1 nineteen of twenty teeth are shorter than a fifth of the largest mirror",
        hard=(0.001, 1000.0),
        soft=(0.1, 10.0),
        panel="Inspection",
    )
