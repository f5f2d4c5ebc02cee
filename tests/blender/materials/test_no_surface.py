# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials without a surface, or with another output than expected, in pictures beside those of Cycles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add, add_square, cycles_picture, empty_scene, extracted, link, look_down, new_material
from scene.color_nodes import node, smooth_image

SIZE = 40
BESIDE = (slice(18, 22), slice(4, 8))
BELOW = (slice(18, 22), slice(19, 23))
SHADOW = (slice(18, 22), slice(11, 13))

type Change = Callable[[bpy.types.Material], None]


def plate_above_a_floor(change: Change | None) -> bpy.types.Object:
    """A square of 1 m half a meter above a floor under a low sun, seen from above; without a material for None."""
    scene = empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.05, 0.1, 0.2, 1.0)
    floor = add_square("floor", 6.0)
    new_material(floor, "ShaderNodeBsdfDiffuse")
    plate = add_square("plate", 1.0)
    plate.location.z = 0.5
    if change is not None:
        material = bpy.data.materials.new("film")
        plate.data.materials.append(material)
        change(material)
    sun = link(bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN")))
    sun.data.energy, sun.data.angle = 3.0, 0.0
    sun.rotation_euler = (0.0, 0.9, 0.0)
    look_down(4.0)
    return plate


def pictures() -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    """(SIZE, SIZE, 3) ours and that of Cycles, and what is said."""
    scene = bpy.context.scene
    renderer = Renderer(extracted(), Settings(method="exact", samples=8))
    frame = renderer.render(view_of_camera(scene, scene.camera, SIZE, SIZE))
    return frame.color()[..., :3], cycles_picture(SIZE, SIZE, 64), frame.warnings


def replace_output(kind: str, socket: str, **inputs: Any) -> Change:
    """A node into an input of the output, and nothing else into it."""

    def change(material: bpy.types.Material) -> None:
        tree = material.node_tree
        tree.links.clear()
        made = node(tree, kind, inputs)
        tree.links.new(made.outputs[0], tree.nodes["Material Output"].inputs[socket])

    return change


def two_outputs(material: bpy.types.Material) -> None:
    """The one for EEVEE is red."""
    tree = material.node_tree
    output = tree.nodes["Material Output"]
    output.target = "EEVEE"
    tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (1.0, 0.0, 0.0, 1.0)
    other: Any = node(tree, "ShaderNodeOutputMaterial")
    other.target = "CYCLES"
    shine = node(tree, "ShaderNodeEmission", {"Color": (0.1, 0.5, 0.3, 1.0)})
    tree.links.new(shine.outputs[0], other.inputs["Surface"])


def not_in_cycles(material: bpy.types.Material) -> None:
    material.node_tree.nodes["Material Output"].target = "EEVEE"


def muted(material: bpy.types.Material) -> None:
    material.node_tree.nodes["Principled BSDF"].mute = True


def alpha_0(material: bpy.types.Material) -> None:
    material.node_tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.0


def image_alone(material: bpy.types.Material) -> None:
    tree = material.node_tree
    image = smooth_image()
    image.pixels.foreach_set(np.tile(np.array((0.3, 0.6, 0.1, 1.0), np.float32), 128))
    texture = node(tree, "ShaderNodeTexImage", image=image)
    tree.links.new(texture.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


CHANGES: dict[str, tuple[Change | None, str]] = {
    "an empty slot": (None, ""),
    "nothing at all": (lambda material: material.node_tree.nodes.clear(), ""),
    "nothing plugged in": (lambda material: material.node_tree.links.clear(), ""),
    "a muted shader": (muted, ""),
    "no output for Cycles": (not_in_cycles, ""),
    "an output of its own for Cycles": (two_outputs, ""),
    "a color": (replace_output("ShaderNodeRGB", "Surface"), ""),
    "an image": (image_alone, ""),
    "full transparency": (replace_output("ShaderNodeBsdfTransparent", "Surface"), ""),
    "alpha 0": (alpha_0, ""),
    "a holdout": (replace_output("ShaderNodeHoldout", "Surface"), "Holdout"),
}


SHINING = ("an output of its own for Cycles", "a color", "an image")


@pytest.mark.usefixtures("gpu")
@pytest.mark.parametrize("name", CHANGES)
def test_pictures_are_those_of_cycles(name: str) -> None:
    change, said = CHANGES[name]
    plate_above_a_floor(change)
    ours, cycles, warnings = pictures()
    # (Light of emitters on other surfaces is not drawn.)
    for place in (BESIDE, BELOW) if name in SHINING else (BESIDE, BELOW, SHADOW):
        np.testing.assert_allclose(ours[place].mean(axis=(0, 1)), cycles[place].mean(axis=(0, 1)), atol=0.03)
    assert [said in warning for warning in warnings if "film" in warning] == ([True] if said else [])


@pytest.mark.usefixtures("gpu")
def test_a_volume_is_not_shown_and_said() -> None:
    """Nothing of the cube is drawn: neither a block nor its shadow."""
    plate = plate_above_a_floor(replace_output("ShaderNodeVolumePrincipled", "Volume", Density=0.01))
    ours, cycles, warnings = pictures()
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), cycles.mean(axis=(0, 1)), atol=0.02)
    assert 'Volumes of material "film" are not shown.' in warnings
    bpy.context.view_layer.update()
    with pytest.raises(InputError, match='"plate" has no surface'):
        extracted(plate)


def test_faces_of_a_slot_without_a_surface_are_left_out() -> None:
    """Also those whose slot is beyond the last: they show the last."""
    empty_scene()
    cube = add("cube")
    cube.data.materials.append(bpy.data.materials.new("plain"))
    fog = bpy.data.materials.new("fog")
    replace_output("ShaderNodeVolumePrincipled", "Volume")(fog)
    cube.data.materials.append(fog)
    cube.data.polygons.foreach_set("material_index", [0, 1, 0, 7, 0, 0])
    scene = extracted()
    (instance,) = scene.instances
    assert len(scene.meshes[instance.mesh].triangles) == 8
    assert [scene.materials[index].name for index in instance.materials] == ["plain", "fog"]


def test_slots_of_the_object_go_before_those_of_the_data() -> None:
    empty_scene()
    cube = add("cube")
    colors = {"data": (1.0, 0.0, 0.0), "object": (0.0, 1.0, 0.0)}
    materials = {}
    for name, color in colors.items():
        materials[name] = bpy.data.materials.new(name)
        materials[name].node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    cube.data.materials.append(materials["data"])
    cube.data.materials.append(None)
    cube.material_slots[0].link = "OBJECT"
    cube.material_slots[0].material = materials["object"]
    scene = extracted()
    (instance,) = scene.instances
    assert [scene.materials[index].name for index in instance.materials] == ["object", "default"]


def test_displacement_and_a_world_volume_are_said() -> None:
    scene = empty_scene()
    cube = add("cube")
    tree, _ = new_material(cube, "ShaderNodeBsdfDiffuse")
    cube.data.materials[0].displacement_method = "BOTH"
    tree.links.new(
        node(tree, "ShaderNodeDisplacement").outputs[0], tree.nodes["Material Output"].inputs["Displacement"]
    )
    world = scene.world.node_tree
    world.links.new(node(world, "ShaderNodeVolumeScatter").outputs[0], world.nodes["World Output"].inputs["Volume"])
    assert extracted().warnings == (
        'Displacement of material "cube" is drawn as bumps: the mesh stays where it is.',
        'The volume of world "world" is not shown.',
    )
