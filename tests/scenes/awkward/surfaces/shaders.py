# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of all kinds on what mirrors show."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..registry import awkward
from ..stage import (
    add_ball,
    emitter,
    find,
    give,
    joined,
    matte,
    node,
    output_of,
    principled,
    principled_node,
    stage,
    surface,
    wall_of,
)


@awkward("subsurface scattering: wax", words=("subsurface",), samples=128)
def subsurface(folder: Path) -> None:
    stage()
    material = principled("Wax", (0.9, 0.3, 0.2), roughness=1.0)
    shader = principled_node(material)
    shader.inputs["Subsurface Weight"].default_value = 1.0
    shader.inputs["Subsurface Radius"].default_value = (1.0, 0.2, 0.1)
    shader.inputs["Subsurface Scale"].default_value = 0.5
    wall_of(material)


@awkward("sheen: velvet", words=("sheen",))
def sheen(folder: Path) -> None:
    stage()
    material = matte("Velvet", (0.1, 0.02, 0.02))
    principled_node(material).inputs["Sheen Weight"].default_value = 1.0
    principled_node(material).inputs["Sheen Roughness"].default_value = 0.5
    wall_of(material)


@awkward("a coat over paint", words=("coat",))
def coat(folder: Path) -> None:
    stage()
    material = matte("Paint", (0.5, 0.02, 0.02))
    principled_node(material).inputs["Coat Weight"].default_value = 1.0
    wall_of(material)


@awkward("a thin film", words=("film", "thin"))
def thin_film(folder: Path) -> None:
    stage()
    material = principled("Soap", (0.1, 0.1, 0.1), roughness=0.05, metallic=1.0)
    principled_node(material).inputs["Thin Film Thickness"].default_value = 400.0
    wall_of(material)


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


@awkward("rough metal", words=("only mirrors reflect",))
def rough_metal(folder: Path) -> None:
    stage()
    wall_of(principled("Steel", (0.8, 0.7, 0.5), metallic=1.0, roughness=0.5))


@awkward("the Metallic shader", words=("only mirrors reflect",))
def metallic_shader(folder: Path) -> None:
    stage()
    wall_of(surface("Gold", "BsdfMetallic", Base_Color=(0.9, 0.6, 0.2, 1.0), Roughness=0.6))


@awkward("an old Glossy shader", words=("only mirrors reflect",))
def glossy_shader(folder: Path) -> None:
    stage()
    wall_of(surface("Glossy", "BsdfAnisotropic", Color=(0.3, 0.7, 0.9, 1.0), Roughness=0.5))


@awkward("a rough diffuse shader: Oren-Nayar")
def oren_nayar(folder: Path) -> None:
    stage()
    wall_of(surface("Clay", "BsdfDiffuse", Color=(0.7, 0.4, 0.3, 1.0), Roughness=1.0))


@awkward("light that comes through: Translucent", words=("translucent",))
def translucent(folder: Path) -> None:
    stage()
    wall_of(surface("Paper", "BsdfTranslucent", Color=(0.9, 0.8, 0.6, 1.0)))


@awkward("the toon shader", words=("toon",))
def toon(folder: Path) -> None:
    stage()
    wall_of(surface("Toon", "BsdfToon", Color=(0.9, 0.2, 0.2, 1.0), Size=0.5, Smooth=0.0))


@awkward("the old velvet shader", words=("sheen", "velvet"))
def sheen_shader(folder: Path) -> None:
    stage()
    wall_of(surface("Sheen", "BsdfSheen", Color=(0.9, 0.3, 0.8, 1.0)))


@awkward("hair shaders on a surface", words=("hair",))
def hair_shader(folder: Path) -> None:
    stage()
    wall_of(surface("Hair", "BsdfHairPrincipled"))


@awkward("a ray portal", words=("portal",))
def ray_portal(folder: Path) -> None:
    stage()
    wall_of(surface("Portal", "BsdfRayPortal", Color=(0.5, 1.0, 0.5, 1.0)))


@awkward("Holdout shader: a hole in the picture", words=("holdout",))
def holdout_shader(folder: Path) -> None:
    stage()
    give("Red", surface("Hole", "Holdout"))


@awkward("a background shader on a surface", words=("background", "shader"))
def background_on_surface(folder: Path) -> None:
    stage()
    wall_of(surface("Odd", "Background", Color=(0.3, 0.8, 0.4, 1.0)))


@awkward("Add Shader of two")
def add_shader(folder: Path) -> None:
    stage()
    first = ("BsdfDiffuse", {"Color": (0.5, 0.1, 0.1, 1.0)})
    wall_of(joined("Sum", "AddShader", first, ("Emission", {"Color": (0.0, 0.2, 0.4, 1.0)}))[0])


@awkward("Mix Shader by Fresnel", words=("fresnel", "mix", "layer weight"))
def mix_by_fresnel(folder: Path) -> None:
    stage()
    first = ("BsdfDiffuse", {"Color": (0.7, 0.1, 0.1, 1.0)})
    material, tree, mix = joined("Mixed", "MixShader", first, ("Emission", {"Color": (0.0, 0.3, 1.0, 1.0)}))
    tree.links.new(node(tree, "LayerWeight", Blend=0.5).outputs["Facing"], mix.inputs[0])
    wall_of(material)


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
    wall = wall_of(material)
    wall.rotation_euler.z = 0.0


@awkward("emission from Principled over its own color", words=("emission",))
def principled_emission(folder: Path) -> None:
    stage()
    wall_of(principled("Glow", (0.1, 0.1, 0.1), emission=(0.8, 0.3, 0.05)))


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
    wall_of(material)
