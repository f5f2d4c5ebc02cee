# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of lamps in mirrors of meshes, against closed forms of the plane and of the sphere."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.design.lights.goals import upright
from curvrefl.curvrefl_addon.design.lights.images import images, is_met, outline, place_of
from curvrefl.curvrefl_addon.design.lights.reflecting import PlacedMirror, Reflecting, reflecting
from curvrefl.curvrefl_addon.optics.ray import reflect_ray
from curvrefl.curvrefl_addon.optics.surfaces.mesh_rays import MeshRays
from curvrefl.curvrefl_addon.optics.surfaces.mesh_reflections import ReflectingMesh
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, unit
from curvrefl.curvrefl_addon.optics.surfaces.sphere import reflection_points
from curvrefl.curvrefl_addon.scene.arrays import LightArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.star_meshes import star_mesh
from scenes.views import look_at

EYE = np.array([0.3, -4.0, 1.0])


def view(orthographic: bool = False) -> View:
    return look_at(EYE, np.zeros(3), 400, 300, 0.7, orthographic=orthographic)


def flat(size: float = 3.0) -> PlacedMirror:
    """In the plane z = 0, of two triangles."""
    corners = size * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return PlacedMirror(
        "flat", corners, np.tile([0.0, 0, 1], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]], np.int32), False
    )


def ball(bands: int = 48) -> PlacedMirror:
    mesh = star_mesh(Ellipsoid(), bands)
    positions = mesh.positions[mesh.corner_vertex].astype(np.float64)
    return PlacedMirror("ball", positions, mesh.corner_normals.astype(np.float64), mesh.triangles, True)


def lamp(kind: str, place: tuple[float, float, float], **more: object) -> LightArrays:
    matrix = np.eye(4)
    matrix[:3, 3] = place
    return LightArrays("lamp", kind, (1.0, 1.0, 1.0), matrix, **more)


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_flat_mirror_shows_one_image_where_the_line_to_the_mirrored_place_goes_through(orthographic: bool) -> None:
    looking = view(orthographic)
    place = np.array([0.4, 0.9, 0.8])
    found = images(reflecting(flat(), looking), np.append(place, 1.0))
    expected = looking.project(np.array([place * (1, 1, -1)]))
    assert len(found.pixels) == 1
    np.testing.assert_allclose(found.pixels, expected, atol=1e-5)


def test_images_on_a_sphere() -> None:
    looking = view()
    mirror = reflecting(ball(), looking)
    rng = np.random.default_rng(4)
    for place in unit(rng.normal(size=(30, 3))) * rng.uniform(1.2, 6.0, (30, 1)):
        found = images(mirror, np.append(place, 1.0))
        point = reflection_points(EYE, place[None], 1.0)
        is_hidden = np.isnan(point).any() or not ((EYE - point) @ point[0] > 0.02 and (place - point) @ point[0] > 0.02)
        if is_hidden:
            continue
        assert len(found.pixels) == 1
        assert np.linalg.norm(found.pixels[0] - looking.project(point)[0]) < 0.5


def test_a_hollow_sphere_shows_several() -> None:
    """Seen from inside near its middle: places on the axis through the eye are seen before and behind it, at least."""
    outside = ball()
    inside = PlacedMirror("bowl", 5.0 * outside.positions, -outside.normals, outside.triangles[:, ::-1], False)
    looking = look_at(np.array([0.0, -1.0, 0.0]), np.array([0.0, 5.0, 0.0]), 400, 300, 2.6)
    place = np.array([2.5, 1.0, 0.3])
    found = images(reflecting(inside, looking), np.append(place, 1.0))
    assert len(found.points) >= 2
    for point in found.points:
        incoming, normal = unit(point - (0.0, -1.0, 0.0)), -unit(point)
        direction = incoming - 2.0 * (incoming @ normal) * normal
        assert unit(place - point) @ direction > 1.0 - 1e-4


def test_the_outline_of_an_area_lamp_in_a_plane_is_its_mirrored_rectangle() -> None:
    looking = view()
    light = lamp("AREA", (0.2, 0.5, 1.0), size=(0.8, 0.5))
    segments, middles = outline(reflecting(flat(), looking), light)
    corners = np.array([[-0.4, -0.25, 0], [0.4, -0.25, 0], [0.4, 0.25, 0], [-0.4, 0.25, 0]])
    expected = looking.project(corners + np.array([0.2, 0.5, -1.0]))
    edges = np.stack([expected, np.roll(expected, -1, axis=0)], axis=1)
    assert len(segments) > 40 and (np.abs(middles[:, 2]) < 1e-9).all()
    for pixel in segments.reshape(-1, 2):
        assert min(_distance(pixel, edge) for edge in edges) < 1.5
    for corner in expected:
        assert np.linalg.norm(segments.reshape(-1, 2) - corner, axis=1).min() < 8.0


