# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of an instance is shown: itself, and the hair that it grows, which counts as an object of its own."""

from __future__ import annotations

from typing import Any

from ..strands.particles import HairSystem, hair_systems

SHOWN = ("LIGHT", "MESH", "CURVES", "POINTCLOUD")
"""Curves, texts, surfaces, metaballs and what geometry nodes make come as instances of meshes, too"""
HAIR = 1 << 32
"""An object's hair has the object's number plus so many times one more than the number of the system"""


def parts_of(instance: Any, view_layer: Any, is_render: bool) -> list[tuple[int, HairSystem | None]]:
    """Of a `DepsgraphObjectInstance`: numbers, the object's `session_uid` for itself; `is_render`: of a depsgraph for
    renders."""
    obj = instance.object
    uid = obj.original.session_uid
    parts: list[tuple[int, HairSystem | None]] = []
    if obj.type in SHOWN and instance.show_self:
        parts.append((uid, None))
    parts += [(uid + HAIR * (1 + hair.number), hair) for hair in hair_systems(instance, view_layer, is_render)]
    return parts


def uid_of_part(number: int) -> int:
    """The `session_uid` of the object."""
    return number % HAIR
