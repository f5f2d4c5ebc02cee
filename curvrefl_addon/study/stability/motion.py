# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How steadily reflection points move: slow paths of the eye and of the vertices, against the oracle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...optics import status
from ...optics.catalog import solvers
from ...optics.surfaces.radial_surfaces import Float64Array
from ...renderer.settings import Settings
from ...renderer.vertices.solution import VertexSolution
from ..solvers.oracle import Oracle
from ..solvers.refraction_cases import make_refraction_cases
from ..solvers.regimes import MESH_VERTICES, make_cases, mesh_cases
from ..solvers.solver_table import study_view
from ..solvers.study_reflector import StudyReflector
from ..solvers.study_surfaces import ALL_STUDIES

FRAMES = 16
STEP = np.radians(0.25)
"""The eye's turn from frame to frame, and how far all vertices move, in radii"""
WAY = np.array([0.6, 0.64, 0.48])


@dataclass(frozen=True, slots=True)
class Motion:
    """One method on one path. Pixels of vertices that both the method and the oracle reflect in all frames."""

    reflector: str
    path: str
    """"eye" or "objects\""""
    method: str
    vertices: int
    jitter_median_px: float
    """Second difference of the reflection point on screen, less the oracle's"""
    jitter_p99_px: float
    worst_pop_px: float
    """Largest move from frame to frame that the oracle does not make"""
    iterations_first: float
    """Mean of the first frame"""
    iterations_later: float
    """Mean of the others, for methods that start where the last frame ended"""
    identical_at_rest: bool
    """The last frame, solved again, has the same reflection points and picture to the last bit"""


def measure_motion(
    reflectors: Sequence[str], count: int, progress: Callable[[str], None] = lambda _: None
) -> list[Motion]:
    """All methods that solve vertices of such a reflector, on a path of the eye around it and one of the vertices."""
    found = []
    for name in reflectors:
        study = ALL_STUDIES[name]
        meshes = max(count // MESH_VERTICES, 1)
        near = make_refraction_cases(study, "inside", meshes) if study.refracts else make_cases(study, "near", meshes)
        cases = mesh_cases(near, meshes)
        reflector, oracle = StudyReflector(study), study.oracle()
        for path in ("eye", "objects"):
            progress(f"Following a slow path of the {path} at the {name}: {FRAMES} frames")
            eyes, vertices = _path(path, cases.eye, cases.vertices)
            truth = _true_pixels(oracle, eyes, vertices)
            for method, entry in solvers().items():
                if entry.solves_vertices and entry.refracts == study.refracts:
                    found.append(_follow(reflector, name, path, method, eyes, vertices, truth))
    return found


def _follow(
    reflector: StudyReflector,
    name: str,
    path: str,
    method: str,
    eyes: Sequence[Float64Array],
    vertices: Sequence[Float64Array],
    truth: Float64Array,
) -> Motion:
    """One method on one path; `truth` as of `_true_pixels`."""
    settings = Settings(method=method)
    pixels, reflected, iterations = [], [], []
    solution: VertexSolution | None = None
    for frame, (eye, here) in enumerate(zip(eyes, vertices, strict=True)):
        view = study_view(eye)
        if frame == 0 or here is not vertices[frame - 1]:
            solve = reflector.solver(method, settings, here, MESH_VERTICES)
        solution = solve(view, solution)
        points, code, steps, seeming = solution.read()
        pixels.append(view.project(points.astype(np.float64)))
        reflected.append(code == status.REFLECTED)
        iterations.append(float(steps[reflected[-1]].mean()) if reflected[-1].any() else 0.0)
    again_points, again_code, _, again_seeming = reflector.solver(method, settings, here, MESH_VERTICES)(
        view, solution
    ).read()
    # All but the number of steps: fewer are needed where nothing has moved.
    pairs = ((points, again_points), (code, again_code), (seeming, again_seeming))
    same = all(np.array_equal(one, other) for one, other in pairs)
    kept = np.all(reflected, axis=0) & np.isfinite(truth).all(axis=(0, 2))
    error = np.array(pixels)[:, kept] - truth[:, kept]
    # Another image of the same vertex is no error of the motion, unless the method jumps to it.
    jitter = np.linalg.norm(np.diff(error, 2, axis=0), axis=2)
    pop = np.linalg.norm(np.diff(error, axis=0), axis=2)
    return Motion(
        name,
        path,
        method,
        int(kept.sum()),
        float(np.median(jitter)) if jitter.size else float("nan"),
        float(np.percentile(jitter, 99)) if jitter.size else float("nan"),
        float(pop.max(initial=0.0)),
        iterations[0],
        float(np.mean(iterations[1:])),
        same,
    )


def _path(kind: str, eye: Float64Array, vertices: Float64Array) -> tuple[list[Float64Array], list[Float64Array]]:
    eyes, moved = [], []
    for frame in range(FRAMES):
        angle = STEP * frame
        turn = np.eye(4)
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        eyes.append(turn @ eye if kind == "eye" else eye)
        moved.append(vertices if kind == "eye" else vertices + angle * WAY)
    return eyes, moved


def _true_pixels(oracle: Oracle, eyes: Sequence[Float64Array], vertices: Sequence[Float64Array]) -> Float64Array:
    """(frames, n, 2); NaN from the frame on in which a vertex has no reflection, or several, between which nothing says
    which is meant: it is followed no farther.
    """
    followed = np.arange(len(vertices[0]))
    pixels = np.full((len(eyes), len(followed), 2), np.nan)
    for frame, (eye, here) in enumerate(zip(eyes, vertices, strict=True)):
        points = oracle.reflection_points(eye, here[followed])
        single = points.counts(len(followed)) == 1
        first, followed = points.first(len(followed))[single], followed[single]
        pixels[frame, followed] = study_view(eye).project(first)
    return pixels
