# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror whose scenery is drawn where its vertices reflect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

from ...scene.arrays import Float32Array
from ..device.textures import read_texture
from ..mirrors.baked_shape import BakedShape
from ..surfaces.surface_buffer import SurfaceBuffer
from ..vertices.mirror_solver import Found
from ..vertices.reflected import draw_reflected
from ..vertices.solution import Pieces, SolvedChunk, VertexSolution
from .shown import Shown, SubFrame


@dataclass(frozen=True)
class ShownVertices(Shown):
    """Reflection points of all vertices."""

    has_reliefs: ClassVar[bool] = False

    shape: BakedShape
    solved: tuple[SolvedChunk, ...]
    found: Found
    """What the next solve may start from"""
    at_rest: bool = False
    """Edges were split where their solved midpoint leaves the chord"""

    @property
    def is_final(self) -> bool:
        return self.at_rest or not self.settings.entry.curves_edges

    @property
    def parts(self) -> tuple[SolvedChunk, ...]:
        return self.solved

    @property
    def solutions(self) -> tuple[VertexSolution, ...]:
        # (No midpoints of split edges.)
        return tuple(part.solution for part in self.solved if part.image == 0 and not isinstance(part.chunk, Pieces))

    def wait(self) -> None:
        for part in self.solved:
            part.solution.wait()

    @classmethod
    def draw(cls, members: Sequence[Self], sub_frame: SubFrame, of_positions: bool = False) -> SurfaceBuffer:
        targets, stage = sub_frame.targets, sub_frame.stage
        targets.reflected.clear()
        for shown in members:
            mirror = shown.mirror
            if mirror.may_hide_itself:
                own = stage.geometry.of_instance(mirror.index)
                targets.back_faces.draw(own, sub_frame.uniforms, sub_frame.view.is_mirrored)
            draw_reflected(
                targets.reflected,
                targets.seen,
                mirror.number,
                targets.back_faces if mirror.may_hide_itself else None,
                shown.solved,
                stage.materials,
                sub_frame.uniforms,
                depth_scale=shown.shape.bound,
                window=mirror.window(sub_frame.view),
                sub_frame=sub_frame.index,
            )
        return targets.reflected

    @classmethod
    def read_back(cls, members: Sequence[Self], sub_frame: SubFrame) -> dict[str, Float32Array]:
        shown = cls.draw(members, sub_frame, of_positions=True)
        return {"reflected_position": read_texture(shown.position), "reflected_color": read_texture(shown.color)}
