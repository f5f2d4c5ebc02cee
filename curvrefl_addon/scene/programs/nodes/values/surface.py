# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes about the surface and the ray: Geometry, Tangent, Light Path, Fresnel, Vector Transform and their like."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from ...program import GEOMETRY
from ..coordinates import generated
from .places import NORMALS_FILE, needs_camera, needs_instance, tangent_of, zero

_FACING_FILE = "values/facing.glsl"

_FLAGS: Mapping[str, str] = {
    "Is Camera Ray": "RAY_IS_CAMERA",
    "Is Shadow Ray": "RAY_IS_SHADOW",
    "Is Diffuse Ray": "RAY_IS_DIFFUSE",
    "Is Glossy Ray": "RAY_IS_GLOSSY",
    "Is Singular Ray": "RAY_IS_SINGULAR",
    "Is Reflection Ray": "RAY_IS_REFLECTION",
    "Is Transmission Ray": "RAY_IS_TRANSMISSION",
}
_OF_EDGES: Mapping[str, str] = {"Pointiness": ".pointiness", "Random Per Island": ".random_per_island"}
"""Names of attributes (scene/meshes/connectivity.py)"""
_DEPTHS: Mapping[str, str] = {
    "Ray Length": "s.ray_length",
    "Ray Depth": "s.depths.x",
    "Diffuse Depth": "s.depths.y",
    "Glossy Depth": "s.depths.z",
    "Transmission Depth": "s.more_depths.x",
    "Transparent Depth": "s.more_depths.y",
}


def normal_input(b: Builder, source: Source, name: str = "Normal") -> Expression:
    """What is plugged into an input for a normal, or the surface's own."""
    b.depend("position")
    if source.input(name).node is None:
        return Expression("s.normal", "vector")
    return b.input(source, name, "vector")


def _geometry(b: Builder, source: Source) -> Expression | None:
    output = source.socket.identifier
    b.depend("position")
    texts = {
        "Position": "(s.position + s.origin)",
        "Normal": "s.normal",
        "True Normal": "s.true_normal",
        "Incoming": "s.incoming",
    }
    if b.is_world:
        texts = {"Position": "s.position"} | dict.fromkeys(("Normal", "True Normal", "Incoming"), "(-s.position)")
    if output in texts:
        if output != "Position":
            b.depend("ray")
        return Expression(texts[output], "vector")
    if output == "Tangent" and not b.is_world:
        return _radial(b, "Z")
    if output == "Parametric" and not b.is_world:
        if b.is_at_neighbors:
            b.note("Bumps {of} of heights by the parametric coordinates of Geometry nodes are drawn flat.")
        return b.made("vector", "vec3(1.0 - s.parametric.x - s.parametric.y, s.parametric.x, 0.0)", 0.0, 1.0)
    if output == "Backfacing":
        b.depend("ray")
        return zero(b, "float") if b.is_world else b.made("float", "float(s.is_back)", 0.0, 1.0)
    if output in _OF_EDGES and not b.is_world:
        return Expression(f"{b.attribute(GEOMETRY, _OF_EDGES[output]).text}.x", "float", None, 0.0, 1.0)
    return zero(b, "float" if output in ("Backfacing", *_OF_EDGES) else "vector")


def _radial(b: Builder, axis: str) -> Expression:
    """About an axis through the middle of the generated coordinates."""
    needs_instance(b)
    place = generated(b)
    from_middle = b.made("vector", f"{place.text} - 0.5")
    text = {
        "X": "vec3(0.0, -{0}.z, {0}.y)",
        "Y": "vec3(-{0}.z, 0.0, {0}.x)",
        "Z": "vec3(-{0}.y, {0}.x, 0.0)",
    }[axis].format(from_middle.text)
    return b.call("vector", "tangent_across", "s", text, file=NORMALS_FILE)


