# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances: collections, geometry nodes, particles, parents that copy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..registry import MIRROR, awkward
from ..stage import add_box, add_object, add_sheet, ball, bpy, find, link, matte, mirror, plane, stage


def _moved_into(name: str, *objects: str) -> Any:
    """A collection, not in the scene, of these objects."""
    collection = bpy.data.collections.new(name)
    for each in objects:
        thing = find(each)
        for owner in list(thing.users_collection):
            owner.objects.unlink(thing)
        collection.objects.link(thing)
    return collection


def _instance(collection: Any, place: tuple[float, float, float], scale: float = 1.0) -> Any:
    holder = link(None, f"Copy of {collection.name}", place)
    holder.instance_type, holder.instance_collection = "COLLECTION", collection
    holder.scale = (scale, scale, scale)
    return holder


@awkward("a collection that is instanced twice")
def collection_instances(folder: Path) -> None:
    stage()
    collection = _moved_into("Boxes", "Red", "Green")
    _instance(collection, (-2.5, -0.5, 0.0))
    _instance(collection, (0.4, 1.5, 0.0), 0.8).rotation_euler = (0.0, 0.0, 0.7)


@awkward("an instanced collection that renders do not show")
def collection_instance_hidden(folder: Path) -> None:
    stage()
    collection = _moved_into("Boxes", "Red", "Green")
    collection.hide_render = True
    _instance(collection, (-1.0, 0.0, 0.0))


@awkward("an instanced collection that the viewport does not show")
def collection_instance_viewport(folder: Path) -> None:
    stage()
    collection = _moved_into("Boxes", "Red", "Green")
    collection.hide_viewport = True
    _instance(collection, (-1.0, 0.0, 0.0))


@awkward("an instanced collection in which one thing is hidden in renders")
def collection_instance_part_hidden(folder: Path) -> None:
    stage()
    collection = _moved_into("Boxes", "Red", "Green")
    find("Red").hide_render = True
    _instance(collection, (-1.0, 0.0, 0.0))


@awkward("an empty that holds an instance, hidden in renders")
def instancer_hidden(folder: Path) -> None:
    stage()
    _instance(_moved_into("Boxes", "Red", "Green"), (-1.0, 0.0, 0.0)).hide_render = True


@awkward("an instance in an instance")
def collection_nested(folder: Path) -> None:
    scene = stage()
    inner = _moved_into("Boxes", "Red", "Green")
    holder = _instance(inner, (0.0, 0.5, 0.0), 0.6)
    outer = bpy.data.collections.new("Outer")
    scene.collection.objects.unlink(holder)
    outer.objects.link(holder)
    _instance(outer, (-2.4, -0.8, 0.0))
    _instance(outer, (-0.4, -1.2, 0.0), 0.7)


@awkward("a mirror in an instanced collection")
def mirror_in_collection(folder: Path) -> None:
    stage()
    _instance(_moved_into("Set", MIRROR), (0.0, 0.0, 0.0))


@awkward("a mirror in a collection with two instances")
def mirror_in_two_instances(folder: Path) -> None:
    stage()
    collection = _moved_into("Set", MIRROR)
    _instance(collection, (-0.8, 0.0, 0.0), 0.7)
    _instance(collection, (0.9, 0.4, 0.0), 0.6)


@awkward("a mirror in the scene and in an instance")
def mirror_and_instance(folder: Path) -> None:
    scene = stage()
    collection = _moved_into("Set", MIRROR)
    scene.collection.children.link(collection)
    _instance(collection, (-1.0, -1.6, 0.0), 0.5)


def _node_group(name: str) -> tuple[Any, Any, Any]:
    """A geometry node group: (tree, its input node, its output node)."""
    tree: Any = bpy.data.node_groups.new(name, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    return tree, tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")


def _scattered(host: Any, seed: Any, realize: bool = False) -> None:
    """Geometry nodes that put `seed` on each vertex of `host`, beside what the host is."""
    tree, source, output = _node_group("Scatter")
    info, points = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("GeometryNodeInstanceOnPoints")
    info.inputs["Object"].default_value = seed
    info.inputs["As Instance"].default_value = True
    join = tree.nodes.new("GeometryNodeJoinGeometry")
    tree.links.new(source.outputs[0], points.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], points.inputs["Instance"])
    made = points.outputs[0]
    if realize:
        node = tree.nodes.new("GeometryNodeRealizeInstances")
        tree.links.new(made, node.inputs[0])
        made = node.outputs[0]
    tree.links.new(made, join.inputs[0])
    tree.links.new(source.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], output.inputs[0])
    host.modifiers.new("Scatter", "NODES").node_group = tree


