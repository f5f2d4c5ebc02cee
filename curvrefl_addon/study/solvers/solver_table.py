# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every vertex method, reflector by reflector and regime by regime, against the oracle.

Errors are distances on screen between a method's reflection point and the nearest true one; so it is with refraction
points of surfaces of glass, for the solvers that refract. Where a method that looks
up an environment shows a vertex follows from the oracle too: it shows it as if it were at the environment's distance.
"""

from __future__ import annotations

import csv
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from time import perf_counter

import numpy as np

from ...errors import InputError
from ...optics import status
from ...optics.catalog import Method, entry_of, solvers
from ...optics.screen import Screen
from ...optics.surfaces.radial_surfaces import Float64Array, unit
from ...renderer.settings import Settings
from ...scene.camera.view import View
from .oracle import Oracle
from .refraction_cases import REFRACTION_REGIMES, make_refraction_cases
from .regimes import MESH_VERTICES, REGIMES, Cases, make_cases, mesh_cases
from .study_reflector import StudyReflector
from .study_surfaces import ALL_STUDIES

WIDTH, HEIGHT, FIELD_OF_VIEW = 640, 480, np.radians(40.0)
OFF = 0.5
"""Pixels from which on a reflected vertex counts as off"""
TIMED_VERTICES = 1 << 14
TIMED_REPEATS, TIMED_SECONDS = 3, 0.5
"""A solve is timed again while it has taken less"""
FAR_AWAY = 1e6
"""Radii: where environment maps take things to be"""

type Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Row:
    """One method with one setting on one reflector in one regime. Shares are of all vertices, errors of those that
    both the method and the oracle call reflected."""

    reflector: str
    regime: str
    method: str
    setting: str
    value: float
    vertices: int
    error_median_px: float
    error_p95_px: float
    error_p99_px: float
    error_max_px: float
    off: float
    """Share of the vertices with a reflection that are shown more than OFF pixels off"""
    misclassified: float
    """Share shown though hidden, or called hidden though shown"""
    unconverged: float
    iterations_mean: float
    iterations_p99: float
    iterations_max: int
    ms_per_million: float
    """Milliseconds of the solve per million vertices, median; NaN for environments. Without drawing the maps that a
    search on the screen reads."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """A method that cannot work on a reflector."""

    reflector: str
    method: str
    reason: str


def study_view(eye: Float64Array) -> View:
    """From a homogeneous eye (4,) at a point towards the origin."""
    back = unit(eye[None, :3])[0]
    up = np.array([0.0, 0.0, 1.0]) if abs(back[2]) < 0.95 else np.array([0.0, 1.0, 0.0])
    right = unit(np.cross(up, back)[None])[0]
    world_to_view = np.eye(4)
    world_to_view[:3, :3] = np.stack([right, np.cross(back, right), back])
    world_to_view[:3, 3] = -world_to_view[:3, :3] @ eye[:3]
    scale = 1.0 / np.tan(0.5 * FIELD_OF_VIEW)
    near, far = 1e-3, 1e3
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = scale * HEIGHT / WIDTH, scale
    projection[2, 2:] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    projection[3, 2] = -1.0
    return View(world_to_view, projection, WIDTH, HEIGHT)


def settings_of(method: Method, name: str, value: float) -> Settings:
    """The default settings with one value of the method's sweep."""
    field, _ = method.sweep
    kind = type(getattr(Settings(), field))
    return replace(Settings(method=name), **{field: kind(value)})


