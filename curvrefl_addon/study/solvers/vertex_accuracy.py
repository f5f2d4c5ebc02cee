# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflection points of a scene's vertices against the oracle's, and what finding them takes.

The oracle works on a map of each reflector with `FINER` times the texels of the methods' own, so that what a method's
map leaves out of the shape counts as its error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ...optics import status
from ...optics.screen import Screen
from ...optics.surfaces.cube_map import CubeMapSurface, nearest_texel
from ...renderer.device.records import read_records
from ...renderer.mirrors.baked_shape import OPEN_LIMITS, BakedShape
from ...renderer.mirrors.mirror import Mirror
from ...renderer.mirrors.reflector_bake import bake_instance
from ...renderer.mirrors.reflector_map import ReflectorMap
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...renderer.surfaces.materials import Materials
from ...renderer.vertices.mirror_solver import MirrorSolver
from ...renderer.vertices.solution import SolvedChunk
from ...report.repeats import Timing, repeated
from ...scene.arrays import Float64Array, SceneArrays
from ...scene.camera.view import View
from ..charts.chart_marks import VertexAccuracy
from .oracle import Oracle
from .reflection_points import ReflectionPoints

FINER = 2
JUDGED = 4000
"""Vertices per reflector that the oracle looks at, drawn at random where there are more"""
SOLVE_REPEATS, SOLVE_SECONDS = 3, 1.0
NODES = 24
"""Along an edge of the oracle's grid"""


@dataclass(frozen=True)
class _Judge:
    """What the oracle says of one reflector's vertices."""

    mirror: Mirror
    fine: ReflectorMap
    chosen: NDArray[np.int64]
    """Indices into all vertices of its scenery"""
    truth: ReflectionPoints
    screen: Screen

    def errors(self, parts: tuple[SolvedChunk, ...]) -> tuple[Float64Array, NDArray[np.bool_], NDArray[np.bool_]]:
        """Pixels (k,) of what both call reflected; per judged vertex whether it is misclassified, unconverged."""
        read = [part.solution.read() for part in parts]
        points = np.concatenate([part[0] for part in read])[self.chosen].astype(np.float64)
        code = np.concatenate([part[1] for part in read])[self.chosen]
        claimed = code == status.REFLECTED
        is_reflected = self.truth.counts(len(self.chosen)) > 0
        both = claimed & is_reflected
        in_map = _moved(self.fine.world_to_map, points)
        nearest = self.truth.nearest_to(in_map)
        off = self.screen.pixels(nearest[both], in_map[both] - nearest[both])
        misclassified = (claimed & ~is_reflected) | ((code == status.HIDDEN) & is_reflected)
        return np.linalg.norm(off, axis=1), misclassified, code >= status.UNSOLVED


class VertexTruth:
    """A scene's vertices as one view needs them, split as by default, the same for all methods and settings."""

    def __init__(self, arrays: SceneArrays, view: View) -> None:
        """Raises InputError for what is wrong with the scene whatever the method."""
        self._arrays, self._view = arrays, view
        self._renderer = Renderer(arrays, Settings(method="environment_cube"))
        self._materials = Materials(arrays)
        self._judges: list[_Judge] = []
        self._solvers: dict[int, MirrorSolver] = {}
        """By the mirror's id"""
        self.warnings = self._renderer.warnings

    def free(self) -> None:
        """Let go of GPU resources."""
        self._renderer.free()
        self._judges = []

    def prepare(self) -> None:
        """Ask the oracle. Reflectors that no radial map can hold, or that hold the eye, are left out."""
        renderer, view = self._renderer, self._view
        tolerance = Settings().pixel_tolerance
        resolution = renderer.settings.map_resolution
        shapes = [(mirror, mirror.shape(resolution)) for mirror in renderer.mirrors]
        renderer.geometry.refine([mirror.sight(view, tolerance, shape) for mirror, shape in shapes])
        self._judges = [
            self._judge(mirror, shape)
            for mirror, shape in shapes
            if shape.map is not None and not mirror.holds_eye(view, shape) and renderer.geometry.scenery(mirror.index)
        ]

    def measure(self, settings: Settings) -> VertexAccuracy | None:
        """Solve all vertices with these settings; None where no reflector can be judged.

        Raises InputError where the method cannot work on a reflector.
        """
        if not self._judges:
            return None
        solved = [self._solve(judge.mirror, settings) for judge in self._judges]
        found = [judge.errors(parts) for judge, parts in zip(self._judges, solved, strict=True)]
        errors, misclassified, unconverged = (np.concatenate(part) for part in zip(*found, strict=True))
        median, p95, p99, worst = np.percentile(errors, (50, 95, 99, 100)).tolist() if len(errors) else [None] * 4
        return VertexAccuracy(
            vertices=sum(part.solution.count for parts in solved for part in parts),
            judged=len(misclassified),
            ms_per_million=self._time(settings),
            median_px=median,
            p95_px=p95,
            p99_px=p99,
            max_px=worst,
            misclassified=float(misclassified.mean()),
            unconverged=float(unconverged.mean()),
        )

    def time_again(self, accuracy: VertexAccuracy, settings: Settings) -> VertexAccuracy:
        """The same with more repeats of the time."""
        for judge in self._judges:
            self._solve(judge.mirror, settings)
        return replace(accuracy, ms_per_million=accuracy.ms_per_million.joined(self._time(settings)))

    def _time(self, settings: Settings) -> Timing:
        """Milliseconds per million vertices of solving them all, when everything is there."""

        def timed() -> float:
            start = perf_counter()
            count = sum(part.solution.count for judge in self._judges for part in self._solve(judge.mirror, settings))
            return 1e9 * (perf_counter() - start) / count

        return Timing(tuple(repeated(timed, SOLVE_REPEATS, SOLVE_SECONDS)))

    def _solve(self, mirror: Mirror, settings: Settings) -> tuple[SolvedChunk, ...]:
        geometry = self._renderer.geometry
        parts, _ = self._solvers.setdefault(id(mirror), MirrorSolver(mirror)).solve(
            self._view,
            settings,
            geometry.scenery(mirror.index),
            geometry.of_instance(mirror.index),
            self._materials,
        )
        for part in parts:
            part.solution.wait()
        # What a vertex has beside its first image is not judged.
        return tuple(part for part in parts if part.image == 0)

    def _judge(self, mirror: Mirror, shape: BakedShape) -> _Judge:
        fine = bake_instance(self._arrays, mirror.index, FINER * Settings().map_resolution, limits=OPEN_LIMITS)
        scenery = self._renderer.geometry.scenery(mirror.index)
        positions = np.concatenate([read_records(chunk.positions, chunk.position_count)[:, :3] for chunk, _ in scenery])
        count = len(positions)
        chosen = np.sort(np.random.default_rng(1).choice(count, min(count, JUDGED), replace=False))
        vertices = _moved(fine.world_to_map, positions[chosen].astype(np.float64))
        eye = fine.world_to_map @ self._view.eye
        met = fine.positions[..., 3] > 0.0

        def cover(u: Float64Array) -> NDArray[np.bool_]:
            return met[nearest_texel(fine.resolution, u)]

        oracle = Oracle(
            CubeMapSurface(fine.radial), NODES, mirror.side(self._view, shape), cover if shape.is_open else None
        )
        truth = oracle.reflection_points(eye, vertices)
        return _Judge(mirror, fine, chosen, truth, Screen(eye, self._view.focal_pixels))


def _moved(matrix: Float64Array, points: Float64Array) -> Float64Array:
    """Points (n, 3) by a matrix (4, 4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]
