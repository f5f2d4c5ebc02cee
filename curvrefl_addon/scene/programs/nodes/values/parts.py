# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes about particles and volumes, and Scene Time."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from ...program import FACTOR, GEOMETRY
from .places import needs_instance, zero

_OF_PARTICLES = ("Location", "Velocity", "Angular Velocity")
"""Vectors of the node Particle Info"""


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
    "PARTICLE_INFO": _particles,
    "VOLUME_INFO": _volume,
    "INPUT_SCENE_TIME": _time,
}
