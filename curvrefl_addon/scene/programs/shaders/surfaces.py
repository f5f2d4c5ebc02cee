# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From the end of the links at a material's output to one surface."""

from __future__ import annotations

from ...materials.node_links import Source, find_input
from ..builder import Builder
from .arithmetic import is_at
from .bsdfs import BSDFS
from .chance import Chance
from .closure import BLACK, Closure, matt, shining
from .inputs import color, number
from .mixes import HALF, add, mix

SIDES = ("Shader", "Shader_001")


def surface_of(b: Builder, source: Source, chance: Chance | None = None) -> Closure:
    """The surface of a shader node; black where there is none."""
    chance = chance or Chance()
    node = source.node
    if node is None:
        return matt(BLACK)
    if source.socket.type != "SHADER":
        # Cycles takes a color for an emission of it.
        return shining(b.value(source, "color"))
    if node.type in BSDFS:
        return BSDFS[node.type](b, source, chance)
    if node.type == "MIX_SHADER":
        return _mix(b, source, chance)
    if node.type == "ADD_SHADER":
        return _add(b, source, chance)
    b.note(f"{node.bl_label} {{of}} is drawn as the nearest plain surface.")
    has_color = any(find_input(node, socket.identifier).identifier == "Color" for socket in node.inputs)
    return matt(color(b, source, "Color") if has_color else BLACK)


def _mix(b: Builder, source: Source, chance: Chance) -> Closure:
    share = number(b, source, "Fac", 0.0, 1.0)
    if is_at(share, 0.0) or is_at(share, 1.0):
        return surface_of(b, source.input(SIDES[int(is_at(share, 1.0))]), chance)
    inside = chance.inside(share)
    first, second = (surface_of(b, source.input(name), inside) for name in SIDES)
    return mix(b, first, second, share, chance)


def _add(b: Builder, source: Source, chance: Chance) -> Closure:
    inside = chance.inside(HALF)
    first, second = (surface_of(b, source.input(name), inside) for name in SIDES)
    return add(b, first, second, chance)
