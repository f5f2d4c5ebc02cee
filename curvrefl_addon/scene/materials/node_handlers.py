# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What color and math nodes do, one function for each kind: from the node's output to a color."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from .color_spaces import luminance_weights
from .node_color import NodeColor, gray, product, spread
from .node_formulas import (
    BLENDS,
    FROM_RGB,
    NUMBER_OPERATIONS,
    TO_RGB,
    VECTOR_OPERATIONS,
    hue_saturation_value,
    map_range,
    power,
)
from .node_links import Source

if TYPE_CHECKING:
    from .node_colors import ColorReader

CURVE_STEPS = 256
"""As Cycles tabulates color ramps and curves"""

_MIXED = {
    "RGBA": ("Factor_Float", "A_Color", "B_Color"),
    "FLOAT": ("Factor_Float", "A_Float", "B_Float"),
    "VECTOR": ("Factor_Float", "A_Vector", "B_Vector"),
}
"""Inputs of a Mix node for each kind of data"""


def _mix(reader: ColorReader, source: Source) -> NodeColor | None:
    node: Any = source.node
    old = node.type == "MIX_RGB"
    kind = "RGBA" if old else node.data_type
    if kind not in _MIXED:
        return None
    names = ("Fac", "Color1", "Color2") if old else _MIXED[kind]
    is_uneven = kind == "VECTOR" and node.factor_mode == "NON_UNIFORM"
    factor_source = source.input("Factor_Vector" if is_uneven else names[0])
    factor = reader.color(factor_source) if is_uneven else reader.value(factor_source)
    if old or node.clamp_factor:
        factor = reader.made(lambda f: np.clip(f, 0.0, 1.0), factor)
    read = reader.value if kind == "FLOAT" else reader.color
    blend = node.blend_type if kind == "RGBA" else "MIX"
    operation = BLENDS[blend]
    clamps = kind == "RGBA" and (node.use_clamp if old else node.clamp_result)
    a = read(source.input(names[1]))
    if factor == gray(0.0):
        result = a
    elif factor == gray(1.0) and blend == "MIX":
        result = read(source.input(names[2]))
    else:
        b = read(source.input(names[2]))
        plain = product(a, b, factor) if blend == "MULTIPLY" else None
        result = reader.made(operation, a, b, factor) if plain is None else plain
    return reader.made(lambda c: np.clip(c, 0.0, 1.0), result) if clamps else result


def _math(reader: ColorReader, source: Source) -> NodeColor | None:
    node: Any = source.node
    operation = NUMBER_OPERATIONS.get(node.operation)
    if operation is None:
        return None
    inputs = [reader.value(source.input(name)) for name in ("Value", "Value_001", "Value_002")]
    if node.operation == "MULTIPLY" and not node.use_clamp:
        plain = product(inputs[0], inputs[1], gray(1.0))
        if plain is not None:
            return plain
    result = reader.made(operation, *inputs)
    return reader.made(lambda v: np.clip(v, 0.0, 1.0), result) if node.use_clamp else result


def _vector_math(reader: ColorReader, source: Source) -> NodeColor | None:
    node: Any = source.node
    if node.operation == "SCALE":
        return reader.changed(source, lambda v, s: v * s, "Vector", "Scale")
    operation = VECTOR_OPERATIONS.get(node.operation)
    if operation is None:
        return None
    return reader.made(
        operation, *(reader.color(source.input(name)) for name in ("Vector", "Vector_001", "Vector_002"))
    )


def _map_range(reader: ColorReader, source: Source) -> NodeColor | None:
    node: Any = source.node
    if node.data_type != "FLOAT":
        return None
    names = ("Value", "From Min", "From Max", "To Min", "To Max")
    kind, clamps = node.interpolation_type, node.clamp

    def change(value: Any, low: Any, high: Any, to_low: Any, to_high: Any, steps: Any) -> Any:
        result = map_range(kind, value, (low, to_low), (high, to_high), steps)
        if clamps and kind in ("LINEAR", "STEPPED"):
            return np.clip(result, np.minimum(to_low, to_high), np.maximum(to_low, to_high))
        return result

    # (There is an input for them in that one kind only.)
    steps = reader.value(source.input("Steps")) if kind == "STEPPED" else gray(1.0)
    return reader.made(change, *(reader.value(source.input(name)) for name in names), steps)


def _clamp(reader: ColorReader, source: Source) -> NodeColor:
    node: Any = source.node
    ordered = node.clamp_type == "RANGE"

    def change(value: Any, low: Any, high: Any) -> Any:
        ends = (np.minimum(low, high), np.maximum(low, high)) if ordered else (low, high)
        return np.minimum(np.maximum(value, ends[0]), ends[1])

    return reader.made(change, *(reader.value(source.input(name)) for name in ("Value", "Min", "Max")))


def _separate(reader: ColorReader, source: Source) -> NodeColor:
    node: Any = source.node
    mode = node.mode if node.type == "SEPARATE_COLOR" else ("HSV" if node.type == "SEPHSV" else "RGB")
    channel = [socket.identifier for socket in node.outputs].index(source.socket.identifier)
    whole = reader.color(source.inputs()[0])
    change = FROM_RGB[mode]
    return reader.made(lambda c: spread(change(c)[..., channel]), whole)


