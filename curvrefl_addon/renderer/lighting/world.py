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

from ...scene.arrays import Float32Array, Float64Array, WorldArrays
from ...scene.materials.pixels import averaged
from .ggx import own_lobe
from .suns import is_same_world

MAP_SIZE = 64
"""Texels along an octahedral map"""
ROUGHNESS_LEVELS = (0.2, 0.35, 0.5, 0.65, 0.8, 1.0)
"""Of the maps of the glossy lobe: evenly spaced but for the last"""
LOBE_LAYER = 2
"""First layer of the glossy lobe's maps"""
WORLD_DEFINES = {
    "WORLD_MAP_SIZE": float(MAP_SIZE),
    "WORLD_MAP_LOBES": LOBE_LAYER,
    "LOBE_FIRST": ROUGHNESS_LEVELS[0],
    "LOBE_STEP": round(ROUGHNESS_LEVELS[1] - ROUGHNESS_LEVELS[0], 6),
    "LOBE_STEPS": float(len(ROUGHNESS_LEVELS) - 2),
    "LOBE_LAST_BUT_ONE": ROUGHNESS_LEVELS[-2],
    "LOBE_LAST_STEP": round(ROUGHNESS_LEVELS[-1] - ROUGHNESS_LEVELS[-2], 6),
}
"""What `world_light.glsl` knows of the maps"""
SMALLEST_PATCH = np.radians(1.5)


@dataclass(frozen=True, slots=True)
class WorldLight:
    """Everything in world directions (not the image's)."""

    directions: Float64Array
    """(d, 3) unit, towards the light: one shadow map each"""
    draws: np.ndarray
    """(k,) indices into `directions`, the bright ones several times; any few in a row stand for the whole sky"""
    weights: Float64Array
    """(k, 3) radiance times solid angle of each draw; sums to the integral over the sphere"""
    maps: Float32Array
    """(2 + levels, MAP_SIZE, MAP_SIZE, 4), octahedral: irradiance by normal; that over the irradiance from the draws;
    per roughness level the radiance that the lobe about a reflected direction sees, with the draws' sum (red, green and
    blue) under `lobe_window` as alpha"""


def lobe_window(cosine: np.ndarray) -> np.ndarray:
    """How much a direction's shadow counts for a glossy lobe at this cosine to it, here and in the shader.

    Wide enough (half at 33 degrees) to hold several of the directions, whatever the lobe.
    """
    return np.maximum(cosine, 0.0) ** 4


_last: list[tuple[WorldArrays, WorldArrays, int, WorldLight]] = []


def world_light(world: WorldArrays, count: int, diffuse: WorldArrays | None = None) -> WorldLight:
    """`count` draws from the sky, and its maps. `diffuse`: what lights diffuse parts, where that is another one; then
    both have images. The last two worlds' are kept: scenes change more often, and a render may run beside the
    viewports."""
    diffuse = diffuse or world
    for known, known_diffuse, known_count, light in _last:
        if known_count == count and is_same_world(known, world) and is_same_world(known_diffuse, diffuse):
            return light
    sky = _Sky.of(world, 64)
    coarse = even = _Sky.of(world, 32)
    drawn = sky
    if diffuse is not world:
        even, fine = _Sky.of(diffuse, 32), _Sky.of(diffuse, 64)
        # (Where only mirrors see the world, its directions are for their lobes alone.)
        drawn = fine if fine.power.any() else sky
    normals = octahedral_directions(MAP_SIZE).reshape(-1, 3).astype(np.float32)
    directions, draws, weights = _uniform(world, count) if world.image is None else _by_power(drawn, count)
    if world.image is None:
        irradiance = np.tile(np.pi * np.asarray(world.color, np.float64), (len(normals), 1))
        lobes = [np.tile(np.asarray(world.color, np.float64), (len(normals), 1))] * len(ROUGHNESS_LEVELS)
    else:
        irradiance = np.maximum(normals @ even.directions.T.astype(np.float32), 0.0) @ even.power
        lobes = [
            _lobe_radiance(sky if roughness < 0.3 else coarse, roughness, normals) for roughness in ROUGHNESS_LEVELS
        ]
    by_draws = np.maximum(normals @ directions[draws].T.astype(np.float32), 0.0) @ weights
    ratio = np.ones_like(by_draws)
    np.divide(irradiance, by_draws, out=ratio, where=by_draws > 0.0)
    layers = np.stack([irradiance, np.clip(ratio, 0.0, 4.0), *lobes])
    window = lobe_window(normals @ directions[draws].T.astype(np.float32)) @ weights.sum(axis=1)
    maps = np.ones((len(layers), MAP_SIZE, MAP_SIZE, 4), np.float32)
    maps[LOBE_LAYER:, ..., 3] = window.reshape(MAP_SIZE, MAP_SIZE)
    maps[..., :3] = layers.reshape(-1, MAP_SIZE, MAP_SIZE, 3)
    light = WorldLight(directions, draws, weights, maps)
    _last[:] = [(world, diffuse, count, light), *_last[:1]]
    return light


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
    """Unit directions (height, width, 3) of an equirectangular image's texels, row 0 lowest; solid angles (height,)."""
    azimuth = -(2.0 * np.pi) * ((np.arange(width) + 0.5) / width - 0.5)
    edges = np.pi * (np.arange(height + 1) / height - 0.5)
    elevation = 0.5 * (edges[1:] + edges[:-1])
    flat = np.cos(elevation)[:, None]
    directions = np.stack(
        [flat * np.cos(azimuth), flat * np.sin(azimuth), np.broadcast_to(np.sin(elevation)[:, None], (height, width))],
        axis=-1,
    )
    return directions, (np.sin(edges[1:]) - np.sin(edges[:-1])) * 2.0 * np.pi / width


