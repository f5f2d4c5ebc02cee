# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A diagnostic view in place of the light of the mirrors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..diagnostics.colors import DiagnosticOptions, Legend, legend_of
from ..scene.arrays import Float64Array
from .mirrors.placed_mesh import polar
from .reflection import Diagnostic, Reflection
from .shading.combs import Combs
from .shading.curvature import Curvatures
from .shading.diagnostics import DiagnosticPass
from .shown.nothing import ShownNothing
from .shown.shown import SubFrame, chosen_mirrors
from .surfaces.canvas import Canvas


class DiagnosticLight:
    """Draws diagnostic views of a renderer's mirrors; nothing is made before one is asked for."""

    def __init__(self) -> None:
        self._pass: DiagnosticPass | None = None
        self.curvatures = Curvatures()
        self.combs = Combs(self.curvatures)

    def curvature_end(self, options: DiagnosticOptions) -> float:
        """What the last color of the curvature view stands for."""
        return options.curvature_range or self.curvatures.end_of(options.curvature)

    def legend(self, diagnostic: Diagnostic, methods: Sequence[str]) -> Legend | None:
        """What the colors of a view mean; `methods`: catalog names by which the mirrors are drawn."""
        end = self.curvature_end(diagnostic.options) if diagnostic.mode == "CURVATURE" else 1.0
        return legend_of(diagnostic.mode, diagnostic.colors, diagnostic.options, methods, end)

    def add(
        self, canvas: Canvas, reflection: Reflection, sub_frame: SubFrame, weight: float, diagnostic: Diagnostic
    ) -> None:
        """Add a sub-frame to a picture."""
        if self._pass is None or self._pass.colors != diagnostic.colors:
            self._pass = DiagnosticPass(diagnostic.colors)
        groups = reflection.groups
        mirrors = sub_frame.stage.mirrors
        methods = reflection.methods or (reflection.settings.method,) * len(mirrors)
        options = diagnostic.options
        curved = None
        if diagnostic.mode == "CURVATURE":
            self.curvatures.prepare(mirrors)
            end = self.curvature_end(options)
            curved = self.curvatures.draw(mirrors, sub_frame.view, sub_frame.uniforms, end)
        for kind, members in groups or [(ShownNothing, [])]:
            shown = kind.draw(members, sub_frame, of_positions=diagnostic.needs_solve)
            if shown is None:
                sub_frame.targets.reflected.clear()
                shown = sub_frame.targets.reflected
            self._pass.add(
                canvas.frame_buffer,
                sub_frame.targets.seen,
                shown,
                sub_frame.uniforms,
                weight,
                diagnostic.mode,
                options,
                methods,
                [one.parts if one in members else () for one in reflection.shown],
                chosen_mirrors(members, len(methods)) if len(groups) > 1 else None,
                _turns(options.lock, sub_frame),
                curved,
            )


def _turns(lock: str, sub_frame: SubFrame) -> Float64Array | None:
    """What turns directions of what a pattern is locked to into the world's: (3, 3), or (mirrors, 3, 3)."""
    if lock == "VIEW":
        return np.asarray(sub_frame.view.world_to_view[:3, :3].T, np.float64)
    mirrors = sub_frame.stage.mirrors
    if lock == "WORLD" or not mirrors:
        return None
    return np.array([polar(mirror.instance.matrix[:3, :3])[0] for mirror in mirrors])