def solver_table(
    count: int,
    reflectors: Sequence[str] = tuple(ALL_STUDIES),
    regimes: Sequence[str] = (*REGIMES, *REFRACTION_REGIMES),
    methods: Sequence[str] = tuple(solvers()),
    timed: bool = True,
    only_defaults: bool = False,
    progress: Progress = lambda _: None,
) -> tuple[list[Row], list[Refusal]]:
    """Rows for `count` vertices a regime; with `only_defaults` one setting per method, the default. Mirrors and glass
    have regimes of their own.

    A method that works on whole meshes gets small ones about some of the vertices.
    """
    rows: list[Row] = []
    refusals: list[Refusal] = []
    for name in reflectors:
        study = ALL_STUDIES[name]
        oracle = study.oracle()
        reflector = StudyReflector(study)
        times: dict[tuple[str, float], float] = {}
        refused: set[str] = set()
        own = REFRACTION_REGIMES if study.refracts else REGIMES
        for regime in dict.fromkeys(regime for regime in regimes if regime in own):
            progress(f"Solving around the {name}: {regime}")
            cases = (make_refraction_cases if study.refracts else make_cases)(study, regime, count)
            if len(cases.vertices) == 0:
                continue
            truth = _Truth(oracle, cases)
            mesh_truth: _Truth | None = None
            for method_name in methods:
                method = entry_of(method_name)
                if method_name in refused or not (method.maps or method.is_environment):
                    continue
                if method.refracts != study.refracts:
                    continue
                judge = truth
                if method.grid_search:
                    mesh_truth = mesh_truth or _Truth(oracle, mesh_cases(cases, max(count // MESH_VERTICES, 1)))
                    judge = mesh_truth
                for settings, value in _settings(method_name, method, only_defaults):
                    try:
                        found = _solve(reflector, method_name, settings, judge)
                        key = (method_name, value)
                        if timed and method.solves_vertices and key not in times:
                            times[key] = _time(reflector, method_name, settings, judge.cases)
                    except InputError as error:
                        refusals.append(Refusal(name, method_name, str(error)))
                        refused.add(method_name)
                        break
                    rows.append(
                        judge.row(
                            name, regime, method_name, method.sweep[0], value, found, times.get(key, float("nan"))
                        )
                    )
    return rows, refusals


def _settings(name: str, method: Method, only_defaults: bool) -> Iterator[tuple[Settings, float]]:
    if only_defaults or not method.solves_vertices:
        field = method.sweep[0]
        default = float(getattr(Settings(), field)) or float(method.steps)
        yield Settings(method=name), default
        return
    for value in method.sweep[1]:
        yield settings_of(method, name, value), value


@dataclass(frozen=True)
class _Found:
    points: Float64Array
    status: np.ndarray
    iterations: np.ndarray


class _Truth:
    """What the oracle says of a regime's cases."""

    def __init__(self, oracle: Oracle, cases: Cases) -> None:
        self.cases = cases
        self._oracle = oracle
        self._looked_up: dict[float, _Found] = {}
        self.all = oracle.reflection_points(cases.eye, cases.vertices)
        self.is_reflected = (self.all.counts(len(cases.vertices)) > 0) | np.isfinite(cases.points[:, 0])
        self.screen = Screen(cases.eye, study_view(cases.eye).focal_pixels)

    def pixels(self, points: Float64Array) -> Float64Array:
        """(n,) to the nearest true reflection point; that of the construction counts even if the oracle missed it."""
        error = np.full(len(points), np.inf)
        for other in (self.all.nearest_to(points), self.cases.points):
            known = np.isfinite(other[:, 0])
            off = self.screen.pixels(other[known], points[known] - other[known])
            error[known] = np.minimum(error[known], np.linalg.norm(off, axis=1))
        return error

    def looked_up(self, radius: float) -> _Found:
        """Where a lookup shows the vertices that takes everything to be at `radius` about the center."""
        if radius not in self._looked_up:
            distance = np.linalg.norm(self.cases.vertices, axis=1)
            shown_at = self.cases.vertices * (radius / np.maximum(distance, 1e-30))[:, None]
            points = self._oracle.reflection_points(self.cases.eye, shown_at).first(len(distance))
            code = np.where(np.isfinite(points[:, 0]), status.REFLECTED, status.HIDDEN)
            self._looked_up[radius] = _Found(np.nan_to_num(points), code, np.zeros(len(code), int))
        return self._looked_up[radius]

    def row(
        self, reflector: str, regime: str, method: str, setting: str, value: float, found: _Found, time: float
    ) -> Row:
        claimed = found.status == status.REFLECTED
        both = claimed & self.is_reflected
        error = self.pixels(found.points)[both]
        iterations = found.iterations[both]
        shown = max(int(self.is_reflected.sum()), 1)
        wrong = (claimed & ~self.is_reflected) | ((found.status == status.HIDDEN) & self.is_reflected)
        median, p95, p99, worst = np.percentile(error, [50, 95, 99, 100]) if len(error) else [float("nan")] * 4
        return Row(
            reflector,
            regime,
            method,
            setting,
            value,
            len(claimed),
            float(median),
            float(p95),
            float(p99),
            float(worst),
            float((error > OFF).sum() / shown),
            float(wrong.mean()),
            float((found.status >= status.UNSOLVED).mean()),
            float(iterations.mean()) if len(iterations) else 0.0,
            float(np.percentile(iterations, 99)) if len(iterations) else 0.0,
            int(iterations.max(initial=0)),
            time,
        )


def _solve(reflector: StudyReflector, method: str, settings: Settings, truth: _Truth) -> _Found:
    cases = truth.cases
    if settings.entry.solves_vertices:
        solution = reflector.solver(method, settings, cases.vertices, MESH_VERTICES)(study_view(cases.eye), None)
        points, code, iterations, _ = solution.read()
        return _Found(points.astype(np.float64), code, iterations)
    if method != "environment_parallax":
        return truth.looked_up(FAR_AWAY)
    median = float(np.median(np.linalg.norm(cases.vertices, axis=1)))
    return truth.looked_up(max(median, reflector.study.surface.bound))


def _time(reflector: StudyReflector, method: str, settings: Settings, cases: Cases) -> float:
    """Milliseconds per million vertices, the regime's own over and over; median of repeats after a first run."""
    count = TIMED_VERTICES // MESH_VERTICES * MESH_VERTICES
    vertices = np.resize(cases.vertices, (count, 3))
    view = study_view(cases.eye)
    solve = reflector.solver(method, settings, vertices, MESH_VERTICES)
    solve(view, None).wait()
    times: list[float] = []
    while len(times) < TIMED_REPEATS and sum(times) < TIMED_SECONDS:
        start = perf_counter()
        solve(view, None).wait()
        times.append(perf_counter() - start)
    return 1e9 * statistics.median(times) / count


def write_csv(rows: Iterable[Row], path: Path) -> None:
    """All columns, shares as they are."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


def readable(rows: Sequence[Row], refusals: Sequence[Refusal]) -> str:
    """The same as text, a block per reflector and regime."""
    lines = [
        f"Errors in pixels of a picture of {WIDTH} x {HEIGHT}, of vertices that both the method and the oracle call "
        "reflected.",
        f"Off by more than {OFF} px: of those that have a reflection. Wrong side: of all, shown though hidden or "
        "called hidden though shown.",
        "Lookups are judged by the geometry that they take for granted. Times are of the solve, maps drawn before.",
    ]
    block = None
    for row in rows:
        if (row.reflector, row.regime) != block:
            block = (row.reflector, row.regime)
            lines.append(f"\n{row.reflector}, {row.regime}: {row.vertices} vertices")
            lines.append(
                f"  {'':26} {'setting':26}  px: median     p95      p99      max   off >{OFF} px  wrong side  unsolved"
                "  iterations: mean  p99   max   ms per million"
            )
        time = "-" if np.isnan(row.ms_per_million) else f"{row.ms_per_million:.0f}"
        lines.append(
            f"  {row.method:26} {row.setting + ' ' + format(row.value, 'g'):26}  {row.error_median_px:10.3g} "
            f"{row.error_p95_px:8.3g} {row.error_p99_px:8.3g} {row.error_max_px:8.3g} {row.off:11.2%} "
            f"{row.misclassified:11.2%} {row.unconverged:9.2%}  {row.iterations_mean:16.1f} {row.iterations_p99:4.0f} "
            f"{row.iterations_max:5d} {time:>16}"
        )
    lines += [f"\n{refusal.method} on the {refusal.reflector}: {refusal.reason}" for refusal in refusals]
    return "\n".join(lines) + "\n"
