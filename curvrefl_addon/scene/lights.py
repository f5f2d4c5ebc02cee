# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps, in the units of `LightArrays`."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np

from .arrays import Float64Array, LightArrays
from .finite import LARGEST_PLACE, LARGEST_POWER, is_usable, problem_of_place
from .materials.node_links import source_of
from .programs.emitters import lamp_emitter
from .programs.emitting import Emitter
from .remarks import Remark
from .visibility import RayVisibility

NARROW_SPREAD = 0.5
"""Radians under which the few places on a lamp that light is looked up from tell"""
FEW_BOUNCES = 4
"""A lamp that lights what is seen after so many mirrors or more is as good as one without a limit"""


def read_light(
    obj: bpy.types.Object, matrix: Float64Array, rays: RayVisibility, warnings: list[Remark | str]
) -> LightArrays | None:
    """The lamp of `obj` placed by `matrix` (4, 4) and seen by `rays`; None for one without light or place.

    As in Cycles, sizes of area lamps follow the object's scale but their power does not, and balls keep their radius.
    An area lamp without area gives no light, nor does a portal.
    """
    light, name = obj.data, obj.name
    assert isinstance(light, bpy.types.Light)
    if problem := problem_of_place(matrix, 0.0):
        warnings.append(f'Lamp "{name}" {problem} and is left out.')
        return None
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if lengths.min() == 0.0 or not is_usable(lengths):
        warnings.append(f'Lamp "{name}" has a zero or endless scale and is left out.')
        return None
    placed = matrix.copy()
    placed[:3, :3] /= lengths
    color = np.array(light.color, np.float64) * light.energy * 2.0**light.exposure
    if light.use_temperature:
        color *= np.array(light.temperature_color, np.float64)
    by_nodes, emitter = _by_nodes(light, name, warnings)
    color *= by_nodes
    if not is_usable(color, LARGEST_POWER):
        warnings.append(f'Lamp "{name}" is left out: its color or power is not a usable number.')
        return None
    # Cycles is an add-on, and may be off. What it has of a lamp does not get into evaluated copies by itself.
    cycles = getattr(obj.original.data, "cycles", None)
    is_portal = light.type == "AREA" and cycles is not None and cycles.is_portal
    if is_portal or not color.any() or not (rays.camera or rays.diffuse or rays.glossy):
        return None
    _warn_of_limits(obj, cycles, warnings)
    is_seen = cycles is None or cycles.use_multiple_importance_sampling

    kind = str(light.type)
    radius = angle = spot_angle = spot_blend = 0.0
    spread = math.pi
    is_ball = False
    size = (0.0, 0.0)
    ellipse = False
    area = 1.0
    if isinstance(light, bpy.types.SunLight):
        angle = light.angle
        if angle > 0.0:
            area = math.pi * math.sin(0.5 * angle) ** 2
    elif isinstance(light, bpy.types.AreaLight):
        height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
        size = (float(light.size * lengths[0]), float(height * lengths[1]))
        ellipse = light.shape in ("DISK", "ELLIPSE")
        area = size[0] * size[1] * (math.pi / 4.0 if ellipse else 1.0)
        if area == 0.0:
            return None
        spread = light.spread
        if spread < NARROW_SPREAD:
            warnings.append(Remark("The narrow spread {of} is drawn roughly.", "lamp", name))
    elif isinstance(light, (bpy.types.PointLight, bpy.types.SpotLight)):
        radius = light.shadow_soft_size
        is_ball = radius > 0.0 and not light.use_soft_falloff
        area = 4.0 * math.pi * radius**2 if radius > 0.0 else 4.0
        if isinstance(light, bpy.types.SpotLight):
            spot_angle, spot_blend = light.spot_size, light.spot_blend
            if lengths.max() > lengths.min() * 1.001:
                warnings.append(f'The cone of spot lamp "{name}" is drawn round, whatever its scale.')
    if not light.normalize:
        # The energy is then that of a square meter; Cycles counts a point as four.
        color *= area
    if not (
        is_usable((radius, *size), LARGEST_PLACE)
        and is_usable((angle, spot_angle, spot_blend))
        and is_usable(color, LARGEST_POWER)
    ):
        warnings.append(f'Lamp "{name}" is left out: its size is not a usable number.')
        return None
    r, g, b = color.tolist()
    return LightArrays(
        name=name,
        kind=kind,
        color=(r, g, b),
        matrix=placed,
        radius=radius,
        angle=angle,
        spot_angle=spot_angle,
        spot_blend=spot_blend,
        size=size,
        ellipse=ellipse,
        spread=spread,
        is_ball=is_ball,
        casts_shadow=light.use_shadow,
        visible_camera=rays.camera and is_seen,
        visible_glossy=rays.glossy and is_seen,
        lights_diffuse=rays.diffuse,
        lights_glossy=rays.glossy,
        emitter=emitter,
    )


def _warn_of_limits(obj: bpy.types.Object, cycles: Any, warnings: list[Remark | str]) -> None:
    """What limits the reach of a lamp in Cycles and is not followed."""
    if cycles is not None and cycles.max_bounces < FEW_BOUNCES:
        warnings.append(
            f'Lamp "{obj.name}" lights all that mirrors show: its limit of {cycles.max_bounces} bounces is left out.'
        )


def _by_nodes(
    light: bpy.types.Light, name: str, warnings: list[Remark | str]
) -> tuple[tuple[float, float, float], Emitter | None]:
    """What the lamp's nodes multiply its color with."""
    tree = light.node_tree
    outputs = [node for node in tree.nodes if node.type == "OUTPUT_LIGHT"] if tree is not None else []
    if not outputs:
        return (1.0, 1.0, 1.0), None
    output = next((node for node in outputs if getattr(node, "is_active_output", False)), outputs[0])
    source = source_of(output.inputs["Surface"])
    notes: list[str] = []
    color, emitter, remarks = lamp_emitter(source, notes)
    warnings += [*(Remark(cause, "lamp", name) for cause in dict.fromkeys(notes)), *remarks]
    return color, emitter
