# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The classic baseline: six pictures of the scene from the reflector's centre, looked up by direction.

Blinn & Newell's environment map as a cube. It takes everything as infinitely far away, so it is right for the
background and wrong for what is near.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gpu
import numpy as np

from ..scene.arrays import Float32Array
from ..scene.view import View
from .chunk import Batches, Chunk
from .gpu_objects import read_texture
from .lighting import Lighting
from .materials import Materials
from .mirror import Mirror, faces_views
from .shade import ShadePass
from .surfaces import SurfaceBuffer, draw_primary
from .view_block import view_block

SUB_FRAMES = 4
"""Jittered shadings per face: the map is looked up at many scales."""


class EnvironmentCube:
    """The cube map of one mirror's surroundings; drawn once, it does not depend on the eye."""

    def __init__(
        self,
        mirror: Mirror,
        scenery: Sequence[tuple[Chunk, Batches]],
        reach: float,
        materials: Materials,
        lighting: Lighting,
        shade: ShadePass,
        resolution: int,
    ) -> None:
        """`reach`: distance from the mirror's centre to the farthest point of the scenery, metres, or more."""
        near = 0.05 * mirror.nearest_surface
        self._views = faces_views(mirror.center, near, max(2.0 * reach, 10.0 * near), resolution)
        self._scenery, self._materials = scenery, materials
        self._seen = SurfaceBuffer(resolution, resolution)
        self._nothing = SurfaceBuffer(1, 1)
        self._nothing.clear()
        self.color: Any = gpu.types.GPUTexture(resolution, is_cubemap=True, format="RGBA32F")
        """Scene-linear radiance by world direction"""
        self.color.filter_mode(True)
        for face, view in enumerate(self._views):
            target = gpu.types.GPUFrameBuffer(color_slots=({"texture": self.color, "layer": face},))
            with target.bind():
                target.clear(color=(0.0, 0.0, 0.0, 0.0))
            for i in range(SUB_FRAMES):
                uniforms = self._draw_face(view.jittered(((i & 1) - 0.5) / 2, ((i >> 1) - 0.5) / 2))
                lighting.prepare(i * max(lighting.sub_frames // SUB_FRAMES, 1) % lighting.sub_frames)
                shade.add(target, self._seen, self._nothing, uniforms, 1.0 / SUB_FRAMES)

    def _draw_face(self, view: View) -> Any:
        uniforms = view_block(view)
        draw_primary(self._seen, self._scenery, self._materials, uniforms)
        return uniforms

    def geometry(self) -> Float32Array:
        """(6, n, n, 4): world position and object_id (0: background) at each texel's centre."""
        faces = []
        for view in self._views:
            self._draw_face(view)
            faces.append(read_texture(self._seen.position))
        return np.stack(faces)
