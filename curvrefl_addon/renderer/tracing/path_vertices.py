# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the paths of all pixels are after a step."""

from __future__ import annotations

from typing import Any

from ..device.frame_buffers import FrameBuffers
from ..device.textures import empty_texture
from ..programs.buffers import MaterialBuffers
from ..rays.material_pass import MaterialPass

MOST_DEPTHS = 4
"""Frame buffers that are kept"""


class PathVertices:
    """What a step of paths has met, one surface for each pixel. `position` of what is infinitely far away is the
    direction, with w = 0."""

    def __init__(self, width: int, height: int, has_programs: bool) -> None:
        self.width, self.height = width, height
        self.position = empty_texture(width, height)
        """xyz world, object_id (0: nothing here)"""
        self.normal = empty_texture(width, height)
        """xyz unit shading normal towards where the path comes from, material index and a quarter for back faces"""
        self.color = empty_texture(width, height, "RGBA16F")
        """Base color, what is shown as `SurfaceBuffer.color`"""
        self.way = empty_texture(width, height)
        """Of the way here: direction, density among those that a rough surface could have chosen, media that it is in
        (`path_state.glsl`)"""
        self.throughput = empty_texture(width, height)
        """What is left of the light on the way, packed state (`path_state.glsl`)"""
        self.made = MaterialBuffers(width, height)
        """What programs make beside"""
        self.hits = empty_texture(width, height) if has_programs else None
        """What was met, for materials' programs (`ray_surface.glsl`)"""
        self.material_pass = MaterialPass(width, height)
        hits = [] if self.hits is None else [self.hits]
        # (Blender takes six at most.)
        textures = (self.position, self.normal, self.color, *hits, self.way, self.throughput)
        self._frame_buffers = FrameBuffers(*textures, most=MOST_DEPTHS)

    def target(self, depth: Any) -> Any:
        """The frame buffer whose pixels are those of a class of the step before."""
        return self._frame_buffers.with_depth(depth)