@pytest.mark.parametrize("kind", ["POINT", "SUN"])
def test_the_outlines_of_balls_and_suns_in_a_plane_are_their_disks(kind: str) -> None:
    looking = view()
    light = lamp(kind, (0.2, 0.5, 1.0), radius=0.3, angle=0.2)
    light.matrix[:3, :3] = upright(unit(-EYE * (1, 1, -1)))
    segments, middles = outline(reflecting(flat(9.0), looking), light)
    assert len(segments) > 20
    for point in middles:
        incoming = unit(point - EYE)
        direction = incoming * (1, 1, -1)
        if kind == "SUN":
            assert np.arccos(direction @ light.matrix[:3, 2]) == pytest.approx(0.1, rel=0.05)
        else:
            away = np.array([0.2, 0.5, 1.0]) - point
            assert np.linalg.norm(np.cross(away, direction)) == pytest.approx(0.3, rel=0.05)


def test_rays_meet_lamps_before_they_end() -> None:
    light = lamp("POINT", (0.0, 0.0, 5.0), radius=0.5)
    up = np.array([0.0, 0.0, 1.0])
    assert is_met(light, np.array([0.4, 0.0, 0.0]), up, np.inf)
    assert not is_met(light, np.array([0.6, 0.0, 0.0]), up, np.inf)
    assert not is_met(light, np.zeros(3), -up, np.inf)
    assert not is_met(light, np.zeros(3), up, 4.0)
    sun = lamp("SUN", (0.0, 0.0, 0.0), angle=0.1)
    assert is_met(sun, np.zeros(3), unit(np.array([0.0, 0.04, 1.0])), np.inf) and not is_met(sun, np.zeros(3), up, 9.0)
    np.testing.assert_allclose(place_of(sun), [0, 0, 1, 0])


def test_what_is_beside_or_behind_the_picture_is_left_out() -> None:
    whole: Reflecting = reflecting(ball(), view())
    assert (whole.pixels[whole.triangles].min(axis=1) < (400, 300)).all()
    away = look_at(EYE, 2.0 * EYE, 400, 300, 0.7)
    assert len(reflecting(ball(), away).triangles) == 0
    # A floor that goes on behind the eye is split, and keeps what is before it.
    floor = reflecting(flat(50.0), view())
    assert len(floor.triangles) > 100
    found = images(floor, np.array([0.4, 0.9, 0.8, 1.0]))
    np.testing.assert_allclose(found.pixels, view().project(np.array([[0.4, 0.9, -0.8]])), atol=1e-4)


def _distance(pixel: np.ndarray, edge: np.ndarray) -> float:
    along = edge[1] - edge[0]
    share = np.clip((pixel - edge[0]) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(pixel - edge[0] - share * along))


def test_what_a_ray_off_a_bumpy_mirror_leads_to_is_shown_where_the_ray_has_left_it() -> None:
    """By construction: rays of the eye are cast at the mesh and reflected, and places on them looked for."""
    mesh = star_mesh(Bumpy(0.6), 40)
    positions = mesh.positions[mesh.corner_vertex].astype(np.float64)
    normals = unit(mesh.corner_normals.astype(np.float64))
    mirror = PlacedMirror("bumpy", positions, normals, mesh.triangles, False)
    looking, rng = view(), np.random.default_rng(2)
    seen = reflecting(mirror, looking)
    pixels = rng.uniform((0.0, 0.0), (400.0, 300.0), (150, 2))
    lines = [looking.line_of_sight(x, y) for x, y in pixels.tolist()]
    origins, directions = (np.array(part) for part in zip(*lines, strict=True))
    hits = MeshRays(positions, normals, mesh.triangles).first_hits(origins, directions)
    is_met = (hits.triangle >= 0) & (np.einsum("ij,ij->i", hits.normal, directions) < -0.1)
    assert is_met.sum() > 30
    missed = 0
    for pixel, origin, direction, distance, normal in zip(
        pixels[is_met], origins[is_met], directions[is_met], hits.distance[is_met], hits.normal[is_met], strict=True
    ):
        ray = reflect_ray(direction, origin + distance * direction, normal)
        found = images(seen, np.append(ray.at(rng.uniform(0.3, 4.0)), 1.0))
        missed += not (np.linalg.norm(found.pixels - pixel, axis=1) < 0.05).any()
    assert missed == 0


def test_images_on_a_bumpy_mirror_are_those_that_the_exhaustive_search_finds() -> None:
    """But for one in some hundred at most."""
    mesh = star_mesh(Bumpy(0.6), 24)
    positions = mesh.positions[mesh.corner_vertex].astype(np.float64)
    normals = unit(mesh.corner_normals.astype(np.float64))
    looking, rng = view(), np.random.default_rng(6)
    seen = reflecting(PlacedMirror("bumpy", positions, normals, mesh.triangles, False), looking)
    places = np.column_stack([unit(rng.normal(size=(60, 3))) * rng.uniform(1.5, 5.0, (60, 1)), np.ones(60)])
    known = ReflectingMesh(positions, normals, mesh.triangles).points(looking.eye, places)
    pixels = looking.project(known.point)
    inside = ((pixels > 0.0) & (pixels < (400.0, 300.0))).all(axis=1)
    counts, missed = [], 0
    for number, place in enumerate(places):
        wanted, found = pixels[(known.row == number) & inside], images(seen, place).pixels
        counts.append(len(wanted))
        missed += sum(np.linalg.norm(found - pixel, axis=1).min(initial=np.inf) > 0.1 for pixel in wanted)
    assert max(counts) > 3 and sum(counts) > 150
    assert missed <= 1
