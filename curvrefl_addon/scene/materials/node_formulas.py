# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas of Cycles' color and math nodes, on arrays: colors (..., 3), numbers of any shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

type Values = NDArray[Any]


def divided(a: Values, b: Values) -> Values:
    """a / b, 0 where b is 0."""
    a, b = np.broadcast_arrays(a, b)
    return np.divide(a, b, out=np.zeros(a.shape, np.result_type(a, b)), where=b != 0.0)


def power(a: Values, b: Values) -> Values:
    """a ** b, 0 where that is no real number."""
    a, b = np.broadcast_arrays(a, b)
    real = ((a > 0.0) | (b == np.trunc(b))) & ~((a == 0.0) & (b < 0.0))
    return np.power(a, b, out=np.zeros(a.shape, np.result_type(a, b)), where=real)


def rgb_to_hsv(colors: Values) -> Values:
    high, low = colors.max(axis=-1), colors.min(axis=-1)
    saturation = divided(high - low, high)
    return np.stack([_hue(colors), saturation, high], axis=-1)


def hsv_to_rgb(hsv: Values) -> Values:
    h, s, v = (hsv[..., k] for k in range(3))
    return np.stack([v * (1.0 - s * (1.0 - part)) for part in _wheel(h)], axis=-1)


def rgb_to_hsl(colors: Values) -> Values:
    high, low = colors.max(axis=-1), colors.min(axis=-1)
    lightness = np.minimum(0.5 * (high + low), 1.0)
    span = high - low
    saturation = np.where(lightness > 0.5, divided(span, 2.0 - high - low), divided(span, high + low))
    return np.stack([_hue(colors), saturation, lightness], axis=-1)


def hsl_to_rgb(hsl: Values) -> Values:
    h, s, lightness = (hsl[..., k] for k in range(3))
    chroma = (1.0 - np.abs(2.0 * lightness - 1.0)) * s
    return np.stack([(part - 0.5) * chroma + lightness for part in _wheel(h)], axis=-1)


FROM_RGB: dict[str, Callable[[Values], Values]] = {"RGB": lambda c: c, "HSV": rgb_to_hsv, "HSL": rgb_to_hsl}
TO_RGB: dict[str, Callable[[Values], Values]] = {"RGB": lambda c: c, "HSV": hsv_to_rgb, "HSL": hsl_to_rgb}


def _hue(colors: Values) -> Values:
    high, low = colors.max(axis=-1), colors.min(axis=-1)
    span = high - low
    r, g, b = (colors[..., k] for k in range(3))
    turn = np.where(
        r == high,
        divided(g - b, span),
        np.where(g == high, 2.0 + divided(b - r, span), 4.0 + divided(r - g, span)),
    )
    return np.mod(np.where(span > 0.0, turn, 0.0) / 6.0, 1.0)


def _wheel(hue: Values) -> list[Values]:
    """Red, green and blue, 0..1, of a full color of this hue."""
    places = [np.mod(hue + offset, 1.0) * 6.0 for offset in (0.0, 2.0 / 3.0, 1.0 / 3.0)]
    return [np.clip(np.abs(place - 3.0) - 1.0, 0.0, 1.0) for place in places]


def hue_saturation_value(colors: Values, hue: Values, saturation: Values, brightness: Values) -> Values:
    """The node Hue/Saturation/Value: `hue` 0.5 leaves it, the others are factors."""
    hsv = rgb_to_hsv(colors)
    turned = np.stack(
        [
            np.mod(hsv[..., 0] + hue[..., 0] + 0.5, 1.0),
            np.clip(hsv[..., 1] * saturation[..., 0], 0.0, 1.0),
            hsv[..., 2] * brightness[..., 0],
        ],
        axis=-1,
    )
    return np.maximum(hsv_to_rgb(turned), 0.0)


