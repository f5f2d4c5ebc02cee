# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps as the shader needs them: one point on each lamp per sub-frame, in Blender's units. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...scene.arrays import EVERY_SET, Float64Array, LightArrays, SceneArrays, WorldArrays
from ...scene.camera.sampling import is_progressive, progressive_points
from ..surfaces.light_sets import LINKED, SHADOWS_LINKED, links_of

LAMP_RECORDS = 13
"""vec4 records per lamp"""
LOOK_RECORD = 12
"""Which of them is `programs.lamps.LampLooks.record`"""
MAX_LAMPS = 32
"""Uniform blocks hold 16 KiB everywhere"""
LEAST_SPREAD = np.radians(1.0)
"""Cycles' own least angle of an area lamp's cone"""
SPOT, SUN, AREA, POINT = 1, 2, 3, 0
KINDS = {"POINT": POINT, "SPOT": SPOT, "SUN": SUN, "AREA": AREA}
LAMP_DEFINES = {
    "LAMP_RECORDS": LAMP_RECORDS,
    "MAX_LAMPS": MAX_LAMPS,
    **{f"LAMP_{name}": number for name, number in KINDS.items()},
}
"""What `lamps.glsl` knows of them"""


@dataclass(frozen=True, slots=True)
class LampSample:
    """One point (homogeneous, w = 0: direction to the sun) of a lamp."""

    place: Float64Array


def reach_into(lights: Iterable[LightArrays], low: Float64Array, high: Float64Array) -> bool:
    """Whether the body of a lamp, none of which is a sun, may be in a box from (3,) to (3,): by balls around them."""
    for light in lights:
        place = light.matrix[:3, 3]
        reach = 0.5 * float(np.hypot(*light.size)) if light.kind == "AREA" else light.radius
        if np.linalg.norm(np.maximum(low - place, place - high).clip(0.0)) <= reach:
            return True
    return False


def is_soft(light: LightArrays) -> bool:
    """Whether the lamp has an extent, so that its shadow has a half-shadow."""
    if light.kind == "SUN":
        return light.angle > 0.0
    if light.kind == "AREA":
        return max(light.size) > 0.0
    return light.radius > 0.0


def has_spread(light: LightArrays) -> bool:
    """Whether the lamp shines into a cone from each of its points."""
    return light.kind == "AREA" and light.spread < np.pi - 1e-4


def strongest(lights: Sequence[LightArrays]) -> tuple[list[LightArrays], tuple[str, ...]]:
    """As many lamps as shaders know, and a sentence where there are more."""
    shining = [light for light in lights if any(light.color)]
    if len(shining) <= MAX_LAMPS:
        return shining, ()
    shining.sort(key=lambda light: -sum(map(abs, light.color)))
    return shining[:MAX_LAMPS], (f"Only the {MAX_LAMPS} strongest of {len(shining)} lamps are used.",)


def lamp_features(lights: Sequence[LightArrays], world: WorldArrays, scene: SceneArrays) -> set[str]:
    """Defines of `lamps.glsl` but for those of shadow maps: what lamps there are, and what they and the world light."""
    found = {f"LIGHTING_{light.kind}" for light in lights}
    parts = [(light.lights_diffuse, light.lights_glossy) for light in lights]
    parts.append((world.visible_diffuse, world.visible_glossy and world.visible_camera))
    flagged = {
        "LIGHTING_SPREAD": any(has_spread(light) for light in lights),
        "LIGHTING_BALLS": any(light.is_ball for light in lights),
        "LIGHTING_PARTS": not all(map(all, parts)),
    }
    return found | {name for name, is_so in flagged.items() if is_so} | links_of(scene)


def knows_links(features: frozenset[str]) -> bool:
    """Whether there are `link_records`."""
    return not features.isdisjoint({LINKED, SHADOWS_LINKED})


def link_records(lights: Sequence[LightArrays]) -> Float64Array:
    """(MAX_LAMPS, 4): of each lamp bits of the light sets that it lights, and of the shadow sets in its light's way."""
    records = np.zeros((MAX_LAMPS, 4))
    for record, light in zip(records, lights, strict=False):
        record[:2] = light.lights_on, light.blocked_by
    return records


def lamp_points(light: LightArrays, count: int, seed: int) -> Float64Array:
    """(count, 4) homogeneous points spread evenly over the lamp; its middle for a count of 1 or a hard lamp.

    Balls are sampled so that they look like an even disk from every side, as Cycles' soft-falloff lamps.
    """
    matrix = light.matrix
    x, y, back, center = (matrix[:3, k] for k in range(4))
    weight = 0.0 if light.kind == "SUN" else 1.0
    if count == 1 or not is_soft(light):
        middle = back if light.kind == "SUN" else center
        return np.tile(np.append(middle, weight), (1, 1))
    # half of the points; the rest lie opposite
    half = (count + 1) // 2
    u, v, w = _half_square(half, seed)
    if light.kind == "AREA" and not light.ellipse:
        offsets = 0.5 * np.column_stack([u - 1.0, 2.0 * v - 1.0]) * light.size @ np.stack([x, y])
    elif light.kind == "AREA":
        offsets = 0.5 * _half_disk(u, v) * light.size @ np.stack([x, y])
    elif light.kind == "SUN":
        offsets = np.tan(0.5 * min(light.angle, 3.1)) * _half_disk(u, v) @ np.stack([x, y])
        center = back
    else:
        offsets = light.radius * _half_ball(u, v, w)
    offsets = np.stack([offsets, -offsets], axis=1).reshape(-1, 3)[:count]
    places = center + offsets
    if light.kind == "SUN":
        places /= np.linalg.norm(places, axis=1, keepdims=True)
    return np.column_stack([places, np.full(count, weight)])


