# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What renders have and the viewport has not, and the other way round: levels, modifiers, hidden things."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..registry import MIRROR, awkward
from ..stage import (
    add_ball,
    add_box,
    add_object,
    add_sheet,
    box,
    bpy,
    find,
    matte,
    mirror,
    stage,
)


def _subdivided(name: str, viewport: int, render: int) -> Any:
    modifier = find(name).modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = viewport, render
    return modifier


@awkward("a mirror that is a cube in the viewport and a ball in renders")
def subdivision_of_mirror(folder: Path) -> None:
    stage(with_mirror=False)
    add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    _subdivided(MIRROR, 0, 4)


@awkward("a thing that is a cube in the viewport and a ball in renders")
def subdivision_of_thing(folder: Path) -> None:
    stage(things=False)
    add_box("Lump", (0.0, -2.2, 0.8), 1.5, matte("Lump", (0.7, 0.1, 0.05)))
    _subdivided("Lump", 0, 3)


@awkward("a mirror that is smoother in the viewport than in renders")
def subdivision_less_in_render(folder: Path) -> None:
    stage(with_mirror=False)
    add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    _subdivided(MIRROR, 4, 1)


@awkward("subdivision that adapts to the camera")
def subdivision_adaptive(folder: Path) -> None:
    scene: Any = stage(with_mirror=False)
    add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    modifier = _subdivided(MIRROR, 1, 2)
    modifier.use_adaptive_subdivision = True
    scene.cycles.dicing_rate = 1.0


@awkward("levels held down by the scene's Simplify for renders")
def simplify_render(folder: Path) -> None:
    scene = stage(with_mirror=False)
    add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    _subdivided(MIRROR, 4, 4)
    scene.render.use_simplify = True
    scene.render.simplify_subdivision, scene.render.simplify_subdivision_render = 6, 1


@awkward("levels held down by the scene's Simplify for the viewport alone")
def simplify_viewport(folder: Path) -> None:
    scene = stage(with_mirror=False)
    add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    _subdivided(MIRROR, 4, 4)
    scene.render.use_simplify = True
    scene.render.simplify_subdivision, scene.render.simplify_subdivision_render = 0, 6


@awkward("sculpted levels that the viewport does not show")
def multires(folder: Path) -> None:
    stage(with_mirror=False)
    thing = add_object(MIRROR, box((2.0, 2.0, 2.0)), mirror("Chrome"), smooth=True, location=(0.0, 0.0, 1.0))
    bpy.context.view_layer.objects.active = thing
    modifier = thing.modifiers.new("Multires", "MULTIRES")
    for _ in range(3):
        bpy.ops.object.multires_subdivide(modifier=modifier.name)
    modifier.levels, modifier.render_levels = 0, 3


@awkward("a modifier for renders alone")
def modifier_render_only(folder: Path) -> None:
    stage()
    modifier = find("Red").modifiers.new("Array", "ARRAY")
    modifier.count, modifier.relative_offset_displace = 3, (0.0, 0.0, 1.1)
    modifier.show_viewport = False


@awkward("a modifier for the viewport alone")
def modifier_viewport_only(folder: Path) -> None:
    stage()
    modifier = find("Red").modifiers.new("Array", "ARRAY")
    modifier.count, modifier.relative_offset_displace = 3, (0.0, 0.0, 1.1)
    modifier.show_render = False


@awkward("a screw with other steps in renders")
def screw_steps(folder: Path) -> None:
    stage(things=False).cycles.diffuse_bounces = 0
    from ..stage import mesh_of

    thing = mesh_of("Vase", [(0.6, 0, 0), (0.9, 0, 0.5), (0.4, 0, 1.2)], [], matte("Vase", (0.7, 0.4, 0.05)))
    thing.data.edges.add(2)
    thing.data.edges.foreach_set("vertices", [0, 1, 1, 2])
    thing.location = (0.0, -2.2, 0.01)
    thing.data.update()
    modifier = thing.modifiers.new("Screw", "SCREW")
    modifier.steps, modifier.render_steps = 3, 32


@awkward("a thing hidden in the viewport alone")
def hidden_in_viewport(folder: Path) -> None:
    stage()
    find("Red").hide_viewport = True


@awkward("a thing hidden by the eye of the outliner")
def hidden_by_eye(folder: Path) -> None:
    stage()
    find("Red").hide_set(True)


@awkward("a thing hidden in renders alone")
def hidden_in_render(folder: Path) -> None:
    stage()
    find("Red").hide_render = True


def _collected(name: str) -> Any:
    scene = bpy.context.scene
    collection = bpy.data.collections.new("Part")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(find(name))
    collection.objects.link(find(name))
    return collection


@awkward("a collection hidden in the viewport alone")
def collection_hidden_in_viewport(folder: Path) -> None:
    stage()
    _collected("Red").hide_viewport = True


