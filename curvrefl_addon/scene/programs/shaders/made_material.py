# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface as the renderer gets it: constants, and a program for the rest."""

from __future__ import annotations

import math
from typing import Any

from ...arrays import Glass, MaterialArrays
from ..builder import Builder
from ..expression import Expression
from .arithmetic import constant, settled
from .closure import DEFAULTS, GLASS, GLOSSY_ONLY, PLAIN_NORMAL, REFRACTION, THIN_WALL, Closure

ONE_FOR_ALL = {
    "coat_ior": "The IOR of the coat",
    "film_thickness": "The thickness of the thin film",
    "film_ior": "The IOR of the thin film",
    "transparent_tint": "The tint of transparency",
    "subsurface": "The share of subsurface scattering",
}
"""Channels that the renderer has one of for a whole material"""


def made_material(b: Builder, surface: Closure, name: str, is_bent: bool = False) -> MaterialArrays:
    """Channels that are the same everywhere are fields; a program sets the others, if there are any.

    `is_bent`: the program's own normal is not the mesh's.
    """
    fields: dict[str, Any] = {}
    varying: dict[str, Expression] = {}
    for channel in DEFAULTS:
        value = settled(surface.get(channel))
        if value.constant is None and channel in ONE_FOR_ALL:
            b.note(f"{ONE_FOR_ALL[channel]} {{of}} differs from place to place and is drawn as one.")
            value = _middle(value, channel)
        if value.constant is None:
            varying[channel] = value
        elif channel == "kind":
            fields |= _kinds(int(value.constant[0]))
        else:
            fields[channel] = value.constant[0] if value.kind == "float" else value.constant
    if varying["normal"] == PLAIN_NORMAL and not is_bent:
        del varying["normal"]
    if not varying:
        return MaterialArrays(name, **fields)
    ranges = tuple((channel, value.low, value.high) for channel, value in varying.items())
    return MaterialArrays(name, **fields, program=b.finished(varying), ranges=ranges)


def _middle(value: Expression, channel: str) -> Expression:
    """Of its bounds; the default where these are not known."""
    if not math.isfinite(value.high - value.low):
        return DEFAULTS[channel]
    return constant(*((0.5 * (value.low + value.high),) * (1 if value.kind == "float" else 3)), kind=value.kind)


def _kinds(bits: int) -> dict[str, Any]:
    glass = Glass.REFRACTION if bits & int(REFRACTION) else Glass.GLASS if bits & int(GLASS) else Glass.PRINCIPLED
    return {"glossy_only": bool(bits & int(GLOSSY_ONLY)), "thin_wall": bool(bits & int(THIN_WALL)), "glass": glass}
