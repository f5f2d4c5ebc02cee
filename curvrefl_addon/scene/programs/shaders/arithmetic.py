# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shader nodes compute of their inputs: constants stay constants, so that plain materials need no program."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..builder import Builder
from ..expression import Expression, Kind

type Numbers = tuple[float, ...]


def constant(*values: float, kind: Kind | None = None) -> Expression:
    """One number or three that take no place among a program's parameters until a text needs them."""
    known = tuple(float(value) for value in values)
    return Expression("", kind or ("float" if len(known) == 1 else "color"), known, min(known), max(known))


def placed(b: Builder, value: Expression) -> str:
    """Its GLSL."""
    if value.text or value.constant is None:
        return value.text
    return b.parameter(*value.constant).text


def settled(value: Expression) -> Expression:
    """As a constant where its bounds leave no choice."""
    if value.constant is not None or not (value.low == value.high and math.isfinite(value.low)):
        return value
    return constant(*((value.low,) * (1 if value.kind == "float" else 3)), kind=value.kind)


def is_at(value: Expression, number: float) -> bool:
    """Whether it is this number everywhere."""
    return value.constant is not None and all(part == number for part in value.constant)


def is_same(one: Expression, other: Expression) -> bool:
    """Whether both are surely the same everywhere."""
    if one.constant is not None or other.constant is not None:
        return one.constant == other.constant
    return one.text == other.text


def clamped(b: Builder, value: Expression, low: float, high: float = math.inf) -> Expression:
    """Between limits; what is not a number stays so."""
    if value.constant is not None:
        return _constant(np.clip(value.constant, low, high), value.kind)
    limits = f"{float(low)!r}" if high == math.inf else f"{float(low)!r}, {float(high)!r}"
    function = "max" if high == math.inf else "clamp"
    # (Also where its bounds say that it is: what of a program is compiled should not depend on numbers.)
    text = f"{function}({value.text}, {limits})"
    return _once(b, value.kind, text, min(max(value.low, low), high), min(max(value.high, low), high))


def product(b: Builder, one: Expression, other: Expression) -> Expression:
    """Of numbers and colors."""
    kind: Kind = "color" if "color" in (one.kind, other.kind) else one.kind
    for value, rest in ((one, other), (other, one)):
        if is_at(value, 0.0):
            return constant(*((0.0,) * (1 if kind == "float" else 3)), kind=kind)
        if is_at(value, 1.0) and rest.kind == kind:
            return rest
    ends = [_finite(x * y) for x in (one.low, one.high) for y in (other.low, other.high)]
    return _made(b, kind, "{} * {}", np.multiply, min(ends), max(ends), one, other)


def total(b: Builder, one: Expression, other: Expression) -> Expression:
    """Of two of one kind."""
    for value, rest in ((one, other), (other, one)):
        if is_at(value, 0.0):
            return rest
    return _made(b, one.kind, "{} + {}", np.add, one.low + other.low, one.high + other.high, one, other)


def rest_of(b: Builder, share: Expression) -> Expression:
    """1 - share."""
    return _made(b, share.kind, "1.0 - {}", lambda x: 1.0 - np.asarray(x), 1.0 - share.high, 1.0 - share.low, share)


def quotient(b: Builder, value: Expression, by: Expression, least: float = 1e-6) -> Expression:
    """`by`: from 0 up, taken for at least `least`."""

    def divide(x: Any, y: Any) -> Any:
        return np.asarray(x) / np.maximum(y, least)

    low, high = (-math.inf if value.low < 0.0 else 0.0), math.inf
    if value.high <= 0.0:
        high = 0.0
    return _made(b, value.kind, f"{{}} / max({{}}, {least!r})", divide, low, high, value, by)


def mixed(b: Builder, one: Expression, other: Expression, share: Expression) -> Expression:
    """`share` (0 to 1) of the other."""
    if is_same(one, other) or is_at(share, 0.0):
        return one
    if is_at(share, 1.0):
        return other

    def mix(x: Any, y: Any, part: Any) -> Any:
        return np.asarray(x) * (1.0 - np.asarray(part)) + np.asarray(y) * np.asarray(part)

    low, high = min(one.low, other.low), max(one.high, other.high)
    return _made(b, one.kind, "mix({}, {}, {})", mix, low, high, one, other, share)


def chosen(b: Builder, side: Expression, one: Expression, other: Expression) -> Expression:
    """The other where `side` is 1, the one where it is 0."""
    if is_same(one, other):
        return one
    low, high = min(one.low, other.low), max(one.high, other.high)
    return _once(b, one.kind, f"{side.text} > 0.5 ? {placed(b, other)} : {placed(b, one)}", low, high)


def _made(
    b: Builder, kind: Kind, text: str, function: Callable[..., Any], low: float, high: float, *values: Expression
) -> Expression:
    known = [value.constant for value in values]
    numbers = [np.array(numbers) for numbers in known if numbers is not None]
    if len(numbers) == len(values):
        with np.errstate(all="ignore"):
            return _constant(np.broadcast_to(function(*numbers), 1 if kind == "float" else 3), kind)
    return _once(b, kind, text.format(*(placed(b, value) for value in values)), low, high)


def _once(b: Builder, kind: Kind, text: str, low: float, high: float) -> Expression:
    """Made once, so that equal values are known to be equal."""
    return b.shared((kind, text), lambda: b.made(kind, text, low, high))


def _constant(values: Any, kind: Kind) -> Expression:
    return constant(*np.atleast_1d(values).tolist(), kind=kind)


def _finite(bound: float) -> float:
    """Zero times endless is zero: the zero is exact."""
    return 0.0 if math.isnan(bound) else bound
