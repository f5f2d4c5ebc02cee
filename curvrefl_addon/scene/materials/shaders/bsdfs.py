# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDF nodes as surfaces, with the limits that Cycles puts on their inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ...arrays import Glass, MaterialArrays
from ..node_color import NodeColor, gray
from ..node_links import Source
from .conductors import fitted_conductor
from .coverage import covered, read_coverage
from .inputs import Inputs
from .surface import BLACK, WHITE, Surface, clear, matt, within

LEAST_IOR = 1e-5
LARGEST_ANISOTROPY = 0.99
"""Of a Glossy BSDF"""
SMOOTH = 0.05
"""Roughness up to which the distributions of facets look alike"""
DARKENS = 0.3
"""Roughness from which on GGX loses more than 1 % of the light between its facets, where Multiscatter GGX loses none"""
THINNEST_FILM = 0.1
"""Nanometers; Cycles leaves out thinner ones"""
_IGNORED = ("Subsurface Weight", "Sheen Weight", "Diffuse Roughness")
"""Inputs of the Principled BSDF that are not drawn unless they are 0"""


def principled(source: Source, inputs: Inputs) -> Surface:
    coverage = read_coverage(source.input("Alpha"), inputs)
    if coverage.is_nothing:
        return clear()
    for name in _IGNORED:
        if not inputs.is_at(source, name, 0.0):
            inputs.notes.always.append(f"{name} {{of}} is not shown.")
    rest = MaterialArrays(
        "",
        ior=max(inputs.number(source, "IOR"), LEAST_IOR),
        specular_level=max(inputs.number(source, "Specular IOR Level"), 0.0),
        specular_tint=_not_negative(inputs.constant(source, "Specular Tint")),
        emission=inputs.emission(source, "Emission Color", "Emission Strength"),
        thin_wall=inputs.number(source, "Thin Wall") != 0.0,
        **_coat(source, inputs),
        **_film(source, inputs),
    )
    if rest.specular_tint != (1.0, 1.0, 1.0):
        inputs.notes.on_scenery.append("Specular Tint {of} is not shown.")
    if rest.coat_weight > 0.0:
        inputs.notes.on_scenery.append("Coat Weight {of} is not shown.")
    surface = Surface(inputs.color(source, "Base Color"), rest, relief=inputs.relief(source))
    for name in ("Roughness", "Metallic"):
        surface = surface.with_scalar(name.lower(), inputs.scalar(source, name))
    surface = surface.with_scalar("transmission", inputs.scalar(source, "Transmission Weight"))
    surface = _with_tangent(surface, source, inputs, "Anisotropic", "Anisotropic Rotation", (0.0, 1.0))
    return covered(_distributed(surface, source, inputs), coverage)


def diffuse(source: Source, inputs: Inputs) -> Surface:
    if inputs.number(source, "Roughness") > 0.0:
        inputs.notes.always.append("Diffuse roughness {of} is left out.")
    return Surface(inputs.color(source, "Color"), matt(), relief=inputs.relief(source))


def glossy(source: Source, inputs: Inputs) -> Surface:
    surface = _rough(source, inputs, inputs.color(source, "Color"), MaterialArrays("", metallic=1.0, glossy_only=True))
    limits = (-LARGEST_ANISOTROPY, LARGEST_ANISOTROPY)
    return _with_tangent(surface, source, inputs, "Anisotropy", "Rotation", limits)


def metallic(source: Source, inputs: Inputs) -> Surface:
    node: Any = source.node
    color, tint = WHITE, (1.0, 1.0, 1.0)
    if node.fresnel_type == "PHYSICAL_CONDUCTOR":
        fitted = fitted_conductor(inputs.constant(source, "IOR"), inputs.constant(source, "Extinction"))
        color, tint = NodeColor(fitted.color), fitted.edge_tint
        if not fitted.is_close:
            inputs.notes.on_paths.append("The edges of a physical conductor {of} are drawn too bright or too dark.")
    else:
        color, tint = inputs.color(source, "Base Color"), _unit(inputs.constant(source, "Edge Tint"))
    if tint != (1.0, 1.0, 1.0):
        inputs.notes.on_scenery.append("Edge Tint {of} is not shown.")
    rest = MaterialArrays("", metallic=1.0, specular_tint=tint, **_film(source, inputs))
    surface = _rough(source, inputs, color, rest)
    return _with_tangent(surface, source, inputs, "Anisotropy", "Rotation", (0.0, 1.0))


def glass(source: Source, inputs: Inputs) -> Surface:
    rest = MaterialArrays("", ior=_ior(source, inputs), transmission=1.0, glass=Glass.GLASS, **_film(source, inputs))
    return _rough(source, inputs, inputs.color(source, "Color"), rest)


def refraction(source: Source, inputs: Inputs) -> Surface:
    rest = MaterialArrays("", ior=_ior(source, inputs), transmission=1.0, glass=Glass.REFRACTION)
    surface = _rough(source, inputs, inputs.color(source, "Color"), rest)
    if "roughness" not in surface.textures and (roughness := inputs.number(source, "Roughness")) < 0.0:
        # (Cycles squares it, and takes it for a number from 0 to 1 after that.)
        surface = surface.with_scalar("roughness", gray(min(-roughness, 1.0)))
    return surface


