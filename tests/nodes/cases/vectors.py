# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that move and turn vectors, and normals."""

from __future__ import annotations

from typing import Any

from ..trees import ACROSS, DAMP, PAINT, PLACE, UP, UV, WIND, MakeTree, Row, rows, shader_node, split

SPACES = ("WORLD", "OBJECT", "CAMERA")
SMOOTH_HEIGHT = shader_node("Math", {0: split(PLACE, "X")}, operation="SINE")
UNIT = shader_node("VectorMath", {0: WIND}, operation="NORMALIZE")


def _mapping() -> list[Row]:
    given = {1: (0.2, -0.5, 0.9), 2: (0.3, 1.2, -0.7), 3: (1.5, 0.4, -2.0)}
    bent = {1: WIND, 2: (0.3, 0.0, 0.0), 3: (0.0, 1.0, 2.0)}

    def trees(kind: str) -> list[MakeTree]:
        moved = [{**inputs, 0: PLACE} for inputs in (given, bent)]
        if kind in ("VECTOR", "NORMAL"):
            # (No location.)
            moved = [{0: PLACE, 1: inputs[2], 2: inputs[3]} for inputs in (given, bent)]
        return [shader_node("Mapping", inputs, vector_type=kind) for inputs in moved]

    return rows("Mapping", *((kind.capitalize(), trees(kind)) for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL")))


def _rotations() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    for kind in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"):
        inputs: dict[str | int, Any] = {"Vector": PLACE, "Center": (0.3, -0.2, 0.1)}
        if kind == "EULER_XYZ":
            more: list[dict[str | int, Any]] = [{"Rotation": (0.4, -1.1, 2.0)}, {"Rotation": WIND}]
        elif kind == "AXIS_ANGLE":
            more = [
                {"Angle": 0.9, "Axis": (0.2, -0.5, 0.7)},
                {"Angle": ACROSS, "Axis": WIND},
                {"Angle": 1.0, "Axis": (0, 0, 0)},
            ]
        else:
            more = [{"Angle": 0.9}, {"Angle": ACROSS}]
        made.append(
            (
                kind.replace("_", " ").capitalize(),
                [
                    shader_node("VectorRotate", {**inputs, **given}, rotation_type=kind, invert=invert)
                    for given in more
                    for invert in (False, True)
                ],
            )
        )
    return rows("Vector Rotate", *made)


def _transforms() -> list[Row]:
    return rows(
        "Vector Transform",
        *(
            (
                f"{kind.capitalize()} from {start.lower()} to {end.lower()} space",
                shader_node(
                    "VectorTransform",
                    {0: UNIT if kind == "NORMAL" else WIND},
                    vector_type=kind,
                    convert_from=start,
                    convert_to=end,
                ),
            )
            for kind in ("POINT", "VECTOR", "NORMAL")
            for start in SPACES
            for end in SPACES
            if start != end
        ),
    )


def _normals() -> list[Row]:
    def normal_map(space: str, **settings: Any) -> list[MakeTree]:
        return [
            shader_node("NormalMap", {"Strength": strength, "Color": color}, space=space, **settings)
            for strength, color in ((1.0, PAINT), (0.4, PAINT), (1.7, (0.6, 0.3, 0.9, 1.0)))
        ]

    def bump(**inputs: Any) -> MakeTree:
        invert = bool(inputs.pop("invert", False))
        return shader_node("Bump", {"Height": SMOOTH_HEIGHT, **inputs}, invert=invert)

    def direction(node: Any) -> None:
        node.outputs["Normal"].default_value = (0.36, 0.48, 0.8)

    bumped = bump(Strength=0.6)
    return [
        *rows(
            "Normal Map",
            ("Tangent space", [*normal_map("TANGENT"), *normal_map("TANGENT", uv_map="Other")]),
            ("Tangent space, DirectX", normal_map("TANGENT", convention="DIRECTX")),
            *(
                (f"{space.replace('_', ' ').capitalize()} space", normal_map(space))
                for space in ("OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD")
            ),
        ),
        *rows(
            "Bump",
            ("", [bump(), bump(Strength=0.5, Distance=2.0), bump(Height=DAMP)]),
            ("Inverted", bump(invert=True, Distance=0.5)),
            ("Chained", [bump(Normal=bumped, Height=UP), bump(Normal=shader_node("NormalMap", {"Color": PAINT}))]),
            ("Of UV", bump(Height=shader_node("Math", {0: split(UV, "Y")}, operation="SINE"), Distance=0.3)),
        ),
        *rows(
            "Normal",
            ("", [shader_node("Normal", {0: WIND}, output, direction) for output in ("Normal", "Dot")]),
        ),
        *rows(
            "Displacement",
            *(
                (
                    f"{space.capitalize()} space",
                    shader_node("Displacement", {"Height": ACROSS, "Midlevel": 0.25, "Scale": 0.5}, space=space),
                )
                for space in ("OBJECT", "WORLD")
            ),
        ),
        *rows(
            "Vector Displacement",
            *(
                (
                    f"{space.capitalize()} space",
                    shader_node("VectorDisplacement", {"Vector": PAINT, "Midlevel": 0.25, "Scale": 0.5}, space=space),
                )
                for space in ("TANGENT", "OBJECT", "WORLD")
            ),
        ),
        *rows(
            "Radial Tiling",
            *(
                (
                    "Normalized" if normalize else "Not normalized",
                    [
                        shader_node("RadialTiling", {0: WIND, 1: sides, 2: roundness}, k, normalize=normalize)
                        for k in range(4)
                        for sides, roundness in ((5.0, 0.0), (4.5, 0.3))
                    ],
                )
                for normalize in (True, False)
            ),
        ),
    ]


ROWS: list[Row] = [*_mapping(), *_rotations(), *_transforms(), *_normals()]
