# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Any eye, any vertex, any reflector: what a solve must never give back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics import status
from ...optics.catalog import Method, solvers
from ...optics.surfaces.radial_surfaces import Float64Array, unit
from ...renderer.settings import Settings
from ...renderer.vertices.solution import VertexSolution
from ...scene.arrays import LARGEST_COORDINATE
from ..solvers.solver_table import study_view
from ..solvers.study_reflector import StudyReflector
from ..solvers.study_surfaces import ALL_STUDIES

BATCH = 1 << 14
SPECIAL = np.array(
    [
        [0.0, 0.0, 0.0],
        [np.nan, 0.0, 1.0],
        [np.inf, 1.0, 0.0],
        [0.0, 0.0, 1e30],
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1e-30],
        [1.0, 1.0, 1.0],
    ]
)
"""Put into every batch"""
WILD = 1.02
"""Bounding radii from the center past which no reflection point can be"""


@dataclass(frozen=True, slots=True)
class Fuzz:
    """Counts of one method over all reflectors."""

    method: str
    triples: int
    not_finite: int
    """Results with a coordinate that is no number"""
    wild: int
    """Reflection points that are not on the reflector"""
    without_code: int
    """Vertices without a usable position that are not marked invalid, or the other way round"""
    reflected: int
    hidden: int
    unsolved: int
    invalid: int


def fuzz(
    triples: int,
    reflectors: Sequence[str] = tuple(ALL_STUDIES),
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> list[Fuzz]:
    """At least `triples` random eyes, vertices and reflectors, the same for every method that solves vertices, and as
    many for those that refract with surfaces of glass.
    """
    found = []
    for refracts in (False, True):
        methods = {
            name: entry for name, entry in solvers().items() if entry.solves_vertices and entry.refracts == refracts
        }
        own = [name for name in reflectors if ALL_STUDIES[name].refracts == refracts]
        if own:
            found += _fuzz_with(methods, own, triples, seed, progress)
    return found


def _fuzz_with(
    methods: dict[str, Method],
    reflectors: Sequence[str],
    triples: int,
    seed: int,
    progress: Callable[[str], None],
) -> list[Fuzz]:
    counts = {method: np.zeros(8, np.int64) for method in methods}
    batches = max(-(-triples // BATCH), 1)
    for first, name in enumerate(reflectors):
        numbers = range(first, batches, len(reflectors))
        if not numbers:
            break
        progress(f"Fuzzing the {name}: {len(numbers) * BATCH} eyes and vertices for each of {len(methods)} methods")
        study = ALL_STUDIES[name]
        reflector, bound = StudyReflector(study), study.surface.bound
        for number in numbers:
            eye, vertices = _random(np.random.default_rng([seed, number]), bound)
            if study.refracts and study.side < 0.0:
                eye[:3] = study.eye
            view = study_view(eye)
            for method, entry in methods.items():
                solution = reflector.solve(method, view, Settings(method=method), vertices)
                counts[method] += _counts(solution, vertices, bound, entry)
    return [Fuzz(method, *(int(number) for number in counts[method])) for method in methods]


def _counts(solution: VertexSolution, vertices: Float64Array, bound: float, method: Method) -> NDArray[np.int64]:
    """(8,) of one batch, in the order of `Fuzz`."""
    points, code, _, seeming = solution.read()
    finite = (np.abs(vertices) < LARGEST_COORDINATE).all(axis=1)
    broken = ~np.isfinite(points).all(axis=1) | ~np.isfinite(seeming).all(axis=1)
    far = np.linalg.norm(points, axis=1) > WILD * bound
    # On a plane in place of the reflector points may be anywhere.
    wild = far & (code == status.REFLECTED) & ("plane" not in method.maps)
    uncoded = (code == status.INVALID) == finite
    kinds = np.bincount(code, minlength=4)
    return np.array([len(vertices), broken.sum(), wild.sum(), uncoded.sum(), *kinds], np.int64)


def _random(random: np.random.Generator, bound: float) -> tuple[Float64Array, Float64Array]:
    """An eye outside of the bounding ball, down to a hundredth of it away, and vertices anywhere."""
    eye = np.ones(4)
    eye[:3] = unit(random.normal(size=(1, 3)))[0] * bound * (1.0 + 10.0 ** random.uniform(-2.0, 2.0))
    distance = bound * 10.0 ** random.uniform(-4.0, 3.0, BATCH)
    vertices = unit(random.normal(size=(BATCH, 3))) * distance[:, None]
    # A third of them next to the surface of a ball: contact.
    near = random.random(BATCH) < 0.33
    vertices[near] *= (bound * (1.0 + 10.0 ** random.uniform(-4.0, -1.0, BATCH)) / distance)[near, None]
    vertices[: len(SPECIAL)] = SPECIAL
    return eye, vertices
