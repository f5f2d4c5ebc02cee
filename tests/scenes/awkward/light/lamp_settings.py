# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lamps can be set to: visibility, nodes, links, groups."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import DARK, add_lamp, add_sheet, bpy, find, matte, node, picture, stage, stripes
from .lamps import lit


@awkward("a lamp with negative power, which takes light away")
def negative_lamp(folder: Path) -> None:
    stage()
    add_lamp("POINT", (0.9, -2.2, 1.2), -60.0, shadow_soft_size=0.05)


@awkward("a lamp without diffuse light")
def lamp_no_diffuse(folder: Path) -> None:
    lit("AREA", size=1.0, diffuse_factor=0.0)
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp that mirrors do not show")
def lamp_no_specular(folder: Path) -> None:
    lit("AREA", size=1.5, specular_factor=0.0)


@awkward("a lamp whose object is invisible to diffuse rays")
def lamp_invisible_to_diffuse(folder: Path) -> None:
    lit("AREA", size=1.0).visible_diffuse = False
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp whose object is invisible to glossy rays")
def lamp_invisible_to_glossy(folder: Path) -> None:
    lit("AREA", size=1.5).visible_glossy = False


@awkward("a lamp without shadows")
def lamp_no_shadow(folder: Path) -> None:
    lamp = lit("POINT", shadow_soft_size=0.05)
    lamp.data.use_shadow = False


@awkward("a portal, which gives no light itself")
def portal(folder: Path) -> None:
    stage()
    lamp = add_lamp("AREA", (2.0, -3.0, 2.0), 300.0, size=2.0)
    lamp.data.cycles.is_portal = True


@awkward("a lamp hidden in renders")
def lamp_hidden(folder: Path) -> None:
    lit("POINT", shadow_soft_size=0.05).hide_render = True
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp of no power")
def lamp_zero(folder: Path) -> None:
    lit("POINT", energy=0.0)
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp with exposure")
def lamp_exposure(folder: Path) -> None:
    lit("POINT", energy=60.0, exposure=2.0, shadow_soft_size=0.05)


@awkward("a lamp whose power does not change with its size")
def lamp_not_normalized(folder: Path) -> None:
    lit("AREA", energy=60.0, size=2.0, normalize=False)


@awkward("the color of a lamp by temperature")
def lamp_temperature(folder: Path) -> None:
    lit("POINT", use_temperature=True, temperature=2200.0, shadow_soft_size=0.05)


def _lamp_tree(lamp: Any) -> tuple[Any, Any]:
    """The node tree of a lamp, and its Emission."""
    lamp.data.use_nodes = True
    tree = lamp.data.node_tree
    return tree, next(item for item in tree.nodes if item.type == "EMISSION")


@awkward("a lamp whose color is a texture", words=("node", "texture", "Area"))
def lamp_textured(folder: Path) -> None:
    tree, emission = _lamp_tree(lit("AREA", size=2.0))
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture("Window", stripes((4.0, 0.1, 0.1), (0.1, 0.1, 4.0)), is_float=True)
    geometry = node(tree, "NewGeometry")
    tree.links.new(geometry.outputs["Parametric"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], emission.inputs["Color"])


@awkward("a lamp with a plain color and strength in its nodes")
def lamp_nodes_plain(folder: Path) -> None:
    _, emission = _lamp_tree(lit("POINT", shadow_soft_size=0.05))
    emission.inputs["Color"].default_value = (0.2, 0.9, 0.3, 1.0)
    emission.inputs["Strength"].default_value = 2.0


@awkward("a lamp with another falloff", words=("falloff", "node"))
def lamp_falloff(folder: Path) -> None:
    tree, emission = _lamp_tree(lit("POINT", energy=30.0, shadow_soft_size=0.05))
    falloff = node(tree, "LightFalloff", Strength=1.0)
    tree.links.new(falloff.outputs["Constant"], emission.inputs["Strength"])


@awkward("an IES profile in a lamp", words=("IES", "node"))
def lamp_ies(folder: Path) -> None:
    file = folder / "lamp.ies"
    angles = np.linspace(0.0, 90.0, 10)
    candela = np.where(angles < 25.0, 2000.0, 30.0)
    file.write_text(
        "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n1 1000 1 10 1 1 2 0 0 0\n1 1 100\n"
        + " ".join(f"{angle:g}" for angle in angles)
        + "\n0\n"
        + " ".join(f"{value:g}" for value in candela)
        + "\n"
    )
    tree, emission = _lamp_tree(lit("POINT", (0.5, -1.5, 3.0), energy=100.0, shadow_soft_size=0.02))
    profile = node(tree, "TexIES")
    profile.mode, profile.filepath = "EXTERNAL", str(file)
    tree.links.new(profile.outputs[0], emission.inputs["Strength"])


