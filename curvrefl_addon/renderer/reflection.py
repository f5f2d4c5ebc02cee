# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the mirrors show in one view, before it is drawn, and the views that explain it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..diagnostics.colors import NORMAL_MODES, SOLVED_MODES, DiagnosticColors, DiagnosticOptions
from ..scene.arrays import Float64Array
from ..scene.camera.view import View
from .choice import Choice
from .mirrors.mirror import Mirror
from .rays.ray_scene import RayScene
from .settings import Settings
from .shading.calm import CalmHistory
from .shading.features import RayShadows
from .shown.shown import Shown
from .vertices.solution import SolvedChunk, VertexSolution


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A view that shows how the picture comes about in place of the picture."""

    mode: str
    """A name of `diagnostics.colors.MODES`"""
    options: DiagnosticOptions = field(default_factory=DiagnosticOptions)
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)

    @property
    def needs_solve(self) -> bool:
        """Whether it shows what the mirrors show, not their surface alone."""
        return self.mode in SOLVED_MODES

    @property
    def of_meshes(self) -> bool:
        """Whether it shows the normals of the mirrors' meshes, without bumps and what rays need of them."""
        return self.mode in NORMAL_MODES or self.mode == "CURVATURE"


@dataclass(frozen=True)
class Reflection:
    """What the mirrors show in one view. It belongs to that view: nothing of it is kept in the renderer."""

    view: View
    """About `origin`"""
    settings: Settings
    """What was asked for"""
    shown: tuple[Shown, ...]
    """Of each mirror; empty where a diagnostic view wants the mirrors' surface alone"""
    warnings: tuple[str, ...]
    """One sentence each"""
    choice: Choice | None = None
    """What `auto` has chosen, and why"""
    coarse_shadows: tuple[bool, bool] = (False, False)
    """Of lamps and of the world: their maps are too coarse for the view"""
    at_rest: bool = False
    """Shadows are found by rays, where that is so, and the light between surfaces"""
    gathers: bool = False
    """At rest rays find the light between surfaces"""
    calm: CalmHistory | None = None
    """The view moves: rough mirrors show what sharp ones would, blurred, in place of one noisy path"""
    origin: Float64Array = field(default_factory=lambda: np.zeros(3))
    """(3,) where in the world the scene had its origin (see `placement`)"""

    def ray_shadows(self, rays: Callable[[], RayScene]) -> RayShadows | None:
        """What takes the place of shadow maps; None where these serve. `rays`: makes the scene as rays need it."""
        if not self.at_rest or not any(self.coarse_shadows):
            return None
        return RayShadows(rays(), *self.coarse_shadows, everywhere=True)

    @property
    def groups(self) -> list[tuple[type[Shown], list[Shown]]]:
        """Mirrors that show the same way, in the order of the first of each."""
        groups: dict[type[Shown], list[Shown]] = {}
        for shown in self.shown:
            groups.setdefault(type(shown), []).append(shown)
        return list(groups.items())

    @property
    def is_final(self) -> bool:
        """Nothing is left that `reflect` would do for a view at rest alone."""
        if self.calm is not None:
            return False
        return all(shown.is_final for shown in self.shown) and (
            self.at_rest or not (self.gathers or any(self.coarse_shadows))
        )

    @property
    def methods(self) -> tuple[str, ...]:
        """Catalog names by which the mirrors are shown, in their order."""
        return tuple(shown.method for shown in self.shown)

    @property
    def parts(self) -> tuple[tuple[SolvedChunk, ...], ...]:
        """Per mirror, where vertices are solved, its scenery with the reflection points."""
        return tuple(shown.parts for shown in self.shown)

    @property
    def solutions(self) -> tuple[VertexSolution, ...]:
        """Of all mirrors and chunks that they may show: every vertex its first image. No midpoints of split edges."""
        return tuple(solution for shown in self.shown for solution in shown.solutions)

    def of(self, mirrors: Sequence[Mirror]) -> list[Shown | None]:
        """What was shown of each of these mirrors."""
        known = {id(shown.mirror): shown for shown in self.shown}
        return [known.get(id(mirror)) for mirror in mirrors]

    def wait(self) -> None:
        """Return when the GPU has finished what was done before drawing."""
        for shown in self.shown:
            shown.wait()
