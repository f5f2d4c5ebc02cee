# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A world's program as images: what the camera sees, what mirrors show, what lights diffuse parts; and its suns."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....scene.arrays import Float32Array, Float64Array, LightArrays, WorldArrays
from ....scene.programs.emitting import SunDisc
from .bake import CAMERA, DIFFUSE, DISC, GLOSSY, TRANSMISSION, Baker, Directions, sky_directions

WIDTH = 2048
"""Pixels around of the image of a program"""
MOST_WIDTH = 4096
"""Where its own images have more"""
EVEN_WIDTH = 128
"""Of one whose color is the same everywhere"""
PROBE_WIDTH = 128
"""Of what only tells whether two kinds of rays see the same"""
DISC_SIZE = 64
SMALLEST_DIFFERENCE = 1e-4
"""Of what two kinds of rays see, as a share of the brightest"""


@dataclass(frozen=True, slots=True)
class BakedWorld:
    """A world without a program, by kinds of rays; the same object where two see the same."""

    seen: WorldArrays
    """By the camera"""
    glossy: WorldArrays
    """By mirrors and glossy parts"""
    diffuse: WorldArrays
    suns: tuple[LightArrays, ...] = ()
    """In addition, seen as well"""
    looks: tuple[Float32Array, ...] = ()
    """(DISC_SIZE, DISC_SIZE, 3) of each sun: what rays see of it, over its mean"""
    warnings: tuple[str, ...] = ()


_last: list[tuple[WorldArrays, BakedWorld]] = []


def baked_world(world: WorldArrays) -> BakedWorld:
    """The images of a world's program; the last two worlds' are kept."""
    if world.emitter is None:
        return BakedWorld(world, world, world)
    for known, baked in _last:
        if known is world:
            return baked
    found = _bake(world)
    _last[:] = [(world, found), *_last[:1]]
    return found


def _bake(world: WorldArrays) -> BakedWorld:
    emitter = world.emitter
    assert emitter is not None and emitter.program is not None
    program = emitter.program
    baker = Baker(program, emitter.images)
    probe = sky_directions(PROBE_WIDTH)
    is_by_ray = "ray" in program.sampled
    kinds = (GLOSSY, CAMERA, DIFFUSE, TRANSMISSION)
    probed = {kind: baker.bake(probe, kind) for kind in (kinds if is_by_ray else kinds[:1])}
    others = {kind for kind in probed if not _is_same(probed[kind], probed[GLOSSY])}
    differs = [kind for kind in (CAMERA, DIFFUSE) if kind in others]
    plain = replace(world, emitter=None)
    width = max([WIDTH, *(min(2 * (image.width // 2), MOST_WIDTH) for image in emitter.images)])
    if "position" not in program.sampled and not program.images:
        width = 2
    images = {kind: _image(baker, width, kind) for kind in (GLOSSY, *differs)}
    needs_image = [kind for kind in (GLOSSY, DIFFUSE) if kind in images and len(images[kind]) > 1]
    worlds = {}
    for kind, image in images.items():
        if len(image) == 1 and not (kind != CAMERA and (needs_image or DIFFUSE in differs)):
            red, green, blue = image[0, 0].tolist()
            worlds[kind] = replace(plain, color=(red, green, blue))
        else:
            size = (EVEN_WIDTH // 2, EVEN_WIDTH, 3)
            worlds[kind] = replace(plain, image=np.broadcast_to(image, size).copy() if len(image) == 1 else image)
    suns = [sun for disc in emitter.discs for sun in _suns(world, baker, disc, (GLOSSY, *differs))]
    looks = tuple(look for _, look in suns)
    warnings = baker.warnings
    if TRANSMISSION in others:
        warnings += ("Through glass the world is drawn as mirrors show it.",)
    if DIFFUSE in differs:
        warnings += (
            "The world lights diffuse and glossy parts of surfaces as its Light Path nodes say; Cycles follows them "
            "for a part of its samples alone.",
        )
    return BakedWorld(
        worlds.get(CAMERA, worlds[GLOSSY]),
        worlds[GLOSSY],
        worlds.get(DIFFUSE, worlds[GLOSSY]),
        tuple(sun for sun, _ in suns),
        looks,
        warnings,
    )


def _is_same(one: Float32Array, other: Float32Array) -> bool:
    scale = max(float(np.abs(one).max()), float(np.abs(other).max()), 1e-12)
    return bool(np.abs(one - other).max() <= SMALLEST_DIFFERENCE * scale)


def _image(baker: Baker, width: int, kind: int) -> Float32Array:
    """(height, width, 3), of one pixel where all are the same."""
    pixels = baker.bake(sky_directions(width), kind, without_suns=True)
    return pixels[:1, :1] if (pixels == pixels[0, 0]).all() else pixels


def _suns(
    world: WorldArrays, baker: Baker, disc: SunDisc, kinds: tuple[int, ...]
) -> list[tuple[LightArrays, Float32Array]]:
    """Lamps for a disc, and how they look: one for all rays, or one for each kind."""
    middle = np.array(disc.direction)
    helper = np.array((0.0, 0.0, 1.0)) if abs(middle[2]) < 0.999 else np.array((0.0, 1.0, 0.0))
    right = np.cross(helper, middle)
    right /= np.linalg.norm(right)
    up = np.cross(middle, right)
    half = 0.5 * disc.angle
    frame = np.stack([half * right, half * up, middle])
    directions = Directions(DISC, DISC_SIZE, DISC_SIZE, frame)
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack([right, up, middle])
    found = []
    for kind in kinds:
        radiance, look = _disc_radiance(baker, directions, half, kind)
        red, green, blue = (np.pi * np.sin(half) ** 2 * radiance).tolist()
        if not radiance.any():
            continue
        by_glossy = kind == GLOSSY
        sun = LightArrays(
            "sun of the world",
            "SUN",
            (red, green, blue),
            matrix,
            angle=disc.angle,
            visible_camera=world.visible_camera and (kind == CAMERA or (by_glossy and CAMERA not in kinds)),
            visible_glossy=world.visible_glossy and by_glossy,
            lights_diffuse=world.visible_diffuse and (kind == DIFFUSE or (by_glossy and DIFFUSE not in kinds)),
            lights_glossy=world.visible_glossy and by_glossy,
        )
        found.append((sun, look))
    return found


def _disc_radiance(baker: Baker, directions: Directions, half: float, kind: int) -> tuple[Float64Array, Float32Array]:
    """(3,) mean over the disc of what the sun adds to the sky, and (DISC_SIZE, DISC_SIZE, 3) that over its mean."""
    more = baker.bake(directions, kind) - baker.bake(directions, kind, without_suns=True)
    steps = 2.0 * (np.arange(DISC_SIZE) + 0.5) / DISC_SIZE - 1.0
    radius = np.hypot(steps, steps[:, None])
    angle = radius * half
    weights = np.where(radius < 1.0, np.sin(angle) / np.maximum(angle, 1e-12), 0.0)
    mean = np.asarray((more * weights[..., None]).sum(axis=(0, 1)) / weights.sum(), np.float64)
    # Outside of the disc as on its rim, which is interpolated.
    inside = np.maximum(radius / (1.0 - 1.5 / DISC_SIZE), 1.0)
    rows, columns = (
        np.clip(((steps_here / inside + 1.0) * 0.5 * DISC_SIZE).astype(int), 0, DISC_SIZE - 1)
        for steps_here in np.meshgrid(steps, steps, indexing="ij")
    )
    look = more[rows, columns] / np.where(mean == 0.0, 1.0, mean)
    return mean, look.astype(np.float32)
