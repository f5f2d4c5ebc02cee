# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes Math, Map Range and Clamp of single numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression, Kind
from .folding import OPERATIONS, divided, folded

MATH_FILE, RANGE_FILE = "values/math.glsl", "values/map_range.glsl"

TEXTS: Mapping[str, str] = {
    "ADD": "{0} + {1}",
    "SUBTRACT": "{0} - {1}",
    "MULTIPLY": "{0} * {1}",
    "DIVIDE": "math_divide({0}, {1})",
    "MULTIPLY_ADD": "{0} * {1} + {2}",
    "POWER": "math_power({0}, {1})",
    "LOGARITHM": "math_logarithm({0}, {1})",
    "SQRT": "sqrt(max({0}, 0.0))",
    "INVERSE_SQRT": "math_inverse_root({0})",
    "ABSOLUTE": "abs({0})",
    "EXPONENT": "exp({0})",
    "MINIMUM": "min({0}, {1})",
    "MAXIMUM": "max({0}, {1})",
    "LESS_THAN": "float({0} < {1})",
    "GREATER_THAN": "float({0} > {1})",
    "SIGN": "sign({0})",
    "COMPARE": "math_compare({0}, {1}, {2})",
    "SMOOTH_MIN": "math_smooth_minimum({0}, {1}, {2})",
    "SMOOTH_MAX": "-math_smooth_minimum(-{0}, -{1}, {2})",
    "ROUND": "floor({0} + 0.5)",
    "FLOOR": "floor({0})",
    "CEIL": "ceil({0})",
    "TRUNC": "trunc({0})",
    "FRACT": "fract({0})",
    "MODULO": "math_modulo({0}, {1})",
    "FLOORED_MODULO": "math_floored_modulo({0}, {1})",
    "WRAP": "math_wrap({0}, {1}, {2})",
    "SNAP": "floor(math_divide({0}, {1})) * {1}",
    "PINGPONG": "math_ping_pong({0}, {1})",
    "SINE": "sin({0})",
    "COSINE": "cos({0})",
    "TANGENT": "tan({0})",
    "ARCSINE": "asin(clamp({0}, -1.0, 1.0))",
    "ARCCOSINE": "acos(clamp({0}, -1.0, 1.0))",
    "ARCTANGENT": "atan({0})",
    "ARCTAN2": "math_arc_tangent({0}, {1})",
    "SINH": "math_hyperbolic_sine({0})",
    "COSH": "0.5 * (exp({0}) + exp(-{0}))",
    "TANH": "math_hyperbolic_tangent({0})",
    "RADIANS": "radians({0})",
    "DEGREES": "degrees({0})",
}
"""GLSL of the Math node's three inputs, by the node's operation"""

_ALWAYS: Mapping[str, tuple[float, float]] = {
    **dict.fromkeys(("LESS_THAN", "GREATER_THAN", "COMPARE", "FRACT"), (0.0, 1.0)),
    **dict.fromkeys(("SINE", "COSINE", "SIGN", "TANH"), (-1.0, 1.0)),
    **dict.fromkeys(("SQRT", "INVERSE_SQRT", "ABSOLUTE", "EXPONENT", "PINGPONG"), (0.0, math.inf)),
}
"""Bounds of operations whatever they are given"""


def operated(b: Builder, operation: str, inputs: Sequence[Expression]) -> Expression:
    """An operation of numbers or vectors, of one kind all, in their kind."""
    kind = inputs[0].kind
    known = folded(b, kind, OPERATIONS[operation], *inputs)
    if known is not None:
        return known
    b.include(MATH_FILE)
    low, high = bounds(operation, inputs)
    return b.made(kind, TEXTS[operation].format(*(value.text for value in inputs)), low, high)


def bounds(operation: str, inputs: Sequence[Expression]) -> tuple[float, float]:
    """Between what values the result of an operation lies."""
    a, b = inputs[0], inputs[1]
    if operation == "ADD":
        return a.low + b.low, a.high + b.high
    if operation == "SUBTRACT":
        return a.low - b.high, a.high - b.low
    if operation == "MULTIPLY":
        ends = [_times(p, q) for p in (a.low, a.high) for q in (b.low, b.high)]
        return min(ends), max(ends)
    if operation == "MINIMUM":
        return min(a.low, b.low), min(a.high, b.high)
    if operation == "MAXIMUM":
        return max(a.low, b.low), max(a.high, b.high)
    if operation == "POWER" and a.low >= 0.0:
        return 0.0, 1.0 if a.high <= 1.0 and b.low >= 0.0 else math.inf
    return _ALWAYS.get(operation, (-math.inf, math.inf))


