# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics of one scene, as the scene changes: maps of them for the points on lamps that sub-frames are lit from."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from time import perf_counter
from typing import Any

from ...pacing.pieces import outcome
from ...scene.arrays import UNLIMITED_BOUNCES, SceneArrays
from ...settings_table import Settings
from ..device.records import record_texture
from ..geometry.mesh_facts import MeshFactsCache
from ..indirect.indirect import Means
from ..lighting.lamps import is_soft
from ..paths.features import ALPHA, COAT, GLASS, ROUGH
from ..tracing.step import Limits, Surroundings
from ..tracing.tracer import PathTracer
from .casters import Casters, casters_of
from .corner_paths import SIDE, CornerPaths, Throw
from .left_out import not_followed
from .maps import CausticMap, thrown

MAPS_AT_REST = 8
"""Of a viewport, where they differ: what is seen is their mean"""
MOST_MAPS = 16
"""That are kept of a render, where there is one for each sub-frame"""
COARSE = 4096
"""Patches of the first map after a change, while things may move on"""
PARTS = ("instances", "meshes", "materials", "images", "lights", "world")
VALUES = ("reflectors", "origin", "most_bounces", "mirror_bounces", "transmission_bounces", "transparent_bounces")
"""Of a scene, which caustics depend on: other objects and other values are another scene"""
type Known = tuple[CausticMap, Any]
"""With its texture"""


@dataclass(frozen=True, slots=True)
class Thrower:
    """What maps are made by, beside what light between surfaces is found by."""

    means: Means
    mirrors: Mapping[int, int]
    """Numbers by the indices of their instances"""
    tracer: PathTracer | None


