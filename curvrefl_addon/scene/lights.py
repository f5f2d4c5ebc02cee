# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender lamps to arrays."""

from __future__ import annotations

import math

import bpy
import numpy as np

from .arrays import LightArrays


def read_light(light: bpy.types.Light, source: bpy.types.Object, matrix: np.ndarray, warnings: list[str]) -> LightArrays:
    """A lamp placed by the world matrix (4, 4); `source` gives its visibility."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    placed = matrix.copy()
    placed[:3, :3] /= np.where(lengths > 0.0, lengths, 1.0)
    size = (0.0, 0.0)
    area = 1.0
    if light.type == "AREA":
        square = light.shape in ("SQUARE", "DISK")
        size = (light.size * lengths[0], (light.size if square else light.size_y) * lengths[1])
        area = size[0] * size[1] * (math.pi / 4 if light.shape in ("DISK", "ELLIPSE") else 1.0)
    elif light.type in ("POINT", "SPOT"):
        area = 4.0 * math.pi * light.shadow_soft_size**2
    elif light.type == "SUN":
        area = math.pi * math.sin(0.5 * light.angle) ** 2
    strength = light.energy * 2.0**light.exposure
    if not light.normalize:
        # The strength is then per area, and a lamp of no area shines as it would normalised.
        strength *= area if area > 0.0 else 1.0
    color = np.array(light.color) * strength
    if light.use_temperature:
        color = color * np.array(light.temperature_color)
    color = color * _node_factor(light, warnings)
    return LightArrays(
        name=source.name,
        kind=light.type,
        color=(float(color[0]), float(color[1]), float(color[2])),
        matrix=placed,
        radius=light.shadow_soft_size if light.type in ("POINT", "SPOT") else 0.0,
        angle=light.angle if light.type == "SUN" else 0.0,
        spot_angle=light.spot_size if light.type == "SPOT" else 0.0,
        spot_blend=light.spot_blend if light.type == "SPOT" else 0.0,
        size=(float(size[0]), float(size[1])),
        ellipse=light.type == "AREA" and light.shape in ("DISK", "ELLIPSE"),
        casts_shadow=light.use_shadow,
        visible_glossy=source.visible_glossy,
    )


def _node_factor(light: bpy.types.Light, warnings: list[str]) -> np.ndarray:
    """What the lamp's nodes multiply its colour by."""
    output = light.node_tree.get_output_node("CYCLES") if light.use_nodes and light.node_tree else None
    if output is None or not output.inputs["Surface"].is_linked:
        return np.ones(3)
    emission = output.inputs["Surface"].links[0].from_node
    if emission.type != "EMISSION" or any(socket.is_linked for socket in emission.inputs):
        warnings.append(f'Lamp "{light.name}": its nodes are not supported and left out.')
        return np.ones(3)
    return np.array(emission.inputs["Color"].default_value)[:3] * emission.inputs["Strength"].default_value
