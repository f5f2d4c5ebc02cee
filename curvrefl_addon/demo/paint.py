# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Pictures painted with numpy: planks, a chequered floor, a beach ball. All sRGB floats, row 0 at the bottom."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..scene.arrays import Float32Array, Float64Array


def smooth_noise(rng: np.random.Generator, shape: tuple[int, int], cells: tuple[int, int]) -> Float64Array:
    """(height, width) of value noise in 0..1 that repeats at the edges, `cells` (rows, columns) of it."""
    lattice = rng.random(cells)

    def coordinates(size: int, count: int) -> tuple[np.ndarray, np.ndarray, Float64Array]:
        t = np.arange(size) / size * count
        low = t.astype(int)
        weight = t - low
        return low % count, (low + 1) % count, weight * weight * (3.0 - 2.0 * weight)

    y0, y1, wy = coordinates(shape[0], cells[0])
    x0, x1, wx = coordinates(shape[1], cells[1])
    lower = lattice[y0][:, x0] * (1.0 - wx) + lattice[y0][:, x1] * wx
    upper = lattice[y1][:, x0] * (1.0 - wx) + lattice[y1][:, x1] * wx
    return lower * (1.0 - wy)[:, None] + upper * wy[:, None]


def planks(width: int, height: int, rows: int, seed: int = 3) -> Float32Array:
    """(height, width, 4): `rows` wooden planks running along x, each cut once, with grain and dark joints."""
    rng = np.random.default_rng(seed)
    image = np.ones((height, width, 4))
    light, dark = np.array([0.78, 0.57, 0.37]), np.array([0.47, 0.28, 0.15])
    edges = np.linspace(0, height, rows + 1).astype(int)
    x = np.arange(width)
    for lower, upper in pairwise(edges):
        size = (upper - lower, width)
        cut = int(rng.integers(width))
        side = ((x - cut) % width < width // 2).astype(float)
        tone = rng.uniform(0.1, 0.9, 2)
        base = tone[0] * side + tone[1] * (1.0 - side)
        wave = smooth_noise(rng, size, (3, 6))
        rings = 0.5 + 0.5 * np.sin(2.0 * np.pi * (wave * 3.5 + np.linspace(0.0, 2.0, size[0])[:, None]))
        grain = smooth_noise(rng, size, (max(2, size[0] // 3), 12))
        mix = np.clip(base[None] * 0.75 + 0.28 * (rings - 0.5) + 0.3 * (grain - 0.5) + 0.05, 0.0, 1.0)[..., None]
        rows_color = light * (1.0 - mix) + dark * mix
        joint = np.ones(size)
        joint[:3] = joint[-2:] = 0.35
        for end in (cut, (cut + width // 2) % width):
            joint[:, [end, (end + 1) % width, (end + 2) % width]] = 0.35
        image[lower:upper, :, :3] = rows_color * joint[..., None]
    return image.astype(np.float32)


def chequer(
    size: int, cells: int, first: tuple[float, float, float], second: tuple[float, float, float]
) -> Float32Array:
    """(size, size, 4): `cells` x `cells` squares of two colors with thin joints and a little variation."""
    rng = np.random.default_rng(7)
    row, column = np.indices((size, size)) * cells // size
    odd = ((row + column) % 2)[..., None]
    image = np.ones((size, size, 4))
    tone = rng.uniform(0.93, 1.0, (cells, cells))[row, column][..., None]
    cloud = 1.0 - 0.08 * smooth_noise(rng, (size, size), (cells * 3, cells * 3))[..., None]
    image[..., :3] = (np.array(first) * (1 - odd) + np.array(second) * odd) * tone * cloud
    step = np.arange(size) * cells % size < cells * 2
    image[step, :, :3] *= 0.7
    image[:, step, :3] *= 0.7
    return image.astype(np.float32)


def segments(width: int, height: int, colors: list[tuple[float, float, float]]) -> Float32Array:
    """(height, width, 4): one upright stripe per color with white ends, as on a beach ball."""
    column = np.arange(width) * len(colors) // width
    image = np.ones((height, width, 4))
    image[..., :3] = np.array(colors)[column][None]
    cap = int(0.07 * height)
    image[:cap, :, :3] = image[-cap:, :, :3] = 0.93
    return image.astype(np.float32)
