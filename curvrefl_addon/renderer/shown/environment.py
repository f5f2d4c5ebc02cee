# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror that shows a map of its surroundings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from ...scene.arrays import Float32Array
from ..environments.hits import environment_hits
from ..environments.vertex_lookups import VertexLookups
from ..shading.lookup import Environment
from .shown import Shown, SubFrame


@dataclass(frozen=True)
class ShownEnvironment(Shown):
    """A lookup in each pixel, or at the mirror's vertices."""

    environment: Environment

    @classmethod
    def draw(cls, members: Sequence[Self], sub_frame: SubFrame, of_positions: bool = False) -> Sequence[Environment]:
        environments = tuple(shown.environment for shown in members)
        if not any(environment.lookup == "environment_cube_vertex" for environment in environments):
            return environments
        targets = sub_frame.targets
        if targets.vertex_lookups is None:
            targets.vertex_lookups = VertexLookups(targets.width, targets.height)
        mirrors = [
            (shown.mirror.number, sub_frame.stage.geometry.of_instance(shown.mirror.index), shown.environment)
            for shown in members
        ]
        return tuple(targets.vertex_lookups.draw(mirrors, targets.seen, sub_frame.uniforms, of_positions))

    @classmethod
    def read_back(cls, members: Sequence[Self], sub_frame: SubFrame) -> dict[str, Float32Array]:
        shown = cls.draw(members, sub_frame, of_positions=True)
        return {"reflected_position": environment_hits(sub_frame.targets.seen, shown, sub_frame.uniforms)}
