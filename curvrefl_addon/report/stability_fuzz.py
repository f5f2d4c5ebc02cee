# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Any eye, any vertex, any reflector: what a solve must never give back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..optics import status
from ..optics.catalogue import METHODS
from ..optics.radial_surfaces import Float64Array, unit
from ..optics.study_surfaces import STUDIES
from ..renderer.frame import Settings
from ..renderer.study_reflector import StudyReflector
from .solver_table import study_view

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
LARGEST_COORDINATE = 1e18
"""As in `vectors.glsl`"""
WILD = 1.02
"""Bounding radii from the centre past which no reflection point can be"""


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


def fuzz(triples: int, reflectors: Sequence[str] = tuple(STUDIES), seed: int = 0) -> list[Fuzz]:
    """About `triples` random eyes, vertices and reflectors for every method that solves vertices."""
    results = []
    batches = max(-(-triples // BATCH), 1)
    for method, entry in METHODS.items():
        if not entry.solves_vertices:
            continue
        random = np.random.default_rng(seed)
        bad = wild = uncoded = total = 0
        counts = np.zeros(4, np.int64)
        known: dict[str, StudyReflector] = {}
        for number in range(batches):
            name = reflectors[number % len(reflectors)]
            reflector = known.setdefault(name, StudyReflector(STUDIES[name]))
            eye, vertices = _random(random, STUDIES[name].surface.bound)
            solution = reflector.solve(method, study_view(eye), Settings(method=method), vertices)
            points, code, _, seeming = solution.read()
            finite = (np.abs(vertices) < LARGEST_COORDINATE).all(axis=1)
            bad += int((~np.isfinite(points).all(axis=1) | ~np.isfinite(seeming).all(axis=1)).sum())
            far = np.linalg.norm(points, axis=1) > WILD * STUDIES[name].surface.bound
            # On a plane in place of the reflector points may be anywhere.
            wild += 0 if "plane" in entry.maps else int((far & (code == status.REFLECTED)).sum())
            uncoded += int(((code == status.INVALID) == finite).sum())
            counts += np.bincount(code, minlength=4)
            total += len(vertices)
        results.append(Fuzz(method, total, bad, wild, uncoded, *(int(count) for count in counts)))
    return results


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
