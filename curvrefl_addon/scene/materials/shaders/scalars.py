# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Roughness, metallic, transmission and alpha of a surface, as the channels of one image."""

from __future__ import annotations

import numpy as np

from ...arrays import Float32Array, ImageArrays
from ..node_color import NodeColor
from ..surface_textures import SurfaceTexture
from .surface import Surface

CHANNELS = ("roughness", "metallic", "transmission", "alpha")


def packed_scalars(surface: Surface, notes: list[str]) -> SurfaceTexture | None:
    """An image with all scalars, None where none has a texture; one that lies elsewhere is its mean, with a note."""
    # What decides whether there is a surface at all goes first.
    textures = [_texture(surface.textures[name]) for name in reversed(CHANNELS) if name in surface.textures]
    if not textures:
        return None
    aligned = [texture for texture in textures if _lies_on(texture, textures[0])]
    grid = max(aligned, key=lambda texture: texture.image.pixels.size)
    height, width = grid.image.pixels.shape[:2]
    pixels = np.empty((height, width, 4), np.float32)
    for channel, name in enumerate(CHANNELS):
        pixels[..., channel] = getattr(surface.rest, name)
        value = surface.textures.get(name)
        if value is None:
            continue
        found = _on(grid, value)
        if found is None:
            notes.append(f"{name.capitalize()} {{of}} is shown as its mean.")
            continue
        is_compared = name == "alpha" and surface.rest.alpha_threshold >= 0.0
        pixels[..., channel] = found if is_compared else np.clip(found, 0.0, 1.0)
    image = ImageArrays(f"{grid.image.name}: scalars", pixels, grid.image.extension, grid.image.nearest)
    return SurfaceTexture(image, grid.space)


def _texture(value: NodeColor) -> SurfaceTexture:
    assert isinstance(value.texture, SurfaceTexture)
    return value.texture


def _lies_on(texture: SurfaceTexture, other: SurfaceTexture) -> bool:
    return (
        texture.space == other.space
        and texture.image.extension == other.image.extension
        and texture.image.nearest == other.image.nearest
    )


def _on(grid: SurfaceTexture, value: NodeColor) -> Float32Array | None:
    """(h, w) of a gray at the grid's pixels."""
    texture = _texture(value)
    pixels = grid.aligned(texture) if _lies_on(texture, grid) else None
    return None if pixels is None else pixels[..., 0] * np.float32(value.factor[0])
