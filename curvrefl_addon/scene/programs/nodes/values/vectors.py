# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes of vectors: Vector Math, Combine and Separate XYZ, Mapping, Vector Rotate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ....materials.node_links import Source
from ...builder import Builder, Handler
from ...expression import Expression
from .folding import OPERATIONS, divided, folded, node_key
from .numbers import MATH_FILE, TEXTS, operated, used_inputs

_TILING_FILE = "values/radial_tiling.glsl"
_ROTATION_FILE = "values/rotation.glsl"
_PARTS = ("x", "y", "z")

_BY_PARTS = {"FRACTION": "FRACT"}
"""Operations of vectors that are one of numbers under another name"""
_WHOLE: Mapping[str, str] = {
    "CROSS_PRODUCT": "cross({0}, {1})",
    "PROJECT": "math_project({0}, {1})",
    "REFLECT": "reflect({0}, math_normalize({1}))",
    "REFRACT": "refract({0}, math_normalize({1}), {3})",
    "FACEFORWARD": "math_face_forward({0}, {1}, {2})",
    "SCALE": "{0} * {3}",
    "NORMALIZE": "math_normalize({0})",
}
"""Of three vectors and a number"""
_NUMBERS: Mapping[str, str] = {
    "DOT_PRODUCT": "dot({0}, {1})",
    "DISTANCE": "distance({0}, {1})",
    "LENGTH": "length({0})",
}
_FORMULAS: Mapping[str, Any] = {
    "CROSS_PRODUCT": lambda a, b, c, s: np.cross(a, b),
    "PROJECT": lambda a, b, c, s: b * divided(a @ b, b @ b),
    "SCALE": lambda a, b, c, s: a * s,
    "NORMALIZE": lambda a, b, c, s: a * divided(np.float64(1.0), np.linalg.norm(a)),
    "DOT_PRODUCT": lambda a, b, c, s: a @ b,
    "DISTANCE": lambda a, b, c, s: np.linalg.norm(a - b),
    "LENGTH": lambda a, b, c, s: np.linalg.norm(a),
}


def _vector_math(b: Builder, source: Source) -> Expression | None:
    node: Any = source.node
    operation = node.operation
    makes_number = operation in _NUMBERS
    if makes_number != (source.socket.identifier == "Value"):
        # The other output is there, hidden, and 0.
        return b.parameter(0.0) if source.socket.identifier == "Value" else b.parameter(0.0, 0.0, 0.0)
    names = ("Vector", "Vector_001", "Vector_002")
    text = _WHOLE.get(operation) or _NUMBERS.get(operation)
    if text is None:
        name = _BY_PARTS.get(operation, operation)
        if name not in OPERATIONS:
            return None
        return operated(b, name, used_inputs(b, source, TEXTS[name], names, "vector"))
    inputs = used_inputs(b, source, text, names, "vector")
    inputs.append(b.input(source, "Scale", "float") if "{3}" in text else b.parameter(0.0))
    kind: Any = "float" if makes_number else "vector"
    known = folded(b, kind, _FORMULAS.get(operation), *inputs)
    if known is not None:
        return known
    b.include(MATH_FILE)
    low = 0.0 if operation in ("DISTANCE", "LENGTH") else -np.inf
    return b.made(kind, text.format(*(value.text for value in inputs)), low)


def combined(b: Builder, kind: Any, parts: list[Expression]) -> Expression:
    """Three numbers as one vector or color."""
    known = folded(b, kind, lambda *numbers: np.array(numbers), *parts)
    if known is not None:
        return known
    low, high = min(part.low for part in parts), max(part.high for part in parts)
    return b.made(kind, f"vec3({', '.join(part.text for part in parts)})", low, high)


def part_of(whole: Expression, number: int) -> Expression:
    """One of three."""
    known = None if whole.constant is None else (whole.constant[number],)
    return Expression(f"{whole.text}.{_PARTS[number]}", "float", known, whole.low, whole.high)


def _combine(b: Builder, source: Source) -> Expression:
    return combined(b, "vector", [b.input(source, name, "float") for name in ("X", "Y", "Z")])


def _separate(b: Builder, source: Source) -> Expression:
    return part_of(b.input(source, "Vector", "vector"), "XYZ".index(source.socket.identifier))


def _mapping(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    vector, rotation, scale = (b.input(source, name, "vector") for name in ("Vector", "Rotation", "Scale"))
    if node.vector_type in ("VECTOR", "NORMAL"):
        function = f"mapping_{node.vector_type.lower()}"
        return b.call("vector", function, vector, rotation, scale, file=_ROTATION_FILE)
    location = b.input(source, "Location", "vector")
    if rotation.constant == (0.0, 0.0, 0.0):
        # The most common mapping, without sines.
        if node.vector_type == "POINT":
            return b.made("vector", f"{vector.text} * {scale.text} + {location.text}")
        b.include(MATH_FILE)
        return b.made("vector", f"math_divide({vector.text} - {location.text}, {scale.text})")
    function = f"mapping_{node.vector_type.lower()}"
    return b.call("vector", function, vector, location, rotation, scale, file=_ROTATION_FILE)


def _rotate(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    vector, center = (b.input(source, name, "vector") for name in ("Vector", "Center"))
    if node.rotation_type == "EULER_XYZ":
        function = "rotation_by_inverse_euler" if node.invert else "rotation_by_euler"
        return b.call("vector", function, vector, center, b.input(source, "Rotation", "vector"), file=_ROTATION_FILE)
    axes = {"X_AXIS": "vec3(1.0, 0.0, 0.0)", "Y_AXIS": "vec3(0.0, 1.0, 0.0)", "Z_AXIS": "vec3(0.0, 0.0, 1.0)"}
    axis = axes.get(node.rotation_type) or b.input(source, "Axis", "vector")
    angle = b.input(source, "Angle", "float")
    turn = f"-{angle.text}" if node.invert else angle.text
    return b.call("vector", "rotation_about_axis", vector, center, axis, turn, file=_ROTATION_FILE)


def _radial_tiling(b: Builder, source: Source) -> Expression:
    node: Any = source.node
    vector, sides = b.input(source, "Vector", "vector"), b.input(source, "Sides", "float")
    output = source.socket.identifier
    if output == "Segment ID":
        return b.call("float", "radial_segment", vector, sides, file=_TILING_FILE)
    roundness = b.input(source, "Roundness", "float")

    def tiled() -> Expression:
        return b.call("vec4", "radial_tiling", vector, sides, roundness, bool(node.normalize), file=_TILING_FILE)

    whole = b.shared(node_key(source, "tiling"), tiled).text
    if output == "Segment Coordinates":
        return b.made("vector", f"vec3({whole}.yx, 0.0)")
    return Expression(f"{whole}.{'z' if output == 'Segment Width' else 'w'}", "float")


NODES: Mapping[str, Handler] = {
    "VECT_MATH": _vector_math,
    "COMBXYZ": _combine,
    "SEPXYZ": _separate,
    "MAPPING": _mapping,
    "VECTOR_ROTATE": _rotate,
    "ShaderNodeRadialTiling": _radial_tiling,
}