@awkward("a collection hidden by the eye of the outliner")
def collection_hidden_by_eye(folder: Path) -> None:
    stage()
    _collected("Red")
    bpy.context.view_layer.layer_collection.children["Part"].hide_viewport = True


@awkward("a collection hidden in renders alone")
def collection_hidden_in_render(folder: Path) -> None:
    stage()
    _collected("Red").hide_render = True


@awkward("a collection that only masks", words=("holdout", "Red"))
def collection_holdout(folder: Path) -> None:
    stage()
    _collected("Red")
    bpy.context.view_layer.layer_collection.children["Part"].holdout = True


@awkward("a collection that is seen in mirrors alone")
def collection_indirect_only(folder: Path) -> None:
    stage()
    _collected("Red")
    bpy.context.view_layer.layer_collection.children["Part"].indirect_only = True


@awkward("a mirror hidden in the viewport alone")
def mirror_hidden_in_viewport(folder: Path) -> None:
    stage()
    find(MIRROR).hide_viewport = True


@awkward("a mirror hidden in renders", words=("hidden",))
def mirror_hidden_in_render(folder: Path) -> None:
    stage()
    find(MIRROR).hide_render = True


@awkward("a curve with more steps in renders")
def curve_render_resolution(folder: Path) -> None:
    stage(things=False)
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.8, location=(0.0, -2.2, 0.9), rotation=(1.2, 0.0, 0.0))
    curve = bpy.context.object.data
    curve.bevel_depth, curve.resolution_u, curve.render_resolution_u = 0.15, 1, 16
    curve.materials.append(matte("Ring", (0.7, 0.3, 0.05)))


@awkward("metaballs that are finer in renders")
def metaball_render_resolution(folder: Path) -> None:
    stage(things=False)
    data = bpy.data.metaballs.new("Blob")
    data.resolution, data.render_resolution = 1.0, 0.1
    for x in (-0.5, 0.4):
        element = data.elements.new()
        element.co, element.radius = (x, 0.0, 0.0), 1.0
    data.materials.append(matte("Blob", (0.1, 0.5, 0.3)))
    from ..stage import link

    link(data, "Blob", (0.0, -2.2, 0.8))


@awkward("shown as a wire and as bounds in the viewport, a surface in renders")
def display_types(folder: Path) -> None:
    stage()
    find("Red").display_type, find("Blue").display_type, find(MIRROR).display_type = "WIRE", "BOUNDS", "WIRE"


@awkward("a keyframe that makes a thing appear only in renders of later frames")
def keyed_hidden(folder: Path) -> None:
    scene = stage()
    thing = find("Red")
    thing.hide_render = True
    thing.keyframe_insert("hide_render", frame=1)
    thing.hide_render = False
    thing.keyframe_insert("hide_render", frame=5)
    scene.frame_set(5)


@awkward("a still on a half frame")
def subframe(folder: Path) -> None:
    scene = stage()
    thing = find("Red")
    for frame, x in ((1, 1.9), (2, -1.0)):
        thing.location.x = x
        thing.keyframe_insert("location", frame=frame)
    scene.frame_set(1, subframe=0.5)


@awkward("a driver of a thing's place")
def driver_of_place(folder: Path) -> None:
    stage()
    curve = find("Red").driver_add("location", 2)
    curve.driver.type = "SUM"
    variable = curve.driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = find("Blue"), "LOC_Z"
    find("Blue").location.z = 1.2


@awkward("geometry that is other in renders by the Is Viewport node")
def is_viewport_node(folder: Path) -> None:
    stage()
    tree: Any = bpy.data.node_groups.new("Detail", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, output = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    switch, viewport = tree.nodes.new("GeometryNodeSwitch"), tree.nodes.new("GeometryNodeIsViewport")
    move = tree.nodes.new("GeometryNodeTransform")
    switch.input_type = "GEOMETRY"
    move.inputs["Translation"].default_value = (0.0, 0.0, 1.5)
    tree.links.new(viewport.outputs[0], switch.inputs["Switch"])
    tree.links.new(source.outputs[0], move.inputs["Geometry"])
    tree.links.new(move.outputs[0], switch.inputs["False"])
    tree.links.new(source.outputs[0], switch.inputs["True"])
    tree.links.new(switch.outputs[0], output.inputs[0])
    find("Red").modifiers.new("Detail", "NODES").node_group = tree


@awkward("a mirror that lies in a disabled collection of another scene too")
def two_scenes(folder: Path) -> None:
    stage()
    other = bpy.data.scenes.new("Other")
    other.collection.objects.link(find(MIRROR))
    add_sheet("Wall", (0.0, 2.5, 1.5), (4.0, 3.0), matte("Wall", (0.5, 0.4, 0.1)), (1.5708, 0.0, 0.0))
    add_ball("Pea", (1.0, -1.9, 0.3), 0.3, matte("Pea", (0.2, 0.6, 0.1)))
