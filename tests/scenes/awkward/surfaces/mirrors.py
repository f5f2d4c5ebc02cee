# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the chosen mirrors are made of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import MIRROR, awkward
from ..stage import (
    add_ball,
    bpy,
    emitter,
    find,
    give,
    joined,
    matte,
    mirror,
    node,
    output_of,
    picture,
    principled,
    principled_node,
    stage,
    stripes,
    surface,
)


def _without_bounces() -> None:
    """What is bright and large shows the light of other surfaces, which is another matter."""
    bpy.context.scene.cycles.diffuse_bounces = 0


def _of(material: bpy.types.Material) -> None:
    give(MIRROR, material)


def _metal(**inputs: Any) -> Any:
    """Chrome with other inputs; returns its tree."""
    stage()
    material = mirror("Chrome 2")
    for name, value in inputs.items():
        principled_node(material).inputs[name.replace("_", " ")].default_value = value
    _of(material)
    return material.node_tree


@awkward("roughness 0.1")
def mirror_roughness_low(folder: Path) -> None:
    _metal(Roughness=0.1)


@awkward("roughness 0.3")
def mirror_roughness(folder: Path) -> None:
    _metal(Roughness=0.3)


@awkward("roughness 1")
def mirror_roughness_full(folder: Path) -> None:
    _metal(Roughness=1.0)


@awkward("roughness by an image")
def mirror_roughness_image(folder: Path) -> None:
    tree = _metal()
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture("Smudges", stripes((0.0, 0.0, 0.0), (0.5, 0.5, 0.5)))
    texture.image.colorspace_settings.name = "Non-Color"
    tree.links.new(texture.outputs[0], principled_node(bpy.data.materials["Chrome 2"]).inputs["Roughness"])


@awkward("an anisotropic mirror")
def mirror_anisotropic(folder: Path) -> None:
    _metal(Anisotropic=1.0, Roughness=0.3)


@awkward("gold")
def mirror_gold(folder: Path) -> None:
    _metal(Base_Color=(1.0, 0.6, 0.2, 1.0))


@awkward("a black metal")
def mirror_black(folder: Path) -> None:
    _metal(Base_Color=(0.0, 0.0, 0.0, 1.0))


@awkward("metal with an edge tint")
def mirror_edge_tint(folder: Path) -> None:
    _metal(Base_Color=(0.5, 0.1, 0.1, 1.0), Specular_Tint=(0.2, 1.0, 0.2, 1.0))


@awkward("half metal, half paint")
def mirror_half_metallic(folder: Path) -> None:
    _metal(Metallic=0.5, Base_Color=(0.7, 0.1, 0.1, 1.0))


@awkward("a dielectric: polished stone")
def mirror_dielectric(folder: Path) -> None:
    _metal(Metallic=0.0, Base_Color=(0.02, 0.02, 0.05, 1.0))


@awkward("white china")
def mirror_china(folder: Path) -> None:
    _metal(Metallic=0.0, Base_Color=(0.8, 0.8, 0.8, 1.0))
    _without_bounces()


@awkward("a matte mirror: nothing is reflected")
def mirror_matte(folder: Path) -> None:
    stage()
    _of(matte("Chalk", (0.8, 0.3, 0.2)))
    _without_bounces()


@awkward("a mirror of glass")
def mirror_glass(folder: Path) -> None:
    stage()
    _of(surface("Glass", "BsdfGlass", Roughness=0.0, IOR=1.45))


@awkward("a mirror of Principled glass")
def mirror_principled_glass(folder: Path) -> None:
    _metal(Metallic=0.0, Transmission_Weight=1.0)


@awkward("a mirror under a coat", words=("coat",))
def mirror_coat(folder: Path) -> None:
    _metal(Metallic=0.0, Base_Color=(0.5, 0.02, 0.02, 1.0), Roughness=1.0, Coat_Weight=1.0, Coat_Roughness=0.0)


@awkward("a coat on metal")
def mirror_coat_on_metal(folder: Path) -> None:
    _metal(Base_Color=(0.5, 0.1, 0.05, 1.0), Coat_Weight=1.0, Coat_Roughness=0.0, Coat_Tint=(0.3, 0.5, 1.0, 1.0))


