# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of the world as textures."""

from __future__ import annotations

from typing import Any

import numpy as np

from ....scene.arrays import WorldArrays
from ....scene.materials.pixels import averaged
from ...device.textures import largest_texture, texture_2d

FEWER_PIXELS = "Fewer pixels of the world's image are drawn than there are: as many as the graphics driver takes."


def world_texture(world: WorldArrays) -> tuple[Any, tuple[str, ...]]:
    """Texture of the world's image, or of one black pixel, and what is wrong with it."""
    if world.image is None:
        return texture_2d(np.zeros((1, 1, 4), np.float32)), ()
    pixels = averaged(world.image, largest_texture(), largest_texture())
    image = np.ones((*pixels.shape[:2], 4), np.float32)
    image[..., :3] = pixels
    warnings = () if pixels.shape == world.image.shape else (FEWER_PIXELS,)
    return texture_2d(image, linear=True, extension="REPEAT"), warnings


def seen_texture(world: WorldArrays) -> Any:
    """The same of what the camera sees, with the factor in it."""
    image = np.ones((1, 1, 3), np.float32) if world.image is None else world.image
    return world_texture(WorldArrays(image=image * np.asarray(world.color, np.float32)))[0]
