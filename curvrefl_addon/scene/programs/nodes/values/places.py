# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that say where on what is shaded: coordinates, attributes, the object, the camera."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy
import numpy as np

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from ...program import FACTOR, GEOMETRY, TANGENT, UV
from ..coordinates import generated, uv

CAMERA_FILE, NORMALS_FILE, INSTANCES_FILE = "values/camera.glsl", "values/normals.glsl", "programs/instances.glsl"


def needs_instance(b: Builder) -> None:
    """The program reads what is known of its instance."""
    b.need("PROGRAM_INSTANCE")
    b.include(INSTANCES_FILE)
    b.depend("instance")


def needs_camera(b: Builder) -> None:
    """The program reads the view that is drawn."""
    b.need("PROGRAM_CAMERA")
    b.include(CAMERA_FILE)
    b.depend("position")


def zero(b: Builder, kind: str = "vector") -> Expression:
    """What stands for something that is not there."""
    return b.parameter(0.0) if kind == "float" else b.parameter(0.0, 0.0, 0.0)


def tangent_of(b: Builder, uv_map: str) -> Expression:
    """(tangent in object space, sign of the bitangent) of a UV map; "": the one that renders use."""
    needs_instance(b)
    b.include(NORMALS_FILE)
    return b.attribute(TANGENT, uv_map)


def _of_instancer(b: Builder, record: int, parts: str) -> Expression:
    if b.is_world:
        return zero(b)
    needs_instance(b)
    text = f"instance_record(s, {record})"
    return b.made("vector", f"{text}.xyz" if parts == "xyz" else f"vec3({text}.xy, 0.0)")


def _coordinates(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    output = source.socket.identifier
    if output == "Generated":
        return _of_instancer(b, 10, "xyz") if node.from_instancer and not b.is_world else generated(b)
    if output == "UV":
        return _of_instancer(b, 11, "xy") if node.from_instancer else uv(b)
    if output == "Object":
        return _object_coordinates(b, node.object)
    b.depend("position")
    if output in ("Normal", "Window") and b.is_at_neighbors:
        b.note(
            f"Bumps {{of}} of heights by the {output.lower()} of Texture Coordinate nodes are drawn flat or elsewhere."
        )
    if output == "Normal":
        if b.is_world:
            return b.made("vector", "-s.position")
        needs_instance(b)
        return b.call("vector", "tangent_object_normal", "s", "s.normal", file=NORMALS_FILE)
    if output == "Reflection":
        b.depend("ray")
        return b.made("vector", "-s.position" if b.is_world else "-reflect(s.incoming, s.normal)")
    needs_camera(b)
    if output == "Camera":
        return b.call("vector", "view_direction" if b.is_world else "view_place", "s.position")
    if output == "Window":
        function = "view_window_of_direction" if b.is_world else "view_window"
        return b.call("vector", function, "s.position")
    return None


def _object_coordinates(b: Builder, other: bpy.types.Object | None) -> Expression:
    """In the space of another object, or of the one that is shaded."""
    b.depend("position")
    if other is not None:
        b.objects.add(other.original.session_uid)
        matrix: Any = np.array(other.matrix_world.inverted_safe(), np.float64)
        first = b.table(matrix[:3])
        rows = ", ".join(f"dot(P({first + row}), vec4(s.position + s.origin, 1.0))" for row in range(3))
        return b.made("vector", f"vec3({rows})")
    if b.is_world:
        return Expression("s.position", "vector")
    needs_instance(b)
    return b.made("vector", "to_object(s, s.position)")


def _uv_map(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    if node.from_instancer:
        return _of_instancer(b, 11, "xy")
    if b.is_world:
        return zero(b)
    return Expression(f"vec3({b.attribute(UV, node.uv_map).text}.xy, 0.0)", "vector")


def _attribute(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    output, name = source.socket.identifier, node.attribute_name
    kind: Any = {"Color": "color", "Vector": "vector"}.get(output, "float")
    is_of_mesh = node.attribute_type == "GEOMETRY"
    if b.is_world and node.attribute_type != "VIEW_LAYER":
        return b.parameter(1.0) if output == "Alpha" else zero(b, kind)
    if is_of_mesh and output == "Fac":
        return Expression(f"{b.attribute(FACTOR, name).text}.x", "float")
    if is_of_mesh:
        found = b.attribute(GEOMETRY, name)
    else:
        needs_instance(b)
        found = b.instance_attribute(f"{node.attribute_type}:{name}")
    if output == "Alpha":
        return Expression(f"{found.text}.w", "float")
    if output == "Fac":
        return b.made("float", f"dot({found.text}.xyz, vec3(1.0 / 3.0))")
    return Expression(f"{found.text}.xyz", kind)


def _color_attribute(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    is_alpha = source.socket.identifier == "Alpha"
    if b.is_world:
        return zero(b, "float" if is_alpha else "color")
    # (What a mesh lacks has no alpha here, unlike with Attribute nodes: as of a UV map, which any attribute may be.)
    found = b.attribute(UV if node.layer_name else GEOMETRY, node.layer_name)
    if is_alpha:
        return Expression(f"{found.text}.w", "float", None, 0.0, 1.0)
    return Expression(f"{found.text}.xyz", "color")


def _object_info(b: Builder, source: Source) -> Expression | None:
    output = source.socket.identifier
    if output == "Material Index":
        return b.parameter(float(_pass_index(source)))
    if b.is_world:
        return zero(b, "vector" if output in ("Location", "Color") else "float")
    needs_instance(b)
    if output == "Location":
        parts = ", ".join(f"instance_record(s, {row}).w" for row in range(3))
        return b.made("vector", f"vec3({parts}) + s.origin")
    texts = {"Alpha": "instance_record(s, 6).w", "Object Index": "instance_record(s, 7).y"}
    if output == "Color":
        return b.made("color", "instance_record(s, 6).xyz")
    if output == "Random":
        return b.made("float", "instance_record(s, 7).x", 0.0, 1.0)
    return b.made("float", texts[output])


def _pass_index(source: Source) -> int:
    """Of the material whose tree the outermost node lies in."""
    outermost = source.groups[0] if source.groups else source.node
    tree = outermost.id_data.original
    owners = (material for material in bpy.data.materials if material.node_tree == tree)
    return next((material.pass_index for material in owners), 0)


def _camera(b: Builder, source: Source) -> Expression:
    needs_camera(b)
    place = b.call("vector", "view_place", "s.position")
    if source.socket.identifier == "View Vector":
        return b.made("vector", f"normalize({place.text})", -1.0, 1.0)
    if source.socket.identifier == "View Z Depth":
        return Expression(f"{place.text}.z", "float")
    return b.made("float", f"length({place.text})", 0.0)


NODES: Mapping[str, Handler] = {
    "TEX_COORD": _coordinates,
    "UVMAP": _uv_map,
    "ATTRIBUTE": _attribute,
    "VERTEX_COLOR": _color_attribute,
    "OBJECT_INFO": _object_info,
    "CAMERA": _camera,
}
