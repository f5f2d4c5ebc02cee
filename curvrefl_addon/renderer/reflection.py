# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the mirrors show in one view, before it is drawn, and the views that explain it."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..diagnostic_colors import SOLVED_MODES, DiagnosticColors, DiagnosticOptions
from ..scene.view import View
from .shading.lookup import Environment
from .vertices.solve import Pieces, SolvedChunk, VertexSolution


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A view that shows how the picture comes about in place of the picture."""

    mode: str
    """A name of `diagnostic_colors.MODES`"""
    options: DiagnosticOptions = field(default_factory=DiagnosticOptions)
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)

    @property
    def needs_solve(self) -> bool:
        """Whether it shows what the mirrors show, not their surface alone."""
        return self.mode in SOLVED_MODES


@dataclass(frozen=True)
class Reflection:
    """What the mirrors show in one view, before it is drawn."""

    view: View
    parts: tuple[tuple[SolvedChunk, ...], ...]
    """Per mirror, where vertices are solved, its scenery with the reflection points"""
    environments: tuple[Environment, ...] | None
    """Per mirror the environment that stands for what it reflects; None where vertices are solved"""
    warnings: tuple[str, ...]
    """One sentence each"""
    follows_rays: bool = False
    """Mirror pixels follow their rays: there is nothing to solve before"""
    is_final: bool = True
    """Nothing is left that `reflect` would do for a view at rest alone"""

    @property
    def solutions(self) -> tuple[VertexSolution, ...]:
        """Of all mirrors and chunks that they may show: every vertex its first image. No midpoints of split edges."""
        return tuple(
            part.solution
            for parts in self.parts
            for part in parts
            if part.image == 0 and not isinstance(part.chunk, Pieces)
        )
