# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF."""

from __future__ import annotations

from ...materials.node_links import Source
from ..builder import Builder
from ..expression import Expression
from .arithmetic import clamped, constant, is_at, product, rest_of, settled
from .chance import Chance
from .closure import NONE, THIN_WALL, WHITE, Closure, clear
from .inputs import LEAST_IOR, brushed, color, film, light, normal, note_distribution, number
from .same_source import is_same_source


def principled(b: Builder, source: Source, _chance: Chance) -> Closure:
    alpha = number(b, source, "Alpha", 0.0, 1.0)
    if is_at(alpha, 0.0):
        return clear()
    channels = {
        "alpha": alpha,
        "base_color": color(b, source, "Base Color"),
        "emission": light(b, source, "Emission Color", "Emission Strength"),
        "metallic": number(b, source, "Metallic", 0.0, 1.0),
        "roughness": number(b, source, "Roughness", 0.0, 1.0),
        "specular_tint": color(b, source, "Specular Tint"),
        "normal": normal(b, source),
        "kind": _kind(b, source),
        "film_thickness": NONE,
        **film(b, source),
        **_coat(b, source),
        **_sheen(b, source),
    }
    if not is_at(alpha, 1.0):
        channels["transparent_tint"] = WHITE
    channels |= brushed(b, source, channels["normal"], "Anisotropic", "Anisotropic Rotation")
    channels |= _below_metal(b, source, channels)
    note_distribution(b, source, channels["roughness"])
    return Closure(channels)


def _kind(b: Builder, source: Source) -> Expression:
    wall = b.input(source, "Thin Wall", "float")
    if wall.constant is not None:
        return constant(THIN_WALL if wall.constant[0] != 0.0 else 0.0)
    return b.made("float", f"{wall.text} != 0.0 ? {THIN_WALL!r} : 0.0", 0.0, THIN_WALL)


def _coat(b: Builder, source: Source) -> dict[str, Expression]:
    weight = number(b, source, "Coat Weight", 0.0)
    if is_at(weight, 0.0):
        return {"coat_weight": NONE}
    if 1.0 < weight.high < float("inf"):
        b.note("A coat weight {of} above 1 is drawn as 1.")
    if b.is_linked(source, "Coat Normal") and not _has_coats_normal(b, source):
        b.note("Normals {of} that are its coat's alone are left out.")
    return {
        "coat_weight": clamped(b, weight, 0.0, 1.0),
        "coat_roughness": number(b, source, "Coat Roughness", 0.0, 1.0),
        "coat_ior": number(b, source, "Coat IOR", 1.0),
        "coat_tint": color(b, source, "Coat Tint"),
    }


def _has_coats_normal(b: Builder, source: Source) -> bool:
    """Whether what is below the coat has the coat's normal."""
    if is_same_source(source.input("Normal"), source.input("Coat Normal")):
        return True
    return normal(b, source) == normal(b, source, "Coat Normal")


def _sheen(b: Builder, source: Source) -> dict[str, Expression]:
    weight = number(b, source, "Sheen Weight", 0.0)
    if is_at(weight, 0.0):
        return {"sheen_weight": NONE}
    return {
        "sheen_weight": weight,
        "sheen_roughness": number(b, source, "Sheen Roughness", 0.0, 1.0),
        "sheen_tint": color(b, source, "Sheen Tint"),
    }


def _below_metal(b: Builder, source: Source, channels: dict[str, Expression]) -> dict[str, Expression]:
    """Channels of what is no metal; they do not matter where all is."""
    if is_at(channels["metallic"], 1.0):
        return {"transmission": NONE}
    transmission = number(b, source, "Transmission Weight", 0.0, 1.0)
    found = {"transmission": transmission, "ior": number(b, source, "IOR", LEAST_IOR)}
    if is_at(transmission, 1.0):
        return found
    found["specular_level"] = number(b, source, "Specular IOR Level", 0.0)
    found["diffuse_roughness"] = number(b, source, "Diffuse Roughness", 0.0, 1.0)
    found |= _below_surface(b, source, channels["kind"])
    return found


def _below_surface(b: Builder, source: Source, kind: Expression) -> dict[str, Expression]:
    weight = number(b, source, "Subsurface Weight", 0.0, 1.0)
    if is_at(weight, 0.0):
        return {"subsurface": NONE, "translucency": NONE}
    if is_at(kind, THIN_WALL):
        # Of a thin sheet all comes out at once, on either side.
        forward = settled(clamped(b, b.input(source, "Subsurface Anisotropy", "float"), -1.0, 1.0))
        share = product(b, constant(0.5), rest_of(b, product(b, constant(-1.0), forward)))
        return {"subsurface": NONE, "translucency": product(b, weight, share)}
    b.note("Light that goes below the surface {of} comes out where it went in.")
    return {"subsurface": weight, "translucency": NONE}
