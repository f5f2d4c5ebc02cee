# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Voronoi Texture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression, Kind
from .coordinates import node_key, place, texture_vector

_FILE = "nodes/voronoi.glsl"
_KINDS: Mapping[str, Kind] = {"Color": "color", "Position": "vector"}
"""Of outputs; others are numbers"""


def _voronoi(b: Builder, source: Source) -> Expression:
    node = source.node
    dimensions = int(node.voronoi_dimensions[0])
    output = source.socket.identifier
    if node.feature == "DISTANCE_TO_EDGE" and output == "Distance":
        return b.shared(node_key(source, "edge"), lambda: _edge(b, source, dimensions))
    if node.feature == "N_SPHERE_RADIUS" and output == "Radius":
        return b.shared(node_key(source, "radius"), lambda: _radius(b, source, dimensions))
    text = "" if node.feature in ("DISTANCE_TO_EDGE", "N_SPHERE_RADIUS") else _output(dimensions, output)
    if not text:
        # What the node does not give with these settings is 0.
        return b.as_kind(Expression("0.0", "float", (0.0,), 0.0, 0.0), "vector" if output == "Position" else "float")
    point = b.shared(node_key(source, "point"), lambda: _point(b, source, dimensions)).text
    return Expression(text.format(point), _KINDS.get(output, "float"))


def _output(dimensions: int, output: str) -> str:
    """GLSL by the name of the point."""
    if output == "Position":
        return {1: "", 2: "vec3({}.position.xy, 0.0)"}.get(dimensions, "{}.position.xyz")
    if output == "W":
        return {1: "{}.position.x", 4: "{}.position.w"}.get(dimensions, "")
    return {"Distance": "{}.distance", "Color": "{}.color"}.get(output, "")


def _point(b: Builder, source: Source, dimensions: int) -> Expression:
    """The name of a VoronoiPoint, as if it were one number."""
    node = source.node
    feature, metric = node.feature, "MANHATTAN" if dimensions == 1 else node.distance
    if feature == "SMOOTH_F1" and b.constant_of(source, "Smoothness") == (0.0,):
        feature = "F1"
    smoothness = exponent = "1.0"
    if feature == "SMOOTH_F1":
        smoothness = f"clamp({b.input(source, 'Smoothness', 'float').text} / 2.0, 0.0, 0.5)"
    if metric == "MINKOWSKI":
        exponent = b.input(source, "Exponent", "float").text
    arguments = [
        _where(b, source, dimensions),
        f"VORONOI_{feature}",
        str(dimensions),
        f"VORONOI_{metric}",
        "true" if node.normalize else "false",
        _reciprocal(b, source, "Scale"),
        *_octaves(b, source),
        smoothness,
        exponent,
        _randomness(b, source),
    ]
    return Expression(b.made_as("VoronoiPoint", f"voronoi_octaves({', '.join(arguments)})"), "float")


def _edge(b: Builder, source: Source, dimensions: int) -> Expression:
    where, randomness = _where(b, source, dimensions), _randomness(b, source)
    octaves = ", ".join(_octaves(b, source))
    normalized = bool(source.node.normalize)
    return b.call("float", "voronoi_edge_octaves", where, dimensions, normalized, octaves, randomness)


def _radius(b: Builder, source: Source, dimensions: int) -> Expression:
    return b.call("float", "voronoi_n_sphere_radius", _where(b, source, dimensions), dimensions, _randomness(b, source))


def _where(b: Builder, source: Source, dimensions: int) -> str:
    b.include(_FILE)
    vector = "" if dimensions == 1 else texture_vector(b, source).text
    return place(b, source, dimensions, vector, *_numbers(b, source, "Scale")).text


def _octaves(b: Builder, source: Source) -> list[str]:
    detail, roughness, lacunarity = _numbers(b, source, "Detail", "Roughness", "Lacunarity")
    return [f"clamp({detail}, 0.0, 15.0)", f"clamp({roughness}, 0.0, 1.0)", lacunarity]


def _reciprocal(b: Builder, source: Source, name: str) -> str:
    """Of an input, 0 of 0; where it is known, to the last bit, as Cycles' factor: positions may be hashed."""
    known = b.constant_of(source, name)
    if known is not None and len(known) == 1:
        value = np.float32(known[0])
        return b.parameter(float(np.float32(1.0) / value) if value else 0.0).text
    text = b.input(source, name, "float").text
    return f"({text} != 0.0 ? 1.0 / {text} : 0.0)"


def _randomness(b: Builder, source: Source) -> str:
    return f"clamp({b.input(source, 'Randomness', 'float').text}, 0.0, 1.0)"


def _numbers(b: Builder, source: Source, *names: str) -> list[str]:
    return [b.input(source, name, "float").text for name in names]


NODES: Mapping[str, Handler] = {"TEX_VORONOI": _voronoi}
