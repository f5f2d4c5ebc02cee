# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDF nodes that have one lobe, and what shines: one function and one row each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...materials.node_links import Source
from ..builder import Builder
from ..expression import Expression
from .arithmetic import clamped, constant, is_at, placed, settled
from .chance import Chance
from .closure import ALL, BLACK, GLASS, GLOSSY_ONLY, NONE, REFRACTION, Closure, clear, matt, shining
from .conductors import fitted_conductor
from .hair import HAIRS
from .inputs import LEAST_IOR, brushed, color, film, light, normal, note_distribution, number
from .principled import principled

LARGEST_ANISOTROPY = 0.99
"""Of a Glossy BSDF"""

type Shader = Callable[[Builder, Source, Chance], Closure]


def diffuse(b: Builder, source: Source, _chance: Chance) -> Closure:
    roughness = number(b, source, "Roughness", 0.0, 1.0)
    return matt(color(b, source, "Color"), diffuse_roughness=roughness, translucency=NONE, **_bent(b, source))


def translucent(b: Builder, source: Source, _chance: Chance) -> Closure:
    # (Seen from either side it is lit from the other.)
    return matt(color(b, source, "Color"), diffuse_roughness=NONE, translucency=ALL, **_bent(b, source))


def subsurface(b: Builder, source: Source, _chance: Chance) -> Closure:
    b.note("Light that goes below the surface {of} comes out where it went in.")
    return matt(
        color(b, source, "Color"), diffuse_roughness=NONE, translucency=NONE, **_bent(b, source) | {"subsurface": ALL}
    )


def sheen(b: Builder, source: Source, _chance: Chance) -> Closure:
    node: Any = source.node
    if node.distribution != "MICROFIBER":
        b.note("Sheen {of} is drawn by the distribution Microfiber, not by its own.")
    return matt(
        BLACK,
        sheen_weight=ALL,
        sheen_tint=color(b, source, "Color"),
        sheen_roughness=number(b, source, "Roughness", 0.0, 1.0),
        normal=normal(b, source),
    )


def glossy(b: Builder, source: Source, _chance: Chance) -> Closure:
    channels = _rough(b, source) | {"metallic": ALL, "transmission": NONE, "kind": constant(GLOSSY_ONLY)}
    limits = (-LARGEST_ANISOTROPY, LARGEST_ANISOTROPY)
    channels |= brushed(b, source, channels["normal"], "Anisotropy", "Rotation", limits)
    return Closure(channels | {"base_color": color(b, source, "Color")}, is_scalable=True)


def metallic(b: Builder, source: Source, _chance: Chance) -> Closure:
    node: Any = source.node
    channels = _rough(b, source) | {"metallic": ALL, "transmission": NONE, "kind": NONE}
    channels |= {"film_thickness": NONE, **film(b, source)}
    channels |= brushed(b, source, channels["normal"], "Anisotropy", "Rotation")
    if node.fresnel_type == "PHYSICAL_CONDUCTOR":
        return Closure(channels | _conductor(b, source))
    colors = {"base_color": color(b, source, "Base Color", 0.0, 1.0)}
    return Closure(channels | colors | {"specular_tint": color(b, source, "Edge Tint", 0.0, 1.0)})


def glass(b: Builder, source: Source, _chance: Chance) -> Closure:
    return _interface(b, source, GLASS, {"film_thickness": NONE, **film(b, source)})


def refraction(b: Builder, source: Source, _chance: Chance) -> Closure:
    # (Cycles squares the roughness, and takes it for a number from 0 to 1 after that.)
    rough = b.input(source, "Roughness", "float")
    if rough.constant is not None:
        turned = constant(min(abs(rough.constant[0]), 1.0))
    else:
        turned = b.made("float", f"min(abs({rough.text}), 1.0)", 0.0, 1.0)
    return _interface(b, source, REFRACTION, {"film_thickness": NONE, "roughness": turned})


def emission(b: Builder, source: Source, _chance: Chance) -> Closure:
    # (Background nodes on surfaces do the same.)
    return shining(light(b, source, "Color", "Strength"))


def transparent(b: Builder, source: Source, _chance: Chance) -> Closure:
    tint = color(b, source, "Color")
    return matt(BLACK) if is_at(tint, 0.0) else clear(tint)


