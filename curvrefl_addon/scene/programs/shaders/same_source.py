# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two inputs of nodes get the same value by nodes that are copies of each other."""

from __future__ import annotations

from typing import Any

import bpy

from ...materials.node_links import Source
from ..builder import plain_value

_OF_ANY_NODE = frozenset(bpy.types.ShaderNode.bl_rna.properties.keys())
_MOST_STEPS = 64
"""Nodes along one way"""


def is_same_source(one: Source, other: Source, steps: int = _MOST_STEPS) -> bool:
    """Surely the same everywhere. (glTF's importer makes a node for each use of an image.)"""
    if one == other:
        return True
    first, second = one.node, other.node
    if first is None or second is None:
        return first is second and plain_value(one.socket) == plain_value(other.socket)
    if steps == 0 or first.type != second.type or one.socket.identifier != other.socket.identifier:
        return False
    settings = {item.identifier for item in first.bl_rna.properties} - _OF_ANY_NODE
    if not all(_is_same(first, second, name) for name in settings):
        return False
    if first.type in ("VALUE", "RGB"):
        return plain_value(one.socket) == plain_value(other.socket)
    pairs = zip(one.inputs(), other.inputs(), strict=False)
    return len(first.inputs) == len(second.inputs) and all(is_same_source(a, b, steps - 1) for a, b in pairs)


def _is_same(first: Any, second: Any, name: str) -> bool:
    """Of a setting of nodes."""
    values = getattr(first, name), getattr(second, name)
    if isinstance(values[0], bpy.types.bpy_struct) and not isinstance(values[0], bpy.types.ID):
        # (What says the frame of a movie or how a node is mapped differs in files made by hand alone.)
        image = first.image if first.type == "TEX_IMAGE" else None
        return image is not None and image.source not in ("MOVIE", "SEQUENCE")
    return bool(values[0] == values[1])
