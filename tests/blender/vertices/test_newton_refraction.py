# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders of `newton_refraction` are held to their float64 reference, and to the vertices they are made from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.fermat import sample, towards_eye
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.snell import refracted
from curvrefl.curvrefl_addon.optics.solvers import newton_refraction, refraction_start
from curvrefl.curvrefl_addon.optics.solvers.descent import minimize
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import RadialSurface, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.radial_maps import SURFACES, radial_map
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([2.3, -2.9, 1.8])
INSIDE = np.array([0.1, -0.12, 0.08])


class Glass:
    """A surface that stands turned and away from the origin, and vertices made from its refracted lines of sight."""

    def __init__(
        self,
        surface: RadialSurface,
        index: float,
        eye: np.ndarray = EYE,
        orthographic: bool = False,
        scale: float = 1.0,
    ) -> None:
        faces = radial_map(surface, 128)
        faces = (faces * scale).astype(np.float32)
        self.surface, self.index = CubeMapSurface(faces.astype(np.float64)), index
        self.side = -1.0 if eye is INSIDE else 1.0
        turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
        self.turn = turn * np.sign(np.linalg.det(turn))
        self.place = scale * np.array([3.0, -2.0, 5.0])
        world_to_map = np.eye(4)
        world_to_map[:3, :3] = self.turn
        world_to_map[:3, 3] = -self.turn @ self.place
        self.view = look_at(self.place + scale * eye, self.place, 640, 480, np.radians(40), orthographic=orthographic)
        self.eye = world_to_map @ self.view.eye
        random = np.random.default_rng(7)
        at = sample(self.surface, unit(random.normal(size=(12_000, 3))))
        to_eye, normal = towards_eye(self.eye, at.position), self.side * at.normal
        ray = refracted(to_eye, normal, index)
        kept = (np.einsum("ij,ij->i", to_eye, normal) > 0.05) & np.isfinite(ray[:, 0])
        distance = scale * 10 ** random.uniform(-3, 1, kept.sum())
        self.vertices = at.position[kept] + distance[:, None] * ray[kept]
        world = (self.vertices @ self.turn + self.place).astype(np.float32)
        self.positions = record_texture(np.column_stack([world, np.ones(len(world))]))
        self.reflector = Reflector(
            world_to_map, self.surface.bound, {"radial": cube_texture(faces)}, side=self.side, index=index
        )

    def solve(self, previous: VertexSolution | None = None, view: View | None = None, **options: int) -> VertexSolution:
        return solve_vertices(
            "newton_refraction",
            view or self.view,
            self.reflector,
            self.positions,
            len(self.vertices),
            previous=previous,
            **options,
        )

    def reference(self, **options: int) -> tuple[newton_refraction.Solution, np.ndarray]:
        return newton_refraction.solve(
            self.surface, Screen(self.eye, self.view.focal_pixels), self.vertices, self.index, side=self.side, **options
        )

    def in_map(self, points: np.ndarray) -> np.ndarray:
        return (points - self.place) @ self.turn.T

    def pixels(self, points: np.ndarray, expected: np.ndarray) -> np.ndarray:
        """(n,) between world points and points of the map frame."""
        return np.linalg.norm(self.view.project(points) - self.view.project(expected @ self.turn + self.place), axis=1)

    def misses(self, points: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """(k,) pixels of some vertices from world points to the refraction points nearest to them: on from there by
        the reference, to a thousandth of the tolerance."""
        screen = Screen(self.eye, self.view.focal_pixels)
        u = unit(self.in_map(points[rows].astype(np.float64)))
        polished, _, _ = minimize(self.surface, screen, self.vertices[rows], u, 30, 1e-4, True, self.index)
        found = self.surface.radius(polished)[0][:, None] * polished
        return self.pixels(points[rows], found)


@pytest.mark.parametrize("index", [1.01, 1.5, 3.0, 1.0 / 1.5])
@pytest.mark.parametrize("name", SURFACES)
def test_shader_follows_the_reference(name: str, index: float) -> None:
    glass = Glass(SURFACES[name], index)
    points, code, iterations, virtual = glass.solve().read()
    reference, _ = glass.reference()
    assert len(code) > 500
    assert (code == reference.status).mean() > 0.998
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.99
    error = glass.misses(points, np.flatnonzero(both))
    assert np.median(error) < 0.01
    assert np.percentile(error, 99) < 0.1
    # Of several images most vertices have the same one.
    same = glass.pixels(points[both], reference.at.position[both]) < 0.2
    assert same.mean() > 0.98
    # (The first pass counts all of its steps where it fails.)
    assert iterations[both].mean() < reference.iterations[both].mean() + 3.5
    assert np.linalg.norm(glass.view.project(virtual[:, :3]) - glass.view.project(points), axis=1)[both].max() < 0.05


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_any_scale_is_solved_alike(scale: float) -> None:
    usual, other = Glass(SURFACES["bumpy"], 1.5), Glass(SURFACES["bumpy"], 1.5, scale=scale)
    one, two = usual.solve().read(), other.solve().read()
    assert (one[1] == two[1]).mean() > 0.998
    both = (one[1] == status.REFLECTED) & (two[1] == status.REFLECTED)
    error = other.misses(two[0], np.flatnonzero(both))
    assert np.percentile(error, 99) < 0.1
    near = np.linalg.norm(one[0] - two[0] / scale, axis=1)[both] < 1e-3
    assert near.mean() > 0.99


@pytest.mark.parametrize("name", SURFACES)
def test_orthographic_views_and_eyes_inside(name: str) -> None:
    for glass in (
        Glass(SURFACES[name], 1.5, orthographic=True),
        Glass(SURFACES[name], 1.0 / 1.5, INSIDE),
        Glass(SURFACES[name], 1.5, INSIDE),
    ):
        points, code, _, _ = glass.solve().read()
        reference, _ = glass.reference()
        assert (code == reference.status).mean() > 0.99
        both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
        assert both.mean() > 0.98
        # (An eye inside sees some of the surface behind itself: no pixels there.)
        expected = reference.at.position @ glass.turn + glass.place
        error = np.linalg.norm(points.astype(np.float64) - expected, axis=1)[both]
        assert np.percentile(error, 98) < 2e-3


@pytest.mark.parametrize("rung", range(refraction_start.RUNG_COUNT), ids=refraction_start.RUNGS)
def test_each_rung_finds_what_the_reference_finds(rung: int) -> None:
    """One step of the first pass settles next to nothing; the rungs before this one are left out."""
    glass = Glass(SURFACES["ellipsoid"], 1.5)
    points, code, _, _ = glass.solve(steps=1, first_rung=rung).read()
    reference, _ = glass.reference(first_steps=1, first_rung=rung)
    assert (code == reference.status).mean() > 0.99
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.5
    assert np.percentile(glass.misses(points, np.flatnonzero(both)), 99) < 0.2


def test_a_warm_start_takes_one_step_or_two() -> None:
    glass = Glass(SURFACES["ellipsoid"], 1.5)
    last = glass.solve()
    turned = EYE + 0.009 * np.linalg.norm(EYE) * unit(np.array([2.9, 2.3, 0.0])[None])[0]
    view = look_at(glass.place + turned, glass.place, 640, 480, np.radians(40))
    _, code, iterations, _ = glass.solve(last, view).read()
    _, cold_code, cold_iterations, _ = glass.solve(view=view).read()
    both = (code == status.REFLECTED) & (cold_code == status.REFLECTED) & (last.read()[1] == status.REFLECTED)
    assert both.mean() > 0.9
    assert iterations[both].mean() < 2.0 < cold_iterations[both].mean()


def test_at_rest_vertices_keep_their_bits() -> None:
    """But for those that a Newton step would move, on the edge of a caustic."""
    glass = Glass(SURFACES["bumpy"], 1.5)
    first = glass.solve().read()
    again = glass.solve(glass.solve()).read()
    shown = first[1] == status.REFLECTED
    for one, other in zip(first, again, strict=True):
        assert (one == other).reshape(len(one), -1).all(axis=1)[shown].mean() > 0.999


@pytest.mark.parametrize("index", [-1.0, 0.0, 1.0, 1000.0, np.inf])
def test_any_index_ends_with_numbers(index: float) -> None:
    glass = Glass(SURFACES["bumpy"], 1.5)
    glass.reflector = replace(glass.reflector, index=index)
    points, code, _, virtual = glass.solve().read()
    assert np.isfinite(points).all() and np.isfinite(virtual).all()
    assert (code < status.INVALID).all()
    if index == 1.0:
        # Straight through.
        assert (code == status.REFLECTED).sum() > 1000
        world = glass.vertices @ glass.turn + glass.place
        shown = code == status.REFLECTED
        off = np.linalg.norm(glass.view.project(points) - glass.view.project(world), axis=1)[shown]
        assert np.percentile(off, 99) < 0.2


def test_hidden_vertices_go_on_past_the_horizon() -> None:
    """Across the last line of sight that passes the sphere a vertex seems to go on, but for a twentieth of the radius:
    beyond it rays next to the last one reach a little, and turn back inside of the horizon."""
    glass = Glass(SURFACES["sphere"], 1.5)
    to_eye = unit(glass.eye[None, :3])[0]
    aside = unit(np.cross(to_eye, [0.3, -0.7, 0.2])[None])[0]
    cosine = 1.0 / np.linalg.norm(glass.eye[:3])
    point = cosine * to_eye + np.sqrt(1.0 - cosine**2) * aside
    ray = refracted(unit((glass.eye[:3] - point)[None]), point[None], 1.5)[0]
    # On a circle about the horizon's point, from the lit side to the dark one.
    angle = np.linspace(-0.05, 0.05, 41)[:, None]
    glass.vertices = point + 0.8 * (np.cos(angle) * ray + np.sin(angle) * unit((point - (point @ ray) * ray)[None]))
    world = (glass.vertices @ glass.turn + glass.place).astype(np.float32)
    glass.positions = record_texture(np.column_stack([world, np.ones(len(world))]))
    _, code, _, virtual = glass.solve().read()
    assert (code[:19] == status.REFLECTED).all() and (code[26:] == status.HIDDEN).all()
    seen = glass.view.project(virtual[:, :3])
    steps = np.linalg.norm(np.diff(seen, axis=0), axis=1)
    size = np.linalg.norm(seen[20] - glass.view.project(glass.place[None]))
    assert steps.max() < 0.06 * size
