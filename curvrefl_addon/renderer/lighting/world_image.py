# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's image on the GPU."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import WorldArrays
from ...scene.materials.pixels import averaged
from ..device.textures import largest_texture, texture_2d


def world_image(world: WorldArrays) -> tuple[Any, tuple[str, ...]]:
    """Texture, black where there is no image, and what is not as it is, one sentence each."""
    if world.image is None:
        return texture_2d(np.zeros((1, 1, 4), np.float32)), ()
    pixels = averaged(world.image, largest_texture(), largest_texture())
    image = np.ones((*pixels.shape[:2], 4), np.float32)
    image[..., :3] = pixels
    texture = texture_2d(image, linear=True, extension="REPEAT")
    if pixels.shape == world.image.shape:
        return texture, ()
    return texture, (
        "Fewer pixels of the world's image are drawn than there are: as many as the graphics driver takes.",
    )
