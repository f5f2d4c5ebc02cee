# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs that shader nodes have in common, with the limits that Cycles puts on them."""

from __future__ import annotations

from typing import Any

from ...materials.node_links import Source
from ..builder import Builder
from ..expression import Expression
from .arithmetic import clamped, is_at, product, settled, total
from .closure import BLACK, PLAIN_NORMAL

LEAST_IOR = 1e-5
THINNEST_FILM = 0.1
"""Nanometers; Cycles leaves out thinner ones"""
SMOOTH = 0.05
"""Roughness up to which the distributions of facets look alike"""
DARKENS = 0.3
"""Roughness from which on GGX loses more than 1 % of the light between its facets, where Multiscatter GGX loses none"""


def number(b: Builder, source: Source, name: str, low: float, high: float = float("inf")) -> Expression:
    """Between limits."""
    return settled(clamped(b, b.input(source, name, "float"), low, high))


def color(b: Builder, source: Source, name: str, low: float = 0.0, high: float = float("inf")) -> Expression:
    """Between limits."""
    return settled(clamped(b, b.input(source, name, "color"), low, high))


def light(b: Builder, source: Source, color_name: str, strength_name: str) -> Expression:
    """A color times a strength."""
    strength = b.input(source, strength_name, "float")
    if is_at(strength, 0.0):
        return BLACK
    return product(b, b.input(source, color_name, "color"), strength)


def normal(b: Builder, source: Source, name: str = "Normal") -> Expression:
    """A unit normal; the surface's own where there is none."""
    if not b.is_linked(source, name):
        return PLAIN_NORMAL
    value = b.input(source, name, "vector")
    if is_at(value, 0.0):
        # (Inputs of groups that nothing is plugged into.)
        return PLAIN_NORMAL
    key = ("unit_normal", value.text)
    return b.shared(key, lambda: b.call("vector", "unit_normal", "s", value, file="nodes/unit_normal.glsl"))


def film(b: Builder, source: Source) -> dict[str, Expression]:
    """Channels of a thin film."""
    thickness = number(b, source, "Thin Film Thickness", 0.0)
    if thickness.high <= THINNEST_FILM:
        return {}
    return {"film_thickness": thickness, "film_ior": number(b, source, "Thin Film IOR", LEAST_IOR)}


def brushed(
    b: Builder,
    source: Source,
    unit: Expression,
    name: str,
    rotation_name: str,
    limits: tuple[float, float] = (0.0, 1.0),
) -> dict[str, Expression]:
    """Channels of anisotropy about the normal `unit`."""
    anisotropy = number(b, source, name, *limits)
    if is_at(anisotropy, 0.0):
        return {}
    rotation = b.input(source, rotation_name, "float")
    if b.is_linked(source, "Tangent"):
        # (What the surface's own tangent has to be turned by, in addition.)
        b.need("PROGRAM_INSTANCE")
        tangent = b.input(source, "Tangent", "vector")
        file = "programs/tangents.glsl"
        turned = b.call("float", "turns_to_tangent", "s", unit, tangent, file=file, low=-0.5, high=0.5)
        rotation = total(b, rotation, turned)
    return {"anisotropy": anisotropy, "anisotropic_rotation": rotation}


def note_distribution(b: Builder, source: Source, roughness: Expression) -> None:
    """Say where facets are spread otherwise than drawn."""
    node: Any = source.node
    if roughness.high > SMOOTH and node.distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY"):
        b.note("Roughness {of} is drawn by the distribution GGX, not by its own.")
    elif roughness.high > DARKENS and node.distribution == "GGX" and node.type != "BSDF_REFRACTION":
        b.note("Roughness {of} is drawn by the distribution Multiscatter GGX, which is brighter.")
