# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps whose nodes say more than a color: maps by direction, or over an area lamp, which their light is multiplied by.

A map is a square: of an area lamp it is the lamp, of a spot the window of its cone, of all others octahedral over the
world's directions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....scene.arrays import Float32Array, Float64Array, LightArrays
from ....scene.materials.pixels import averaged
from ....scene.programs.emitting import QUADRATIC
from ...device.textures import texture_layers
from ...programs.instance_table import PLAIN_VALUES
from .bake import AREA, DISC, LAMP, LIGHTING, SPOT, Baker, Directions
from .world import DISC_SIZE

LOOK_SIZE = 256
"""Texels along a map"""
AREA_CELLS = 4
"""Along an area lamp, of what it lights with"""
EVEN_SIZE = 4
"""Of what does not differ with the direction"""
WIDEST_WINDOW = np.radians(150.0)
"""Spots with a wider cone have an octahedral map"""
LOOKS, FALLOFF = "LIGHTING_LOOKS", "LIGHTING_FALLOFF"
"""Features"""
SMALLEST_DIFFERENCE = 1e-4
LOOK_DEFINES = {"LOOK_SIZE": float(LOOK_SIZE)}


@dataclass(frozen=True, slots=True)
class BakedLamp:
    """A lamp without a program."""

    light: LightArrays
    """Its color has all that is the same everywhere"""
    lit: Float32Array | None = None
    """(LOOK_SIZE, LOOK_SIZE, 3) what its light is multiplied with"""
    seen: Float32Array | None = None
    """The same of what rays see of it; None where `lit` serves"""
    warnings: tuple[str, ...] = ()


class LampLooks:
    """All lamps of a scene, and their maps on the GPU."""

    def __init__(self) -> None:
        self._baked: dict[int, tuple[LightArrays, BakedLamp]] = {}
        self._texture: Any = None
        self._layers: dict[int, tuple[int, int]] = {}
        self.features: frozenset[str] = frozenset()
        self.warnings: tuple[str, ...] = ()

    def follow(
        self, lights: tuple[LightArrays, ...], suns: tuple[LightArrays, ...], sun_looks: tuple[Float32Array, ...]
    ) -> tuple[LightArrays, ...]:
        """These lamps without their programs, and the world's suns, with what rays see of them; what is the same object
        as last time stays one."""
        known, self._baked = self._baked, {}
        for light in lights:
            before = known.get(id(light))
            is_known = before is not None and before[0] is light
            self._baked[id(light)] = before if before is not None and is_known else (light, _baked(light))
        lamps = [baked for _, baked in self._baked.values()]
        times = LOOK_SIZE // DISC_SIZE
        for sun, look in zip(suns, sun_looks, strict=True):
            lamps.append(BakedLamp(sun, None, look.repeat(times, axis=0).repeat(times, axis=1)))
        looks: list[Float32Array] = []
        self._layers = {}
        for lamp in lamps:
            lit = seen = -1
            if lamp.lit is not None:
                lit = seen = len(looks)
                looks.append(lamp.lit)
            if lamp.seen is not None:
                seen = len(looks)
                looks.append(lamp.seen)
            self._layers[id(lamp.light)] = lit, seen
        self._texture = None
        if looks:
            layers = np.ones((len(looks), LOOK_SIZE, LOOK_SIZE, 4), np.float32)
            layers[..., :3] = looks
            self._texture = texture_layers(layers)
        falls = any(light.emitter is not None and _falls(light) for light in lights)
        self.features = frozenset(({LOOKS} if looks else set()) | ({FALLOFF} if falls else set()))
        self.warnings = tuple(dict.fromkeys(warning for lamp in lamps for warning in lamp.warnings))
        return tuple(lamp.light for lamp in lamps)

    def record(self, light: LightArrays) -> tuple[float, float, float, float]:
        """Of a lamp, for `lamps.glsl`: layers of its map and of what is seen of it (-1: none), its falloff (with 4: the
        map is octahedral), its smoothness."""
        lit, seen = self._layers.get(id(light), (-1, -1))
        falloff, smoothness = QUADRATIC, 0.0
        if light.emitter is not None and light.kind != "SUN":
            falloff, smoothness = light.emitter.falloff, light.emitter.smoothness
        return float(lit), float(seen), float(falloff + 4 * _is_octahedral(light)), smoothness

    def bind(self, shader: Any) -> None:
        """Set `look_samplers` on a bound shader."""
        if self._texture is not None:
            shader.uniform_sampler("lighting_looks", self._texture)


