# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What constants give, so that a tree of constants needs no program: Blender's formulas on arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ....materials.node_links import Source
from ...builder import Builder
from ...expression import Expression, Kind

type Values = Any
"""A number or an array"""
type Formula = Callable[..., Any]


def folded(b: Builder, kind: Kind, formula: Formula | None, *inputs: Expression) -> Expression | None:
    """The value of a node whose inputs are all known; None where one is not, or where the formula gives no number.
    (A float is a number for `formula`, anything else (3,), in single precision: steps are where Blender has them.)"""
    if formula is None or not all(value.is_constant for value in inputs):
        return None
    with np.errstate(all="ignore"):
        result = np.asarray(formula(*(_array(value) for value in inputs)), np.float64)
    count = 1 if kind == "float" else 3
    numbers = np.broadcast_to(result, (count,)).tolist()
    if not np.isfinite(numbers).all():
        return None
    made = b.parameter(*numbers)
    return Expression(made.text, kind, made.constant, made.low, made.high)


def node_key(source: Source, name: str) -> tuple[Any, ...]:
    """For `Builder.shared`: what all outputs of a node share."""
    return (name, source.node.as_pointer(), tuple(group.as_pointer() for group in source.groups))


def _array(value: Expression) -> Any:
    numbers = value.constant or ()
    return np.float32(numbers[0]) if value.kind == "float" else np.array(numbers, np.float32)


def divided(a: Values, b: Values) -> Values:
    """a / b, 0 where b is 0."""
    return np.where(b != 0.0, a / np.where(b != 0.0, b, 1.0), 0.0)


def power(a: Values, b: Values) -> Values:
    """a ** b, 0 where that is no real number."""
    real = ((a > 0.0) | ((a < 0.0) & (b == np.trunc(b)))) & (b != 0.0)
    return np.where(real, np.power(np.where(real, a, 1.0), b), np.where(b == 0.0, 1.0, 0.0))


def logarithm(a: Values, base: Values) -> Values:
    """Of `a`; 0 where there is none."""
    real = (a > 0.0) & (base > 0.0)
    return divided(np.log(np.where(real, a, 1.0)), np.log(np.where(real, base, 1.0)))


def modulo(a: Values, b: Values) -> Values:
    """Truncated; 0 where b is 0."""
    return np.where(b != 0.0, np.fmod(a, np.where(b != 0.0, b, 1.0)), 0.0)


def wrapped(value: Values, high: Values, low: Values) -> Values:
    """Into the range from low to high."""
    return np.where(high != low, value - (high - low) * np.floor(divided(value - low, high - low)), low)


def smooth_minimum(a: Values, b: Values, width: Values) -> Values:
    """The smaller of two, rounded off over a width."""
    h = divided(np.maximum(width - np.abs(a - b), 0.0), width)
    return np.minimum(a, b) - h**3 * width / 6.0


OPERATIONS: Mapping[str, Formula] = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: divided(a, b),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: power(a, b),
    "LOGARITHM": lambda a, b, c: logarithm(a, b),
    "SQRT": lambda a, b, c: np.sqrt(np.maximum(a, 0.0)),
    "INVERSE_SQRT": lambda a, b, c: divided(np.float64(1.0), np.sqrt(np.maximum(a, 0.0))),
    "ABSOLUTE": lambda a, b, c: np.abs(a),
    "EXPONENT": lambda a, b, c: np.exp(a),
    "MINIMUM": lambda a, b, c: np.minimum(a, b),
    "MAXIMUM": lambda a, b, c: np.maximum(a, b),
    "LESS_THAN": lambda a, b, c: a < b,
    "GREATER_THAN": lambda a, b, c: a > b,
    "SIGN": lambda a, b, c: np.sign(a),
    "COMPARE": lambda a, b, c: np.abs(a - b) <= np.maximum(c, np.finfo(np.float32).eps),
    "SMOOTH_MIN": lambda a, b, c: smooth_minimum(a, b, c),
    "SMOOTH_MAX": lambda a, b, c: -smooth_minimum(-a, -b, c),
    "ROUND": lambda a, b, c: np.floor(a + 0.5),
    "FLOOR": lambda a, b, c: np.floor(a),
    "CEIL": lambda a, b, c: np.ceil(a),
    "TRUNC": lambda a, b, c: np.trunc(a),
    "FRACT": lambda a, b, c: a - np.floor(a),
    "MODULO": lambda a, b, c: modulo(a, b),
    "FLOORED_MODULO": lambda a, b, c: (a - np.floor(divided(a, b)) * b) * (b != 0.0),
    "WRAP": wrapped,
    "SNAP": lambda a, b, c: np.floor(divided(a, b)) * b,
    "PINGPONG": lambda a, b, c: np.abs(np.mod(divided(a - b, b * 2.0), 1.0) * b * 2.0 - b),
    "SINE": lambda a, b, c: np.sin(a),
    "COSINE": lambda a, b, c: np.cos(a),
    "TANGENT": lambda a, b, c: np.tan(a),
    "ARCSINE": lambda a, b, c: np.arcsin(np.clip(a, -1.0, 1.0)),
    "ARCCOSINE": lambda a, b, c: np.arccos(np.clip(a, -1.0, 1.0)),
    "ARCTANGENT": lambda a, b, c: np.arctan(a),
    "ARCTAN2": lambda a, b, c: np.arctan2(a, b),
    "SINH": lambda a, b, c: np.sinh(a),
    "COSH": lambda a, b, c: np.cosh(a),
    "TANH": lambda a, b, c: np.tanh(a),
    "RADIANS": lambda a, b, c: np.radians(a),
    "DEGREES": lambda a, b, c: np.degrees(a),
}
"""Of the Math node's three inputs, by the node's operation"""
