# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes on squares in a mirror, lit by one sun: how far the mean of each square is from Cycles' own."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np
from extraction import add_square, empty_scene
from materials.mirrored_wall import pictures_of_wall

from .stage import MakeTree
from .trees import Value, shader_node

COLOR = (0.8, 0.4, 0.2, 1.0)
COLUMNS = 8
TOLERANCE = 1.0 / 255.0
INNER = slice(4, 12)
"""Pixels of a square that its edges are not in"""


def _bsdf(kind: str, inputs: Mapping[str | int, Value] = {}, **settings: str) -> MakeTree:
    name = "Base Color" if kind in ("BsdfPrincipled", "BsdfMetallic") else "Color"
    return shader_node(kind, {name: COLOR, **inputs}, **settings)


def _principled(**inputs: Value) -> MakeTree:
    return _bsdf("BsdfPrincipled", {name.replace("_", " "): value for name, value in inputs.items()})


def _both(kind: str, first: MakeTree, second: MakeTree, factor: float | None = None) -> MakeTree:
    number = 0 if factor is None else 1
    inputs: dict[str | int, Value] = {number: first, number + 1: second}
    return shader_node(kind, inputs if factor is None else {0: factor, **inputs})


DIFFUSE, GLOSSY = _bsdf("BsdfDiffuse"), _bsdf("BsdfAnisotropic", {"Roughness": 0.4})
SHADERS: Mapping[str, MakeTree] = {
    "Diffuse BSDF": DIFFUSE,
    "Diffuse BSDF, rough": _bsdf("BsdfDiffuse", {"Roughness": 0.8}),
    **{
        f"Glossy BSDF, {kind.replace('_', ' ').lower()}": _bsdf(
            "BsdfAnisotropic", {"Roughness": 0.5}, distribution=kind
        )
        for kind in ("MULTI_GGX", "GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY")
    },
    "Glossy BSDF, anisotropic": _bsdf("BsdfAnisotropic", {"Roughness": 0.5, "Anisotropy": 0.6}),
    "Metallic BSDF, F82": _bsdf("BsdfMetallic", {"Roughness": 0.5}),
    "Metallic BSDF, physical": shader_node("BsdfMetallic", {"Roughness": 0.5}, fresnel_type="PHYSICAL_CONDUCTOR"),
    "Glass BSDF": _bsdf("BsdfGlass", {"Roughness": 0.3}),
    "Refraction BSDF": _bsdf("BsdfRefraction", {"Roughness": 0.3}),
    "Transparent BSDF": _bsdf("BsdfTransparent"),
    "Translucent BSDF": _bsdf("BsdfTranslucent"),
    "Sheen BSDF": _bsdf("BsdfSheen"),
    "Sheen BSDF, Ashikhmin": _bsdf("BsdfSheen", distribution="ASHIKHMIN"),
    "Toon BSDF, diffuse": _bsdf("BsdfToon"),
    "Toon BSDF, glossy": _bsdf("BsdfToon", component="GLOSSY"),
    "Subsurface Scattering": _bsdf("SubsurfaceScattering", {"Scale": 0.05}),
    "Emission": _bsdf("Emission"),
    "Background": _bsdf("Background"),
    "Holdout": shader_node("Holdout"),
    "Ray Portal BSDF": _bsdf("BsdfRayPortal"),
    "Hair BSDF": _bsdf("BsdfHair"),
    "Principled Hair BSDF": shader_node("BsdfHairPrincipled"),
    "Specular BSDF": shader_node("EeveeSpecular"),
    "Principled BSDF": _principled(),
    "Principled BSDF, metallic": _principled(Metallic=1.0),
    "Principled BSDF, half metallic": _principled(Metallic=0.5),
    "Principled BSDF, coat": _principled(Coat_Weight=1.0, Coat_Roughness=0.3, Coat_Tint=(0.9, 0.6, 0.3, 1.0)),
    "Principled BSDF, sheen": _principled(Sheen_Weight=1.0, Sheen_Roughness=0.4),
    "Principled BSDF, specular": _principled(Specular_Tint=(0.9, 0.2, 0.2, 1.0), Specular_IOR_Level=0.9),
    "Principled BSDF, transmission": _principled(Transmission_Weight=0.8, Roughness=0.3),
    "Principled BSDF, thin wall": _principled(Transmission_Weight=0.8, Roughness=0.3, Thin_Wall=True),
    "Principled BSDF, subsurface": _principled(Subsurface_Weight=0.7, Subsurface_Scale=0.02),
    "Principled BSDF, diffuse roughness": _principled(Diffuse_Roughness=0.9),
    "Principled BSDF, alpha": _principled(Alpha=0.4),
    "Principled BSDF, emission": _principled(Emission_Color=COLOR, Emission_Strength=0.5),
    "Principled BSDF, thin film": _principled(Metallic=1.0, Thin_Film_Thickness=400.0),
    "Principled BSDF, anisotropic": _principled(Metallic=1.0, Anisotropic=0.6),
    "Mix Shader": _both("MixShader", DIFFUSE, GLOSSY, 0.4),
    "Mix Shader, of transparency": _both("MixShader", DIFFUSE, _bsdf("BsdfTransparent"), 0.4),
    "Mix Shader, of two Principled": _both("MixShader", _principled(Metallic=1.0), _principled(Roughness=0.9), 0.5),
    "Add Shader": _both("AddShader", DIFFUSE, _bsdf("Emission", {"Strength": 0.3})),
    "Add Shader, of layers": _both("AddShader", DIFFUSE, GLOSSY),
}


@dataclass(frozen=True, slots=True)
class JudgedShader:
    """How a shader is drawn."""

    name: str
    error: float
    """Of the square's mean color, the largest channel"""
    warnings: tuple[str, ...]
    """That name it"""

    @property
    def is_right(self) -> bool:
        return self.error <= TOLERANCE

    @property
    def is_silently_wrong(self) -> bool:
        return not self.is_right and not self.warnings


def judged_shaders() -> list[JudgedShader]:
    """All, in one picture."""
    empty_scene()
    for number, (name, make) in enumerate(SHADERS.items()):
        row, column = divmod(number, COLUMNS)
        square = add_square(name, 0.9)
        square.location, square.rotation_euler = (column, 0.0, row), (math.pi / 2.0, 0.0, 0.0)
        material = bpy.data.materials.new(name)
        tree = material.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(make(tree), output.inputs["Surface"])
        square.data.materials.append(material)
    wall = pictures_of_wall(COLUMNS, -(-len(SHADERS) // COLUMNS))
    errors = np.abs((wall.ours - wall.cycles)[:, :, INNER, INNER].mean(axis=(2, 3))).max(axis=2)
    return [
        JudgedShader(name, float(errors[divmod(number, COLUMNS)]), _naming(name, wall.warnings))
        for number, name in enumerate(SHADERS)
    ]


def _naming(name: str, warnings: tuple[str, ...]) -> tuple[str, ...]:
    """Those that say what is wrong with a material; without its name."""
    about = [text for text in warnings if f'"{name}"' in text and "material" in text]
    return tuple(re.sub(r" of (?:material \"[^\"]*\"|\d+ materials \([^)]*\))", "", text) for text in about)