def emission(source: Source, inputs: Inputs) -> Surface:
    return Surface(BLACK, replace(matt(), emission=inputs.emission(source, "Color", "Strength")))


def transparent(source: Source, inputs: Inputs) -> Surface:
    color = inputs.fine.color(source.input("Color"))
    if color.is_constant:
        tint = _not_negative(color.factor)
        return clear(tint) if any(tint) else Surface(BLACK, matt())
    return clear(_not_negative(inputs.constant(source, "Color")))


def holdout(_source: Source, inputs: Inputs) -> Surface:
    inputs.notes.always.append("Holdout shaders {of} are drawn black.")
    return Surface(BLACK, matt())


BSDFS: Mapping[str, Callable[[Source, Inputs], Surface]] = {
    "BSDF_PRINCIPLED": principled,
    "BSDF_DIFFUSE": diffuse,
    "BSDF_GLOSSY": glossy,
    "BSDF_METALLIC": metallic,
    "BSDF_GLASS": glass,
    "BSDF_REFRACTION": refraction,
    "BSDF_TRANSPARENT": transparent,
    "EMISSION": emission,
    "HOLDOUT": holdout,
}
"""By type of node"""


def _rough(source: Source, inputs: Inputs, color: NodeColor, rest: MaterialArrays) -> Surface:
    """Of a BSDF with roughness and a normal."""
    surface = Surface(color, rest, relief=inputs.relief(source))
    surface = surface.with_scalar("roughness", inputs.scalar(source, "Roughness"))
    return _distributed(surface, source, inputs)


def _distributed(surface: Surface, source: Source, inputs: Inputs) -> Surface:
    """The surface as it is, with a note where its facets are spread otherwise than drawn."""
    node: Any = source.node
    is_rough = surface.rest.roughness > SMOOTH or "roughness" in surface.textures
    if is_rough and node.distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY"):
        inputs.notes.on_paths.append("Roughness {of} is drawn by the distribution GGX, not by its own.")
    elif surface.rest.roughness > DARKENS and node.distribution == "GGX" and node.type != "BSDF_REFRACTION":
        inputs.notes.on_paths.append("Roughness {of} is drawn by the distribution Multiscatter GGX, which is brighter.")
    return surface


def _coat(source: Source, inputs: Inputs) -> dict[str, Any]:
    weight = max(inputs.number(source, "Coat Weight"), 0.0)
    if weight == 0.0:
        return {}
    if weight > 1.0:
        inputs.notes.on_paths.append("A coat weight {of} above 1 is drawn as 1.")
    if source.input("Coat Normal").node is not None:
        inputs.notes.on_paths.append("Normals {of} that are its coat's alone are left out.")
    return {
        "coat_weight": min(weight, 1.0),
        "coat_roughness": inputs.within(source, "Coat Roughness", 0.0, 1.0),
        "coat_ior": max(inputs.number(source, "Coat IOR"), 1.0),
        "coat_tint": _not_negative(inputs.constant(source, "Coat Tint")),
    }


def _film(source: Source, inputs: Inputs) -> dict[str, Any]:
    thickness = inputs.number(source, "Thin Film Thickness")
    if thickness <= THINNEST_FILM:
        return {}
    inputs.notes.on_scenery.append("Thin Film Thickness {of} is not shown.")
    return {"film_thickness": thickness, "film_ior": max(inputs.number(source, "Thin Film IOR"), LEAST_IOR)}


def _with_tangent(
    surface: Surface, source: Source, inputs: Inputs, name: str, rotation_name: str, limits: tuple[float, float]
) -> Surface:
    anisotropy = inputs.within(source, name, *limits)
    if anisotropy == 0.0:
        return surface
    inputs.notes.on_scenery.append("Anisotropy {of} is not shown.")
    rest = replace(surface.rest, anisotropy=anisotropy, anisotropic_rotation=inputs.number(source, rotation_name))
    node = source.input("Tangent").node
    uv_map = None
    if node is not None and node.type == "TANGENT" and node.direction_type == "UV_MAP":
        uv_map = str(node.uv_map)
    elif node is not None and not (node.type == "TANGENT" and node.axis == "Z"):
        inputs.notes.on_paths.append("Tangents {of} are drawn about the Z axis.")
    return replace(surface, rest=replace(rest, tangent_by_uv=uv_map is not None), tangents=uv_map)


def _ior(source: Source, inputs: Inputs) -> float:
    return max(inputs.number(source, "IOR"), LEAST_IOR)


def _not_negative(color: tuple[float, float, float]) -> tuple[float, float, float]:
    r, g, b = (max(part, 0.0) for part in color)
    return r, g, b


def _unit(color: tuple[float, float, float]) -> tuple[float, float, float]:
    r, g, b = (within(part, 0.0, 1.0) for part in color)
    return r, g, b