class Caustics:
    """Of one renderer. Where they are off, or nothing throws light, there are no maps."""

    def __init__(self, scene: SceneArrays, settings: Settings, facts: MeshFactsCache) -> None:
        self._scene, self._settings, self._facts = scene, settings, facts
        self._maps: dict[int, Known] = {}
        """By number; the one last made comes last"""
        self._coarse: Known | None = None
        self._is_stale = False
        """That is of what was"""
        self._wanted: int | None = None
        """How many differ; None: to be found"""
        self._casters: Casters | None = None
        self._paths: tuple[bool, CornerPaths] | None = None
        """And whether they are for materials' programs"""
        self._work: tuple[int, Generator[None, None, CausticMap]] | None = None
        """And the number of the map that it makes"""
        self._told: tuple[SceneArrays, tuple[str, ...]] | None = None
        """What is not followed in a state of the scene"""
        self.prepare_ms = 0.0
        """Of the last map that was made at once"""

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        before, self._scene = self._scene, scene
        is_same = all(getattr(scene, name) is getattr(before, name) for name in PARTS)
        if not is_same or any(getattr(scene, name) != getattr(before, name) for name in VALUES):
            # (What was serves a viewport until there is something else, unless it is elsewhere now.)
            shown = next(iter(self._maps.values()), self._coarse) if scene.origin == before.origin else None
            self.forget()
            self._coarse, self._is_stale = shown, True

    def configure(self, settings: Settings) -> None:
        """Be switched on or off, or finer."""
        before, self._settings = self._settings, settings
        asked = ("caustics", "caustic_patches", "bounces", "samples")
        if any(getattr(settings, name) != getattr(before, name) for name in asked):
            self.forget()

    def forget(self) -> None:
        """All maps are of what was."""
        self._maps.clear()
        self._work = self._coarse = self._wanted = self._casters = None
        if not self._settings.caustics:
            self._paths = None

    @property
    def is_thrown(self) -> bool:
        """There is a map to be looked up."""
        return bool(self._maps) or self._coarse is not None

    @property
    def is_settled(self) -> bool:
        """Nothing is left to make for a viewport."""
        if not self._settings.caustics:
            return True
        return self._wanted is not None and len(self._maps) >= min(self._wanted, MAPS_AT_REST)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is not followed, one sentence each."""
        if not self._settings.caustics:
            return ()
        if self._told is None or self._told[0] is not self._scene:
            self._told = self._scene, not_followed(self._scene)
        return self._told[1]

    @property
    def state(self) -> str:
        """For a panel or a report."""
        if not self._settings.caustics:
            return "off"
        if self._wanted == 0:
            return "none: no lamp, or nothing sharp that throws its light"
        if not self.is_thrown:
            return "to be found"
        known = next(reversed(self._maps.values())) if self._maps else self._coarse
        assert known is not None
        counted = f"{known[0].patches:,} patches of mirrors and glass, {known[0].pieces:,} pieces of light"
        return counted if self.is_settled else f"{counted}, not settled"

    def prepare(self, by: Thrower, sub_frame: int) -> bool:
        """Make the map of a sub-frame; returns whether it is the first, by which pictures are others."""
        wanted = self._found_wanted(by)
        if wanted == 0:
            was, self._coarse = self._coarse, None
            return was is not None
        if (number := sub_frame % wanted) in self._maps:
            return False
        start = perf_counter()
        self._keep(number, outcome(self._making(by, number, self._settings.caustic_patches)))
        self.prepare_ms = 1e3 * (perf_counter() - start)
        return len(self._maps) == 1

    def advance(self, by: Thrower, seconds: float) -> bool:
        """Make maps for about so long, a step at least; returns whether pictures are others by it: with a first coarse
        map after a change, with the first fine one, and with the last."""
        if self._found_wanted(by) == 0:
            was, self._coarse = self._coarse, None
            return was is not None
        if not self._maps and (self._coarse is None or self._is_stale):
            self._work, self._is_stale = None, False
            self._coarse = _stored(outcome(self._making(by, 0, COARSE, rounds=0)))
            return True
        end = perf_counter() + seconds
        while not self.is_settled:
            if self._work is None:
                number = next(number for number in range(MOST_MAPS) if number not in self._maps)
                self._work = number, self._making(by, number, self._settings.caustic_patches)
            try:
                next(self._work[1])
            except StopIteration as done:
                self._keep(self._work[0], done.value)
                self._work = None
                if len(self._maps) == 1 or self.is_settled:
                    return True
            if perf_counter() >= end:
                break
        return False

    def bind(self, shader: Any, sub_frame: int) -> None:
        """See `ThrownLight`."""
        known = self._coarse
        if self._maps:
            wanted = self._wanted or 1
            numbers = list(self._maps)
            known = self._maps.get(sub_frame % wanted, self._maps[numbers[sub_frame % len(numbers)]])
        assert known is not None
        shader.uniform_sampler("thrown", known[1])

    def _found_wanted(self, by: Thrower) -> int:
        """How many maps differ: one for each sub-frame where lamps are soft, or light goes one way or another by
        chance."""
        if not self._settings.caustics:
            return 0
        if self._wanted is None:
            lamps = by.means.lighting.lamp_points(0)
            self._casters = casters_of(self._scene, by.mirrors, self._facts) if lamps else None
            differ = _is_by_chance(by.tracer) or any(is_soft(light) for light, _ in lamps)
            self._wanted = 0 if self._casters is None else by.means.lighting.sub_frames if differ else 1
        return self._wanted

    def _keep(self, number: int, made: CausticMap) -> None:
        self._maps[number] = _stored(made)
        while len(self._maps) > MOST_MAPS:
            del self._maps[next(iter(self._maps))]

    def _making(self, by: Thrower, number: int, patches: int, rounds: int = 2) -> Generator[None, None, CausticMap]:
        assert self._casters is not None
        means = by.means
        has_programs = means.materials.has_programs
        if self._paths is None or self._paths[0] != has_programs:
            self._paths = has_programs, CornerPaths(has_programs)
        window = (0, 0, SIDE, SIDE)
        if by.tracer is not None:
            around = by.tracer.surroundings(means.rays(), means.view_uniforms, window)
        else:
            links = frozenset(means.materials.links)
            lighting = means.lighting
            around = Surroundings(
                links, means.materials, means.rays(), lighting.ggx, None, None, means.view_uniforms, window
            )
        throw = Throw(around, means.lighting, self._limits(by.tracer), number, number, _is_by_chance(by.tracer))
        lamps = means.lighting.lamp_points(number)
        return thrown(self._scene, self._casters, lamps, self._paths[1], throw, patches, rounds)

    def _limits(self, tracer: PathTracer | None) -> Limits:
        if tracer is not None:
            return tracer.limits(self._settings.bounces)
        reflections = min(self._settings.bounces, self._scene.mirror_bounces, self._scene.most_bounces)
        return Limits(reflections, 0, 0, min(reflections, UNLIMITED_BOUNCES))


def _is_by_chance(tracer: PathTracer | None) -> bool:
    """Whether surfaces may send light one way or another."""
    return tracer is not None and not tracer.features.isdisjoint({ROUGH, COAT, GLASS, ALPHA})


def _stored(made: CausticMap) -> Known:
    return made, record_texture(made.records)
