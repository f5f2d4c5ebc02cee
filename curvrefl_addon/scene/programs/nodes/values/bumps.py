# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that tilt normals: Normal Map, Bump, and displacement as bumps."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from ...program import NORMAL, TANGENT
from .places import NORMALS_FILE, needs_instance, tangent_of
from .surface import normal_input

_BUMP_FILE = "values/bump.glsl"
_STILL = (TANGENT, NORMAL)
"""Kinds of attributes that Cycles does not look for at neighbors"""
_FILTER_WIDTH = 0.1
"""Of Cycles' bumps from displacement, in pixels"""


def _normal_map(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    b.depend("position")
    color, strength = b.input(source, "Color", "color"), b.input(source, "Strength", "float")
    if node.space.startswith("BLENDER"):
        # "Strange Blender convention", says Cycles: Y and Z are the other way.
        color = b.made("color", f"vec3({color.text}.x, 1.0 - {color.text}.y, 1.0 - {color.text}.z)")
    if node.convention == "DIRECTX":
        color = b.made("color", f"vec3({color.text}.x, 1.0 - {color.text}.y, {color.text}.z)")
    if b.is_world:
        return Expression("(-s.position)", "vector")
    if node.space == "TANGENT":
        found, normal = tangent_of(b, node.uv_map), b.attribute(NORMAL, "")
        return b.call("vector", "normal_map_tangent", "s", color, strength, found, normal, file=NORMALS_FILE)
    needs_instance(b)
    function = "normal_map_object" if "OBJECT" in node.space else "normal_map_world"
    return b.call("vector", function, "s", color, strength, file=NORMALS_FILE)


def _bump(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    normal = normal_input(b, source)
    height = source.input("Height")
    if height.node is None or b.is_world:
        # The same everywhere.
        return normal
    strength, distance = b.input(source, "Strength", "float"), b.input(source, "Distance", "float")
    # (Cycles takes no links for the filter's width.)
    width = b.parameter(float(node.inputs["Filter Width"].default_value))
    scale = b.made("float", f"-{distance.text}") if node.invert else distance
    function = b.function(height, "float")
    return _tilted(b, normal, f"{function}({{}})", (scale, strength, width))


def _tilted(
    b: Builder, normal: Expression, height: str, numbers: tuple[Expression, Expression, Expression]
) -> Expression:
    """Tilted by heights; `height`: GLSL with `{}` for the point. `numbers`: scale, strength, the filter's width."""
    b.need("PROGRAM_BUMP")
    b.include(_BUMP_FILE)
    if b.is_at_neighbors:
        b.note("Bumps {of} of heights by other bumps are drawn as if both were slight.")
    b.shared(("bump", "aligned"), lambda: b.made("float", "bump_aligned(s)"))
    for attribute, number in b.attributes.items():
        if attribute.kind in _STILL:
            b.shared(("bump", number), partial(b.made, "float", f"bump_kept(s, {number})"))
    scale, strength, width = numbers
    points = ("s", f"bump_across(s, {width.text})", f"bump_up(s, {width.text})")
    heights = b.made("vector", f"vec3({', '.join(height.format(point) for point in points)})")
    return b.call("vector", "bump_normal", "s", normal, heights, scale, strength, width)


def _displacement(b: Builder, source: Source) -> Expression:
    """As a vector in world space."""
    node: Any = source.node
    height, middle, scale = (b.input(source, name, "float") for name in ("Height", "Midlevel", "Scale"))
    amount = b.made("float", f"({height.text} - {middle.text}) * {scale.text}")
    normal = normal_input(b, source)
    if node.space == "WORLD" or b.is_world:
        return b.made("vector", f"{amount.text} * {normal.text}")
    needs_instance(b)
    return b.call("vector", "displacement_object", "s", normal, amount, file=NORMALS_FILE)


def _vector_displacement(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    vector, middle = b.input(source, "Vector", "color"), b.input(source, "Midlevel", "float")
    scale = b.input(source, "Scale", "float")
    amount = b.made("vector", f"({vector.text} - {middle.text}) * {scale.text}")
    if node.space == "WORLD" or b.is_world:
        return amount
    needs_instance(b)
    if node.space == "OBJECT":
        return b.made("vector", f"to_world_direction(s, {amount.text})")
    return b.call("vector", "displacement_tangent", "s", amount, tangent_of(b, ""), file=NORMALS_FILE)


def displacement_as_bump(b: Builder, source: Source) -> Expression | None:
    """The normal that displacement, which is plugged into a material's output, gives to surfaces that stay where they
    are; None where it changes none. To be asked before all else of the material: in Cycles what nodes take for the
    surface's normal is this one, so it is put into `s.normal`."""
    if source.node is None or b.is_world:
        return None
    b.depend("position")
    function = b.function(source, "vector")
    numbers = (b.parameter(1.0), b.parameter(1.0), b.parameter(_FILTER_WIDTH))
    tilted = _tilted(b, Expression("s.normal", "vector"), f"dot({function}({{}}), s.normal)", numbers)
    return b.made("vector", f"s.normal = {tilted.text}", -1.0, 1.0)


NODES: Mapping[str, Handler] = {
    "NORMAL_MAP": _normal_map,
    "BUMP": _bump,
    "DISPLACEMENT": _displacement,
    "VECTOR_DISPLACEMENT": _vector_displacement,
}
