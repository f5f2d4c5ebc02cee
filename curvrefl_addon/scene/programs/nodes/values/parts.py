# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes about what objects consist of: strands, points, particles, volumes; and Scene Time."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from ...program import FACTOR, GEOMETRY
from .places import needs_instance, zero

_FILE = "values/parts.glsl"
_OF_STRANDS: Mapping[str, str] = {
    "Is Strand": ".curve_is_strand",
    "Intercept": ".curve_intercept",
    "Length": ".curve_length",
    "Random": ".curve_random",
}
"""Names of attributes (scene/strands), all 0 on meshes"""
_OF_PARTICLES = ("Location", "Velocity", "Angular Velocity")
"""Vectors of the node Particle Info"""


def _strands(b: Builder, source: Source) -> Expression:
    output = source.socket.identifier
    if b.is_world:
        return zero(b, "vector" if output == "Tangent Normal" else "float")
    if output in _OF_STRANDS:
        return Expression(f"{b.attribute(GEOMETRY, _OF_STRANDS[output]).text}.x", "float")
    needs_instance(b)
    b.include(_FILE)
    if output == "Thickness":
        return b.call("float", "parts_size", "s", f"{b.attribute(GEOMETRY, '.curve_thickness').text}.x")
    b.depend("ray")
    return b.call("vector", "parts_facing", "s", f"{b.attribute(GEOMETRY, '.curve_tangent').text}.xyz")


def _points(b: Builder, source: Source) -> Expression:
    output = source.socket.identifier
    if b.is_world:
        return zero(b, "vector" if output == "Position" else "float")
    if output == "Random":
        return Expression(f"{b.attribute(GEOMETRY, '.point_random').text}.x", "float")
    needs_instance(b)
    b.include(_FILE)
    radius = f"{b.attribute(GEOMETRY, '.point_radius').text}.x"
    if output == "Radius":
        return b.call("float", "parts_size", "s", radius)
    place = b.attribute(GEOMETRY, ".point_position").text
    return b.made("vector", f"{radius} > 0.0 ? to_world(s, {place}.xyz) : vec3(0.0)")


def _particles(b: Builder, source: Source) -> Expression:
    """(Values of instances: 0 where they are none of a particle.)"""
    output = source.socket.identifier
    is_vector = output in _OF_PARTICLES
    if b.is_world:
        return zero(b, "vector" if is_vector else "float")
    needs_instance(b)
    found = b.instance_attribute(f"PARTICLE:{output}")
    return b.made("vector", f"{found.text}.xyz") if is_vector else b.made("float", f"{found.text}.x")


def _volume(b: Builder, source: Source) -> Expression:
    """On surfaces: attributes of these names."""
    output = source.socket.identifier
    if b.is_world:
        return zero(b, "color" if output == "Color" else "float")
    if output == "Color":
        return Expression(f"{b.attribute(GEOMETRY, 'color').text}.xyz", "color")
    return Expression(f"{b.attribute(FACTOR, output.lower()).text}.x", "float")


def _time(b: Builder, source: Source) -> Expression:
    is_frame = source.socket.identifier == "Frame"
    if b.is_world:
        scene = bpy.context.scene
        rate = 1.0 if is_frame else scene.render.fps / scene.render.fps_base
        return b.parameter(scene.frame_current_final / rate)
    # (As values of instances, so that a new frame is no new material.)
    needs_instance(b)
    frame = b.instance_attribute("VIEW_LAYER:frame_current_final").text
    if is_frame:
        return b.made("float", f"{frame}.x")
    rate, base = (b.instance_attribute(f"VIEW_LAYER:render.{name}").text for name in ("fps", "fps_base"))
    return b.made("float", f"{frame}.x * {base}.x / {rate}.x")


NODES: Mapping[str, Handler] = {
    "HAIR_INFO": _strands,
    "POINT_INFO": _points,
    "PARTICLE_INFO": _particles,
    "VOLUME_INFO": _volume,
    "INPUT_SCENE_TIME": _time,
}
