# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0): colors of hair as in Cycles
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of hair: as the plain surface that is nearest to them."""

from __future__ import annotations

from typing import Any

from ...materials.node_links import Source
from ..builder import Builder
from ..expression import Expression
from .arithmetic import constant, placed
from .chance import Chance
from .closure import ALL, BLACK, NONE, PLAIN_NORMAL, Closure, matt
from .inputs import color, number

CAUSE = "Hair shaders {of} are drawn as the nearest plain surface."
LEVEL = constant(0.5)
_FILE = "nodes/hair_color.glsl"


def hair(b: Builder, source: Source, _chance: Chance) -> Closure:
    b.note(CAUSE)
    node: Any = source.node
    through = ALL if node.component == "TRANSMISSION" else NONE
    return matt(color(b, source, "Color"), translucency=through, normal=PLAIN_NORMAL)


def principled_hair(b: Builder, source: Source, _chance: Chance) -> Closure:
    b.note(CAUSE)
    return Closure(
        {
            "base_color": _color(b, source),
            "specular_level": LEVEL,
            "ior": number(b, source, "IOR", 1.0),
            "roughness": number(b, source, "Roughness", 0.0, 1.0),
            "alpha": ALL,
            "emission": BLACK,
            "normal": PLAIN_NORMAL,
            **dict.fromkeys(("metallic", "transmission", "coat_weight", "sheen_weight", "film_thickness"), NONE),
            **dict.fromkeys(("subsurface", "translucency", "diffuse_roughness", "kind"), NONE),
        }
    )


def _color(b: Builder, source: Source) -> Expression:
    """What a bundle of such hair reflects."""
    node: Any = source.node
    if node.parametrization == "COLOR":
        return color(b, source, "Color", 0.0, 1.0)
    name = "Radial Roughness" if node.model == "CHIANG" else "Roughness"
    rough = placed(b, number(b, source, name, 0.0, 1.0))
    if node.parametrization == "ABSORPTION":
        absorption = placed(b, color(b, source, "Absorption Coefficient"))
        return b.call("color", "hair_color", absorption, rough, file=_FILE, low=0.0, high=1.0)
    melanin, redness = (placed(b, number(b, source, part, 0.0, 1.0)) for part in ("Melanin", "Melanin Redness"))
    tint = placed(b, color(b, source, "Tint", 0.0, 1.0))
    return b.call("color", "melanin_color", melanin, redness, tint, rough, file=_FILE, low=0.0, high=1.0)


HAIRS = {"BSDF_HAIR": hair, "BSDF_HAIR_PRINCIPLED": principled_hair}
