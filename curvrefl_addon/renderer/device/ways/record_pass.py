# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes that compute records, each on its own: by a compute shader, or by a fragment for each record.

Both run the same GLSL (`common/invocation.glsl`). By fragments the record textures are what is drawn to, and the rows
that hold the records are drawn over.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..batches import full_screen_triangle
from ..frame_buffers import frame_buffer
from ..records import TEXTURE_WIDTH
from ..shaders import FULL_SCREEN, Piece, build_shader, dispatch, flags, named
from ..state import drawing_state, scissored, set_viewport
from ..textures import depth_texture
from .features import Features

GROUP = 64
"""Invocations in a group of a compute shader"""
MARKS = Piece(defines={**flags("MARKS_RECORDS"), "MARKED": 0.5}, writes_depth=True)
"""For a pass by fragments that marks records for another one, by their depth: that of FULL_SCREEN"""


@dataclass(frozen=True, slots=True)
class RecordPass:
    """Bind its shader and set what it reads, then run it."""

    shader: Any
    targets: tuple[str, ...]
    """Names of what it writes, by fragments; none for a compute shader"""
    marks: bool = False
    """See MARKS"""

    def run(self, images: Mapping[str, Any], count: int, first: int = 0, marks: Any = None) -> None:
        """Compute `count` records from the number `first` on, of the textures that `images` names.

        `marks`, by fragments alone: depth texture of `marks_for`, which this pass makes, or which says what it is for.
        """
        if not self.targets:
            for name, texture in images.items():
                self.shader.image(name, texture)
            dispatch(self.shader, count, GROUP)
            return
        textures = [images[name] for name in self.targets]
        first_row, end_row = first // TEXTURE_WIDTH, -(-(first + count) // TEXTURE_WIDTH)
        rows = (0, first_row, TEXTURE_WIDTH, end_row - first_row)
        test = "NONE" if marks is None else "ALWAYS" if self.marks else "EQUAL"
        target = frame_buffer(*textures, depth=marks)
        with drawing_state(test, depth_write=self.marks), target.bind(), scissored(rows):
            set_viewport(0, 0, textures[0].width, textures[0].height)
            full_screen_triangle().draw(self.shader)


def build_record_pass(label: str, device: Features, *pieces: Piece) -> RecordPass:
    """Of pieces that are those of a compute shader, but for its group; as `build_shader`.

    Their images are record textures that the shader only writes, where it is to run by fragments.
    """
    if device.compute:
        return RecordPass(build_shader(label, *pieces, Piece(group=GROUP)), ())
    targets = tuple(dict.fromkeys(name for piece in pieces for name in piece.images))
    drawn = [
        replace(piece, fragment=piece.compute, compute=None, images={}, outputs=named("VEC4", *piece.images))
        for piece in pieces
    ]
    shader = build_shader(f"{label} by fragments", FULL_SCREEN, Piece(defines=flags("BY_FRAGMENTS")), *drawn)
    return RecordPass(shader, targets, any(piece.writes_depth for piece in pieces))


def marks_for(records: Any) -> Any:
    """A depth texture that marks records of this texture, unfilled."""
    return depth_texture(records.width, records.height)
