# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough metals and other glossy things, each in the room."""

from __future__ import annotations

from functools import partial
from typing import Any

from ..awkward.stage import surface
from .registry import Limits, add_scene, path_scene
from .stage import metal, of_principled, put_ball, put_suzanne, put_teapot, room

LIMITS: dict[float, Limits] = {0.1: (0.02, 0.01), 0.3: (0.05, 0.025), 0.5: (0.08, 0.035)}
"""By roughness"""
LAYERED: Limits = (0.05, 0.03)
"""Soft light on the base leaves 0.025 by itself"""
ROUGHNESSES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


def _metal_ball(roughness: float) -> None:
    room()
    put_ball(metal(roughness))


for _roughness in ROUGHNESSES:
    add_scene(
        f"metal_{round(10 * _roughness):02d}",
        f"a metal ball of roughness {_roughness}",
        partial(_metal_ball, _roughness),
        LIMITS.get(_roughness, (None, None)),
        samples=1024 if _roughness < 0.2 else 512,
    )


@path_scene("a sharp metal ball: what the rest of the picture leaves")
def metal_sharp() -> None:
    _metal_ball(0.0)


@path_scene("a metal ball of roughness 0.3 where the lamp and the sky light all", LIMITS[0.3])
def metal_03_soft() -> None:
    room(soft=True)
    put_ball(metal(0.3))


@path_scene("a metal pot that sees itself, roughness 0.1", LIMITS[0.1])
def teapot_01() -> None:
    room()
    put_teapot(metal(0.1))


@path_scene("a metal pot that sees itself, roughness 0.3", LIMITS[0.3])
def teapot_03() -> None:
    room()
    put_teapot(metal(0.3))


@path_scene("a subdivided head of metal, roughness 0.3", LIMITS[0.3])
def suzanne_03() -> None:
    room()
    put_suzanne(metal(0.3))


@path_scene("the Glossy shader, roughness 0.3", LIMITS[0.3])
def glossy_03() -> None:
    room()
    put_ball(surface("Glossy", "BsdfAnisotropic", Color=(0.9, 0.7, 0.4, 1.0), Roughness=0.3))


@path_scene("the Metallic shader, roughness 0.3", LIMITS[0.3])
def metallic_03() -> None:
    room()
    put_ball(surface("Metallic", "BsdfMetallic", Base_Color=(0.9, 0.6, 0.3, 1.0), Roughness=0.3))


@path_scene("brushed metal: anisotropy 0.8, roughness 0.3", LIMITS[0.3])
def brushed_03() -> None:
    room()
    put_ball(metal(0.3, Anisotropic=0.8))


@path_scene("brushed metal turned by a quarter", LIMITS[0.3])
def brushed_turned_03() -> None:
    room()
    put_ball(metal(0.3, Anisotropic=0.8, Anisotropic_Rotation=0.25))


@path_scene("brushed metal along its UV map", LIMITS[0.3])
def brushed_uv_03() -> None:
    room()
    material = metal(0.3, Anisotropic=0.8)
    tree: Any = material.node_tree
    tangent = tree.nodes.new("ShaderNodeTangent")
    tangent.direction_type = "UV_MAP"
    tangent.uv_map = "UVMap"
    shader = next(item for item in tree.nodes if item.type == "BSDF_PRINCIPLED")
    tree.links.new(tangent.outputs[0], shader.inputs["Tangent"])
    put_ball(material)


@path_scene("two rough metal balls that see each other", LIMITS[0.3], mirrors=("Object", "Second"))
def pair_03() -> None:
    room()
    put_ball(metal(0.3), place=(-0.7, 0.0, 0.75), radius=0.75, segments=64)
    put_ball(metal(0.2, (0.9, 0.6, 0.3)), "Second", (0.85, -0.3, 0.6), 0.6, 64)


@path_scene("a rough dielectric over white: roughness 0.3", LAYERED, layered=True)
def dielectric_03() -> None:
    room(soft=True)
    put_ball(of_principled("Plastic", Base_Color=(0.5, 0.08, 0.05, 1.0), Roughness=0.3))


@path_scene("a sharp dielectric over a color")
def dielectric_00() -> None:
    room(soft=True)
    put_ball(of_principled("Plastic", Base_Color=(0.5, 0.08, 0.05, 1.0), Roughness=0.0))


@path_scene("a rough dielectric of a high index", LAYERED, layered=True)
def dielectric_dense_03() -> None:
    room(soft=True)
    put_ball(of_principled("Diamond paint", Base_Color=(0.1, 0.3, 0.6, 1.0), Roughness=0.3, IOR=2.4))
