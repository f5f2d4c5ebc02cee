# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Render targets of one size of picture."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..environments.vertex_lookups import VertexLookups
from ..rays.paths import PathBuffer
from ..shading.calm import CalmMirrors
from ..surfaces.surface_buffer import SurfaceBuffer
from ..vertices.back_faces import BackFaces


@dataclass
class Targets:
    """Everything that has the size of the picture."""

    width: int
    height: int
    seen: SurfaceBuffer = field(init=False)
    reflected: SurfaceBuffer = field(init=False)
    back_faces: BackFaces = field(init=False)
    vertex_lookups: VertexLookups | None = None
    """Made where a method needs them, as the next two"""
    calm: CalmMirrors | None = None
    paths: list[PathBuffer] = field(default_factory=list)

    def path(self, bounce: int) -> PathBuffer:
        """Where rays get to after the mirror `bounce`, 0 for the first; two buffers take turns."""
        while len(self.paths) <= min(bounce, 1):
            self.paths.append(PathBuffer(self.width, self.height))
        return self.paths[bounce % 2]

    def calm_mirrors(self) -> CalmMirrors:
        """Made when first asked for."""
        if self.calm is None:
            self.calm = CalmMirrors(self.width, self.height)
        return self.calm

    def __post_init__(self) -> None:
        self.seen = SurfaceBuffer(self.width, self.height)
        self.reflected = SurfaceBuffer(self.width, self.height)
        self.back_faces = BackFaces(self.width, self.height)


MOST_TARGETS = 3
"""Sizes of pictures whose targets are kept: a viewport draws smaller ones while it moves"""


class TargetPool:
    """Targets by their size."""

    def __init__(self) -> None:
        self._targets: dict[tuple[int, int], Targets] = {}

    def of(self, width: int, height: int) -> Targets:
        """Made when first asked for; those that were made the longest ago go."""
        if (width, height) not in self._targets:
            while len(self._targets) >= MOST_TARGETS:
                del self._targets[next(iter(self._targets))]
            self._targets[width, height] = Targets(width, height)
        return self._targets[width, height]
