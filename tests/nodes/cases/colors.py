# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that mix and change colors, and curves."""

from __future__ import annotations

from typing import Any

from ..trees import ACROSS, DAMP, GLOW, PAINT, UP, WIND, MakeTree, Row, rows, shader_node

BLENDS = [
    "MIX",
    "DARKEN",
    "MULTIPLY",
    "BURN",
    "LIGHTEN",
    "SCREEN",
    "DODGE",
    "ADD",
    "OVERLAY",
    "SOFT_LIGHT",
    "LINEAR_LIGHT",
    "DIFFERENCE",
    "EXCLUSION",
    "SUBTRACT",
    "DIVIDE",
    "HUE",
    "SATURATION",
    "COLOR",
    "VALUE",
]


def _title(name: str) -> str:
    return name.replace("_", " ").lower()


def _mixes() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    for blend in BLENDS:
        settings: dict[str, Any] = {"data_type": "RGBA", "blend_type": blend}
        made.append(
            (
                f"Color, {_title(blend)}",
                [
                    shader_node("Mix", {"Factor": 0.65, "A": PAINT, "B": GLOW}, **settings),
                    shader_node("Mix", {"Factor": ACROSS, "A": GLOW, "B": PAINT}, clamp_factor=True, **settings),
                    shader_node("Mix", {"Factor": DAMP, "A": PAINT, "B": GLOW}, clamp_factor=False, **settings),
                    shader_node(
                        "Mix", {"Factor": 1.0, "A": GLOW, "B": (0.3, 0.6, 0.0, 1)}, clamp_result=True, **settings
                    ),
                ],
            )
        )
    made.append(
        (
            "Float",
            [
                shader_node("Mix", {"Factor": factor, "A": UP, "B": 0.25}, data_type="FLOAT", clamp_factor=clamp)
                for factor, clamp in ((ACROSS, True), (ACROSS, False), (0.3, True))
            ],
        )
    )
    made.append(
        (
            "Vector, one factor",
            [
                shader_node(
                    "Mix", {"Factor": ACROSS, "A": WIND, "B": (0.1, 0.2, 0.7)}, data_type="VECTOR", clamp_factor=clamp
                )
                for clamp in (True, False)
            ],
        )
    )
    made.append(
        (
            "Vector, a factor for each axis",
            [
                shader_node(
                    "Mix",
                    {"Factor": GLOW, "A": WIND, "B": (0.1, 0.2, 0.7)},
                    data_type="VECTOR",
                    factor_mode="NON_UNIFORM",
                    clamp_factor=clamp,
                )
                for clamp in (True, False)
            ],
        )
    )
    legacy = [
        (
            _title(blend).capitalize(),
            [
                shader_node("MixRGB", {0: 0.65, 1: PAINT, 2: GLOW}, blend_type=blend),
                shader_node("MixRGB", {0: ACROSS, 1: GLOW, 2: PAINT}, blend_type=blend, use_clamp=True),
            ],
        )
        for blend in BLENDS
    ]
    return rows("Mix", *made) + rows("Mix (Legacy)", *legacy)


def _changes() -> list[Row]:
    def pair(kind: str, *inputs: dict[str | int, Any]) -> list[MakeTree]:
        return [shader_node(kind, given) for given in inputs]

    return [
        *rows(
            "Brightness/Contrast",
            ("", pair("BrightContrast", {0: PAINT, 1: 0.1, 2: -0.4}, {0: GLOW, 1: DAMP, 2: 1.5})),
        ),
        *rows("Gamma", ("", pair("Gamma", {0: PAINT, 1: 2.2}, {0: GLOW, 1: 0.4}, {0: PAINT, 1: UP}))),
        *rows(
            "Hue/Saturation/Value",
            (
                "",
                pair(
                    "HueSaturation",
                    {"Hue": 0.3, "Saturation": 1.4, "Value": 0.8, "Factor": 0.9, "Color": PAINT},
                    {"Hue": DAMP, "Saturation": ACROSS, "Value": 1.2, "Factor": 1.0, "Color": GLOW},
                    {"Hue": 0.7, "Factor": DAMP, "Color": PAINT},
                ),
            ),
        ),
        *rows("Invert Color", ("", pair("Invert", {0: 1.0, 1: PAINT}, {0: DAMP, 1: GLOW}))),
    ]


def _bent(curve: Any, points: tuple[tuple[float, float], ...], handle: str = "AUTO") -> None:
    for point, place in zip(curve.points, (points[0], points[-1]), strict=False):
        point.location = place
    for place in points[1:-1]:
        curve.points.new(*place)
    for point in curve.points:
        point.handle_type = handle


def _curves() -> list[Row]:
    def color(extend: str) -> Any:
        def adjust(node: Any) -> None:
            mapping = node.mapping
            mapping.extend = extend
            _bent(mapping.curves[0], ((0.0, 0.1), (0.4, 0.7), (1.0, 0.8)))
            _bent(mapping.curves[1], ((0.1, 0.9), (0.8, 0.2)), "VECTOR")
            _bent(mapping.curves[3], ((0.0, 0.0), (0.5, 0.3), (1.0, 1.0)))
            mapping.update()

        return adjust

    def levels(node: Any) -> None:
        color("HORIZONTAL")(node)
        node.mapping.black_level, node.mapping.white_level = (0.1, 0.05, 0.0), (0.9, 1.2, 0.8)
        node.mapping.update()

    def vector(extend: str) -> Any:
        def adjust(node: Any) -> None:
            node.mapping.extend = extend
            _bent(node.mapping.curves[0], ((-1.0, -0.5), (0.0, 0.4), (1.0, 0.6)))
            _bent(node.mapping.curves[2], ((-0.8, 0.9), (0.2, -0.2), (0.7, 0.1)), "VECTOR")
            node.mapping.update()

        return adjust

    def number(extend: str) -> Any:
        def adjust(node: Any) -> None:
            node.mapping.extend = extend
            _bent(node.mapping.curves[0], ((0.05, 0.2), (0.3, 0.9), (0.9, 0.4)))
            node.mapping.update()

        return adjust

    ways = ("HORIZONTAL", "EXTRAPOLATED")
    return [
        *rows(
            "RGB Curves",
            *(
                (
                    f"Extend {way.lower()}",
                    [
                        shader_node("RGBCurve", {0: factor, 1: given}, adjust=color(way))
                        for factor, given in ((1.0, PAINT), (DAMP, GLOW))
                    ],
                )
                for way in ways
            ),
            ("Levels", shader_node("RGBCurve", {0: 1.0, 1: PAINT}, adjust=levels)),
        ),
        *rows(
            "Vector Curves",
            *(
                (
                    f"Extend {way.lower()}",
                    [shader_node("VectorCurve", {0: factor, 1: WIND}, adjust=vector(way)) for factor in (1.0, 0.4)],
                )
                for way in ways
            ),
        ),
        *rows(
            "Float Curve",
            *(
                (
                    f"Extend {way.lower()}",
                    [shader_node("FloatCurve", {0: factor, 1: ACROSS}, adjust=number(way)) for factor in (1.0, DAMP)],
                )
                for way in ways
            ),
        ),
    ]


ROWS: list[Row] = [*_mixes(), *_changes(), *_curves()]
