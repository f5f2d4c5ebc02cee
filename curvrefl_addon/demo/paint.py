# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Pictures painted with numpy: wood, plaster, rug, landscape, beach ball. All sRGB floats, row 0 at the bottom."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..scene.arrays import Float32Array, Float64Array

type Tint = tuple[float, float, float]


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


def planks(
    width: int,
    height: int,
    rows: int,
    seed: int = 3,
    colors: tuple[Tint, Tint] = ((0.78, 0.57, 0.37), (0.47, 0.28, 0.15)),
) -> Float32Array:
    """(height, width, 4): `rows` wooden planks running along x, each cut once, with grain and dark joints, between a
    light and a dark color."""
    rng = np.random.default_rng(seed)
    image = np.ones((height, width, 4))
    light, dark = (np.array(color) for color in colors)
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


def chequer(size: int, cells: int, first: Tint, second: Tint) -> Float32Array:
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


def segments(width: int, height: int, colors: list[Tint]) -> Float32Array:
    """(height, width, 4): one upright stripe per color with white ends, as on a beach ball."""
    column = np.arange(width) * len(colors) // width
    image = np.ones((height, width, 4))
    image[..., :3] = np.array(colors)[column][None]
    cap = int(0.07 * height)
    image[:cap, :, :3] = image[-cap:, :, :3] = 0.93
    return image.astype(np.float32)


def plaster(size: int, color: Tint, seed: int = 11) -> Float32Array:
    """(size, size, 4): a wall painted by hand, a little cloudy at several scales."""
    rng = np.random.default_rng(seed)
    clouds = sum(
        smooth_noise(rng, (size, size), (cells, cells)) / weight for cells, weight in ((4, 1), (13, 2), (61, 4))
    )
    image = np.ones((size, size, 4))
    image[..., :3] = np.array(color) * (0.91 + 0.1 * clouds[..., None] / 1.75)
    return np.clip(image, 0.0, 1.0).astype(np.float32)


def rug(width: int, height: int) -> Float32Array:
    """(height, width, 4): rhombs in rows between borders, with the grain of threads."""
    rng = np.random.default_rng(5)
    red, cream, blue, ocher = ((0.52, 0.16, 0.13), (0.86, 0.79, 0.66), (0.14, 0.22, 0.33), (0.78, 0.52, 0.2))
    y, x = np.indices((height, width))
    u, v = x / width, y / height
    rhomb = np.abs((u * 6.0) % 1.0 - 0.5) + np.abs((v * 9.0) % 1.0 - 0.5)
    image = np.ones((height, width, 4))
    image[..., :3] = red
    for least, most, color in ((0.36, 0.46, cream), (0.16, 0.36, blue), (0.0, 0.16, ocher)):
        image[(rhomb >= least) & (rhomb < most), :3] = color
    edge = np.minimum(np.minimum(u, 1.0 - u) * width, np.minimum(v, 1.0 - v) * height) / min(width, height)
    for least, most, color in ((0.0, 0.035, cream), (0.035, 0.09, blue), (0.09, 0.11, ocher)):
        image[(edge >= least) & (edge < most), :3] = color
    threads = 0.86 + 0.09 * (y % 2)[..., None] + 0.05 * rng.random((height, width, 1))
    image[..., :3] *= threads
    return image.astype(np.float32)


def landscape(width: int, height: int) -> Float32Array:
    """(height, width, 4): hills one behind the other under a low sun, flat colors as of a print."""
    rng = np.random.default_rng(23)
    y, x = np.indices((height, width))
    u, v = x / width, y / height
    image = np.ones((height, width, 4))
    low, high = np.array([0.97, 0.8, 0.6]), np.array([0.62, 0.77, 0.8])
    image[..., :3] = low + (high - low) * v[..., None]
    disk = (u - 0.66) ** 2 * (width / height) ** 2 + (v - 0.66) ** 2 < 0.105**2
    image[disk, :3] = (0.93, 0.42, 0.24)
    hills = (
        (0.58, (0.55, 0.66, 0.68)),
        (0.46, (0.33, 0.5, 0.54)),
        (0.33, (0.2, 0.36, 0.4)),
        (0.18, (0.11, 0.23, 0.27)),
    )
    for level, color in hills:
        ridge = level + 0.28 * (smooth_noise(rng, (1, width), (1, 5))[0] - 0.5)
        ridge += 0.05 * (smooth_noise(rng, (1, width), (1, 17))[0] - 0.5)
        image[v < ridge[x], :3] = color
    border = (x < 0.09 * width) | (x > 0.91 * width) | (y < 0.09 * width) | (y > height - 0.09 * width)
    image[border, :3] = (0.93, 0.91, 0.86)
    return image.astype(np.float32)


def leaves(size: int) -> Float32Array:
    """(size, size, 4): a hedge or a lawn, by spots of light and dark green."""
    rng = np.random.default_rng(9)
    spots = sum(smooth_noise(rng, (size, size), (cells, cells)) for cells in (9, 31, 83)) / 3.0
    mix = np.clip(3.0 * (spots - 0.5) + 0.5, 0.0, 1.0)[..., None]
    image = np.ones((size, size, 4))
    image[..., :3] = np.array([0.13, 0.24, 0.08]) * (1.0 - mix) + np.array([0.52, 0.63, 0.25]) * mix
    return image.astype(np.float32)
