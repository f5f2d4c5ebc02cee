# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What rough, layered and glassy surfaces do to paths, against the same in double precision."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...optics.scattering.scatter import scatter
from ...scene.arrays import Float64Array, MaterialArrays, SceneArrays, WorldArrays
from ..device.context import gpu_cache
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.textures import texture_2d
from ..lighting.ggx import GGX_DEFINES, ggx_table
from ..paths.features import COAT, GLASS, ROUGH
from ..surfaces.materials import TABLE, Materials
from .cases import as_stored, directions
from .proof import Found, Work, drawn_square

SIDE = 24
"""Paths are a square of so many"""
MOST_OFF = 0.01
"""Of a path's direction, and of its weight and density in parts of themselves"""
OUTLIERS = 0.02
"""Share of the paths that may do anything: where a random number falls beside a chance rounding decides"""
MATERIALS = (
    MaterialArrays("metal", base_color=(0.8, 0.4, 0.1), metallic=1.0, roughness=0.3),
    MaterialArrays("lacquer", base_color=(0.2, 0.4, 0.1), roughness=0.5, coat_weight=0.8, coat_roughness=0.2),
    MaterialArrays("glass", base_color=(0.9, 0.8, 0.7), transmission=0.7, roughness=0.15, ior=1.45),
)


def prove_paths() -> Work:
    """One decision of each path, by random numbers that are not."""
    count = SIDE * SIDE
    ways = directions(2 * count)[:count]
    # (Those of the upper half.)
    viewers = as_stored(np.roll(ways, 131, axis=0))
    chances = as_stored((0.5 + np.arange(1, count + 1)[:, None] * np.array([0.8567, 0.7339, 0.6287, 0.5386])) % 1.0)
    number = np.arange(count) % len(MATERIALS)
    way, weight = _decided(viewers, number, chances)
    yield
    off = np.zeros(count)
    normal, tangent, table = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), ggx_table().astype(np.float64)
    for k, material in enumerate(MATERIALS):
        mine = number == k
        truth = scatter(material, normal, tangent, False, viewers[mine], chances[mine], table)
        differences = (
            np.abs(way[mine, :3] - truth.direction).max(axis=1),
            np.abs(way[mine, 3] - truth.pdf) / (truth.pdf + 0.01),
            (np.abs(weight[mine, :3] - truth.weight) / (truth.weight + 0.01)).max(axis=1),
            np.where(np.rint(weight[mine, 3]) == truth.kind, 0.0, np.inf),
        )
        off[mine] = np.max(differences, axis=0)
    off[np.isnan(off)] = np.inf
    return Found(float(np.sort(off)[: int(count * (1.0 - OUTLIERS))][-1]), MOST_OFF, "of a path's weight")


def _decided(viewers: Float64Array, number: np.ndarray, chances: Float64Array) -> list[np.ndarray]:
    """Both outputs (n, 4) of `scatter.frag.glsl`."""
    inputs = {"viewers": np.column_stack([viewers, number]), "randoms": chances}
    textures = {name: texture_2d(array.reshape(SIDE, SIDE, 4)) for name, array in inputs.items()}
    textures["materials"] = Materials(SceneArrays((), (), MATERIALS, (), (), WorldArrays())).table
    textures["lighting_ggx"] = texture_2d(ggx_table(), linear=True)
    return [found.reshape(-1, 4) for found in drawn_square(_shader(), SIDE, textures, 2)]


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "proof of paths",
        FULL_SCREEN,
        TABLE,
        Piece(
            samplers=named("FLOAT_2D", "lighting_ggx", "viewers", "randoms"),
            outputs=named("VEC4", "path_way", "path_weight"),
            defines={**GGX_DEFINES, **flags(ROUGH, COAT, GLASS)},
            fragment="proofs/scatter.frag.glsl",
        ),
    )
