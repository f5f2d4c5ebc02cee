# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves of Blender as strands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np

from ..arrays import Float32Array
from ..meshes.attributes import PARTS, values_of
from ..programs.program import FACTOR, TANGENT, UV, Attribute
from .strands import Strands

PLAIN_RADIUS = 0.005
"""Of curves that have none"""


def strands_of_curves(curves: Any, wanted: Sequence[Attribute]) -> Strands:
    """Of evaluated curves, object space; those of one point are left out."""
    count = len(curves.points)
    starts = np.zeros(len(curves.curves) + 1, np.int32)
    curves.curve_offset_data.foreach_get("value", starts)
    points = np.zeros((count, 3), np.float32)
    curves.position_data.foreach_get("vector", points.reshape(-1))
    radii = _of_points(curves, "radius", count)
    slots = curves.attributes.get("material_index")
    materials = np.zeros(len(starts) - 1, np.int32)
    if slots is not None and slots.domain == "CURVE" and slots.data_type == "INT":
        slots.data.foreach_get("value", materials)
    strands = Strands(
        points,
        np.full(count, PLAIN_RADIUS, np.float32) if radii is None else np.maximum(radii, np.float32(0.0)),
        starts.astype(np.int64),
        np.maximum(materials, 0),
        layers_of(curves, wanted),
    )
    return strands.chosen(strands.lengths > 1)


def layers_of(data: Any, wanted: Sequence[Attribute]) -> tuple[tuple[Attribute, Float32Array], ...]:
    """Those of the `wanted` attributes that curves or points have, on their own domains."""
    layers = []
    for attribute in wanted:
        found = _named(data, attribute)
        if found is None or found.data_type not in PARTS:
            continue
        values = values_of(found)
        if attribute.kind == FACTOR:
            values = values[:, :1] if values.shape[1] <= 2 else values[:, :3].mean(axis=1, keepdims=True)
        layers.append((attribute, values))
    return tuple(layers)


def _named(data: Any, attribute: Attribute) -> bpy.types.Attribute | None:
    if attribute.kind == TANGENT:
        return None
    if attribute.kind == UV and not attribute.name:
        # (As in Cycles the first that could be.)
        return next((item for item in data.attributes if item.data_type == "FLOAT2"), None)
    found: bpy.types.Attribute | None = data.attributes.get(attribute.name) if attribute.name else None
    return found


def _of_points(data: Any, name: str, count: int) -> Float32Array | None:
    """(count,)"""
    attribute = data.attributes.get(name)
    if attribute is None or attribute.domain != "POINT" or attribute.data_type != "FLOAT":
        return None
    values = np.zeros(count, np.float32)
    attribute.data.foreach_get("value", values)
    return values