def lamp_records(light: LightArrays, place: Float64Array, spacing: float) -> Float64Array:
    """(LAMP_RECORDS, 4) of a lamp lit from `place`; the shadow's records stay 0 (filled by Lighting).

    `spacing`: how many samples share the lamp's extent, for the width of highlights.
    """
    records = np.zeros((LAMP_RECORDS, 4))
    matrix = light.matrix
    x, y, back, center = (matrix[:3, k] for k in range(4))
    color = np.asarray(light.color, np.float64)
    kind = KINDS[light.kind]
    extent = light.radius
    records[0] = [*place[:3], kind]
    records[2] = [*(back if kind == SUN else center), light.radius]
    records[3, :3] = -back
    records[4, :3], records[5, :3] = x, y
    records[5, 3] = float(light.visible_glossy)
    # (As in Cycles the camera sees no sun that has shadow linking.)
    is_seen = light.visible_camera and (kind != SUN or light.blocked_by == EVERY_SET)
    records[11, 1:] = float(light.lights_diffuse), float(light.lights_glossy), float(is_seen)
    if kind == SUN:
        half = 0.5 * light.angle
        # the whole sun gives `color` to a plane that faces its middle
        records[1, :3] = color * 2.0 / (1.0 + np.cos(half))
        if half > 0.0:
            records[6, :3] = color / (np.pi * np.sin(half) ** 2)
        records[3, 3] = np.cos(half)
        extent = np.sin(half)
    elif kind == AREA:
        area = light.size[0] * light.size[1] * (np.pi / 4.0 if light.ellipse else 1.0)
        records[1, :3] = color / np.pi  # radiance times area
        if area > 0.0:
            records[6, :3] = color / (np.pi * area)
        records[4, :3] *= 0.5 * light.size[0]
        records[5, :3] *= 0.5 * light.size[1]
        records[4, 3] = float(light.ellipse)
        records[2, 3] = np.sqrt(area / np.pi)
        extent = records[2, 3]
        if has_spread(light):
            half = 0.5 * max(light.spread, LEAST_SPREAD)
            records[3, 3] = np.tan(half)
            records[2, 3] = 1.0 / (np.tan(half) - half)
    else:
        records[1, :3] = color / (4.0 * np.pi)  # radiant intensity
        records[5, 0] = float(light.is_ball)
        if light.radius > 0.0:
            records[6, :3] = records[1, :3] / (np.pi * light.radius**2)
        if kind == SPOT:
            edge = np.cos(0.5 * light.spot_angle)
            records[3, 3] = edge
            records[4, 3] = 1.0 / max((1.0 - edge) * light.spot_blend, 1e-5)
    records[1, 3] = extent / np.sqrt(spacing)
    return records


def _half_square(count: int, seed: int) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Three times (count,) in 0..1, spread evenly: in the square of the first two, and in the third."""
    if is_progressive(2 * count):
        # (The middles of pairs are the lamp's: its halves are gone through alike.)
        square, more = (progressive_points(count, 2 * seed + item) for item in range(2))
        return square[:, 0], square[:, 1], more[:, 0]
    order = np.arange(count)
    u, w = ((step * order) % count for step in (1, 5))
    return (u + 0.5) / count, _half_sequence(count, seed), (w + 0.5) / count


def _half_sequence(count: int, seed: int) -> Float64Array:
    """(count,) van der Corput's sequence, shifted by `seed`; off 0 so that 1 minus it interleaves."""
    sequence = np.zeros(count)
    weight, rest = 0.5, np.arange(count)
    while np.any(rest > 0):
        sequence += weight * (rest & 1)
        rest >>= 1
        weight *= 0.5
    return (sequence + 0.25 / count + 0.5698402910 * seed) % 1.0


def _half_disk(u: Float64Array, v: Float64Array) -> Float64Array:
    """(n, 2) points of one half of the unit disk."""
    radius, turn = np.sqrt(u), np.pi * v
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])


def _half_ball(u: Float64Array, v: Float64Array, w: Float64Array) -> Float64Array:
    """(n, 3) points of one half of the unit ball, density 1 / sqrt(1 - r^2): along any axis an even disk. The
    directions by `u` and `v`, the radii by `w`."""
    radii = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, 257))
    share = (np.arcsin(radii) - radii * np.sqrt(1.0 - radii**2)) * 2.0 / np.pi
    height, turn = 1.0 - 2.0 * u, np.pi * v
    sine = np.sqrt(np.maximum(1.0 - height**2, 0.0))
    radius = np.interp(w, share, radii)
    return np.column_stack([sine * np.cos(turn), sine * np.sin(turn), height]) * radius[:, None]
