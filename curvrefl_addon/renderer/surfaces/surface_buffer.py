# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The render targets of a geometry pass.

A surface buffer holds for every pixel the surface there, unlit: world position and object, shading normal and
material, base color. Lighting is done once per pixel afterwards (`shading/shade.py`), for what is visible only.
"""

from __future__ import annotations

from typing import Any

from ..device.frame_buffers import frame_buffer, wait_for
from ..device.shaders import Piece, named
from ..device.textures import depth_texture, empty_texture
from ..programs.buffers import NONE, Buffers, MaterialBuffers

SURFACE_OUTPUTS = Piece(outputs=named("VEC4", "surface_position", "surface_normal", "surface_color_out"))
"""Color targets of a SurfaceBuffer"""
SURFACE_SAMPLERS = ("vertex_position", "vertex_normal", "vertex_color")
"""Their names where shaders look up what rays have met"""
HOLE = -2.0
"""In place of a mirror's number: a hole in the picture"""
SEEN_THROUGH = -3.0
"""In place of a mirror's number: light goes on behind it, and paths follow it"""


class SurfaceBuffer:
    """Render targets of one geometry pass."""

    def __init__(self, width: int, height: int) -> None:
        self.position = empty_texture(width, height)
        """xyz world, object_id (0: nothing here)"""
        self.normal = empty_texture(width, height)
        """xyz unit shading normal, material index"""
        self.color = empty_texture(width, height, "RGBA16F")
        """Base color; the solver's iterations (reflected), or (primary) the mirror's number, -1 of other surfaces, -2
        of a hole in the picture, 0 where nothing is seen"""
        self.depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.position, self.normal, self.color, depth=self.depth)
        self.width, self.height = width, height
        self.made = MaterialBuffers(width, height)
        """What programs make beside"""
        self._with_buffers: dict[Buffers, Any] = {NONE: self.frame_buffer}

    def target(self, buffers: Buffers) -> Any:
        """The frame buffer, with those of the programs' buffers."""
        if buffers not in self._with_buffers:
            textures = (self.position, self.normal, self.color, *self.made.textures(buffers))
            self._with_buffers[buffers] = frame_buffer(*textures, depth=self.depth)
        return self._with_buffers[buffers]

    def clear(self) -> None:
        """Nothing anywhere."""
        with self.frame_buffer.bind():
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        wait_for(self.frame_buffer)
