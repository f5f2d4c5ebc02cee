# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex methods on a radial map: their shaders against the float64 searches on the same map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...optics import status
from ...optics.catalog import entry_of
from ...optics.fermat import sample, towards_eye
from ...optics.screen import Screen
from ...optics.snell import refracted
from ...optics.solvers import bisector, newton, newton_region, secant_star
from ...optics.surfaces.cube_map import CubeMapSurface
from ...optics.surfaces.curvature_regions import curvature_regions
from ...optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface
from ...scene.arrays import Float32Array, Float64Array
from ...scene.camera.view import View
from ..device.cubes import cube_texture
from ..device.records import record_texture
from ..device.shaders import compiled
from ..vertices.solution import VertexSolution
from ..vertices.solve import Reflector, RegionTextures, solve_region, solve_vertices
from .cases import EYE, as_stored, directions, radial_map, records_of, vertices_around, view_of_origin
from .proof import Found, Work

VERTICES, TEXELS = 192, 48
PIXELS = 640, 480
MOST_OFF = 0.5
"""Pixels that a point may be off; what filters maps in hardware has steps of 1/256 of a texel"""
OUTLIERS = 0.03
"""Share of the points that may be anywhere: on the horizon rounding decides what is hidden"""
SPHERE, EGG, BUMPY = Ellipsoid(), Ellipsoid(1.0, 0.8, 0.6), Bumpy(0.15)
INDEX = 1.4
"""Of refraction, in `prove_refraction`"""
FEW_STEPS = 2
"""Of the first pass of a method that has two, so that the second has work"""

type Reference = tuple[Float64Array, NDArray[np.integer]]
"""Points (n, 3) and their status (n,)"""


@dataclass(frozen=True)
class Case:
    """A surface, an eye, vertices around, and a float64 search for what it reflects."""

    surface: RadialSurface
    reference: Callable[[CubeMapSurface, Screen, Float64Array], Reference]
    outliers: float = OUTLIERS
    vertices: Float64Array = field(init=False)
    faces: Float32Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", vertices_around(self.surface, VERTICES))
        object.__setattr__(self, "faces", radial_map(self.surface, TEXELS))

    @property
    def map(self) -> CubeMapSurface:
        return CubeMapSurface(self.faces)

    @property
    def reflector(self) -> Reflector:
        return Reflector(np.eye(4), self.map.bound, {"radial": cube_texture(self.faces)})

    def found(self, solution: VertexSolution, view: View, expected: Reference) -> Found:
        return judged(solution, Screen(view.eye, view.focal_pixels), expected, self.outliers)


def judged(solution: VertexSolution, screen: Screen, expected: Reference, outliers: float) -> Found:
    """The error in pixels that all but a share of the points stay under; a point with another status is nowhere."""
    points, code, _, _ = solution.read()
    truth, expected_code = expected
    off = np.full(len(code), np.inf)
    alike = code == expected_code
    off[alike] = 0.0
    both = alike & (code == status.REFLECTED)
    off[both] = np.linalg.norm(screen.pixels(truth[both], points[both] - truth[both]), axis=1)
    off[np.isnan(off)] = np.inf
    kept = np.sort(off)[: max(int(len(off) * (1.0 - outliers)), 1)]
    # Where nothing is reflected nothing is proven.
    return Found(float(kept[-1]) if both.any() else np.inf, MOST_OFF, "pixels")


def _newton(surface: CubeMapSurface, screen: Screen, vertices: Float64Array) -> Reference:
    found = newton.solve(surface, screen, vertices, first_steps=FEW_STEPS)[0]
    return found.at.position, found.status


def _secant_star(surface: CubeMapSurface, screen: Screen, vertices: Float64Array) -> Reference:
    found = secant_star.solve(surface, screen, vertices)
    return found.at.position, found.status


def _bisector(surface: CubeMapSurface, screen: Screen, vertices: Float64Array) -> Reference:
    found = bisector.solve(surface, screen.eye, vertices)
    return found.position, found.status


CASES = {
    "newton": Case(EGG, _newton),
    "secant_star": Case(EGG, _secant_star),
    "bisector_cube": Case(EGG, _bisector, outliers=0.06),
}


def prove_search(method: str) -> Work:
    """Of a method with a radial map and a search of its own."""
    case, view = CASES[method], view_of_origin(EYE, *PIXELS)
    steps = FEW_STEPS if entry_of(method).stragglers else 0
    positions = record_texture(records_of(case.vertices))
    search = partial(solve_vertices, method, view, case.reflector, positions, VERTICES, steps=steps)
    solution = yield from compiled(search)
    yield
    expected = case.reference(case.map, Screen(view.eye, view.focal_pixels), case.vertices)
    yield
    return case.found(solution, view, expected)


def prove_refraction() -> Work:
    """`newton_refraction`: vertices on lines of sight that have been bent show where those were bent."""
    faces, view = radial_map(EGG, TEXELS), view_of_origin(EYE, *PIXELS)
    surface = CubeMapSurface(faces)
    at = sample(surface, directions(3 * VERTICES))
    to_eye = towards_eye(view.eye, at.position)
    seen = np.flatnonzero(np.einsum("ij,ij->i", to_eye, at.normal) > 0.2)[:VERTICES]
    points = at.position[seen]
    away = 0.02 * 30.0 ** ((np.arange(len(seen)) * 0.6180339887) % 1.0)
    vertices = as_stored(points + away[:, None] * refracted(to_eye[seen], at.normal[seen], INDEX))
    yield
    reflector = Reflector(np.eye(4), surface.bound, {"radial": cube_texture(faces)}, index=INDEX)
    positions = record_texture(records_of(vertices))
    search = partial(solve_vertices, "newton_refraction", view, reflector, positions, len(seen), steps=FEW_STEPS)
    solution = yield from compiled(search)
    yield
    expected = points, np.full(len(seen), status.REFLECTED)
    # (Farther back a vertex may be seen at another place, too.)
    return judged(solution, Screen(view.eye, view.focal_pixels), expected, OUTLIERS)


def prove_regions() -> Work:
    """Of images beside the first, on a mirror that bends both ways."""
    faces = radial_map(BUMPY, TEXELS)
    surface, vertices = CubeMapSurface(faces), vertices_around(BUMPY, VERTICES)
    view = view_of_origin(EYE, *PIXELS)
    screen = Screen(view.eye, view.focal_pixels)
    regions = curvature_regions(surface)
    yield
    expected = newton_region.solve_region(surface, screen, vertices, regions, 0)
    yield
    textures = RegionTextures(regions)
    reflector = Reflector(np.eye(4), surface.bound, {"radial": cube_texture(faces)})
    solution = solve_region(view, reflector, textures, 0, record_texture(records_of(vertices)), VERTICES)
    yield
    return judged(solution, screen, (expected.at.position, expected.status), 0.06)