@dataclass(frozen=True, slots=True)
class _Sky:
    """The sky in patches, world directions."""

    directions: Float64Array
    """(n, 3) unit, the middle of each patch's power"""
    solid_angles: Float64Array
    """(n,)"""
    power: Float64Array
    """(n, 3) radiance times solid angle"""

    @staticmethod
    def of(world: WorldArrays, height: int) -> _Sky:
        """`height` rows of patches, twice as many columns."""
        if world.image is None:
            pixels = np.broadcast_to(np.asarray(world.color, np.float64), (height, 2 * height, 3))
        else:
            pixels = averaged(world.image, height, 2 * height).astype(np.float64) * np.asarray(world.color)
        directions, solid = image_directions(*pixels.shape[:2])
        solid_angles = np.broadcast_to(solid[:, None], pixels.shape[:2]).ravel()
        power = pixels.reshape(-1, 3) * solid_angles[:, None]
        return _Sky((directions @ world.rotation).reshape(-1, 3), solid_angles, power)


def _uniform(world: WorldArrays, count: int) -> tuple[Float64Array, np.ndarray, Float64Array]:
    """Directions spread evenly (Sobol's first two dimensions on the sphere by equal areas), each drawn once."""
    first, second = _sobol(count)
    height = 1.0 - 2.0 * (first + 0.5 / count)
    turn = 2.0 * np.pi * second
    flat = np.sqrt(1.0 - height**2)
    directions = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height])
    weights = np.tile(4.0 * np.pi / count * np.asarray(world.color, np.float64), (count, 1))
    return directions, np.arange(count), weights


def _by_power(sky: _Sky, count: int) -> tuple[Float64Array, np.ndarray, Float64Array]:
    """Directions of patches of about equal power; what has more (a sun) is drawn several times."""
    energy = sky.power.sum(axis=1)
    groups = _median_cut(sky.directions, energy, max(count * 3 // 4, 1))
    directions = np.empty((len(groups), 3))
    weights = np.empty((len(groups), 3))
    for row, members in enumerate(groups):
        middle = (energy[members] + 1e-12) @ sky.directions[members]
        directions[row] = middle / max(float(np.linalg.norm(middle)), 1e-12)
        weights[row] = sky.power[members].sum(axis=0)
    times = _shares(weights.sum(axis=1), count)
    draws = np.repeat(np.arange(len(groups)), times)
    order = np.argsort(np.argsort(_sobol(count)[0]))
    return directions, draws[order], (weights / times[:, None])[draws[order]]


def _shares(energy: Float64Array, count: int) -> np.ndarray:
    """At least one each and `count` in all, else in proportion to `energy`."""
    times = np.ones(len(energy), np.int64)
    for _ in range(count - len(energy)):
        times[np.argmax(energy / times)] += 1
    return times


def _sobol(count: int) -> tuple[Float64Array, Float64Array]:
    """First two dimensions of Sobol's sequence; aligned runs of a power of two are stratified in both."""
    first, second = np.zeros(count), np.zeros(count)
    bits = max(int(count - 1).bit_length(), 1)
    direction = 1 << (bits - 1)
    columns = []
    for _ in range(bits):
        columns.append(direction)
        direction ^= direction >> 1
    for index in range(count):
        a = b = 0
        for bit in range(bits):
            if index >> bit & 1:
                a ^= 1 << (bits - 1 - bit)
                b ^= columns[bit]
        first[index], second[index] = a / (1 << bits), b / (1 << bits)
    return first, second


def _median_cut(directions: Float64Array, energy: Float64Array, count: int) -> list[np.ndarray]:
    """Cut the sky into `count` groups of indices: always the one with the most energy times extent, across its length.

    The groups come in the order of the tree of cuts, so neighbors in the list are neighbors on the sky.
    """

    def priority(members: np.ndarray) -> float:
        extent = float(np.linalg.norm(np.ptp(directions[members], axis=0)))
        return float(energy[members].sum()) * max(extent - SMALLEST_PATCH, 0.0)

    everything = np.arange(len(directions))
    # (-priority, place in the tree, width there, members)
    heap: list[tuple[float, float, float, np.ndarray]] = [(-priority(everything), 0.0, 1.0, everything)]
    done: list[tuple[float, float, float, np.ndarray]] = []
    while heap and len(heap) + len(done) < count:
        group = heapq.heappop(heap)
        value, place, width, members = group
        if value >= 0.0 or len(members) < 2:
            done.append(group)
            continue
        axis = int(np.argmax(np.ptp(directions[members], axis=0)))
        members = members[np.argsort(directions[members, axis], kind="stable")]
        running = np.cumsum(energy[members] + 1e-12)
        cut = int(np.clip(np.searchsorted(running, 0.5 * running[-1]), 1, len(members) - 1))
        for side, part in enumerate((members[:cut], members[cut:])):
            heapq.heappush(heap, (-priority(part), place + 0.5 * width * side, 0.5 * width, part))
    return [members for _, _, _, members in sorted(done + heap, key=lambda group: group[1])]


def _lobe_radiance(sky: _Sky, roughness: float, reflected: Float32Array) -> Float64Array:
    """Radiance (n, 3) seen by the GGX lobe about each reflected direction, normal and viewer along it.

    The split-sum's first factor (Karis, "Real Shading in Unreal Engine 4", 2013).
    """
    power = np.column_stack([sky.power, sky.solid_angles]).astype(np.float32)
    directions = sky.directions.T.astype(np.float32)
    result = np.empty((len(reflected), 4), np.float32)
    for start in range(0, len(reflected), 256):
        result[start : start + 256] = own_lobe(reflected[start : start + 256] @ directions, roughness) @ power
    return (result[:, :3] / np.maximum(result[:, 3:], 1e-30)).astype(np.float64)