def look_samplers(features: frozenset[str]) -> dict[str, str]:
    """What `lamps.glsl` needs of them."""
    return {"lighting_looks": "FLOAT_2D_ARRAY"} if LOOKS in features else {}


def _falls(light: LightArrays) -> bool:
    emitter = light.emitter
    return emitter is not None and light.kind != "SUN" and (emitter.falloff != QUADRATIC or emitter.smoothness > 0.0)


def _is_octahedral(light: LightArrays) -> bool:
    return light.kind == "POINT" or (light.kind == "SPOT" and light.spot_angle > WIDEST_WINDOW)


def _baked(light: LightArrays) -> BakedLamp:
    emitter = light.emitter
    if emitter is None or emitter.program is None:
        return BakedLamp(light)
    program = emitter.program
    baker = Baker(program, emitter.images, _instance(light))
    differs = bool(program.sampled & {"position", "instance"} or program.images or program.attributes)
    directions = _directions(light, LOOK_SIZE if differs else EVEN_SIZE)
    # (Cycles tells lamps nothing of the rays, not even of those that see them.)
    lit = baker.bake(directions, LIGHTING)
    if light.kind == "SUN" or _is_even(lit):
        # (Of a sun the disc is small: its mean.)
        red, green, blue = (np.asarray(light.color) * lit.mean(axis=(0, 1))).tolist()
        return BakedLamp(replace(light, color=(red, green, blue)), warnings=baker.warnings)
    seen = None
    if light.kind == "AREA":
        # Each of the few places that light is looked up from stands for all about it.
        seen, times = lit, LOOK_SIZE // AREA_CELLS
        cells = averaged(lit, AREA_CELLS, AREA_CELLS).astype(np.float32)
        lit = cells.repeat(times, axis=0).repeat(times, axis=1)
    # (Another object, by which its layers are found.)
    return BakedLamp(replace(light), lit, seen, baker.warnings)


def _directions(light: LightArrays, size: int) -> Directions:
    x, y, back = (light.matrix[:3, k] for k in range(3))
    place = (float(light.matrix[0, 3]), float(light.matrix[1, 3]), float(light.matrix[2, 3]))
    if light.kind == "SUN":
        half = max(0.5 * light.angle, 1e-4)
        return Directions(DISC, EVEN_SIZE, EVEN_SIZE, np.stack([half * x, half * y, back]))
    if light.kind == "AREA":
        frame = np.stack([0.5 * light.size[0] * x, 0.5 * light.size[1] * y, -back])
        return Directions(AREA, size, size, frame, place)
    if _is_octahedral(light):
        return Directions(LAMP, size, size, np.stack([x, y, back]), place, light.radius if light.is_ball else 0.0)
    wide = np.tan(0.5 * light.spot_angle)
    frame = np.stack([wide * x, wide * np.cross(back, x), -back])
    return Directions(SPOT, size, size, frame, place, light.radius if light.is_ball else 0.0)


def _instance(light: LightArrays) -> Float64Array:
    """(records, 4) of `programs/instances.glsl`; generated coordinates are those of the object."""
    records = np.zeros((PLAIN_VALUES + 1, 4))
    records[0:3] = light.matrix[:3]
    records[3:6] = np.linalg.inv(light.matrix)[:3]
    records[6] = records[8] = 1.0
    return records


def _is_even(look: Float32Array) -> bool:
    return bool(np.ptp(look, axis=(0, 1)).max() <= SMALLEST_DIFFERENCE * max(float(np.abs(look).max()), 1e-12))
