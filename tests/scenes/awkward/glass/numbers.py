# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough and transparent surfaces whose numbers are none, or out of all range."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..registry import MIRROR, awkward
from ..stage import bpy, find, give, node, output_of, principled, principled_node, stage, surface

NAN, INF = float("nan"), float("inf")
NONE = ("finite", "number", "NaN", "range")
"""What a sentence says of a number that is none"""


def _scene() -> None:
    stage()
    bpy.context.scene.cycles.diffuse_bounces = 0


def _linked(material: bpy.types.Material, socket: str, number: float) -> bpy.types.Material:
    """The number comes from a Value node: a socket itself would not hold it."""
    tree: Any = material.node_tree
    value = node(tree, "Value")
    value.outputs[0].default_value = number
    tree.links.new(value.outputs[0], principled_node(material).inputs[socket])
    return material


def _chrome(socket: str, number: float) -> None:
    _scene()
    give(MIRROR, _linked(principled("Odd", (0.9, 0.8, 0.7), metallic=1.0, roughness=0.2), socket, number))


def _pane(socket: str, number: float) -> None:
    """Glass as scenery, before the mirror and beside it."""
    _scene()
    material = principled("Odd", (0.95, 0.95, 0.95), roughness=0.0)
    principled_node(material).inputs["Transmission Weight"].default_value = 1.0
    give("Blue", _linked(material, socket, number))


def _veil(number: float) -> None:
    _scene()
    material = principled("Odd", (0.7, 0.1, 0.1), roughness=1.0)
    principled_node(material).inputs["Specular IOR Level"].default_value = 0.0
    give("Red", _linked(material, "Alpha", number))


@awkward("a rough mirror whose roughness is no number", words=NONE)
def glass_roughness_nan(folder: Path) -> None:
    _chrome("Roughness", NAN)


@awkward("a mirror of roughness -0.5")
def glass_roughness_negative(folder: Path) -> None:
    _chrome("Roughness", -0.5)


@awkward("a mirror of roughness 7")
def glass_roughness_large(folder: Path) -> None:
    _chrome("Roughness", 7.0)


@awkward("a mirror whose metallic is no number", words=NONE)
def glass_metallic_nan(folder: Path) -> None:
    _chrome("Metallic", NAN)


@awkward("a mirror of metallic -2")
def glass_metallic_negative(folder: Path) -> None:
    _chrome("Metallic", -2.0)


@awkward("glass whose index is no number", words=NONE)
def glass_ior_nan(folder: Path) -> None:
    _pane("IOR", NAN)


@awkward("glass of an infinite index", words=NONE)
def glass_ior_infinite(folder: Path) -> None:
    _pane("IOR", INF)


@awkward("glass of an index of 0", words=NONE)
def glass_ior_zero(folder: Path) -> None:
    _pane("IOR", 0.0)


@awkward("glass of an index of -1.5", words=NONE)
def glass_ior_negative(folder: Path) -> None:
    _pane("IOR", -1.5)


@awkward("glass of an index of 1000")
def glass_ior_1000(folder: Path) -> None:
    _pane("IOR", 1000.0)


@awkward("a transmission of -1")
def glass_transmission_negative(folder: Path) -> None:
    _pane("Transmission Weight", -1.0)


@awkward("a transmission of 2")
def glass_transmission_two(folder: Path) -> None:
    _pane("Transmission Weight", 2.0)


@awkward("an alpha that is no number", words=NONE)
def glass_alpha_nan(folder: Path) -> None:
    _veil(NAN)


@awkward("an alpha of -0.5")
def glass_alpha_negative(folder: Path) -> None:
    _veil(-0.5)


@awkward("an alpha of 2")
def glass_alpha_two(folder: Path) -> None:
    _veil(2.0)


def _absorbing(density: float) -> None:
    _scene()
    material = surface("Resin", "BsdfRefraction", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.0)
    tree: Any = material.node_tree
    absorb = node(tree, "VolumeAbsorption", Color=(0.9, 0.2, 0.1, 1.0))
    absorb.inputs["Density"].default_value = density
    tree.links.new(absorb.outputs[0], output_of(tree).inputs["Volume"])
    give("Red", material)


@awkward("a volume that absorbs more than all")
def absorption_huge(folder: Path) -> None:
    _absorbing(1e6)


@awkward("a volume of a negative density")
def absorption_negative(folder: Path) -> None:
    _absorbing(-1.0)


@awkward("a film of a negative thickness on a mirror", words=("film",))
def film_negative(folder: Path) -> None:
    _scene()
    material = principled("Film", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0)
    give(MIRROR, _linked(material, "Thin Film Thickness", -300.0))


@awkward(
    "a transparent color that is brighter than all, and one below 0", words=("transparen", "color", "range", "tint")
)
def transparent_out_of_range(folder: Path) -> None:
    _scene()
    give("Red", surface("Bright", "BsdfTransparent", Color=(3.0, 0.5, -0.5, 1.0)))
    find("Green").location.x = 1.0
