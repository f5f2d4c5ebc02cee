# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A diagnostic view in place of the light of the mirrors."""

from __future__ import annotations

from .reflection import Diagnostic, Reflection
from .shading.diagnostics import DiagnosticPass
from .shown.nothing import ShownNothing
from .shown.shown import SubFrame, chosen_mirrors
from .surfaces.canvas import Canvas


def add_diagnostic(
    diagnostics: DiagnosticPass,
    canvas: Canvas,
    reflection: Reflection,
    sub_frame: SubFrame,
    weight: float,
    diagnostic: Diagnostic,
) -> None:
    """Add a sub-frame to a picture."""
    groups = reflection.groups
    methods = reflection.methods or (reflection.settings.method,) * len(sub_frame.stage.mirrors)
    for kind, members in groups or [(ShownNothing, [])]:
        shown = kind.draw(members, sub_frame, of_positions=diagnostic.needs_solve)
        if shown is None:
            sub_frame.targets.reflected.clear()
            shown = sub_frame.targets.reflected
        diagnostics.add(
            canvas.frame_buffer,
            sub_frame.targets.seen,
            shown,
            sub_frame.uniforms,
            weight,
            diagnostic.mode,
            diagnostic.options,
            methods,
            [one.parts if one in members else () for one in reflection.shown],
            chosen_mirrors(members, len(methods)) if len(groups) > 1 else None,
        )
