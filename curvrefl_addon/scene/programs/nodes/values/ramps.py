# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Color ramps, curves and spectra: tables of the program's parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....materials.color_spaces import xyz_to_scene
from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from .folding import folded, node_key
from .tables import RAMP_ROWS, SPECTRUM, SPECTRUM_SCALE, SPECTRUM_START, SPECTRUM_STEP

_FILE = "values/ramps.glsl"
type _Rows = NDArray[np.float64]


def _ramp(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    ramp = node.color_ramp
    rows = np.array([ramp.evaluate(k / (RAMP_ROWS - 1)) for k in range(RAMP_ROWS)], np.float64)
    interpolates = ramp.interpolation != "CONSTANT"
    factor = b.input(source, "Fac", "float")
    is_alpha = source.socket.identifier == "Alpha"
    part = rows[:, 3] if is_alpha else rows[:, :3]
    kind: Any = "float" if is_alpha else "color"
    # (Blender computes what is known before Cycles sees it: by the ramp itself, not by its table.)
    known = folded(
        b, kind, lambda place: ramp.evaluate(min(max(float(place), 0.0), 1.0))[3 if is_alpha else slice(3)], factor
    )
    if known is not None:
        return known

    def look_up() -> Expression:
        function = "ramp_linear" if interpolates else "ramp_constant"
        return b.call("vec4", function, f"s.records + {b.table(rows)}", factor, file=_FILE)

    both = b.shared(node_key(source, "ramp"), look_up)
    return Expression(f"{both.text}.{'w' if is_alpha else 'xyz'}", kind, None, float(part.min()), float(part.max()))


def _extent(curves: list[Any]) -> tuple[float, float]:
    return min(curve.points[0].location[0] for curve in curves), max(curve.points[-1].location[0] for curve in curves)


def _curves(b: Builder, source: Source) -> Expression:
    """RGB, Vector and Float Curves."""
    node: Any = source.node
    mapping = node.mapping
    mapping.initialize()
    kind: Any = {"CURVE_RGB": "color", "CURVE_VEC": "vector", "CURVE_FLOAT": "float"}[node.type]
    name = {"CURVE_RGB": "Color", "CURVE_VEC": "Vector", "CURVE_FLOAT": "Value"}[node.type]
    value = b.input(source, name, kind)
    factor = b.input(source, "Factor" if kind == "float" else "Fac", "float")
    curves = list(mapping.curves)[: {"color": 4, "vector": 3, "float": 1}[kind]]
    low, high = _extent(curves)
    places = low + (high - low) * np.arange(RAMP_ROWS) / (RAMP_ROWS - 1)
    if kind == "color":
        # The curve of all three comes first.
        places = np.array([mapping.evaluate(curves[3], place) for place in places])
    rows = np.array([[mapping.evaluate(curve, place) for curve in curves[:3]] for place in places], np.float64)
    extends = mapping.extend == "EXTRAPOLATED"

    def bent(curve: Any, place: float) -> float:
        """Of a known value, by Blender: not by the table, and numbers are clipped."""
        found = mapping.evaluate(curve, place)
        clips = kind == "float" and mapping.use_clip
        return min(max(found, mapping.clip_min_y), mapping.clip_max_y) if clips else found

    def formula(v: Any, f: Any) -> Any:
        values = np.ravel(v).tolist()
        if kind == "color":
            values = [bent(curves[3], part) for part in values]
        found = np.array([bent(curve, part) for curve, part in zip(curves, values, strict=False)])
        return (1.0 - f) * v + f * (found[0] if kind == "float" else found)

    known = folded(b, kind, formula, value, factor)
    if known is not None:
        return known
    extent = b.record(low, high - low)
    place = b.made(kind, f"({value.text} - P({extent}).x) / P({extent}).y")
    first = f"s.records + {b.table(rows)}"
    if kind == "float":
        found = b.call("vec4", "ramp_extended" if extends else "ramp_linear", first, place, file=_FILE)
        found = Expression(f"{found.text}.x", "float")
    else:
        found = b.call(kind, "ramp_curves_extended" if extends else "ramp_curves", first, place, file=_FILE)
    ends = (-np.inf, np.inf) if extends else (float(rows.min()), float(rows.max()))
    if factor.constant == (1.0,):
        return b.made(kind, found.text, *ends)
    return b.made(kind, f"(1.0 - {factor.text}) * {value.text} + {factor.text} * {found.text}")


def _wavelength(b: Builder, source: Source) -> Expression:
    rows = xyz_to_scene(SPECTRUM) * SPECTRUM_SCALE
    length = b.input(source, "Wavelength", "float")

    def formula(nanometers: Any) -> Any:
        place = (float(nanometers) - SPECTRUM_START) / SPECTRUM_STEP
        row = int(place)
        if row < 0 or row >= len(rows) - 1:
            return np.zeros(3)
        return np.maximum(rows[row] + (place - row) * (rows[row + 1] - rows[row]), 0.0)

    known = folded(b, "color", formula, length)
    if known is not None:
        return known
    place = b.made("float", f"({length.text} - {SPECTRUM_START!r}) / {SPECTRUM_STEP!r}")
    first = f"s.records + {b.table(rows)}"
    return b.call("color", "ramp_spectrum", first, len(rows), place, file=_FILE, low=0.0, high=float(rows.max()))


NODES: Mapping[str, Handler] = {
    "VALTORGB": _ramp,
    **dict.fromkeys(("CURVE_RGB", "CURVE_VEC", "CURVE_FLOAT"), _curves),
    "WAVELENGTH": _wavelength,
}
