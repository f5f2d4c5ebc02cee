# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as textures."""

from __future__ import annotations

from typing import Any

import numpy as np

from ....scene.arrays import Float32Array, WorldArrays
from ....scene.materials.pixels import averaged
from ...device.textures import largest_texture, texture_2d, texture_layers
from .world import BakedWorld

SEEN = "LIGHTING_SEEN"
"""A feature: the camera sees another world than mirrors do"""
FEWER_PIXELS = "Fewer pixels of the world's image are drawn than there are: as many as the graphics driver takes."


def world_samplers(features: frozenset[str]) -> dict[str, str]:
    """What `world_light.glsl` needs."""
    seen = {"lighting_world_seen": "FLOAT_2D"} if SEEN in features else {}
    return {"lighting_world_maps": "FLOAT_2D_ARRAY", "lighting_world_image": "FLOAT_2D", **seen}


class WorldTextures:
    """Of one state of the world."""

    def __init__(self, world: BakedWorld, maps: Float32Array) -> None:
        """`maps`: of `world.WorldLight`."""
        self._maps = texture_layers(maps)
        self._image = _texture(world.glossy)
        self._seen = None
        if world.seen is not world.glossy:
            image = np.ones((1, 1, 3), np.float32) if world.seen.image is None else world.seen.image
            self._seen = _texture(WorldArrays(image=image * np.asarray(world.seen.color, np.float32)))
        self.features = frozenset() if self._seen is None else frozenset({SEEN})
        shown = world.glossy.image
        is_too_large = shown is not None and max(shown.shape) > largest_texture()
        self.warnings = (*world.warnings, *((FEWER_PIXELS,) if is_too_large else ()))

    def bind(self, shader: Any) -> None:
        """Set `world_samplers` on a bound shader."""
        shader.uniform_sampler("lighting_world_maps", self._maps)
        shader.uniform_sampler("lighting_world_image", self._image)
        if self._seen is not None:
            shader.uniform_sampler("lighting_world_seen", self._seen)


def _texture(world: WorldArrays) -> Any:
    """Of the world's image, or of one black pixel."""
    if world.image is None:
        return texture_2d(np.zeros((1, 1, 4), np.float32))
    pixels = averaged(world.image, largest_texture(), largest_texture())
    image = np.ones((*pixels.shape[:2], 4), np.float32)
    image[..., :3] = pixels
    return texture_2d(image, linear=True, extension="REPEAT")
