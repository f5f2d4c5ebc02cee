# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that tell where a surface is asked, and what it is part of."""

from __future__ import annotations

from typing import Any

from ..trees import DAMP, PAINT, UP, WIND, MakeTree, Row, attribute, rows, shader_node

OUTPUTS: dict[str, tuple[str, str]] = {
    "Texture Coordinate": ("TexCoord", "Generated,Normal,UV,Object,Camera,Window,Reflection"),
    "Geometry": (
        "NewGeometry",
        "Position,Normal,Tangent,True Normal,Incoming,Parametric,Backfacing,Pointiness,Random Per Island",
    ),
    "Object Info": ("ObjectInfo", "Location,Color,Alpha,Object Index,Material Index,Random"),
    "Camera Data": ("CameraData", "View Vector,View Z Depth,View Distance"),
    "Light Path": (
        "LightPath",
        "Is Camera Ray,Is Shadow Ray,Is Diffuse Ray,Is Glossy Ray,Is Singular Ray,Is Reflection Ray,"
        "Is Transmission Ray,Is Volume Scatter Ray,Ray Length,Ray Depth,Diffuse Depth,Glossy Depth,Transparent Depth,"
        "Transmission Depth,Portal Depth",
    ),
    "Particle Info": ("ParticleInfo", "Index,Random,Age,Lifetime,Location,Size,Velocity,Angular Velocity"),
    "Curves Info": ("HairInfo", "Is Strand,Intercept,Length,Thickness,Tangent Normal,Random"),
    "Point Info": ("PointInfo", "Position,Radius,Random"),
    "Volume Info": ("VolumeInfo", "Color,Density,Flame,Temperature"),
}
"""Nodes without settings: a row for each output"""


def _outputs() -> list[Row]:
    return [
        row
        for node, (kind, outputs) in OUTPUTS.items()
        for row in rows(node, *((output, shader_node(kind, output=output)) for output in outputs.split(",")))
    ]


def _attributes() -> list[Row]:
    outputs = ("Color", "Vector", "Factor", "Alpha")

    def all_of(name: str, kind: str = "GEOMETRY") -> list[MakeTree]:
        return [attribute(name, output, kind) for output in outputs]

    return [
        *rows(
            "Attribute",
            ("Geometry, a float", all_of("damp")),
            ("Geometry, a vector", all_of("wind")),
            ("Geometry, a color", all_of("Paint")),
            ("Geometry, a byte color", all_of("Bytes")),
            ("Geometry, a color of points", all_of("Glow")),
            ("Geometry, an integer of faces", all_of("tier")),
            ("Geometry, a UV map", all_of("Other")),
            ("Geometry, no such", all_of("nowhere")),
            ("Object, a number", all_of("warmth", "OBJECT")),
            ("Object, a vector", all_of("shade", "OBJECT")),
            ("Object, no such", all_of("nowhere", "OBJECT")),
            ("Instancer", all_of("warmth", "INSTANCER")),
            ("View layer", all_of("warmth", "VIEW_LAYER")),
        ),
        *rows(
            "Color Attribute",
            ("Named", [shader_node("VertexColor", output=k, layer_name="Glow") for k in range(2)]),
            ("The active one", [shader_node("VertexColor", output=k) for k in range(2)]),
        ),
        *rows(
            "UV Map",
            ("Named", shader_node("UVMap", uv_map="Other")),
            ("The active one", shader_node("UVMap")),
            ("No such", shader_node("UVMap", uv_map="nowhere")),
        ),
        *rows(
            "Tangent",
            *((f"Radial, {axis}", shader_node("Tangent", direction_type="RADIAL", axis=axis)) for axis in "XYZ"),
            ("UV map", shader_node("Tangent", direction_type="UV_MAP")),
            ("Named UV map", shader_node("Tangent", direction_type="UV_MAP", uv_map="Other")),
        ),
    ]


def _angles() -> list[Row]:
    unit = shader_node("VectorMath", {0: WIND}, operation="NORMALIZE")
    bumped = shader_node("NormalMap", {"Color": PAINT})

    def trees(kind: str, name: str, values: tuple[Any, ...], output: str) -> list[MakeTree]:
        plain = [shader_node(kind, {name: value}, output) for value in values]
        return [*plain, *(shader_node(kind, {name: values[0], "Normal": normal}, output) for normal in (unit, bumped))]

    return [
        *rows("Fresnel", ("", trees("Fresnel", "IOR", (1.45, 2.5, 0.7, UP), "Factor"))),
        *rows(
            "Layer Weight",
            *(
                (output, trees("LayerWeight", "Blend", (0.5, 0.2, 0.8, DAMP), output))
                for output in ("Fresnel", "Facing")
            ),
        ),
    ]


def _with_object() -> list[Row]:
    """Texture coordinates of another object."""

    def make(tree: Any) -> Any:
        import bpy

        other = bpy.data.objects.get("other") or bpy.data.objects.new("other", None)
        if other.name not in bpy.context.scene.collection.objects:
            bpy.context.scene.collection.objects.link(other)
        other.location, other.rotation_euler, other.scale = (0.4, 0.3, -0.2), (0.3, 0.8, -0.4), (1.5, 0.7, 1.2)
        node = tree.nodes.new("ShaderNodeTexCoord")
        node.object = other
        return node.outputs["Object"]

    return rows("Texture Coordinate", ("Object, of another object", make))


def _not_in_programs() -> list[Row]:
    return [
        *rows("Wireframe", ("", shader_node("Wireframe"))),
        *rows("Ambient Occlusion", ("", [shader_node("AmbientOcclusion", output=k) for k in range(2)])),
        *rows("Bevel", ("", shader_node("Bevel"))),
        *rows("Raycast", ("", shader_node("Raycast"))),
        *rows("UV Along Stroke", ("", shader_node("UVAlongStroke"))),
        *rows(
            "Light Falloff",
            *((name, shader_node("LightFalloff", output=name)) for name in ("Quadratic", "Linear", "Constant")),
        ),
        *rows("IES Texture", ("", shader_node("TexIES"))),
        *rows("Script", ("", _script)),
    ]


def _script(tree: Any) -> Any:
    """(Blender gives it sockets only where OSL is on.)"""
    node = tree.nodes.new("ShaderNodeScript")
    return node.outputs.new("NodeSocketFloat", "Made") if not node.outputs else node.outputs[0]


ROWS: list[Row] = [*_outputs(), *_attributes(), *_angles(), *_with_object(), *_not_in_programs()]