def used_inputs(b: Builder, source: Source, text: str, names: Sequence[str], kind: Kind) -> list[Expression]:
    """Those that occur in an operation's text; the first in place of the others, which hold values nevertheless."""
    first = b.input(source, names[0], kind)
    return [first] + [
        b.input(source, name, kind) if f"{{{k}}}" in text else first for k, name in enumerate(names[1:], 1)
    ]


def _times(p: float, q: float) -> float:
    return 0.0 if p == 0.0 or q == 0.0 else p * q


def clamped(b: Builder, value: Expression) -> Expression:
    """Between 0 and 1; the same where it is."""
    if value.low >= 0.0 and value.high <= 1.0:
        return value
    known = folded(b, value.kind, lambda v: np.clip(v, 0.0, 1.0), value)
    if known is not None:
        return known
    return b.made(value.kind, f"clamp({value.text}, 0.0, 1.0)", max(value.low, 0.0), min(value.high, 1.0))


def _math(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    if node.operation not in TEXTS:
        return None
    names = ("Value", "Value_001", "Value_002")
    result = operated(b, node.operation, used_inputs(b, source, TEXTS[node.operation], names, "float"))
    return clamped(b, result) if node.use_clamp else result


def _clamp(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    value, low, high = (b.input(source, name, "float") for name in ("Value", "Min", "Max"))
    ordered = node.clamp_type == "RANGE"

    def formula(v: Any, first: Any, second: Any) -> Any:
        ends = (min(first, second), max(first, second)) if ordered else (first, second)
        return min(max(v, ends[0]), ends[1])

    known = folded(b, "float", formula, value, low, high)
    if known is not None:
        return known
    least, most = min(low.low, high.low), max(low.high, high.high)
    function = "range_clamp_ordered" if ordered else "range_clamp"
    return b.call("float", function, value, low, high, file=RANGE_FILE, low=least, high=most)


def smooth(t: Any) -> Any:
    """The place in the range of Map Range's smooth steps."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def smoother(t: Any) -> Any:
    """The same of its smoother steps."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0)


def _map_range(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    is_vector = node.data_type == "FLOAT_VECTOR"
    suffix = "_FLOAT3" if is_vector else ""
    joint = "_" if is_vector else " "
    names = [f"{end}{joint}{extent}{suffix}" for end in ("From", "To") for extent in ("Min", "Max")]
    kind: Any = "vector" if is_vector else "float"
    value = b.input(source, "Vector" if is_vector else "Value", kind)
    from_low, from_high, low, high = (b.input(source, name, kind) for name in names)
    interpolation = node.interpolation_type
    clamps = node.clamp and interpolation in ("LINEAR", "STEPPED")
    inputs = [value, from_low, from_high, low, high]
    if interpolation == "STEPPED":
        inputs.append(b.input(source, f"Steps{suffix}", kind))

    def formula(v: Any, a: Any, z: Any, to_a: Any, to_z: Any, steps: Any = 1.0) -> Any:
        place = divided(v - a, z - a)
        if interpolation == "STEPPED":
            place = np.where(steps > 0.0, divided(np.floor(place * (steps + 1.0)), steps), 0.0)
        elif interpolation != "LINEAR":
            place = (smooth if interpolation == "SMOOTHSTEP" else smoother)(place)
        # (Blender computes what is known before Cycles sees it: an empty range is its beginning there, 0 in Cycles.)
        result = to_a + place * (to_z - to_a)
        return np.clip(result, np.minimum(to_a, to_z), np.maximum(to_a, to_z)) if clamps else result

    known = folded(b, kind, formula, *inputs)
    if known is not None:
        return known
    place = b.call(kind, "range_place", value, from_low, from_high, file=RANGE_FILE)
    if interpolation == "STEPPED":
        place = b.call(kind, "range_stepped", place, inputs[5])
    elif interpolation != "LINEAR":
        place = b.call(kind, "range_smooth" if interpolation == "SMOOTHSTEP" else "range_smoother", place)
    least, most = min(low.low, high.low), max(low.high, high.high)
    if is_vector:
        result = b.made(kind, f"{low.text} + {place.text} * ({high.text} - {low.text})")
    else:
        result = b.call(kind, "range_mapped", place, from_low, from_high, low, high)
    if clamps:
        return b.call(kind, "range_clamp_ordered", result, low, high, low=least, high=most)
    if interpolation in ("SMOOTHSTEP", "SMOOTHERSTEP"):
        return Expression(result.text, kind, None, min(least, 0.0), max(most, 0.0))
    return result


NODES: Mapping[str, Handler] = {"MATH": _math, "CLAMP": _clamp, "MAP_RANGE": _map_range}