@awkward("a mirror with sheen", words=("sheen",))
def mirror_sheen(folder: Path) -> None:
    _metal(Sheen_Weight=1.0)


@awkward("a mirror of wax", words=("subsurface", "diffuse"))
def mirror_subsurface(folder: Path) -> None:
    _metal(Metallic=0.0, Base_Color=(0.8, 0.3, 0.2, 1.0), Subsurface_Weight=1.0)


@awkward("a mirror that is half transparent")
def mirror_alpha(folder: Path) -> None:
    _metal(Alpha=0.5)


@awkward("a mirror that glows", words=("emission", "emit", "glow"))
def mirror_emission(folder: Path) -> None:
    _metal(Emission_Color=(0.3, 0.1, 0.0, 1.0), Emission_Strength=1.0)


@awkward("a mirror with a thin film")
def mirror_thin_film(folder: Path) -> None:
    _metal(Thin_Film_Thickness=450.0)


@awkward("a mirror of an emitter alone", words=("emission",))
def mirror_emitter(folder: Path) -> None:
    stage()
    _of(emitter("Lamp", (0.7, 0.5, 0.2)))


@awkward("an old Glossy shader without roughness")
def mirror_glossy_shader(folder: Path) -> None:
    stage()
    _of(surface("Glossy", "BsdfAnisotropic", Color=(0.9, 0.7, 0.4, 1.0), Roughness=0.0))


@awkward("a Metallic shader without roughness")
def mirror_metallic_shader(folder: Path) -> None:
    stage()
    _of(surface("Metal", "BsdfMetallic", Base_Color=(0.9, 0.7, 0.4, 1.0), Roughness=0.0))


@awkward("a Metallic shader by physical values")
def mirror_metallic_physical(folder: Path) -> None:
    stage()
    material = surface("Metal", "BsdfMetallic", Roughness=0.0)
    shader = next(item for item in material.node_tree.nodes if item.type == "BSDF_METALLIC")
    shader.fresnel_type = "PHYSICAL_CONDUCTOR"
    _of(material)


def _mixed(name: str, first: tuple[str, dict[str, Any]], gloss: dict[str, Any], by_fresnel: bool) -> None:
    stage()
    material, tree, mix = joined(name, "MixShader", first, ("BsdfAnisotropic", {**gloss, "Roughness": 0.0}))
    if by_fresnel:
        tree.links.new(node(tree, "Fresnel", IOR=2.0).outputs[0], mix.inputs[0])
    _of(material)


PAINT: tuple[str, dict[str, Any]] = ("BsdfDiffuse", {"Color": (0.6, 0.05, 0.05, 1.0)})
WHITE = {"Color": (1.0, 1.0, 1.0, 1.0)}


@awkward("car paint: diffuse and glossy mixed by Fresnel", words=("mix", "diffuse", "fresnel"))
def mirror_mix_fresnel(folder: Path) -> None:
    _mixed("Mixed", PAINT, WHITE, by_fresnel=True)


@awkward("diffuse and glossy, half and half", words=("mix", "diffuse"))
def mirror_mix_half(folder: Path) -> None:
    _mixed("Mixed", PAINT, WHITE, by_fresnel=False)


@awkward("an old transparent and glossy mix: lazy glass", words=("transparen", "mix"))
def mirror_lazy_glass(folder: Path) -> None:
    _mixed("Lazy", ("BsdfTransparent", {}), {}, by_fresnel=True)


@awkward("a tinted mirror by an image")
def mirror_tint_image(folder: Path) -> None:
    tree = _metal()
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture("Stripes", stripes())
    tree.links.new(texture.outputs[0], principled_node(bpy.data.materials["Chrome 2"]).inputs["Base Color"])


