# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""What constants give in the nodes of colors, (3,) each: the GLSL of `gpu_shaders/values` in numpy."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from .folding import Values, divided, power


def rgb_to_hsv(color: Values) -> Values:
    high, low = color.max(), color.min()
    saturation = divided(high - low, high)
    hue = _hue(color) / 6.0 if saturation != 0.0 else 0.0
    return np.array([hue + 1.0 if hue < 0.0 else hue, saturation, high])


def hsv_to_rgb(hsv: Values) -> Values:
    """(Hues beyond a turn are those of the last sextant, as in Cycles.)"""
    h, s, v = hsv
    place = 0.0 if h == 1.0 else h * 6.0
    sextant = np.floor(place)
    part = place - sextant
    p, q, t = v * (1.0 - s), v * (1.0 - s * part), v * (1.0 - s * (1.0 - part))
    colors = ((v, t, p), (q, v, p), (p, v, t), (p, q, v), (t, p, v), (v, p, q))
    return np.array(colors[int(sextant)] if 0 <= sextant < 5 else colors[5])


def rgb_to_hsl(color: Values) -> Values:
    high, low = color.max(), color.min()
    lightness = min(0.5 * (high + low), 1.0)
    span = high - low
    saturation = divided(span, 2.0 - high - low) if lightness > 0.5 else divided(span, high + low)
    hue = _hue(color) / 6.0 if span != 0.0 else 0.0
    return np.array([hue + 1.0 if hue < 0.0 else hue, saturation, lightness])


def hsl_to_rgb(hsl: Values) -> Values:
    h, s, lightness = hsl
    place = h * 6.0
    pure = np.array([np.abs(place - 3.0) - 1.0, 2.0 - np.abs(place - 2.0), 2.0 - np.abs(place - 4.0)])
    return (np.clip(pure, 0.0, 1.0) - 0.5) * (1.0 - np.abs(2.0 * lightness - 1.0)) * s + lightness


def _hue(color: Values) -> float:
    """In sextants, from red."""
    r, g, b = color
    span = color.max() - color.min()
    turn = (g - b) if r == color.max() else (2.0 * span + b - r) if g == color.max() else (4.0 * span + r - g)
    return float(turn / span)


FROM_RGB: Mapping[str, Callable[[Values], Values]] = {"HSV": rgb_to_hsv, "HSL": rgb_to_hsl}
TO_RGB: Mapping[str, Callable[[Values], Values]] = {"HSV": hsv_to_rgb, "HSL": hsl_to_rgb}


def hue_saturation(color: Values, hue: Values, saturation: Values, value: Values, factor: Values) -> Values:
    """The node Hue/Saturation/Value: `hue` 0.5 leaves it, the others are factors."""
    h, s, v = rgb_to_hsv(color)
    turned = np.array([np.mod(h + hue + 0.5, 1.0), np.clip(s * saturation, 0.0, 1.0), v * value])
    return np.maximum(factor * hsv_to_rgb(turned) + (1.0 - factor) * color, 0.0)


def bright_contrast(color: Values, bright: Values, contrast: Values) -> Values:
    return np.maximum((1.0 + contrast) * color + bright - 0.5 * contrast, 0.0)


def gamma(color: Values, exponent: Values) -> Values:
    return np.where(color > 0.0, power(np.maximum(color, 0.0), exponent), 1.0 if exponent == 0.0 else color)


def inverted(color: Values, factor: Values) -> Values:
    return factor * (1.0 - color) + (1.0 - factor) * color


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
        taken, second = rgb_to_hsv(a), rgb_to_hsv(b)
        if 0 in channels:
            # Hues are not mixed: the colors are.
            taken[list(channels)] = second[list(channels)]
            return _mixed(a, hsv_to_rgb(taken), f) if second[1] != 0.0 else a
        if channels == (1,) and taken[1] == 0.0:
            return a
        taken[channels[0]] = _mixed(taken[channels[0]], second[channels[0]], f)
        return hsv_to_rgb(taken)

    return blend


BLENDS: Mapping[str, Callable[[Values, Values, Values], Values]] = {
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


_RED = (
    (1.61919106e03, -2.05010916e-03, 5.02995757e00),
    (2.48845471e03, -1.11330907e-03, 3.22621544e00),
    (3.34143193e03, -4.86551192e-04, 1.76486769e00),
    (4.09461742e03, -1.27446582e-04, 7.25731635e-01),
    (4.67028036e03, 2.91258199e-05, 1.26703442e-01),
    (4.59509185e03, 2.87495649e-05, 1.50345020e-01),
    (3.78717450e03, 9.35907826e-06, 3.99075871e-01),
)
_GREEN = (
    (-4.88999748e02, 6.04330754e-04, -7.55807526e-02),
    (-7.55994277e02, 3.16730098e-04, 4.78306139e-01),
    (-1.02363977e03, 1.20223470e-04, 9.36662319e-01),
    (-1.26571316e03, 4.87340896e-06, 1.27054498e00),
    (-1.42529332e03, -4.01150431e-05, 1.43972784e00),
    (-1.17554822e03, -2.16378048e-05, 1.30408023e00),
    (-5.00799571e02, -4.59832026e-06, 1.09098763e00),
)
_BLUE = (
    (5.96945309e-11, -4.85742887e-08, -9.70622247e-05, -4.07936148e-03),
    (2.40430366e-11, 5.55021075e-08, -1.98503712e-04, 2.89312858e-02),
    (-1.40949732e-11, 1.89878968e-07, -3.56632824e-04, 9.10767778e-02),
    (-3.61460868e-11, 2.84822009e-07, -4.93211319e-04, 1.56723440e-01),
    (-1.97075738e-11, 1.75359352e-07, -2.50542825e-04, -2.22783266e-02),
    (-1.61997957e-13, -1.64216008e-08, 3.86216271e-04, -7.38077418e-01),
    (6.72650283e-13, -2.73078809e-08, 4.24098264e-04, -7.52335691e-01),
)
_PIECES = (965.0, 1167.0, 1449.0, 1902.0, 3315.0, 6365.0)


def blackbody(kelvin: float) -> Values:
    """(3,) linear Rec.709, which may be negative."""
    if kelvin >= 12000.0:
        return np.array([0.8262954810464208, 0.9945080501520986, 1.566307710274283])
    if kelvin < 800.0:
        return np.array([5.413294490189271, -0.20319390035873933, -0.0822535242887164])
    piece = sum(kelvin >= start for start in _PIECES)
    shares = [row[0] / kelvin + row[1] * kelvin + row[2] for row in (_RED[piece], _GREEN[piece])]
    return np.array([*shares, np.polyval(_BLUE[piece], kelvin)])
