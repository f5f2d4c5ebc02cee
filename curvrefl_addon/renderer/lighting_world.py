# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as a light: a few weighted directions for its shadows, and maps of what arrives without them. Pure numpy.

The directions stand for patches of the sky of about equal power, as Debevec's "A Median Cut Algorithm for Light
Probe Sampling" (2006), but a patch that is small on the sky already (a sun) is cut no further.
Maps over directions are octahedral: Cigolle et al., "Survey of Efficient Representations for Independent Unit
Vectors" (JCGT 2014), the border texels exactly on the fold.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from ..scene.arrays import Float32Array, Float64Array, WorldArrays

MAP_SIZE = 64
"""Texels along an octahedral map, as WORLD_MAP_SIZE in world_light.glsl"""
ROUGHNESS_LEVELS = (0.2, 0.35, 0.5, 0.65, 0.8, 1.0)
"""Of the maps of the glossy lobe, as in world_light.glsl"""
SMALLEST_PATCH = np.radians(1.5)


@dataclass(frozen=True, slots=True)
class WorldLight:
    """Everything in world directions (not the image's)."""

    directions: Float64Array
    """(k, 3) unit, towards the light"""
    weights: Float64Array
    """(k, 3) radiance times solid angle; sums to the integral over the sphere"""
    maps: Float32Array
    """(2 + levels, MAP_SIZE, MAP_SIZE, 4): irradiance by normal; irradiance over that of the directions; then per
    roughness level the radiance that the lobe about a reflected direction sees"""


def world_light(world: WorldArrays, count: int) -> WorldLight:
    """`count` directions and the maps of a world."""
    sky_directions, solid_angles, radiance = _sky(world)
    directions, weights = _quadrature(world, sky_directions, solid_angles, radiance, count)
    normals = octahedral_directions(MAP_SIZE).reshape(-1, 3)
    power = radiance * solid_angles[:, None]
    if world.image is None:
        irradiance = np.tile(np.pi * np.asarray(world.color), (len(normals), 1))
    else:
        irradiance = np.maximum(normals @ sky_directions.T, 0.0, dtype=np.float32) @ power
    by_directions = np.maximum(normals @ directions.T, 0.0) @ weights
    ratio = np.where(by_directions > 0.0, irradiance / np.maximum(by_directions, 1e-30), 1.0)
    layers = [irradiance, np.clip(ratio, 0.0, 4.0)]
    for roughness in ROUGHNESS_LEVELS:
        if world.image is None:
            layers.append(np.tile(np.asarray(world.color, np.float64), (len(normals), 1)))
        else:
            layers.append(_lobe_radiance(world, roughness, normals))
    maps = np.ones((len(layers), MAP_SIZE, MAP_SIZE, 4), np.float32)
    maps[..., :3] = np.stack(layers).reshape(len(layers), MAP_SIZE, MAP_SIZE, 3)
    return WorldLight(directions, weights, maps)


def octahedral_directions(size: int) -> Float64Array:
    """(size, size, 3) unit directions of the texels of an octahedral map, [row, column]; z from the middle down."""
    steps = np.linspace(-1.0, 1.0, size)
    x, y = np.meshgrid(steps, steps)
    z = 1.0 - np.abs(x) - np.abs(y)
    fold = np.maximum(-z, 0.0)
    x, y = x - np.copysign(fold, x), y - np.copysign(fold, y)
    directions = np.stack([x, y, z], axis=-1)
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def image_directions(height: int, width: int) -> tuple[Float64Array, Float64Array]:
    """Unit directions (height, width, 3) of an equirectangular image's texels, row 0 lowest, and solid angles (height,)."""
    azimuth = -(2.0 * np.pi) * ((np.arange(width) + 0.5) / width - 0.5)
    edges = np.pi * (np.arange(height + 1) / height - 0.5)
    elevation = 0.5 * (edges[1:] + edges[:-1])
    flat = np.cos(elevation)[:, None]
    directions = np.stack(
        [flat * np.cos(azimuth), flat * np.sin(azimuth), np.broadcast_to(np.sin(elevation)[:, None], (height, width))],
        axis=-1,
    )
    return directions, (np.sin(edges[1:]) - np.sin(edges[:-1])) * 2.0 * np.pi / width