def _tangent(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    if b.is_world:
        return zero(b)
    b.depend("position")
    if node.direction_type == "RADIAL":
        return _radial(b, node.axis)
    found = tangent_of(b, node.uv_map)
    return b.call("vector", "tangent_across", "s", f"{found.text}.xyz", file=NORMALS_FILE)


def _light_path(b: Builder, source: Source) -> Expression:
    output = source.socket.identifier
    if output in ("Is Volume Scatter Ray", "Portal Depth"):
        # No ray that is followed here scatters in volumes or passes portals.
        return zero(b, "float")
    b.depend("ray")
    if output in _FLAGS:
        return b.made("float", f"float((s.ray & {_FLAGS[output]}) != 0)", 0.0, 1.0)
    return Expression(_DEPTHS[output], "float", None, 0.0)


def _fresnel(b: Builder, source: Source) -> Expression:
    b.depend("ray")
    normal, ior = normal_input(b, source), b.input(source, "IOR", "float")
    return b.call("float", "facing_fresnel_node", "s", normal, ior, file=_FACING_FILE, low=0.0, high=1.0)


def _layer_weight(b: Builder, source: Source) -> Expression:
    b.depend("ray")
    normal, blend = normal_input(b, source), b.input(source, "Blend", "float")
    function = "facing_layer_weight" if source.socket.identifier == "Fresnel" else "facing_facing"
    return b.call("float", function, "s", normal, blend, file=_FACING_FILE, low=0.0, high=1.0)


def _normal(b: Builder, source: Source) -> Expression:
    direction = np.array(source.node.outputs["Normal"].default_value, np.float64)
    direction /= max(float(np.linalg.norm(direction)), 1e-30)
    chosen = b.parameter(*direction.tolist())
    if source.socket.identifier == "Normal":
        return chosen
    normal = b.input(source, "Normal", "vector")
    return b.made("float", f"dot({chosen.text}, normalize({normal.text}))", -1.0, 1.0)


def _light_falloff(b: Builder, source: Source) -> Expression:
    b.depend("ray")
    strength, smooth = b.input(source, "Strength", "float"), b.input(source, "Smooth", "float")
    power = ("Quadratic", "Linear", "Constant").index(source.socket.identifier)
    return b.call("float", "facing_falloff", "s", strength, smooth, power, file=_FACING_FILE)


def _transform(b: Builder, source: Source) -> Expression:
    """Vector Transform: to world space, then from there. (Normals of objects and the camera come out with length 1.)"""
    node: Any = source.node
    value = b.input(source, "Vector", "vector")
    start, end, kind = node.convert_from, node.convert_to, node.vector_type
    if start == end:
        return value
    is_normal = kind == "NORMAL"
    if "CAMERA" in (start, end):
        needs_camera(b)
    if "OBJECT" in (start, end) and not b.is_world:
        needs_instance(b)
        b.include(NORMALS_FILE)
    # (Matrices are about the origin of what is drawn.)
    is_place = kind == "POINT" and not b.is_world
    if start == "WORLD" and is_place:
        value = b.made("vector", f"{value.text} - s.origin")
    if start == "CAMERA":
        function = "view_to_world" if kind == "POINT" else "view_to_world_direction"
        value = b.call("vector", function, value)
        value = b.made("vector", f"normalize({value.text})") if is_normal else value
    elif start == "OBJECT" and not b.is_world:
        names = {"POINT": "to_world", "VECTOR": "to_world_direction", "NORMAL": "tangent_unit_normal"}
        value = b.call("vector", names[kind], "s", value)
    if end == "CAMERA":
        value = b.call("vector", "view_place" if kind == "POINT" else "view_direction", value)
        value = b.made("vector", f"normalize({value.text})") if is_normal else value
    elif end == "OBJECT" and not b.is_world:
        names = {"POINT": "to_object", "VECTOR": "to_object_direction", "NORMAL": "tangent_object_normal"}
        value = b.call("vector", names[kind], "s", value)
    elif is_place:
        value = b.made("vector", f"{value.text} + s.origin")
    return value


NODES: Mapping[str, Handler] = {
    "NEW_GEOMETRY": _geometry,
    "TANGENT": _tangent,
    "LIGHT_PATH": _light_path,
    "FRESNEL": _fresnel,
    "LAYER_WEIGHT": _layer_weight,
    "NORMAL": _normal,
    "LIGHT_FALLOFF": _light_falloff,
    "VECT_TRANSFORM": _transform,
}