def _seed() -> Any:
    """A small seed, itself out of sight below the floor's edge."""
    return add_object("Seed", ball(0.16, 12), matte("Seed", (0.8, 0.5, 0.05)), True, (0.0, 0.0, 0.0))


def _bed() -> Any:
    return add_sheet("Bed", (0.0, -1.6, 0.02), (3.4, 1.4), matte("Bed", (0.05, 0.2, 0.05)), cells=(6, 3))


@awkward("instances by geometry nodes")
def nodes_instances(folder: Path) -> None:
    stage(things=False)
    _scattered(_bed(), _seed())


@awkward("instances by geometry nodes of a seed that is hidden")
def nodes_hidden_seed(folder: Path) -> None:
    stage(things=False)
    seed = _seed()
    _scattered(_bed(), seed)
    seed.hide_render = seed.hide_viewport = True


@awkward("instances by geometry nodes of a seed in a hidden collection")
def nodes_hidden_collection_seed(folder: Path) -> None:
    scene = stage(things=False)
    seed = _seed()
    _scattered(_bed(), seed)
    collection = _moved_into("Seeds", "Seed")
    scene.collection.children.link(collection)
    collection.hide_render = collection.hide_viewport = True


@awkward("instances by geometry nodes, made real")
def nodes_realized(folder: Path) -> None:
    stage(things=False)
    _scattered(_bed(), _seed(), realize=True)


@awkward("geometry nodes that replace the material")
def nodes_set_material(folder: Path) -> None:
    stage()
    tree, source, output = _node_group("Painted")
    node = tree.nodes.new("GeometryNodeSetMaterial")
    node.inputs["Material"].default_value = matte("Other", (0.1, 0.8, 0.3))
    tree.links.new(source.outputs[0], node.inputs[0])
    tree.links.new(node.outputs[0], output.inputs[0])
    find("Red").modifiers.new("Painted", "NODES").node_group = tree


@awkward("a mirror that geometry nodes scatter")
def nodes_mirror_instances(folder: Path) -> None:
    stage(with_mirror=False, things=True)
    add_object(MIRROR, ball(0.3, 32), mirror("Chrome"), True, (0.0, 0.0, 0.9))
    _scattered(
        add_sheet("Bed", (0.0, -0.6, 0.5), (2.6, 1.2), matte("Bed", (0.1, 0.3, 0.1)), cells=(2, 1)), find(MIRROR)
    )


@awkward("a mirror made by geometry nodes alone")
def nodes_mirror_made(folder: Path) -> None:
    stage(with_mirror=False)
    thing = add_object(MIRROR, plane((0.1, 0.1)), mirror("Chrome"), location=(0.0, 0.0, 1.0))
    tree, _, output = _node_group("Ball")
    sphere, smooth = tree.nodes.new("GeometryNodeMeshUVSphere"), tree.nodes.new("GeometryNodeSetShadeSmooth")
    paint = tree.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = bpy.data.materials["Chrome"]
    tree.links.new(sphere.outputs[0], smooth.inputs[0])
    tree.links.new(smooth.outputs[0], paint.inputs[0])
    tree.links.new(paint.outputs[0], output.inputs[0])
    thing.modifiers.new("Ball", "NODES").node_group = tree


