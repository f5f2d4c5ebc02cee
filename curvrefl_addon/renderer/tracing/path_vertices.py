# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the paths of all pixels are after a step."""

from __future__ import annotations

from typing import Any

from ..device.frame_buffers import frame_buffer
from ..device.textures import empty_texture
from ..paths.features import SCALARS


class PathVertices:
    """What a step of paths has met, one surface for each pixel. `position` of what is infinitely far away is the
    direction, with w = 0."""

    def __init__(self, width: int, height: int, features: frozenset[str], with_images: bool) -> None:
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
        self.uv = empty_texture(width, height) if with_images else None
        """uv, 1 where there is a surface"""
        self.scalars = empty_texture(width, height, "RGBA16F") if SCALARS in features else None
        """Roughness, metallic, transmission, alpha, where a material has an image of them"""
        images = [] if self.uv is None else [self.uv]
        # (Blender takes six at most.)
        self._textures = [self.position, self.normal, self.color, *images, self.way, self.throughput]
        self._targets: list[tuple[Any, dict[str, Any]]] = []

    def targets(self, depth: Any) -> dict[str, Any]:
        """Frame buffers whose pixels are those of a class of the step before: 'all', 'color', 'scalars'."""
        for known, targets in self._targets:
            if known is depth:
                return targets
        targets = {"all": frame_buffer(*self._textures, depth=depth), "color": frame_buffer(self.color, depth=depth)}
        if self.scalars is not None:
            targets["scalars"] = frame_buffer(self.scalars, depth=depth)
        self._targets = [*self._targets[-3:], (depth, targets)]
        return targets