def _combine(reader: ColorReader, source: Source) -> NodeColor:
    node: Any = source.node
    mode = node.mode if node.type == "COMBINE_COLOR" else ("HSV" if node.type == "COMBHSV" else "RGB")
    parts = [reader.value(item) for item in source.inputs()[:3]]
    change = TO_RGB[mode]

    def joined(a: Any, b: Any, c: Any) -> Any:
        return change(np.stack(np.broadcast_arrays(a[..., 0], b[..., 0], c[..., 0]), axis=-1))

    return reader.made(joined, *parts)


def _ramp(reader: ColorReader, source: Source) -> NodeColor:
    node: Any = source.node
    places = np.linspace(0.0, 1.0, CURVE_STEPS)
    table = np.array([node.color_ramp.evaluate(place) for place in places])
    table = table[:, [3, 3, 3]] if source.socket.identifier == "Alpha" else table[:, :3]
    factor = source.input("Fac")

    def ramp(colors: Any) -> Any:
        place = np.clip(colors[..., 0], 0.0, 1.0)
        return np.stack([np.interp(place, places, table[:, k]) for k in range(3)], axis=-1)

    return reader.made(ramp, reader.value(factor))


def _curves(reader: ColorReader, source: Source) -> NodeColor:
    node: Any = source.node
    mapping = node.mapping
    mapping.initialize()
    low, high = (mapping.clip_min_x, mapping.clip_max_x) if mapping.use_clip else (0.0, 1.0)
    places = np.linspace(low, high, CURVE_STEPS)
    whole = node.type == "CURVE_FLOAT"
    first = places if whole else [mapping.evaluate(mapping.curves[3], place) for place in places]
    curves = [mapping.curves[0]] * 3 if whole else list(mapping.curves)[:3]
    tables = [np.array([mapping.evaluate(curve, place) for place in first]) for curve in curves]
    goes_on = mapping.extend == "EXTRAPOLATED"

    def change(colors: Any, factor: Any) -> Any:
        bent = [_along(colors[..., k], places, tables[k], goes_on) for k in range(3)]
        return colors + factor * (np.stack(bent, axis=-1) - colors)

    if whole:
        return reader.made(change, reader.value(source.input("Value")), reader.value(source.input("Factor")))
    return reader.changed(source, change, "Color", "Fac")


def _invert(c: Any, factor: Any) -> Any:
    return c + factor * (1.0 - 2.0 * c)


def _contrast(c: Any, bright: Any, contrast: Any) -> Any:
    return np.maximum((1.0 + contrast) * c + bright - 0.5 * contrast, 0.0)


def _hue_saturation(c: Any, hue: Any, saturation: Any, value: Any, factor: Any) -> Any:
    return (1.0 - factor) * c + factor * hue_saturation_value(c, hue, saturation, value)


def _gamma(c: Any, exponent: Any) -> Any:
    return np.where(c > 0.0, power(np.maximum(c, 0.0), exponent), c)


type _Handler = Callable[[ColorReader, Source], NodeColor | None]
HANDLERS: dict[str, _Handler] = {
    "GAMMA": lambda reader, source: reader.changed(source, _gamma, "Color", "Gamma"),
    "INVERT": lambda reader, source: reader.changed(source, _invert, "Color", "Fac"),
    "BRIGHTCONTRAST": lambda reader, source: reader.changed(source, _contrast, "Color", "Bright", "Contrast"),
    "HUE_SAT": lambda reader, source: reader.changed(
        source, _hue_saturation, "Color", "Hue", "Saturation", "Value", "Fac"
    ),
    "RGBTOBW": lambda reader, source: reader.changed(
        source, lambda c: spread(c @ luminance_weights().astype(c.dtype)), "Color"
    ),
    "MIX": _mix,
    "MIX_RGB": _mix,
    "MATH": _math,
    "VECT_MATH": _vector_math,
    "MAP_RANGE": _map_range,
    "CLAMP": _clamp,
    "VALTORGB": _ramp,
    "CURVE_RGB": _curves,
    "CURVE_FLOAT": _curves,
    **dict.fromkeys(("SEPARATE_COLOR", "SEPRGB", "SEPXYZ", "SEPHSV"), _separate),
    **dict.fromkeys(("COMBINE_COLOR", "COMBRGB", "COMBXYZ", "COMBHSV"), _combine),
}


def _along(values: Any, places: Any, table: Any, goes_on: bool) -> Any:
    """Look values up in a curve, which goes on straight beyond its ends or stays level there."""
    found = np.interp(values, places, table)
    if goes_on:
        for end, inner, beyond in ((0, 1, values < places[0]), (-1, -2, values > places[-1])):
            slope = (table[end] - table[inner]) / (places[end] - places[inner])
            found = np.where(beyond, table[end] + slope * (values - places[end]), found)
    return found