@awkward("colors of instances by an attribute of the instancer", words=("attribute",))
def nodes_instance_attribute(folder: Path) -> None:
    stage(things=False)
    seed, bed = _seed(), _bed()
    _scattered(bed, seed)
    tree = bed.modifiers[0].node_group
    store = tree.nodes.new("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT_COLOR", "INSTANCE"
    store.inputs["Name"].default_value = "tint"
    store.inputs["Value"].default_value = (0.1, 0.2, 0.9, 1.0)
    points = next(node for node in tree.nodes if node.bl_idname == "GeometryNodeInstanceOnPoints")
    join = next(node for node in tree.nodes if node.bl_idname == "GeometryNodeJoinGeometry")
    tree.links.new(points.outputs[0], store.inputs["Geometry"])
    tree.links.new(store.outputs[0], join.inputs[0])
    for each in list(join.inputs[0].links):
        if each.from_node == points:
            tree.links.remove(each)
    material = seed.data.materials[0].node_tree
    attribute = material.nodes.new("ShaderNodeAttribute")
    attribute.attribute_type, attribute.attribute_name = "INSTANCER", "tint"
    material.links.new(attribute.outputs["Color"], material.nodes["Principled BSDF"].inputs["Base Color"])


def _particles(kind: str, **properties: Any) -> Any:
    """A particle system on a bed, of ten things."""
    bed = _bed()
    bpy.context.view_layer.objects.active = bed
    modifier: Any = bed.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = modifier.particle_system.settings
    settings.type, settings.count = kind, 30
    for name, value in properties.items():
        setattr(settings, name, value)
    return settings


@awkward("particles that are objects")
def particles_objects(folder: Path) -> None:
    stage(things=False)
    seed = _seed()
    settings = _particles("HAIR")
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", seed, 1.0


@awkward("particles of a seed that is hidden")
def particles_hidden_seed(folder: Path) -> None:
    stage(things=False)
    seed = _seed()
    settings = _particles("HAIR")
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", seed, 1.0
    seed.hide_render = seed.hide_viewport = True


@awkward("particles, more in renders than in the viewport")
def particles_viewport_share(folder: Path) -> None:
    stage(things=False)
    seed = _seed()
    settings = _particles("HAIR", display_percentage=10)
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", seed, 1.0


@awkward("emitted particles as halos, which Cycles does not draw")
def particles_halo(folder: Path) -> None:
    stage(things=False)
    _particles("EMITTER", frame_start=-20, frame_end=1, lifetime=100)
    bpy.context.scene.frame_set(5)


@awkward("hair of particles")
def particles_hair(folder: Path) -> None:
    stage(things=False)
    settings = _particles("HAIR", hair_length=0.6)
    settings.count, settings.root_radius, settings.radius_scale = 300, 3.0, 0.02


@awkward("the emitter of particles is hidden, the particles are not")
def particles_emitter_hidden(folder: Path) -> None:
    stage(things=False)
    seed = _seed()
    settings = _particles("HAIR")
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", seed, 1.0
    find("Bed").show_instancer_for_render = False


@awkward("children on the vertices of a parent")
def vertex_instances(folder: Path) -> None:
    stage(things=False)
    bed, seed = _bed(), _seed()
    seed.parent = bed
    bed.instance_type = "VERTS"


@awkward("children on the faces of a parent, scaled by them, the parent not shown")
def face_instances(folder: Path) -> None:
    stage(things=False)
    bed, seed = _bed(), add_box("Seed", (0.0, 0.0, 0.0), 0.5, matte("Seed", (0.8, 0.3, 0.1)))
    seed.parent = bed
    bed.instance_type, bed.use_instance_faces_scale = "FACES", True
    bed.show_instancer_for_render = False


@awkward("a linked duplicate mirrored in X")
def linked_mirrored(folder: Path) -> None:
    stage()
    twin = bpy.data.objects.new("Twin", find("Red").data)
    twin.location, twin.scale = (-2.3, 0.6, 0.5), (-1.0, 1.0, 1.5)
    bpy.context.scene.collection.objects.link(twin)


@awkward("two thousand instances")
def instances_many(folder: Path) -> None:
    stage(things=False)
    bed = add_sheet("Bed", (0.0, -0.6, 0.01), (7.0, 6.0), matte("Bed", (0.05, 0.15, 0.05)), cells=(49, 39))
    seed = add_object("Seed", ball(0.04, 6), matte("Seed", (0.8, 0.5, 0.05)), location=(0.0, 0.0, -1.0))
    _scattered(bed, seed)


@awkward("instances with a different material for each by the object")
def instance_materials(folder: Path) -> None:
    stage()
    mesh = find("Red").data
    for number, color in enumerate(((0.1, 0.7, 0.7), (0.8, 0.7, 0.1))):
        twin = bpy.data.objects.new(f"Twin {number}", mesh)
        twin.location = (-2.2 + 1.1 * number, 0.9, 0.5)
        bpy.context.scene.collection.objects.link(twin)
        twin.material_slots[0].link = "OBJECT"
        twin.material_slots[0].material = matte(f"Twin {number}", color)
