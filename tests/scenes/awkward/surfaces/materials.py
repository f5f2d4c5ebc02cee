# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of what mirrors show, and of what the eye sees beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    add_ball,
    add_sheet,
    bpy,
    emitter,
    find,
    give,
    matte,
    node,
    output_of,
    picture,
    principled,
    principled_node,
    stage,
    surface,
    textured,
)


@awkward("the usual scene: nothing is awkward")
def plain(folder: Path) -> None:
    stage()


def _wall(material: bpy.types.Material) -> bpy.types.Object:
    """A wall behind the camera's things, which the mirror shows, and a ball of it that the eye sees."""
    add_ball("Sample", (-1.2, -1.9, 0.55), 0.55, material)
    return add_sheet("Wall", (0.0, -5.5, 2.0), (6.0, 4.0), material, (-np.pi / 2.0, 0.0, np.pi))


def _gltf(metallic: float, roughness: float) -> bpy.types.Material:
    """As Blender's glTF importer wires it: Separate Color of one image, green to roughness and blue to metallic."""
    material = matte("glTF", (0.7, 0.5, 0.3))
    tree: Any = material.node_tree
    pixels = np.ones((8, 8, 4), np.float32)
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = 1.0, roughness, metallic
    image = picture("Metallic Roughness", pixels)
    image.colorspace_settings.name = "Non-Color"
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    separate = node(tree, "SeparateColor")
    shader = principled_node(material)
    tree.links.new(texture.outputs["Color"], separate.inputs[0])
    tree.links.new(separate.outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(separate.outputs["Blue"], shader.inputs["Metallic"])
    return material


@awkward("glTF's metallic and roughness in one image: rough, not metallic")
def gltf_leather(folder: Path) -> None:
    stage()
    _wall(_gltf(0.0, 0.95))


@awkward("glTF's metallic and roughness in one image: rough metal", words=("rough", "metal", "glTF", "gloss"))
def gltf_metal(folder: Path) -> None:
    stage()
    _wall(_gltf(1.0, 0.6))


@awkward("glTF's occlusion in its group node")
def gltf_occlusion(folder: Path) -> None:
    stage()
    material = _gltf(0.0, 0.9)
    tree: Any = material.node_tree
    group = bpy.data.node_groups.new("glTF Material Output", "ShaderNodeTree")
    group.interface.new_socket("Occlusion", in_out="INPUT", socket_type="NodeSocketFloat")
    used = tree.nodes.new("ShaderNodeGroup")
    used.node_tree = group
    separate = next(item for item in tree.nodes if item.type == "SEPARATE_COLOR")
    tree.links.new(separate.outputs["Red"], used.inputs["Occlusion"])
    _wall(material)


@awkward("a material whose output has no surface")
def no_surface(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Nothing")
    tree: Any = material.node_tree
    tree.links.remove(output_of(tree).inputs["Surface"].links[0])
    _wall(material)


@awkward("a slot without a material")
def empty_slot(folder: Path) -> None:
    stage()
    give("Red", None)


@awkward("a material without any node")
def no_nodes(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Empty")
    material.node_tree.nodes.clear()
    _wall(material)


@awkward("two outputs, of which one is for another engine")
def two_outputs(folder: Path) -> None:
    stage()
    material = matte("Two", (0.8, 0.1, 0.1))
    tree: Any = material.node_tree
    output_of(tree).target = "EEVEE"
    other = tree.nodes.new("ShaderNodeOutputMaterial")
    other.target = "CYCLES"
    shader = node(tree, "BsdfDiffuse", Color=(0.1, 0.7, 0.2, 1.0))
    tree.links.new(shader.outputs[0], other.inputs["Surface"])
    _wall(material)


@awkward("a fog cube: a volume without a surface", words=("volume", "Fog"))
def fog_cube(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Fog")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    fog = node(tree, "VolumeScatter", Density=1.5)
    tree.links.new(fog.outputs[0], output.inputs["Volume"])
    give("Red", material)


@awkward("a surface and a volume in one material", words=("volume", "Smoke", "glass", "refract", "transmi"))
def glass_with_volume(folder: Path) -> None:
    stage()
    material = surface("Smoke", "BsdfRefraction", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.0)
    tree: Any = material.node_tree
    absorb = node(tree, "VolumeAbsorption", Color=(0.9, 0.2, 0.1, 1.0), Density=2.0)
    tree.links.new(absorb.outputs[0], output_of(tree).inputs["Volume"])
    give("Red", material)


@awkward("a Principled volume that glows", words=("volume", "Fire"))
def fire_volume(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Fire")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    fire = node(tree, "VolumePrincipled", Density=0.5, Emission_Strength=2.0, Emission_Color=(1.0, 0.4, 0.1, 1.0))
    tree.links.new(fire.outputs[0], output.inputs["Volume"])
    give("Red", material)


@awkward("glass", words=("glass", "transmi", "refract"))
def glass(folder: Path) -> None:
    stage()
    give("Blue", surface("Glass", "BsdfGlass", Color=(0.9, 1.0, 0.9, 1.0), Roughness=0.0, IOR=1.45))


@awkward("glass by Principled's transmission", words=("glass", "transmi", "refract"))
def principled_transmission(folder: Path) -> None:
    stage()
    material = principled("Clear", (0.95, 0.95, 0.95), roughness=0.0)
    principled_node(material).inputs["Transmission Weight"].default_value = 1.0
    give("Blue", material)


@awkward("a wall of glass before the mirror", words=("glass", "transmi", "refract"))
def window_pane(folder: Path) -> None:
    stage()
    add_sheet(
        "Pane",
        (0.0, -2.6, 1.0),
        (3.0, 2.0),
        surface("Glass", "BsdfGlass", Color=(1.0, 0.6, 0.5, 1.0), Roughness=0.0, IOR=1.0),
        (np.pi / 2.0, 0.0, 0.0),
    )


@awkward("a transparent shader of one color", words=("transparen",))
def transparent(folder: Path) -> None:
    stage()
    give("Red", surface("Foil", "BsdfTransparent", Color=(0.2, 0.9, 0.3, 1.0)))


@awkward("Principled's alpha of one half", words=("alpha", "transparen"))
def alpha_half(folder: Path) -> None:
    stage()
    material = matte("Half", (0.8, 0.1, 0.1))
    principled_node(material).inputs["Alpha"].default_value = 0.5
    give("Red", material)


@awkward("Principled's alpha of zero", words=("alpha", "transparen"))
def alpha_zero(folder: Path) -> None:
    stage()
    material = matte("None", (0.8, 0.1, 0.1))
    principled_node(material).inputs["Alpha"].default_value = 0.0
    give("Red", material)


@awkward("a mix of transparent and diffuse by a checker", words=("transparen", "Checker", "alpha"))
def alpha_checker(folder: Path) -> None:
    stage()
    material = matte("Grid", (0.8, 0.1, 0.1))
    tree: Any = material.node_tree
    checker = node(tree, "TexChecker", Scale=6.0)
    tree.links.new(checker.outputs["Fac"], principled_node(material).inputs["Alpha"])
    _wall(material)


@awkward("subsurface scattering: wax", words=("subsurface",), samples=128)
def subsurface(folder: Path) -> None:
    stage()
    material = principled("Wax", (0.9, 0.3, 0.2), roughness=1.0)
    shader = principled_node(material)
    shader.inputs["Subsurface Weight"].default_value = 1.0
    shader.inputs["Subsurface Radius"].default_value = (1.0, 0.2, 0.1)
    shader.inputs["Subsurface Scale"].default_value = 0.5
    _wall(material)


@awkward("sheen: velvet", words=("sheen",))
def sheen(folder: Path) -> None:
    stage()
    material = matte("Velvet", (0.1, 0.02, 0.02))
    principled_node(material).inputs["Sheen Weight"].default_value = 1.0
    principled_node(material).inputs["Sheen Roughness"].default_value = 0.5
    _wall(material)


@awkward("a coat over paint", words=("coat",))
def coat(folder: Path) -> None:
    stage()
    material = matte("Paint", (0.5, 0.02, 0.02))
    principled_node(material).inputs["Coat Weight"].default_value = 1.0
    _wall(material)


@awkward("a thin film", words=("film", "thin"))
def thin_film(folder: Path) -> None:
    stage()
    material = principled("Soap", (0.1, 0.1, 0.1), roughness=0.05, metallic=1.0)
    principled_node(material).inputs["Thin Film Thickness"].default_value = 400.0
    _wall(material)


@awkward("a gleaming floor that is not chosen as a mirror", words=("Floor", "gloss", "shiny", "mirror"))
def shiny_floor(folder: Path) -> None:
    stage()
    find("Floor").data.materials.clear()
    find("Floor").data.materials.append(principled("Polished", (0.05, 0.05, 0.06), metallic=1.0, roughness=0.0))
    find("Floor").data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (
        0.8,
        0.8,
        0.8,
        1.0,
    )


@awkward("a chrome ball beside the mirror, not chosen", words=("Blue", "gloss", "shiny", "mirror"))
def shiny_ball(folder: Path) -> None:
    stage()
    find("Blue").location = (-1.3, -1.6, 0.8)
    find("Blue").scale = (1.6, 1.6, 1.6)
    give("Blue", principled("Chrome 2", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.02))


@awkward("rough metal", words=("rough", "gloss"))
def rough_metal(folder: Path) -> None:
    stage()
    _wall(principled("Steel", (0.8, 0.7, 0.5), metallic=1.0, roughness=0.5))


@awkward("the Metallic shader", words=("metallic", "gloss", "shader"))
def metallic_shader(folder: Path) -> None:
    stage()
    _wall(surface("Gold", "BsdfMetallic", Base_Color=(0.9, 0.6, 0.2, 1.0), Roughness=0.6))


@awkward("an old Glossy shader", words=("gloss",))
def glossy_shader(folder: Path) -> None:
    stage()
    _wall(surface("Glossy", "BsdfAnisotropic", Color=(0.3, 0.7, 0.9, 1.0), Roughness=0.5))


@awkward("a rough diffuse shader: Oren-Nayar")
def oren_nayar(folder: Path) -> None:
    stage()
    _wall(surface("Clay", "BsdfDiffuse", Color=(0.7, 0.4, 0.3, 1.0), Roughness=1.0))


@awkward("light that comes through: Translucent", words=("translucent",))
def translucent(folder: Path) -> None:
    stage()
    _wall(surface("Paper", "BsdfTranslucent", Color=(0.9, 0.8, 0.6, 1.0)))


@awkward("the toon shader", words=("toon",))
def toon(folder: Path) -> None:
    stage()
    _wall(surface("Toon", "BsdfToon", Color=(0.9, 0.2, 0.2, 1.0), Size=0.5, Smooth=0.0))


@awkward("the old velvet shader", words=("sheen", "velvet"))
def sheen_shader(folder: Path) -> None:
    stage()
    _wall(surface("Sheen", "BsdfSheen", Color=(0.9, 0.3, 0.8, 1.0)))


@awkward("hair shaders on a surface", words=("hair",))
def hair_shader(folder: Path) -> None:
    stage()
    _wall(surface("Hair", "BsdfHairPrincipled"))


@awkward("a ray portal", words=("portal",))
def ray_portal(folder: Path) -> None:
    stage()
    _wall(surface("Portal", "BsdfRayPortal", Color=(0.5, 1.0, 0.5, 1.0)))


@awkward("Holdout shader: a hole in the picture", words=("holdout",))
def holdout_shader(folder: Path) -> None:
    stage()
    give("Red", surface("Hole", "Holdout"))


@awkward("a background shader on a surface", words=("background", "shader"))
def background_on_surface(folder: Path) -> None:
    stage()
    _wall(surface("Odd", "Background", Color=(0.3, 0.8, 0.4, 1.0)))


@awkward("Add Shader of two")
def add_shader(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Sum")
    tree: Any = material.node_tree
    tree.nodes.clear()
    add, output = node(tree, "AddShader"), tree.nodes.new("ShaderNodeOutputMaterial")
    first = node(tree, "BsdfDiffuse", Color=(0.5, 0.1, 0.1, 1.0))
    second = node(tree, "Emission", Color=(0.0, 0.2, 0.4, 1.0))
    tree.links.new(first.outputs[0], add.inputs[0])
    tree.links.new(second.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], output.inputs["Surface"])
    _wall(material)


@awkward("Mix Shader by Fresnel", words=("fresnel", "mix", "layer weight"))
def mix_by_fresnel(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Mixed")
    tree: Any = material.node_tree
    tree.nodes.clear()
    mix, output = node(tree, "MixShader"), tree.nodes.new("ShaderNodeOutputMaterial")
    first = node(tree, "BsdfDiffuse", Color=(0.7, 0.1, 0.1, 1.0))
    second = node(tree, "Emission", Color=(0.0, 0.3, 1.0, 1.0))
    weight = node(tree, "LayerWeight", Blend=0.5)
    tree.links.new(weight.outputs["Facing"], mix.inputs[0])
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    _wall(material)


@awkward("Mix Shader by Backfacing: paint outside, another inside", words=("geometry", "backfacing"))
def mix_by_backfacing(folder: Path) -> None:
    stage()
    material = matte("Sides", (0.7, 0.1, 0.1))
    tree: Any = material.node_tree
    mix = node(tree, "Mix")
    mix.data_type = "RGBA"
    geometry = node(tree, "NewGeometry")
    mix.inputs[6].default_value, mix.inputs[7].default_value = (0.8, 0.1, 0.1, 1.0), (0.1, 0.7, 0.2, 1.0)
    tree.links.new(geometry.outputs["Backfacing"], mix.inputs[0])
    tree.links.new(mix.outputs[2], principled_node(material).inputs["Base Color"])
    wall = _wall(material)
    wall.rotation_euler.z = 0.0


@awkward("emission from Principled over its own color")
def principled_emission(folder: Path) -> None:
    stage()
    _wall(principled("Glow", (0.1, 0.1, 0.1), emission=(0.8, 0.3, 0.05)))


@awkward("an emitter that lights what is round it", words=("emitter", "emission", "emit", "light of", "lights"))
def emitter_lights(folder: Path) -> None:
    stage(sky=(0.02, 0.02, 0.03), sun=0.3)
    add_ball("Bulb", (0.9, -1.6, 1.4), 0.25, emitter("Bulb", (40.0, 25.0, 10.0)))


@awkward("displacement in the material", words=("displace",))
def material_displacement(folder: Path) -> None:
    stage()
    material = matte("Rocks", (0.6, 0.4, 0.2))
    material.displacement_method = "BOTH"
    tree: Any = material.node_tree
    displace, noise = node(tree, "Displacement", Scale=0.8), node(tree, "TexNoise", Scale=3.0)
    tree.links.new(noise.outputs["Fac"], displace.inputs["Height"])
    tree.links.new(displace.outputs[0], output_of(tree).inputs["Displacement"])
    add_ball("Rock", (-1.0, -1.8, 0.6), 0.6, material, 128)


@awkward("bump of a thing", words=("bump", "relief"))
def bump_of_thing(folder: Path) -> None:
    stage()
    material = matte("Bumpy", (0.7, 0.6, 0.5))
    tree: Any = material.node_tree
    bump, wave = node(tree, "Bump", Distance=0.5), node(tree, "TexWave", Scale=2.0)
    tree.links.new(wave.outputs["Fac"], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], principled_node(material).inputs["Normal"])
    _wall(material)


def _colored(kind: str, output: str = "Color", **inputs: Any) -> None:
    """A wall whose color is a node's."""
    stage()
    material = matte("Patterned", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    made = node(tree, kind, **inputs)
    tree.links.new(made.outputs[output], principled_node(material).inputs["Base Color"])
    _wall(material)


@awkward("checker texture", words=("checker",))
def texture_checker(folder: Path) -> None:
    _colored("TexChecker", Color1=(0.9, 0.1, 0.1, 1.0), Color2=(0.1, 0.1, 0.8, 1.0), Scale=4.0)


@awkward("noise texture", words=("noise",))
def texture_noise(folder: Path) -> None:
    _colored("TexNoise", Scale=3.0)


@awkward("Voronoi texture", words=("voronoi",))
def texture_voronoi(folder: Path) -> None:
    _colored("TexVoronoi", Scale=4.0)


@awkward("bricks", words=("brick",))
def texture_brick(folder: Path) -> None:
    _colored("TexBrick", Scale=3.0)


@awkward("gradient texture", words=("gradient",))
def texture_gradient(folder: Path) -> None:
    _colored("TexGradient")


@awkward("magic texture", words=("magic",))
def texture_magic(folder: Path) -> None:
    _colored("TexMagic", Scale=3.0)


@awkward("the object's own color", words=("object info",))
def object_info_color(folder: Path) -> None:
    _colored("ObjectInfo")
    find("Wall").color, find("Sample").color = (0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)


@awkward("a random number for each object", words=("object info", "random"))
def object_info_random(folder: Path) -> None:
    _colored("ObjectInfo", "Random")


@awkward("what a ray is: dark to the camera, bright in mirrors", words=("light path",))
def light_path(folder: Path) -> None:
    _colored("LightPath", "Is Glossy Ray")


@awkward("ambient occlusion as a color", words=("ambient occlusion",))
def ambient_occlusion(folder: Path) -> None:
    _colored("AmbientOcclusion")


@awkward("blackbody color")
def blackbody(folder: Path) -> None:
    _colored("Blackbody", Temperature=2500.0)


@awkward("wavelength as a color", words=("wavelength",))
def wavelength(folder: Path) -> None:
    _colored("Wavelength", Wavelength=520.0)


def _ramped(output: str, stops: list[tuple[float, tuple[float, ...]]]) -> None:
    stage()
    material = matte("Ramped", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    ramp = node(tree, "ValToRGB", Fac=0.7)
    for element, (place, color) in zip(ramp.color_ramp.elements, stops, strict=True):
        element.position, element.color = place, color
    tree.links.new(ramp.outputs[output], principled_node(material).inputs["Base Color"])
    _wall(material)


@awkward("the color of a ramp at a number")
def ramp_color(folder: Path) -> None:
    _ramped("Color", [(0.2, (0.9, 0.1, 0.1, 1.0)), (0.9, (0.1, 0.1, 0.9, 1.0))])


@awkward("the alpha of a ramp as a color")
def ramp_alpha(folder: Path) -> None:
    _ramped("Alpha", [(0.2, (0.9, 0.1, 0.1, 1.0)), (0.9, (0.9, 0.9, 0.9, 0.1))])


def _mixed(blend: str, factor: float, clamp: bool) -> None:
    stage()
    material = matte("Mix", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    mix = node(tree, "Mix")
    mix.data_type, mix.blend_type, mix.clamp_result, mix.clamp_factor = "RGBA", blend, clamp, False
    mix.inputs[0].default_value = factor
    mix.inputs[6].default_value, mix.inputs[7].default_value = (0.9, 0.5, 0.1, 1.0), (0.6, 0.9, 0.7, 1.0)
    tree.links.new(mix.outputs[2], principled_node(material).inputs["Emission Color"])
    principled_node(material).inputs["Emission Strength"].default_value = 0.6
    principled_node(material).inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    _wall(material)


@awkward("Mix by addition, with its result clamped")
def mix_clamp_result(folder: Path) -> None:
    _mixed("ADD", 1.0, True)


@awkward("Mix by addition, over 1")
def mix_over_one(folder: Path) -> None:
    _mixed("ADD", 1.0, False)


@awkward("Mix by color dodge", words=("mix", "dodge"))
def mix_dodge(folder: Path) -> None:
    _mixed("DODGE", 0.7, False)


@awkward("Mix with a factor of two")
def mix_factor_two(folder: Path) -> None:
    _mixed("MIX", 2.0, False)


@awkward("hue and saturation", words=("hue",))
def hue_saturation(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Hue", picture("Orange", np.full((4, 4, 4), (0.9, 0.5, 0.1, 1.0))))
    change = node(tree, "HueSaturation", Hue=0.8, Saturation=1.4)
    tree.links.new(texture.outputs[0], change.inputs["Color"])
    tree.links.new(change.outputs[0], principled_node(material).inputs["Base Color"])
    _wall(material)


@awkward("a node group in a node group")
def nested_groups(folder: Path) -> None:
    stage()
    groups = []
    for number in range(2):
        group: Any = bpy.data.node_groups.new(f"Group {number}", "ShaderNodeTree")
        group.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        source, output = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        if groups:
            inner = group.nodes.new("ShaderNodeGroup")
            inner.node_tree = groups[0]
        else:
            inner = node(group, "Invert")
        tree_in = inner.inputs["Color"]
        group.links.new(source.outputs[0], tree_in)
        group.links.new(inner.outputs[0], output.inputs[0])
        groups.append(group)
    material = matte("Grouped", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    used = tree.nodes.new("ShaderNodeGroup")
    used.node_tree = groups[1]
    used.inputs["Color"].default_value = (0.1, 0.8, 0.9, 1.0)
    tree.links.new(used.outputs[0], principled_node(material).inputs["Base Color"])
    _wall(material)


@awkward("a muted node, a reroute, and frames")
def muted_nodes(folder: Path) -> None:
    stage()
    material = matte("Muted", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    color, invert = node(tree, "RGB"), node(tree, "Invert")
    color.outputs[0].default_value = (0.9, 0.3, 0.1, 1.0)
    invert.mute = True
    reroute = tree.nodes.new("NodeReroute")
    tree.links.new(color.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], invert.inputs["Color"])
    tree.links.new(invert.outputs[0], principled_node(material).inputs["Base Color"])
    _wall(material)