@awkward("a lamp with a gobo of a light path", words=("light path", "node"))
def lamp_light_path(folder: Path) -> None:
    tree, emission = _lamp_tree(lit("AREA", size=1.5))
    path = node(tree, "LightPath")
    tree.links.new(path.outputs["Is Glossy Ray"], emission.inputs["Strength"])


@awkward("light linking: a lamp that lights one thing alone")
def light_linking(folder: Path) -> None:
    lamp = lit("POINT", shadow_soft_size=0.05)
    add_lamp("SUN", (-2.0, -2.0, 3.0), 0.5)
    receivers = bpy.data.collections.new("Receivers")
    receivers.objects.link(find("Red"))
    lamp.light_linking.receiver_collection = receivers


@awkward("light linking: a lamp that leaves one thing out")
def light_linking_excludes(folder: Path) -> None:
    lamp = lit("POINT", shadow_soft_size=0.05)
    receivers = bpy.data.collections.new("Receivers")
    receivers.objects.link(find("Floor"))
    lamp.light_linking.receiver_collection = receivers
    receivers.collection_objects[0].light_linking.link_state = "EXCLUDE"


@awkward("shadow linking: one thing casts no shadow of this lamp")
def shadow_linking(folder: Path) -> None:
    lamp = lit("POINT", (3.0, -1.2, 2.2), shadow_soft_size=0.05)
    blockers = bpy.data.collections.new("Blockers")
    blockers.objects.link(find("Red"))
    lamp.light_linking.blocker_collection = blockers
    blockers.collection_objects[0].light_linking.link_state = "EXCLUDE"


@awkward("a light group, which changes nothing")
def light_group(folder: Path) -> None:
    stage()
    bpy.context.view_layer.lightgroups.add(name="Key")
    find("Sun").lightgroup = "Key"


@awkward("a lamp inside the mirror")
def lamp_in_mirror(folder: Path) -> None:
    lit("POINT", (0.0, 0.0, 1.0), 500.0, shadow_soft_size=0.1)
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp inside a thing")
def lamp_in_thing(folder: Path) -> None:
    lit("POINT", (1.9, -0.6, 0.5), 500.0, shadow_soft_size=0.05)
    add_lamp("SUN", (-2.0, -2.0, 3.0), 1.0)


@awkward("a lamp that touches the floor")
def lamp_at_floor(folder: Path) -> None:
    lit("POINT", (0.9, -1.9, 0.02), 30.0, shadow_soft_size=0.01)


@awkward("a lamp two kilometers away")
def lamp_far(folder: Path) -> None:
    lit("POINT", (1200.0, -1200.0, 1200.0), 8e7, shadow_soft_size=1.0)


@awkward("lamps in a collection that is instanced")
def lamps_instanced(folder: Path) -> None:
    scene = stage(sky=DARK, sun=0.5)
    collection = bpy.data.collections.new("Lamps")
    lamp = add_lamp("POINT", (0.0, 0.0, 0.0), 60.0, shadow_soft_size=0.05)
    scene.collection.objects.unlink(lamp)
    collection.objects.link(lamp)
    for x in (-1.5, 1.5):
        holder = bpy.data.objects.new("Holder", None)
        holder.instance_type, holder.instance_collection = "COLLECTION", collection
        holder.location = (x, -2.4, 1.5)
        scene.collection.objects.link(holder)


@awkward("a lamp between two sheets close to each other")
def lamp_between(folder: Path) -> None:
    lit("POINT", (1.0, -2.0, 0.6), 10.0, shadow_soft_size=0.02)
    for y in (-1.95, -2.05):
        add_sheet("Sheet", (1.0, y, 0.6), (1.0, 1.0), matte("Sheet", (0.7, 0.6, 0.2)), (np.pi / 2.0, 0.0, 0.0))
    add_lamp("SUN", (-2.0, -2.0, 3.0), 0.5)


@awkward("a lamp with a custom shader output and a lamp of another scene")
def lamp_of_other_scene(folder: Path) -> None:
    lit("POINT", shadow_soft_size=0.05)
    other = bpy.data.scenes.new("Other")
    lamp = bpy.data.objects.new("Elsewhere", bpy.data.lights.new("Elsewhere", "SUN"))
    other.collection.objects.link(lamp)
