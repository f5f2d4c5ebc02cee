# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Render targets of one size of picture."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..environments.vertex_lookups import VertexLookups
from ..rays.paths import PathBuffer
from ..shading.calm import CalmMirrors
from ..surfaces.by_size import BySize
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


MOST_SIZES = 3
"""Of pictures whose targets are kept"""


def target_pool() -> BySize[Targets]:
    return BySize(Targets, MOST_SIZES)