def _normal_map(uv: str | None) -> None:
    tree = _metal()
    size = 64
    x = np.linspace(0.0, 8.0 * np.pi, size)
    normal = np.zeros((size, size, 4), np.float32)
    normal[..., 0], normal[..., 1], normal[..., 3] = 0.5 + 0.25 * np.sin(x)[None], 0.5, 1.0
    normal[..., 2] = 0.5 + 0.5 * np.sqrt(1.0 - (0.5 * np.sin(x)[None]) ** 2)
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture("Waves", normal)
    texture.image.colorspace_settings.name = "Non-Color"
    relief = node(tree, "NormalMap", Strength=0.6)
    if uv is not None:
        relief.uv_map = uv
    tree.links.new(texture.outputs[0], relief.inputs["Color"])
    tree.links.new(relief.outputs[0], principled_node(bpy.data.materials["Chrome 2"]).inputs["Normal"])


@awkward("a normal map on the mirror")
def mirror_normal_map(folder: Path) -> None:
    _normal_map(None)


@awkward("a normal map that names the mirror's only UV map")
def mirror_normal_map_named(folder: Path) -> None:
    _normal_map("UVMap")


@awkward("a normal map in world space", words=("normal map", "relief", "bump"))
def mirror_normal_map_world(folder: Path) -> None:
    _normal_map(None)
    tree = bpy.data.materials["Chrome 2"].node_tree
    next(item for item in tree.nodes if item.type == "NORMAL_MAP").space = "WORLD"


@awkward("bump on the mirror by a wave texture", words=("bump", "relief", "wave"))
def mirror_bump(folder: Path) -> None:
    tree = _metal()
    bump, wave = node(tree, "Bump", Distance=0.1, Strength=0.5), node(tree, "TexWave", Scale=2.0)
    tree.links.new(wave.outputs["Fac"], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], principled_node(bpy.data.materials["Chrome 2"]).inputs["Normal"])


@awkward("displacement in the mirror's material", words=("displace",))
def mirror_displacement(folder: Path) -> None:
    stage()
    tree = _metal()
    bpy.data.materials["Chrome 2"].displacement_method = "DISPLACEMENT"
    displace, noise = node(tree, "Displacement", Scale=0.6), node(tree, "TexNoise", Scale=1.5)
    tree.links.new(noise.outputs["Fac"], displace.inputs["Height"])
    tree.links.new(displace.outputs[0], output_of(tree).inputs["Displacement"])


@awkward("a mirror of two materials, one of them matte")
def mirror_two_materials(folder: Path) -> None:
    stage()
    mesh = find(MIRROR).data
    mesh.materials.append(matte("Paint", (0.7, 0.1, 0.05)))
    count = len(mesh.polygons)
    mesh.polygons.foreach_set("material_index", [int(i // 48 % 4 == 1) for i in range(count)])


@awkward("a mirror without a material", words=("roughness", "diffuse", "Mirror"))
def mirror_no_material(folder: Path) -> None:
    stage()
    find(MIRROR).data.materials.clear()
    _without_bounces()


@awkward("a material linked to the object in place of its mesh")
def mirror_object_material(folder: Path) -> None:
    stage()
    slot = find(MIRROR).material_slots[0]
    slot.link = "OBJECT"
    slot.material = principled("Gold", (0.95, 0.6, 0.2), metallic=1.0, roughness=0.0)


@awkward("a mirror with a roughness by the object's random number", words=("roughness",))
def mirror_random_roughness(folder: Path) -> None:
    tree = _metal()
    info = node(tree, "ObjectInfo")
    tree.links.new(info.outputs["Random"], principled_node(bpy.data.materials["Chrome 2"]).inputs["Roughness"])


@awkward("a one-way mirror: glossy outside, transparent inside", words=("transparen", "geometry", "mix"))
def mirror_one_way(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("One way")
    tree: Any = material.node_tree
    tree.nodes.clear()
    mix, output = node(tree, "MixShader"), tree.nodes.new("ShaderNodeOutputMaterial")
    first, second = node(tree, "BsdfAnisotropic", Roughness=0.0), node(tree, "BsdfTransparent")
    geometry = node(tree, "NewGeometry")
    tree.links.new(geometry.outputs["Backfacing"], mix.inputs[0])
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    _of(material)


@awkward("two mirrors, one rough and one clear", mirrors=(MIRROR, "Second"))
def mirror_pair_rough(folder: Path) -> None:
    stage()
    add_ball("Second", (-1.1, -1.3, 0.7), 0.6, principled("Satin", (0.9, 0.8, 0.6), metallic=1.0, roughness=0.4))
