# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that turn numbers and vectors into others."""

from __future__ import annotations

from typing import Any

from ..trees import ACROSS, DAMP, GLOW, PAINT, PLACE, UP, WIND, MakeTree, Row, rows, shader_node

MATH_ONE = [
    "LOGARITHM",
    "SQRT",
    "INVERSE_SQRT",
    "ABSOLUTE",
    "EXPONENT",
    "SIGN",
    "ROUND",
    "FLOOR",
    "CEIL",
    "TRUNC",
    "FRACT",
    "SINE",
    "COSINE",
    "TANGENT",
    "ARCSINE",
    "ARCCOSINE",
    "ARCTANGENT",
    "SINH",
    "COSH",
    "TANH",
    "RADIANS",
    "DEGREES",
]
MATH_TWO = [
    "ADD",
    "SUBTRACT",
    "MULTIPLY",
    "DIVIDE",
    "POWER",
    "MINIMUM",
    "MAXIMUM",
    "LESS_THAN",
    "GREATER_THAN",
    "MODULO",
    "FLOORED_MODULO",
    "SNAP",
    "PINGPONG",
    "ARCTAN2",
    "LOGARITHM",
]
MATH_THREE = ["MULTIPLY_ADD", "COMPARE", "SMOOTH_MIN", "SMOOTH_MAX", "WRAP"]
VECTOR_ONE = [
    "LENGTH",
    "NORMALIZE",
    "ABSOLUTE",
    "SIGN",
    "ROUND",
    "FLOOR",
    "CEIL",
    "FRACTION",
    "SINE",
    "COSINE",
    "TANGENT",
]
VECTOR_TWO = [
    "ADD",
    "SUBTRACT",
    "MULTIPLY",
    "DIVIDE",
    "CROSS_PRODUCT",
    "PROJECT",
    "REFLECT",
    "DOT_PRODUCT",
    "DISTANCE",
    "POWER",
    "MINIMUM",
    "MAXIMUM",
    "MODULO",
    "SNAP",
]


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _math() -> list[Row]:
    made: dict[str, list[MakeTree]] = {}
    for operation in MATH_ONE:
        made[operation] = [
            shader_node("Math", {0: ACROSS}, operation=operation),
            shader_node("Math", {0: DAMP}, operation=operation),
            shader_node("Math", {0: 0.375}, operation=operation),
            shader_node("Math", {0: ACROSS}, operation=operation, use_clamp=True),
        ]
    for operation in MATH_TWO:
        made.setdefault(operation, []).extend(
            shader_node("Math", inputs, operation=operation)
            for inputs in (
                {0: ACROSS, 1: UP},
                {0: ACROSS, 1: 0.7},
                {0: -1.3, 1: UP},
                {0: UP, 1: 0.0},
                {0: ACROSS, 1: 2.0},
            )
        )
        made[operation].append(shader_node("Math", {0: ACROSS, 1: UP}, operation=operation, use_clamp=True))
    for operation in MATH_THREE:
        made[operation] = [
            shader_node("Math", inputs, operation=operation)
            for inputs in (
                {0: ACROSS, 1: UP, 2: DAMP},
                {0: ACROSS, 1: 0.3, 2: 0.8},
                {0: UP, 1: ACROSS, 2: 0.0},
                {0: UP, 1: 1.5, 2: -0.75},
            )
        ]
    return rows("Math", *((_title(operation), trees) for operation, trees in made.items()))


def _vector_math() -> list[Row]:
    made: dict[str, list[MakeTree]] = {}

    def tree(operation: str, inputs: dict[str | int, Any]) -> MakeTree:
        return shader_node("VectorMath", inputs, operation=operation)

    for operation in VECTOR_ONE:
        made[operation] = [
            tree(operation, {0: WIND}),
            tree(operation, {0: PLACE}),
            tree(operation, {0: (0.1, -0.7, 0.4)}),
        ]
    for operation in VECTOR_TWO:
        made[operation] = [
            tree(operation, {0: WIND, 1: PLACE}),
            tree(operation, {0: WIND, 1: (0.5, -0.25, 0.0)}),
            tree(operation, {0: (0.6, -0.3, 0.9), 1: PLACE}),
        ]
    for operation in ("MULTIPLY_ADD", "WRAP", "FACEFORWARD"):
        made[operation] = [
            tree(operation, {0: WIND, 1: PLACE, 2: PAINT}),
            tree(operation, {0: PLACE, 1: (0.7, 0.5, 0.1), 2: (-0.4, 0.1, 0.1)}),
        ]
    made["SCALE"] = [tree("SCALE", {0: WIND, "Scale": UP}), tree("SCALE", {0: PLACE, "Scale": -1.4})]
    made["REFRACT"] = [
        tree("REFRACT", {0: (0.3, 0.2, -0.9327379), 1: (0.0, 0.0, 1.0), "Scale": DAMP}),
        tree("REFRACT", {0: WIND, 1: (0.6, 0.0, 0.8), "Scale": 0.75}),
    ]
    return rows("Vector Math", *((_title(operation), trees) for operation, trees in made.items()))


