# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures that are computed."""

from __future__ import annotations

from typing import Any

from ..trees import DAMP, PAINT, PLACE, UP, UV, WIND, MakeTree, Row, rows, shader_node, split, stepped

DIMENSIONS = ("1D", "2D", "3D", "4D")


def _placed(dimensions: str, vector: MakeTree = PLACE) -> dict[str | int, Any]:
    """What is plugged into a texture of so many dimensions."""
    number = {"W": split(vector, "X") if dimensions == "1D" else 0.4}
    return {**({} if dimensions == "1D" else {"Vector": vector}), **(number if dimensions in ("1D", "4D") else {})}


def _noise() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    for kind in ("FBM", "MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"):
        for dimensions in DIMENSIONS:
            settings: dict[str, Any] = {"noise_dimensions": dimensions, "noise_type": kind}
            given = _placed(dimensions)
            more: dict[str | int, Any] = {}
            if kind not in ("FBM", "MULTIFRACTAL"):
                more["Offset"] = 0.3
            if kind in ("HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL"):
                more["Gain"] = 1.4
            trees = [
                shader_node("TexNoise", {**given, **more, "Scale": 1.5}, "Factor", **settings),
                shader_node(
                    "TexNoise",
                    {**given, **more, "Scale": 1.0, "Detail": 3.5, "Roughness": 0.7, "Lacunarity": 1.8},
                    "Color",
                    **settings,
                ),
                shader_node("TexNoise", {**given, **more, "Scale": 1.0, "Distortion": 0.5}, "Factor", **settings),
                shader_node(
                    "TexNoise", {**given, **more, "Scale": DAMP, "Detail": UP, "Roughness": DAMP}, "Color", **settings
                ),
            ]
            if kind == "FBM":
                trees += [
                    shader_node(
                        "TexNoise", {**given, "Scale": 1.5, "Distortion": 0.7}, output, normalize=False, **settings
                    )
                    for output in ("Factor", "Color")
                ]
            made.append((f"{kind.replace('_', ' ').lower()}, {dimensions}", trees))
    return rows("Noise Texture", *((mode[:1].upper() + mode[1:], trees) for mode, trees in made))


def _voronoi() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    for dimensions in DIMENSIONS:
        given = _placed(dimensions)
        position = "W" if dimensions == "1D" else "Position"
        for feature in ("F1", "F2", "SMOOTH_F1"):
            smooth: dict[str | int, Any] = {"Smoothness": 0.6} if feature == "SMOOTH_F1" else {}
            for distance in (
                ("EUCLIDEAN",) if dimensions == "1D" else ("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI")
            ):
                settings = {"voronoi_dimensions": dimensions, "feature": feature, "distance": distance}
                more = {**smooth, **({"Exponent": 0.8} if distance == "MINKOWSKI" else {})}
                trees = [
                    shader_node("TexVoronoi", {**given, **more, "Scale": 2.0, "Randomness": 0.8}, output, **settings)
                    for output in ("Distance", "Color", position)
                ]
                trees.append(
                    shader_node(
                        "TexVoronoi",
                        {**given, **more, "Scale": 1.5, "Detail": 1.5, "Roughness": 0.6, "Lacunarity": 2.2},
                        normalize=True,
                        **settings,
                    )
                )
                made.append((f"{feature}, {dimensions}, {distance.lower()}", trees))
        settings = {"voronoi_dimensions": dimensions, "feature": "DISTANCE_TO_EDGE"}
        made.append(
            (
                f"Distance to edge, {dimensions}",
                [
                    shader_node("TexVoronoi", {**given, "Scale": 2.0}, **settings),
                    shader_node("TexVoronoi", {**given, "Scale": 1.5, "Detail": 2.0}, normalize=True, **settings),
                ],
            )
        )
        made.append(
            (
                f"N-sphere radius, {dimensions}",
                shader_node(
                    "TexVoronoi",
                    {**given, "Scale": 2.0},
                    "Radius",
                    voronoi_dimensions=dimensions,
                    feature="N_SPHERE_RADIUS",
                ),
            )
        )
    return rows("Voronoi Texture", *made)