def _shrunk(image: Float32Array, height: int) -> Float64Array:
    """The image averaged down to about `height` rows and twice as many columns, never up."""
    rows, columns = image.shape[0] // max(image.shape[0] // height, 1), image.shape[1] // max(
        image.shape[1] // (2 * height), 1
    )
    tall = np.add.reduceat(image, np.arange(rows) * image.shape[0] // rows, axis=0, dtype=np.float64)
    both = np.add.reduceat(tall, np.arange(columns) * image.shape[1] // columns, axis=1)
    row_counts = np.diff(np.append(np.arange(rows) * image.shape[0] // rows, image.shape[0]))
    column_counts = np.diff(np.append(np.arange(columns) * image.shape[1] // columns, image.shape[1]))
    return both / (row_counts[:, None, None] * column_counts[None, :, None])


def _sky(world: WorldArrays, height: int = 64) -> tuple[Float64Array, Float64Array, Float64Array]:
    """World directions (n, 3), solid angles (n,) and radiances (n, 3) of the sky's patches."""
    if world.image is None:
        pixels = np.broadcast_to(np.asarray(world.color, np.float64), (16, 32, 3))
    else:
        pixels = _shrunk(world.image, height) * np.asarray(world.color)
    directions, solid = image_directions(*pixels.shape[:2])
    solid_angles = np.broadcast_to(solid[:, None], pixels.shape[:2])
    return (directions @ world.rotation).reshape(-1, 3), solid_angles.ravel(), pixels.reshape(-1, 3).copy()


def _quadrature(
    world: WorldArrays, directions: Float64Array, solid_angles: Float64Array, radiance: Float64Array, count: int
) -> tuple[Float64Array, Float64Array]:
    """Directions and weights; neighbours in the list are far apart on the sky, so that any few in a row stand for all."""
    if world.image is None:
        index = np.arange(count) + 0.5
        height = 1.0 - 2.0 * index / count
        turn = np.pi * (1.0 + np.sqrt(5.0)) * index
        flat = np.sqrt(1.0 - height**2)
        chosen = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height])
        weights = np.tile(4.0 * np.pi / count * np.asarray(world.color, np.float64), (count, 1))
    else:
        power = radiance * solid_angles[:, None]
        groups = _median_cut(directions, power.sum(axis=1), count)
        chosen = np.empty((len(groups), 3))
        weights = np.empty((len(groups), 3))
        for row, members in enumerate(groups):
            energy = power[members].sum(axis=1) + 1e-12
            middle = energy @ directions[members]
            chosen[row] = middle / np.linalg.norm(middle)
            weights[row] = power[members].sum(axis=0)
    order = _spread_order(len(chosen))
    return chosen[order], weights[order]


def _spread_order(count: int) -> np.ndarray:
    """Permutation that steps through 0..count-1 by about the golden section."""
    step = max(int(round(count * 0.6180339887)), 1)
    while np.gcd(step, count) != 1:
        step += 1
    return (np.arange(count) * step) % count


def _median_cut(directions: Float64Array, energy: Float64Array, count: int) -> list[np.ndarray]:
    """Cut the sky into `count` groups of indices: always the one with the most energy times extent, across its length."""

    def priority(members: np.ndarray) -> float:
        extent = float(np.linalg.norm(np.ptp(directions[members], axis=0)))
        return energy[members].sum() * max(extent - SMALLEST_PATCH, 0.0)

    everything = np.arange(len(directions))
    heap: list[tuple[float, int, np.ndarray]] = [(-priority(everything), 0, everything)]
    done: list[np.ndarray] = []
    serial = 0
    while heap and len(heap) + len(done) < count:
        value, _, members = heapq.heappop(heap)
        if value >= 0.0 or len(members) < 2:
            done.append(members)
            continue
        axis = int(np.argmax(np.ptp(directions[members], axis=0)))
        members = members[np.argsort(directions[members, axis], kind="stable")]
        running = np.cumsum(energy[members] + 1e-12)
        cut = int(np.clip(np.searchsorted(running, 0.5 * running[-1]), 1, len(members) - 1))
        for part in (members[:cut], members[cut:]):
            serial += 1
            heapq.heappush(heap, (-priority(part), serial, part))
    return done + [members for _, _, members in sorted(heap, key=lambda item: item[1])]


def _lobe_radiance(world: WorldArrays, roughness: float, reflected: Float64Array) -> Float64Array:
    """Radiance (n, 3) seen by the GGX lobe about each reflected direction, normal and viewer along it.

    The split-sum's first factor (Karis, "Real Shading in Unreal Engine 4", 2013).
    """
    directions, solid_angles, radiance = _sky(world, 64 if roughness < 0.45 else 32)
    alpha2 = np.float32(roughness**4)
    power = np.column_stack([radiance * solid_angles[:, None], solid_angles]).astype(np.float32)
    result = np.empty((len(reflected), 4), np.float32)
    sky = directions.T.astype(np.float32)
    for start in range(0, len(reflected), 512):
        cosine = reflected[start : start + 512].astype(np.float32) @ sky
        kernel = (0.5 + 0.5 * cosine) * (alpha2 - np.float32(1.0)) + np.float32(1.0)
        np.square(kernel, out=kernel)
        np.divide(np.maximum(cosine, 0.0, out=cosine), kernel, out=kernel)
        result[start : start + 512] = kernel @ power
    return (result[:, :3] / np.maximum(result[:, 3:], 1e-30)).astype(np.float64)
