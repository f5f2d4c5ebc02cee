# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that absorb light on the way through them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import Float32Array, SceneArrays
from ..device.records import record_texture
from ..device.shaders import Piece

MEDIA_PLACES = 256
"""Records of media; 0 is none. More than 255 materials that absorb share the last"""
ABSORBING = Piece(samplers={"absorbing": "FLOAT_2D"}, defines={"MEDIA_PLACES": MEDIA_PLACES})
"""What `media.glsl` needs"""


def absorbing(scene: SceneArrays) -> Any:
    """Record texture: absorption per meter of each medium, then the number of each material's medium."""
    return record_texture(medium_records(scene))


def medium_records(scene: SceneArrays) -> Float32Array:
    """(MEDIA_PLACES + materials, 4), see `absorbing`."""
    records = np.zeros((MEDIA_PLACES + len(scene.materials), 4), np.float32)
    count = 0
    for index, material in enumerate(scene.materials):
        if max(material.absorption) > 0.0:
            count = min(count + 1, MEDIA_PLACES - 1)
            records[count, :3] = material.absorption
            records[MEDIA_PLACES + index, 0] = count
    return records