def holdout(b: Builder, _source: Source, _chance: Chance) -> Closure:
    b.note("Holdout shaders {of} are drawn black.")
    return matt(BLACK)


def toon(b: Builder, source: Source, _chance: Chance) -> Closure:
    node: Any = source.node
    b.note(f"{node.bl_label} shaders {{of}} are drawn as the nearest plain surface.")
    if node.component == "DIFFUSE":
        return matt(color(b, source, "Color"), **_bent(b, source))
    channels = {"metallic": ALL, "transmission": NONE, "kind": constant(GLOSSY_ONLY), "alpha": ALL, "emission": BLACK}
    rough = number(b, source, "Size", 0.0, 1.0)
    channels |= {"roughness": rough, "normal": normal(b, source), "coat_weight": NONE, "sheen_weight": NONE}
    return Closure(channels | {"base_color": color(b, source, "Color")}, is_scalable=True)


def portal(b: Builder, source: Source, chance: Chance) -> Closure:
    b.note("Ray portals {of} are drawn as transparency.")
    return transparent(b, source, chance)


def nothing(_b: Builder, _source: Source, _chance: Chance) -> Closure:
    """A shader of volumes where one of surfaces should be: no light at all."""
    return matt(BLACK)


BSDFS: Mapping[str, Shader] = {
    "BSDF_PRINCIPLED": principled,
    "BSDF_DIFFUSE": diffuse,
    "BSDF_GLOSSY": glossy,
    "BSDF_METALLIC": metallic,
    "BSDF_GLASS": glass,
    "BSDF_REFRACTION": refraction,
    "BSDF_TRANSPARENT": transparent,
    "BSDF_TRANSLUCENT": translucent,
    "BSDF_SHEEN": sheen,
    "BSDF_TOON": toon,
    "BSDF_RAY_PORTAL": portal,
    "SUBSURFACE_SCATTERING": subsurface,
    "EMISSION": emission,
    "BACKGROUND": emission,
    "HOLDOUT": holdout,
    **dict.fromkeys(("VOLUME_ABSORPTION", "VOLUME_SCATTER", "VOLUME_COEFFICIENTS", "PRINCIPLED_VOLUME"), nothing),
    **HAIRS,
}
"""By type of node"""


def _bent(b: Builder, source: Source) -> dict[str, Expression]:
    return {"normal": normal(b, source), "subsurface": NONE}


def _rough(b: Builder, source: Source) -> dict[str, Expression]:
    """Channels of a BSDF with roughness and a normal."""
    roughness = number(b, source, "Roughness", 0.0, 1.0)
    note_distribution(b, source, roughness)
    plain = {"alpha": ALL, "emission": BLACK, "coat_weight": NONE, "sheen_weight": NONE}
    return plain | {"roughness": roughness, "normal": normal(b, source)}


def _interface(b: Builder, source: Source, kind: float, rest: dict[str, Expression]) -> Closure:
    channels = _rough(b, source) | {"metallic": NONE, "transmission": ALL, "kind": constant(kind)}
    channels |= {"ior": number(b, source, "IOR", LEAST_IOR), "base_color": color(b, source, "Color")}
    return Closure(channels | rest, is_scalable=True)


def _conductor(b: Builder, source: Source) -> dict[str, Expression]:
    """Colors of the metal that is nearest to a physical conductor."""
    n, k = (clamped(b, b.input(source, name, "color"), 0.0) for name in ("IOR", "Extinction"))
    cause = "The edges of a physical conductor {of} are drawn too bright or too dark."
    if n.constant is not None and k.constant is not None:
        fitted = fitted_conductor(_triple(n), _triple(k))
        if not fitted.is_close:
            b.note(cause)
        return {"base_color": constant(*fitted.color), "specular_tint": constant(*fitted.edge_tint)}
    b.note(cause)
    file = "nodes/conductor.glsl"
    n_text, k_text = (placed(b, settled(value)) for value in (n, k))
    return {
        "base_color": b.call("color", "conductor_color", n_text, k_text, file=file, low=0.0, high=1.0),
        "specular_tint": b.call("color", "conductor_edge_tint", n_text, k_text, file=file, low=0.0, high=1.0),
    }


def _triple(value: Expression) -> tuple[float, float, float]:
    r, g, b = np.broadcast_to(value.constant or (0.0,), 3).tolist()
    return float(r), float(g), float(b)
