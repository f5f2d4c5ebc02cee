# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The eye as a uniform block `view`, the same in all passes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.camera.view import View
from ..device.shaders import Block, Piece, uniform_block

_TYPEDEF = "struct ViewBlock { mat4 world_to_view; mat4 view_to_clip; mat4 clip_to_world; vec4 eye; };"
VIEW = Piece(blocks={"view": Block("ViewBlock", _TYPEDEF)})
_BLOCK = np.dtype(
    [("world_to_view", "f4", (4, 4)), ("view_to_clip", "f4", (4, 4)), ("clip_to_world", "f4", (4, 4)), ("eye", "f4", 4)]
)


def view_block(view: View) -> Any:
    """GPUUniformBuf of a view; keep it until the draws that use it are done."""
    block = np.zeros(1, _BLOCK)
    block["world_to_view"] = view.world_to_view.T
    block["view_to_clip"] = view.view_to_clip.T
    block["clip_to_world"] = view.clip_to_world.T
    block["eye"] = view.eye
    return uniform_block(block)
