# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that are no meshes: text, curves, hair, points, volumes, grease pencil; and simulated ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import MIRROR, awkward
from ..stage import add_sheet, bpy, find, link, matte, stage


@awkward("text")
def text(folder: Path) -> None:
    stage(things=False)
    bpy.ops.object.text_add(location=(-1.5, -1.8, 0.1), rotation=(1.3, 0.0, 0.0))
    data = bpy.context.object.data
    data.body, data.size, data.extrude = "Text", 1.2, 0.05
    data.materials.append(matte("Ink", (0.8, 0.3, 0.05)))


@awkward("a filled curve")
def filled_curve(folder: Path) -> None:
    stage(things=False)
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.8, location=(0.0, -1.9, 0.6), rotation=(1.2, 0.0, 0.0))
    curve = bpy.context.object.data
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    curve.materials.append(matte("Disk", (0.8, 0.3, 0.05)))


@awkward("a curve bevelled by another and tapered")
def bevel_object(folder: Path) -> None:
    stage(things=False)
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.12, location=(0.0, 0.0, -3.0))
    profile = bpy.context.object
    bpy.ops.curve.primitive_bezier_curve_add(radius=1.2, location=(0.0, -1.9, 0.7), rotation=(1.5, 0.0, 0.0))
    curve = bpy.context.object.data
    curve.bevel_mode, curve.bevel_object = "OBJECT", profile
    curve.materials.append(matte("Rope", (0.8, 0.5, 0.2)))


@awkward("a NURBS surface")
def nurbs_surface(folder: Path) -> None:
    stage(things=False)
    bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=0.7, location=(0.0, -1.9, 0.7))
    bpy.context.object.data.materials.append(matte("Ring", (0.2, 0.5, 0.8)))


@awkward("hair curves")
def hair_curves(folder: Path) -> None:
    # (What it is about is not how light goes from strand to strand.)
    stage(things=False).cycles.diffuse_bounces = 0
    data: Any = bpy.data.hair_curves.new("Fur")
    data.add_curves([4] * 400)
    rng = np.random.default_rng(4)
    roots = rng.uniform((-1.5, -2.2, 0.0), (1.5, -1.5, 0.0), (400, 3))
    steps = np.linspace(0.0, 1.0, 4)[None, :, None]
    bend = rng.uniform((-0.2, -0.2, 0.5), (0.2, 0.2, 0.9), (400, 1, 3))
    points = (roots[:, None] + steps * bend).astype(np.float32)
    data.position_data.foreach_set("vector", points.ravel())
    data.set_types(type="POLY")
    radius = data.attributes.new("radius", "FLOAT", "POINT")
    radius.data.foreach_set("value", np.full(1600, 0.015, np.float32))
    data.materials.append(matte("Fur", (0.6, 0.4, 0.2)))
    link(data, "Fur")


@awkward("a point cloud")
def point_cloud(folder: Path) -> None:
    stage().cycles.diffuse_bounces = 0
    bed = find("Green")
    tree: Any = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, output = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    points = tree.nodes.new("GeometryNodeMeshToPoints")
    points.inputs["Radius"].default_value = 0.2
    tree.links.new(source.outputs[0], points.inputs[0])
    tree.links.new(points.outputs[0], output.inputs[0])
    bed.name = "Points"
    bed.scale = (2.0, 2.0, 2.0)
    bed.modifiers.new("Points", "NODES").node_group = tree


@awkward("grease pencil", words=("grease pencil", "Drawing"))
def grease_pencil(folder: Path) -> None:
    stage(things=False)
    bpy.ops.object.grease_pencil_add(type="MONKEY", location=(0.0, -1.9, 0.8))
    bpy.context.object.name = "Drawing"


@awkward("a volume object from an OpenVDB file", words=("volume", "Cloud"))
def volume_object(folder: Path) -> None:
    stage()
    tree: Any = bpy.data.node_groups.new("Cloud", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, output = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    volume = tree.nodes.new("GeometryNodeMeshToVolume")
    paint = tree.nodes.new("GeometryNodeSetMaterial")
    fog = bpy.data.materials.new("Cloud")
    fog.node_tree.nodes.clear()
    scatter, end = (
        fog.node_tree.nodes.new("ShaderNodeVolumePrincipled"),
        fog.node_tree.nodes.new("ShaderNodeOutputMaterial"),
    )
    scatter.inputs["Density"].default_value = 8.0
    fog.node_tree.links.new(scatter.outputs[0], end.inputs["Volume"])
    paint.inputs["Material"].default_value = fog
    tree.links.new(source.outputs[0], volume.inputs[0])
    tree.links.new(volume.outputs[0], paint.inputs[0])
    tree.links.new(paint.outputs[0], output.inputs[0])
    find("Red").name = "Cloud"
    find("Cloud").modifiers.new("Cloud", "NODES").node_group = tree


@awkward("an empty, a speaker, an armature, a lattice and a force field: nothing to see")
def helpers(folder: Path) -> None:
    stage()
    link(None, "Empty", (0.0, -1.5, 1.0))
    link(bpy.data.speakers.new("Speaker"), "Speaker", (0.5, -1.5, 1.0))
    link(bpy.data.armatures.new("Armature"), "Armature", (0.7, -1.5, 1.0))
    link(bpy.data.lattices.new("Lattice"), "Lattice", (-0.7, -1.5, 1.0))
    bpy.ops.object.effector_add(type="WIND", location=(0.0, -2.0, 0.5))


@awkward("an empty that shows an image, which renders do not")
def image_empty(folder: Path) -> None:
    from ..stage import picture, stripes

    stage()
    empty = link(None, "Reference", (0.0, -1.5, 1.0))
    empty.empty_display_type, empty.data = "IMAGE", picture("Stripes", stripes())


@awkward("a light probe of EEVEE's, which Cycles does not know")
def light_probe(folder: Path) -> None:
    stage()
    bpy.ops.object.lightprobe_add(type="SPHERE", location=(0.0, -1.5, 1.0))


@awkward("the ocean modifier")
def ocean(folder: Path) -> None:
    stage(things=False)
    sea = add_sheet("Sea", (0.0, 0.0, 0.1), (2.0, 2.0), matte("Sea", (0.05, 0.3, 0.4)))
    modifier: Any = sea.modifiers.new("Ocean", "OCEAN")
    modifier.geometry_mode, modifier.size, modifier.resolution, modifier.viewport_resolution = "GENERATE", 0.1, 10, 4
    modifier.wave_scale = 0.6


@awkward("a build modifier half way")
def build_modifier(folder: Path) -> None:
    scene = stage()
    modifier: Any = find("Blue").modifiers.new("Build", "BUILD")
    modifier.frame_start, modifier.frame_duration = 1.0, 100.0
    scene.frame_set(50)


@awkward("an explosion of a thing by simulation nodes is not baked: a rigid body at its start")
def rigid_body(folder: Path) -> None:
    scene = stage()
    bpy.context.view_layer.objects.active = find("Red")
    bpy.ops.rigidbody.object_add()
    scene.frame_set(1)


@awkward("a wireframe modifier: thin bars")
def wireframe(folder: Path) -> None:
    stage()
    modifier: Any = find("Red").modifiers.new("Wireframe", "WIREFRAME")
    modifier.thickness = 0.05


@awkward("a mask modifier that removes all of the mirror", words=("Mirror",))
def mirror_masked(folder: Path) -> None:
    stage()
    find(MIRROR).vertex_groups.new(name="None")
    find(MIRROR).modifiers.new("Mask", "MASK").vertex_group = "None"
