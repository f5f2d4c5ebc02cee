# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes of colors: Mix (of numbers and vectors too), adjustments, Combine and Separate Color, Blackbody."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ....materials.color_spaces import rec709_to_scene
from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression, Kind
from . import color_formulas
from .folding import folded
from .numbers import clamped
from .vectors import combined, part_of

_MIX_FILE, _FILE, _MODELS = "values/mix.glsl", "values/colors.glsl", "values/color_models.glsl"
_INPUTS: Mapping[str, tuple[Kind, str, str]] = {
    "RGBA": ("color", "A_Color", "B_Color"),
    "FLOAT": ("float", "A_Float", "B_Float"),
    "VECTOR": ("vector", "A_Vector", "B_Vector"),
}
"""Of the Mix node, by its type of data"""
_WITHIN = ("MIX", "DARKEN", "LIGHTEN")
"""Blends that lie between their colors"""
_UNIT = (*_WITHIN, "MULTIPLY", "SCREEN", "OVERLAY", "DODGE", "BURN", "SOFT_LIGHT", "DIFFERENCE", "EXCLUSION")
"""Blends that stay within 0 and 1"""


def _mix(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    if node.data_type not in _INPUTS:
        return None
    kind, first, second = _INPUTS[node.data_type]
    if source.socket.type != {"color": "RGBA", "float": "VALUE", "vector": "VECTOR"}[kind]:
        return None
    is_uneven = kind == "vector" and node.factor_mode == "NON_UNIFORM"
    factor = b.input(source, "Factor_Vector", "vector") if is_uneven else b.input(source, "Factor_Float", "float")
    if node.clamp_factor:
        factor = clamped(b, factor)
    if kind == "color":
        result = _blended(b, source, node.blend_type, factor, (first, second))
        return clamped(b, result) if node.clamp_result else result
    return _between(b, kind, factor, b.input(source, first, kind), b.input(source, second, kind))


def _mix_rgb(b: Builder, source: Source) -> Expression:
    """The node of older files."""
    node: Any = source.node
    factor = clamped(b, b.input(source, "Fac", "float"))
    result = _blended(b, source, node.blend_type, factor, ("Color1", "Color2"))
    return clamped(b, result) if node.use_clamp else result


def _blended(b: Builder, source: Source, blend: str, factor: Expression, names: tuple[str, str]) -> Expression:
    if factor.constant == (1.0,) and blend == "MIX":
        return b.input(source, names[1], "color")
    a = b.input(source, names[0], "color")
    if factor.constant == (0.0,) and (blend == "MIX" or not a.is_constant):
        return a
    z = b.input(source, names[1], "color")
    if blend == "MIX":
        return _between(b, "color", factor, a, z)
    known = folded(b, "color", color_formulas.BLENDS[blend], a, z, factor)
    if known is not None:
        return known
    low, high = -np.inf, np.inf
    if factor.low >= 0.0 and factor.high <= 1.0:
        if blend in _WITHIN:
            low, high = min(a.low, z.low), max(a.high, z.high)
        elif blend in _UNIT and min(a.low, z.low) >= 0.0 and max(a.high, z.high) <= 1.0:
            low, high = 0.0, 1.0
    return b.call("color", f"mix_{blend.lower()}", a, z, factor, file=_MIX_FILE, low=low, high=high)


def _between(b: Builder, kind: Kind, factor: Expression, a: Expression, z: Expression) -> Expression:
    known = folded(b, kind, lambda p, q, f: (1.0 - f) * p + f * q, a, z, factor)
    if known is not None:
        return known
    low, high = -np.inf, np.inf
    if factor.low >= 0.0 and factor.high <= 1.0:
        low, high = min(a.low, z.low), max(a.high, z.high)
    return b.made(kind, f"(1.0 - {factor.text}) * {a.text} + {factor.text} * {z.text}", low, high)


def _adjusted(function: str, formula: Any, names: tuple[str, ...], low: float = -np.inf) -> Handler:
    """A handler of a node that changes the input Color by numbers."""

    def handler(b: Builder, source: Source) -> Expression:
        inputs = [b.input(source, "Color", "color"), *(b.input(source, name, "float") for name in names)]
        known = folded(b, "color", formula, *inputs)
        return known or b.call("color", function, *inputs, file=_FILE, low=low)

    return handler


def _separate(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    color = b.input(source, "Color", "color")
    number = ("Red", "Green", "Blue").index(source.socket.identifier)
    if node.mode == "RGB":
        return part_of(color, number)
    model = node.mode.lower()
    known = folded(b, "vector", color_formulas.FROM_RGB[node.mode], color)
    if known is not None:
        return part_of(known, number)
    # (The functions are asked once by each output that is used: compilers find what is the same.)
    low, high = (0.0, 1.0) if color.low >= 0.0 and color.high <= 1.0 else (-np.inf, np.inf)
    return part_of(b.call("vector", f"color_to_{model}", color, file=_MODELS, low=low, high=high), number)


def _combine(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    parts = [b.input(source, name, "float") for name in ("Red", "Green", "Blue")]
    whole = combined(b, "color", parts)
    if node.mode == "RGB":
        return whole
    known = folded(b, "color", color_formulas.TO_RGB[node.mode], whole)
    return known or b.call("color", f"color_from_{node.mode.lower()}", whole, file=_MODELS)


def _gray(b: Builder, source: Source) -> Expression:
    return b.as_kind(b.input(source, "Color", "color"), "float")


def _blackbody(b: Builder, source: Source) -> Expression:
    temperature = b.input(source, "Temperature", "float")
    to_scene = rec709_to_scene(np.eye(3, dtype=np.float32)).T.astype(np.float64)
    known = folded(b, "color", lambda t: np.maximum(to_scene @ color_formulas.blackbody(float(t)), 0.0), temperature)
    if known is not None:
        return known
    first = b.table(to_scene)
    rows = (f"P({first + row}).xyz" for row in range(3))
    return b.call("color", "blackbody_color", temperature, *rows, file="values/blackbody.glsl", low=0.0)


NODES: Mapping[str, Handler] = {
    "MIX": _mix,
    "MIX_RGB": _mix_rgb,
    "HUE_SAT": _adjusted(
        "color_hue_saturation", color_formulas.hue_saturation, ("Hue", "Saturation", "Value", "Fac"), 0.0
    ),
    "BRIGHTCONTRAST": _adjusted("color_bright_contrast", color_formulas.bright_contrast, ("Bright", "Contrast"), 0.0),
    "GAMMA": _adjusted("color_gamma", color_formulas.gamma, ("Gamma",)),
    "INVERT": _adjusted("color_inverted", color_formulas.inverted, ("Fac",)),
    "RGBTOBW": _gray,
    "SEPARATE_COLOR": _separate,
    "COMBINE_COLOR": _combine,
    "BLACKBODY": _blackbody,
}