def _waves() -> list[Row]:
    made: list[tuple[str, list[MakeTree]]] = []
    for profile in ("SIN", "SAW", "TRI"):
        for kind, name, directions in (
            ("BANDS", "bands_direction", ("X", "Y", "Z", "DIAGONAL")),
            ("RINGS", "rings_direction", ("X", "Y", "Z", "SPHERICAL")),
        ):
            trees = [
                shader_node(
                    "TexWave",
                    {"Vector": PLACE, "Scale": 0.7, "Distortion": distortion, "Phase Offset": 0.6, "Detail": 1.5},
                    output,
                    wave_type=kind,
                    wave_profile=profile,
                    **{name: direction},
                )
                for direction in directions
                for distortion, output in ((0.0, "Color"), (1.5, "Factor"))
            ]
            made.append((f"{kind.capitalize()}, {profile.lower()}", trees))
    return rows("Wave Texture", *made)


def _patterns() -> list[Row]:
    def brick(inputs: dict[str | int, Any], output: str = "Color", **settings: Any) -> MakeTree:
        return shader_node("TexBrick", {"Vector": PLACE, "Scale": 2.0, **inputs}, output, **settings)

    def plain(kind: str, output: str, inputs: dict[str | int, Any], **settings: Any) -> MakeTree:
        return shader_node(kind, {"Vector": PLACE, **inputs}, output, **settings)

    colors = {"Color1": PAINT, "Color2": (0.2, 0.1, 0.8, 1.0)}
    return [
        *rows(
            "Brick Texture",
            (
                "",
                [
                    brick({**colors, "Mortar": (1.0, 1.0, 0.2, 1.0)}),
                    brick({"Mortar Smooth": 0.8, "Mortar Size": 0.06, "Bias": -0.3}, "Factor"),
                    brick({**colors, "Brick Width": 0.7, "Row Height": 0.3}, offset=0.3, offset_frequency=3),
                    brick({"Mortar Smooth": 0.4, "Mortar Size": 0.1}, squash=0.6, squash_frequency=2),
                    shader_node("TexBrick", {"Vector": UV, "Scale": 3.0, "Mortar Size": DAMP}),
                ],
            ),
        ),
        *rows(
            "Checker Texture",
            ("", [plain("TexChecker", output, {**colors, "Scale": 3.3}) for output in ("Color", "Factor")]),
        ),
        *rows(
            "Magic Texture",
            *(
                (
                    f"Depth {depth}",
                    [
                        plain("TexMagic", output, {"Scale": 1.2, "Distortion": 1.4}, turbulence_depth=depth)
                        for output in ("Color", "Factor")
                    ],
                )
                for depth in (0, 1, 2, 3, 4, 6, 10)
            ),
        ),
        *rows(
            "Gradient Texture",
            *(
                (
                    kind.replace("_", " ").capitalize(),
                    [
                        plain("TexGradient", output, {"Vector": vector}, gradient_type=kind)
                        for output, vector in (("Color", PLACE), ("Factor", WIND))
                    ],
                )
                for kind in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")
            ),
        ),
        *rows(
            "White Noise Texture",
            *(
                (
                    dimensions,
                    [
                        shader_node(
                            "TexWhiteNoise", _placed(dimensions, stepped(UV)), output, noise_dimensions=dimensions
                        )
                        for output in ("Value", "Color")
                    ],
                )
                for dimensions in DIMENSIONS
            ),
        ),
        *rows(
            "Gabor Texture",
            *(
                (
                    f"{kind}, {output.lower()}",
                    [
                        plain(
                            "TexGabor",
                            output,
                            {"Scale": 1.5, "Frequency": 1.8, "Anisotropy": anisotropy, "Orientation": orientation},
                            gabor_type=kind,
                        )
                        for anisotropy in (1.0, 0.4)
                    ],
                )
                for kind, orientation in (("2D", 0.5), ("3D", (0.3, 0.5, 0.8)))
                for output in ("Value", "Phase", "Intensity")
            ),
        ),
    ]


ROWS: list[Row] = [*_noise(), *_voronoi(), *_waves(), *_patterns()]
