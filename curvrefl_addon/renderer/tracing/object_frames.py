# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects' axes, for tangents about their Z axis: of the brushing of anisotropic metal.

As Cycles' default tangent it goes about the middle of the mesh's box, in coordinates that the box scales to a cube.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import Float32Array, SceneArrays
from ..device.records import record_texture
from ..device.shaders import Piece

FRAME_RECORDS = 4
OBJECT_FRAMES = Piece(samplers={"object_frames": "FLOAT_2D"}, defines={"FRAME_RECORDS": FRAME_RECORDS})
"""What `tangent_about_z` in `path_vertex.glsl` needs"""


def object_frames(scene: SceneArrays) -> Any:
    """Record texture by object_id."""
    return record_texture(frame_records(scene).reshape(-1, 4))


def frame_records(scene: SceneArrays) -> Float32Array:
    """(objects + 1, FRAME_RECORDS, 4): rows that give x and y from the middle over the box's widths; world axes x, y.

    Of those that are anisotropic; of an object with several instances the first counts.
    """
    count = 1 + max((instance.object_id for instance in scene.instances), default=0)
    records = np.zeros((count, FRAME_RECORDS, 4))
    done: set[int] = set()
    for instance in scene.instances:
        if instance.object_id in done or not any(
            scene.materials[index].range_of("anisotropy") != (0.0, 0.0) for index in instance.materials
        ):
            continue
        done.add(instance.object_id)
        positions = scene.meshes[instance.mesh].positions
        if len(positions) == 0:
            continue
        low, high = positions.min(axis=0).astype(np.float64), positions.max(axis=0).astype(np.float64)
        middle, width = 0.5 * (low + high), np.maximum(high - low, 1e-30)
        try:
            to_object = np.linalg.inv(instance.matrix)
        except np.linalg.LinAlgError:
            # (A flat object: nothing is seen of it that could be brushed.)
            continue
        record = records[instance.object_id]
        for axis in range(2):
            record[axis] = to_object[axis]
            record[axis, 3] -= middle[axis]
            record[axis] /= width[axis]
            record[2 + axis, :3] = instance.matrix[:3, axis]
    return records.astype(np.float32)