def smoothstep(low: Values, high: Values, value: Values) -> Values:
    t = np.clip(divided(value - low, high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def map_range(
    kind: str, value: Values, lows: tuple[Values, Values], highs: tuple[Values, Values], steps: Values
) -> Any:
    """The node Map Range: `lows` and `highs` are (from, to); `kind` as the node's interpolation. None: not known."""
    (from_low, to_low), (from_high, to_high) = lows, highs
    place = divided(value - from_low, from_high - from_low)
    if kind == "STEPPED":
        place = divided(np.floor(place * (steps + 1.0)), steps)
    elif kind == "SMOOTHSTEP":
        place = smoothstep(from_low, from_high, value)
    elif kind == "SMOOTHERSTEP":
        t = np.clip(place, 0.0, 1.0)
        place = t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
    elif kind != "LINEAR":
        return None
    return np.where(from_high != from_low, to_low + place * (to_high - to_low), 0.0)


def _mixed(a: Values, b: Values, f: Values) -> Values:
    return a * (1.0 - f) + b * f


def _overlay(a: Values, b: Values, f: Values) -> Values:
    dark = a * (1.0 - f + 2.0 * f * b)
    bright = 1.0 - (1.0 - f + 2.0 * f * (1.0 - b)) * (1.0 - a)
    return np.where(a < 0.5, dark, bright)


def _dodge(a: Values, b: Values, f: Values) -> Values:
    left = 1.0 - f * b
    return np.where(a == 0.0, 0.0, np.where(left <= 0.0, 1.0, np.minimum(divided(a, left), 1.0)))


def _burn(a: Values, b: Values, f: Values) -> Values:
    part = 1.0 - f + f * b
    return np.where(part <= 0.0, 0.0, np.clip(1.0 - divided(1.0 - a, part), 0.0, 1.0))


def _soft_light(a: Values, b: Values, f: Values) -> Values:
    screen = 1.0 - (1.0 - b) * (1.0 - a)
    return (1.0 - f) * a + f * ((1.0 - a) * b * a + a * screen)


def _hsv_blend(channels: tuple[int, ...]) -> Callable[[Values, Values, Values], Values]:
    """Some of hue, saturation and value from the second color."""

    def blend(a: Values, b: Values, f: Values) -> Values:
        a, b, f = np.broadcast_arrays(a, b, f)
        first, second = rgb_to_hsv(a), rgb_to_hsv(b)
        taken = first.copy()
        if 0 in channels:
            # Hues are not mixed: the colors are.
            taken[..., channels] = second[..., channels]
            return np.where(second[..., 1:2] != 0.0, _mixed(a, hsv_to_rgb(taken), f), a)
        taken[..., channels] = _mixed(first, second, f)[..., channels]
        changed = hsv_to_rgb(taken)
        return np.where(first[..., 1:2] != 0.0, changed, a) if channels == (1,) else changed

    return blend


BLENDS: dict[str, Callable[[Values, Values, Values], Values]] = {
    "MIX": _mixed,
    "MULTIPLY": lambda a, b, f: a * (1.0 - f + f * b),
    "ADD": lambda a, b, f: a + f * b,
    "SUBTRACT": lambda a, b, f: a - f * b,
    "SCREEN": lambda a, b, f: 1.0 - (1.0 - f + f * (1.0 - b)) * (1.0 - a),
    "DIVIDE": lambda a, b, f: np.where(b != 0.0, (1.0 - f) * a + f * divided(a, b), a),
    "DIFFERENCE": lambda a, b, f: _mixed(a, np.abs(a - b), f),
    "EXCLUSION": lambda a, b, f: np.maximum(_mixed(a, a + b - 2.0 * a * b, f), 0.0),
    "DARKEN": lambda a, b, f: _mixed(a, np.minimum(a, b), f),
    "LIGHTEN": lambda a, b, f: _mixed(a, np.maximum(a, b), f),
    "OVERLAY": _overlay,
    "DODGE": _dodge,
    "BURN": _burn,
    "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda a, b, f: a + f * (2.0 * b - 1.0),
    "HUE": _hsv_blend((0,)),
    "SATURATION": _hsv_blend((1,)),
    "VALUE": _hsv_blend((2,)),
    "COLOR": _hsv_blend((0, 1)),
}

NUMBER_OPERATIONS: dict[str, Callable[[Values, Values, Values], Values]] = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: divided(a, b),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: power(a, b),
    "SQRT": lambda a, b, c: np.sqrt(np.maximum(a, 0.0)),
    "INVERSE_SQRT": lambda a, b, c: divided(np.ones_like(a), np.sqrt(np.maximum(a, 0.0))),
    "ABSOLUTE": lambda a, b, c: np.abs(a),
    "EXPONENT": lambda a, b, c: np.exp(a),
    "MINIMUM": lambda a, b, c: np.minimum(a, b),
    "MAXIMUM": lambda a, b, c: np.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) + 0.0 * a,
    "GREATER_THAN": lambda a, b, c: (a > b) + 0.0 * a,
    "SIGN": lambda a, b, c: np.sign(a),
    "COMPARE": lambda a, b, c: (np.abs(a - b) <= np.maximum(c, 1e-5)) + 0.0 * a,
    "ROUND": lambda a, b, c: np.floor(a + 0.5),
    "FLOOR": lambda a, b, c: np.floor(a),
    "CEIL": lambda a, b, c: np.ceil(a),
    "TRUNC": lambda a, b, c: np.trunc(a),
    "FRACT": lambda a, b, c: a - np.floor(a),
    "MODULO": lambda a, b, c: np.where(b != 0.0, np.fmod(a, np.where(b != 0.0, b, 1.0)), 0.0),
    "FLOORED_MODULO": lambda a, b, c: np.where(b != 0.0, a - np.floor(divided(a, b)) * b, 0.0),
    "SNAP": lambda a, b, c: np.floor(divided(a, b)) * b,
    "SINE": lambda a, b, c: np.sin(a),
    "COSINE": lambda a, b, c: np.cos(a),
    "TANGENT": lambda a, b, c: np.tan(a),
    "ARCTANGENT": lambda a, b, c: np.arctan(a),
    "ARCTAN2": lambda a, b, c: np.arctan2(a, b),
    "RADIANS": lambda a, b, c: np.radians(a),
    "DEGREES": lambda a, b, c: np.degrees(a),
}
"""Of the Math node's three inputs"""

VECTOR_OPERATIONS: dict[str, Callable[[Values, Values, Values], Values]] = {
    **{
        name: NUMBER_OPERATIONS[name]
        for names in (
            ("ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "MINIMUM", "MAXIMUM", "FLOOR"),
            ("CEIL", "MODULO", "SNAP", "SINE", "COSINE", "TANGENT", "POWER", "SIGN"),
        )
        for name in names
    },
    "FRACTION": NUMBER_OPERATIONS["FRACT"],
}
"""Of the Vector Math node's three vectors, part by part"""
