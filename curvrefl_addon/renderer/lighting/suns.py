# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Suns in a world image, taken out of it as lamps: they get sharp shadows and highlights. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ...scene.arrays import Float64Array, LightArrays, WorldArrays

BRIGHT = 20.0
"""A sun is brighter than this many times the mean of the sky"""
LEAST_SHARE = 0.01
"""and gives at least this share of its light"""
MOST_SUNS = 4
WIDEST = np.radians(4.0)
"""Angular radius of what is one sun"""


@dataclass(frozen=True, slots=True)
class Sky:
    """A world in two parts that add up to it."""

    world: WorldArrays
    """Where the suns were, no brighter than `limit`"""
    suns: tuple[LightArrays, ...]
    """SUN lamps that no mirror sees: the image shows them"""
    limit: float
    """Greatest sum of red, green and blue of the world's radiance that is not a sun's; infinite without suns"""


_last: list[tuple[WorldArrays, Sky]] = []


def split_suns(world: WorldArrays) -> Sky:
    """Find the suns of the world. The last two worlds' are kept, so that its image stays the same object."""
    if world.image is None:
        return Sky(world, (), np.inf)
    for known, sky in _last:
        if is_same_world(known, world):
            return sky
    sky = _split(world)
    _last[:] = [(world, sky), *_last[:1]]
    return sky


def suns_of_kinds(glossy: Sky, diffuse: Sky) -> tuple[LightArrays, ...]:
    """The suns of the world as mirrors show it and as it lights diffuse parts: often the same."""
    if diffuse is glossy:
        return glossy.suns
    of_glossy = tuple(replace(sun, lights_diffuse=False) for sun in glossy.suns)
    return of_glossy + tuple(replace(sun, lights_glossy=False) for sun in diffuse.suns)


def shines(world: WorldArrays, is_asked: bool) -> bool:
    """Whether it gives light where that is asked for."""
    return is_asked and max(world.color) > 0.0 and (world.image is None or bool(world.image.any()))


def is_same_world(one: WorldArrays, other: WorldArrays) -> bool:
    """Whether they shine alike and for the same rays."""
    plain = [item.name for item in fields(WorldArrays) if item.name not in ("image", "rotation", "program")]
    return (
        one.image is other.image
        and one.program is other.program
        and np.array_equal(one.rotation, other.rotation)
        and all(getattr(one, name) == getattr(other, name) for name in plain)
    )


def _split(world: WorldArrays) -> Sky:
    assert world.image is not None
    color = np.asarray(world.color, np.float64)
    height, width = world.image.shape[:2]
    solid_angles = 4.0 * np.pi * _row_shares(height)[:, None] / width
    brightness = world.image @ color.astype(np.float32)
    total = float((brightness * solid_angles).sum())
    limit = BRIGHT * total / (4.0 * np.pi)
    rows, columns = np.nonzero(brightness > limit)
    if len(rows) == 0:
        return Sky(world, (), np.inf)
    directions = _directions(rows, columns, height, width) @ world.rotation
    excess = 1.0 - limit / brightness[rows, columns]
    power = world.image[rows, columns] * color * (excess * solid_angles[rows, 0])[:, None]
    left = np.ones(len(rows), bool)
    image = world.image.copy()
    suns: list[LightArrays] = []
    while left.any() and len(suns) < MOST_SUNS:
        brightest = directions[np.argmax(np.where(left, power.sum(axis=1), -1.0))]
        near = left & (directions @ brightest > np.cos(WIDEST))
        middle = power[near].sum(axis=1) @ directions[near]  # the brightest texel may lie at the sun's rim
        members = near | (left & (directions @ middle > np.cos(WIDEST) * np.linalg.norm(middle)))
        left &= ~members
        if power[members].sum() < LEAST_SHARE * total:
            continue
        suns.append(_sun(world, directions[members], power[members], len(suns)))
        where = rows[members], columns[members]
        image[where] *= (1.0 - excess[members])[:, None]
    if not suns:
        return Sky(world, (), np.inf)
    return Sky(replace(world, image=image), tuple(suns), limit)


def _sun(world: WorldArrays, directions: Float64Array, power: Float64Array, number: int) -> LightArrays:
    """A SUN lamp of the world with the power (n, 3), the middle and the spread of these directions."""
    energy = power.sum(axis=1)
    middle = energy @ directions
    middle /= np.linalg.norm(middle)
    spread = np.sqrt(float(energy @ ((directions - middle) ** 2).sum(axis=1)) / energy.sum())
    helper = np.eye(3)[int(np.argmin(np.abs(middle)))]
    right = np.cross(helper, middle)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack([right, np.cross(middle, right), middle])
    red, green, blue = power.sum(axis=0)
    return LightArrays(
        f"sun {number + 1} of the world",
        "SUN",
        (float(red), float(green), float(blue)),
        matrix,
        # an even disk's root mean square distance from its middle is its radius over the root of 2
        angle=2.0 * np.sqrt(2.0) * spread,
        visible_camera=False,
        visible_glossy=False,
        lights_diffuse=world.visible_diffuse,
        lights_glossy=world.visible_glossy,
    )


def _row_shares(height: int) -> Float64Array:
    """(height,) share of the sphere of each row of an equirectangular image."""
    edges = np.sin(np.pi * (np.arange(height + 1) / height - 0.5))
    return 0.5 * np.diff(edges)


def _directions(rows: np.ndarray, columns: np.ndarray, height: int, width: int) -> Float64Array:
    """(n, 3) image directions of these texels, as `lighting_world.image_directions`."""
    azimuth = -(2.0 * np.pi) * ((columns + 0.5) / width - 0.5)
    elevation = np.pi * ((rows + 0.5) / height - 0.5)
    flat = np.cos(elevation)
    return np.column_stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])