def _map_range() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    limits = {"From Min": -0.5, "From Max": 1.25, "To Min": 0.2, "To Max": -1.4}
    for kind in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
        steps: dict[str | int, Any] = {"Steps": 3.5} if kind == "STEPPED" else {}
        vector_steps: dict[str | int, Any] = {"Steps": (3.0, 2.5, 5.0)} if kind == "STEPPED" else {}
        made.append(
            (
                f"Float, {_title(kind).lower()}",
                [
                    shader_node("MapRange", {"Value": ACROSS, **limits, **steps}, interpolation_type=kind, clamp=clamp)
                    for clamp in (True, False)
                ]
                + [
                    shader_node("MapRange", {"Value": ACROSS, **limits, **more, **steps}, interpolation_type=kind)
                    for more in (
                        {"From Max": UP},
                        {"From Min": 0.5, "From Max": 0.5},
                        {"From Min": 1.5, "To Min": DAMP},
                    )
                ],
            )
        )
        made.append(
            (
                f"Vector, {_title(kind).lower()}",
                [
                    shader_node(
                        "MapRange",
                        {
                            "Vector": WIND,
                            "From Min": (-0.5, 0.7, 0.2),
                            "From Max": maximum,
                            "To Min": (0.0, 1.0, -0.5),
                            "To Max": PAINT,
                            **vector_steps,
                        },
                        data_type="FLOAT_VECTOR",
                        interpolation_type=kind,
                        clamp=clamp,
                    )
                    for clamp, maximum in ((True, (1.0, -0.2, 0.2)), (False, (1.0, -0.2, 0.9)))
                ],
            )
        )
    return rows("Map Range", *made)


def _ramps() -> list[Row]:
    def tree(mode: str, way: str, interpolation: str, factor: MakeTree, output: str = "Color") -> MakeTree:
        def adjust(node: Any) -> None:
            ramp = node.color_ramp
            ramp.color_mode, ramp.interpolation = mode, interpolation
            ramp.hue_interpolation = way
            ramp.elements[0].position, ramp.elements[0].color = 0.1, (0.9, 0.2, 0.1, 0.3)
            ramp.elements[1].position, ramp.elements[1].color = 0.8, (0.1, 0.3, 0.9, 1.0)
            middle = ramp.elements.new(0.45)
            middle.color = (0.3, 0.8, 0.2, 0.6)

        return shader_node("ValToRGB", {0: factor}, output, adjust)

    made: list[tuple[str, list[MakeTree]]] = [
        (
            f"RGB, {_title(interpolation).lower()}",
            [tree("RGB", "NEAR", interpolation, DAMP), tree("RGB", "NEAR", interpolation, ACROSS, "Alpha")],
        )
        for interpolation in ("LINEAR", "CONSTANT", "EASE", "CARDINAL", "B_SPLINE")
    ]
    made += [
        (f"{mode}, {way.lower()}", [tree(mode, way, "LINEAR", DAMP), tree(mode, way, "LINEAR", ACROSS)])
        for mode in ("HSV", "HSL")
        for way in ("NEAR", "FAR", "CW", "CCW")
    ]
    return rows("Color Ramp", *made)


def _colors_to_numbers() -> list[Row]:
    made = []
    for mode in ("RGB", "HSV", "HSL"):
        made += rows(
            "Separate Color",
            (
                mode,
                [shader_node("SeparateColor", {0: color}, k, mode=mode) for k in range(3) for color in (PAINT, GLOW)],
            ),
        )
        made += rows(
            "Combine Color",
            (
                mode,
                [
                    shader_node("CombineColor", inputs, mode=mode)
                    for inputs in ({0: DAMP, 1: 0.7, 2: 0.6}, {0: ACROSS, 1: UP, 2: DAMP}, {0: 0.3, 1: DAMP, 2: ACROSS})
                ],
            ),
        )
    made += rows("Separate XYZ", ("", [shader_node("SeparateXYZ", {0: WIND}, k) for k in range(3)]))
    made += rows("Combine XYZ", ("", shader_node("CombineXYZ", {0: ACROSS, 1: UP, 2: 0.25})))
    made += rows("RGB to BW", ("", [shader_node("RGBToBW", {0: color}) for color in (PAINT, GLOW)]))
    kelvin = shader_node("Math", {0: ACROSS, 1: 3000.0, 2: 6500.0}, operation="MULTIPLY_ADD")
    made += rows("Blackbody", ("", [shader_node("Blackbody", {0: value}) for value in (kelvin, 2700.0, 15000.0)]))
    nanometers = shader_node("Math", {0: ACROSS, 1: 130.0, 2: 560.0}, operation="MULTIPLY_ADD")
    made += rows("Wavelength", ("", [shader_node("Wavelength", {0: value}) for value in (nanometers, 480.0)]))
    return made


def _others() -> list[Row]:
    made = rows(
        "Clamp",
        *(
            (
                _title(kind),
                [
                    shader_node("Clamp", inputs, clamp_type=kind)
                    for inputs in ({0: ACROSS, 1: -0.3, 2: 0.8}, {0: ACROSS, 1: UP, 2: 0.2}, {0: UP, 1: 0.9, 2: -0.5})
                ],
            )
            for kind in ("MINMAX", "RANGE")
        ),
    )
    made += rows(
        "Value",
        ("", shader_node("Value", adjust=lambda node: setattr(node.outputs[0], "default_value", 0.625))),
    )
    return made + rows(
        "Color",
        ("", shader_node("RGB", adjust=lambda node: setattr(node.outputs[0], "default_value", (0.2, 0.7, 1.5, 1.0)))),
    )


ROWS: list[Row] = [*_math(), *_vector_math(), *_map_range(), *_ramps(), *_colors_to_numbers(), *_others()]
