# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that tell of strands and of points: by the attributes that their meshes have of themselves."""

from __future__ import annotations

from collections.abc import Mapping

from ...materials.node_links import Source
from ...strands.points import POINT_PLACE, POINT_RADIUS, POINT_RANDOM
from ...strands.strands import INTERCEPT, IS_STRAND, LENGTH, RANDOM, TANGENT_ALONG, THICKNESS
from ..builder import Builder, Handler
from ..expression import Expression
from ..program import GEOMETRY
from .values.places import needs_instance, zero

_OF_STRANDS = {
    "Is Strand": IS_STRAND,
    "Intercept": INTERCEPT,
    "Length": LENGTH,
    "Thickness": THICKNESS,
    "Random": RANDOM,
}
"""By output"""


def _number(b: Builder, name: str) -> Expression:
    return Expression(f"{b.attribute(GEOMETRY, name).text}.x", "float", None, 0.0)


def _strand(b: Builder, source: Source) -> Expression | None:
    output = source.socket.identifier
    if b.is_world:
        return zero(b, "vector" if output == "Tangent Normal" else "float")
    if output in _OF_STRANDS:
        return _number(b, _OF_STRANDS[output])
    if output != "Tangent Normal":
        return None
    needs_instance(b)
    b.depend("ray")
    along = b.attribute(GEOMETRY, TANGENT_ALONG)
    return b.call("vector", "strand_tangent_normal", "s", along, file="nodes/strands.glsl")


def _point(b: Builder, source: Source) -> Expression | None:
    output = source.socket.identifier
    if b.is_world:
        return zero(b, "vector" if output == "Position" else "float")
    if output == "Random":
        return _number(b, POINT_RANDOM)
    needs_instance(b)
    if output == "Position":
        place, radius = b.attribute(GEOMETRY, POINT_PLACE), b.attribute(GEOMETRY, POINT_RADIUS)
        return b.call("vector", "point_position", "s", place, radius, file="nodes/strands.glsl")
    if output == "Radius":
        radius = b.attribute(GEOMETRY, POINT_RADIUS)
        return b.call("float", "point_radius", "s", radius, file="nodes/strands.glsl", low=0.0)
    return None


NODES: Mapping[str, Handler] = {"HAIR_INFO": _strand, "POINT_INFO": _point}
