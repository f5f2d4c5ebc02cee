# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Position and normal of one reflector in a widened view (Estalella et al. 2006, sections 4 and 5.2)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...scene.arrays import Float64Array
from ...scene.camera.view import View
from ..geometry.chunk import Batches, Chunk
from ..surfaces.materials import Materials
from ..surfaces.primary import depths_of, draw_primary
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import view_block


def widened(view: View, frustum: float, resolution: float) -> View:
    """The same eye with the picture plane `frustum` times as wide and high, and `resolution` texels per pixel."""
    projection = view.view_to_clip.copy()
    projection[:2] /= frustum
    size = [max(round(side * frustum * resolution), 1) for side in (view.width, view.height)]
    return replace(view, view_to_clip=projection, width=size[0], height=size[1])


class ScreenMaps:
    """The targets of one reflector; kept from view to view."""

    def __init__(self) -> None:
        self._target: SurfaceBuffer | None = None

    def draw(self, surface: tuple[Chunk, Batches], materials: Materials, view: View) -> dict[str, Any]:
        """Draw the reflector alone as `view` (widened) sees it; textures by sampler name, world space."""
        if self._target is None or (self._target.width, self._target.height) != (view.width, view.height):
            self._target = SurfaceBuffer(view.width, view.height)
        # Bound by reference only until the draw is done.
        uniforms = view_block(view)
        draw_primary(
            self._target,
            [surface],
            materials,
            uniforms,
            is_smooth=lambda _chunk: True,
            depths=depths_of(view),
            mirrored=view.is_mirrored,
        )
        return {"screen_position": self._target.position, "screen_normal": self._target.normal}


def map_to_texels(view: View, world_to_map: Float64Array) -> Float64Array:
    """(4, 4) homogeneous points in the map frame to texels of a view's targets."""
    to_texels = np.diag([0.5 * view.width, 0.5 * view.height, 1.0, 1.0])
    to_texels[:2, 3] = 0.5 * view.width, 0.5 * view.height
    return to_texels @ view.world_to_clip @ np.linalg.inv(world_to_map)
