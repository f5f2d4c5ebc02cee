# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of what mirrors show against closed forms, and against rays in float64."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.mesh_rays import MeshRays
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.truth.truth import FAR_AWAY
from scenes.mirror_room import MIRROR, Room
from scenes.views import lines_of_sight, look_at
from truth_scenes import RED, drawn, with_mirrors

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize("method", ["exact", "planar"])
def test_a_flat_mirror_shows_the_mirrored_world(method: str) -> None:
    """Mirror in the plane y = 2, a wall of 4 x 3 meters at y = -3 behind the eye: all by reflecting the eye."""
    room = Room()
    room.add_rectangle((0.0, 2.0, 0.0), (1.1, 0.0, 0.0), (0.0, 0.0, 1.1))
    room.add_rectangle((0.3, -3.0, 0.2), (-2.0, 0.0, 0.0), (0.0, 0.0, 1.5))
    scene = with_mirrors(room, 1)
    eye = np.array([0.4, -1.0, 0.3])
    view = look_at(eye, np.array([0.0, 2.0, 0.1]), 64, 48, 0.7)
    frame = drawn(scene, view, method)
    truth = frame.truth
    _, sight = lines_of_sight(view)
    to_mirror = (2.0 - eye[1]) / sight[..., 1]
    seen = eye + to_mirror[..., None] * sight
    on_mirror = (np.abs(seen[..., [0, 2]]) < 1.1 - 0.01).all(axis=-1)
    assert 500 < on_mirror.sum() < on_mirror.size
    whole = 8.0 / sight[..., 1]
    shown = (eye + whole[..., None] * sight) * [1.0, -1.0, 1.0] + [0.0, 4.0, 0.0]
    u, v = 0.5 - (shown[..., 0] - 0.3) / 4.0, 0.5 + (shown[..., 2] - 0.2) / 3.0
    inside = on_mirror & (np.abs(u - 0.5) < 0.499) & (np.abs(v - 0.5) < 0.499)
    missed = on_mirror & ((np.abs(u - 0.5) > 0.501) | (np.abs(v - 0.5) > 0.501))
    assert inside.sum() > 300 and missed.sum() > 30
    depth, distance, length = truth.depth(), truth.distance(), truth.path_length()
    np.testing.assert_allclose(depth[inside], whole[inside], rtol=2e-6)
    np.testing.assert_allclose(distance[inside], (whole - to_mirror)[inside], rtol=2e-6)
    np.testing.assert_allclose(length[inside], whole[inside], rtol=2e-6)
    np.testing.assert_array_equal(np.stack([depth, distance, length])[:, missed], np.float32(FAR_AWAY))
    uv = truth.uv()
    np.testing.assert_allclose(uv[inside], np.stack([u, v, np.ones_like(u)], -1)[inside], atol=2e-6)
    assert not uv[missed].any()
    np.testing.assert_allclose(truth.normal()[inside], np.tile([0.0, 1.0, 0.0], (inside.sum(), 1)), atol=1e-6)
    np.testing.assert_allclose(truth.albedo()[inside], np.tile(RED, (inside.sum(), 1)), atol=1e-6)
    assert not truth.normal()[missed].any() and not truth.albedo()[missed].any()
    np.testing.assert_allclose(truth.incidence()[on_mirror], np.arccos(sight[..., 1])[on_mirror], atol=2e-6)
    np.testing.assert_array_equal(truth.mirror_id()[on_mirror], 10.0)
    outside = (np.abs(seen[..., [0, 2]]) > 1.1 + 0.01).any(axis=-1)
    for name in ("normal", "albedo", "depth", "distance", "path_length", "uv", "incidence", "mirror_id"):
        assert not getattr(truth, name)()[outside].any(), name


def test_a_ball_shows_what_closed_forms_say() -> None:
    room = Room()
    room.add_mirror(Ellipsoid(), 512)
    ball = room.add_ball((1.5, -1.0, 0.4), 0.5)
    room.add_rectangle((0.0, 0.0, -1.2), (5.0, 0.0, 0.0), (0.0, 5.0, 0.0))
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 80, 60, 0.45)
    on_ball, hit, shown = room.seen_in_ball(view)
    origin, sight = lines_of_sight(view)
    truth = drawn(room.arrays(), view).truth
    along = (origin * sight).sum(-1)
    reach = -along - np.sqrt(np.maximum(along**2 - (origin**2).sum(-1) + 1.0, 0.0))
    seen = origin + reach[..., None] * sight
    facing = -(seen * sight).sum(-1)
    # (At the rim the mesh's facets are seen edge on.)
    steep = on_ball & (facing > 0.3) & (truth.mirror_id() == MIRROR)
    assert steep.sum() > 1000
    np.testing.assert_allclose(truth.incidence()[steep], np.arccos(facing)[steep], atol=2e-3)
    for number, normal in ((ball, unit(shown - [1.5, -1.0, 0.4])), (3, np.array([0.0, 0.0, 1.0]))):
        here = steep & (hit == number) & (np.linalg.norm(truth.normal() - normal, axis=-1) < 0.1)
        assert here.sum() > 0.97 * (steep & (hit == number)).sum() > 20
        off = np.linalg.norm(truth.normal()[here] - np.broadcast_to(normal, seen.shape)[here], axis=1)
        assert np.median(off) < 2e-3
        onward = np.linalg.norm(shown - seen, axis=-1)
        assert np.median(np.abs(truth.distance() - onward)[here] / onward[here]) < 4e-3
        whole = onward + np.linalg.norm(seen - view.place, axis=-1)
        assert np.median(np.abs(truth.depth() - whole)[here] / whole[here]) < 4e-4


def test_a_path_goes_on_from_mirror_to_mirror() -> None:
    """Between flat mirrors at y = 1 and y = -1, seen from between them, a sheet: its images stand at known places."""
    room = Room()
    room.add_rectangle((0.0, 1.0, 0.0), (40.0, 0.0, 0.0), (0.0, 0.0, 40.0))
    room.add_rectangle((0.0, -1.0, 0.0), (40.0, 0.0, 0.0), (0.0, 0.0, 40.0))
    room.add_rectangle((0.0, 0.0, -3.0), (40.0, 0.0, 0.0), (0.0, 40.0, 0.0))
    scene = with_mirrors(room, 1, 2)
    view = look_at(np.zeros(3), np.array([0.0, 1.0, -1.0]), 60, 60, 0.6)
    frame = drawn(scene, view, bounces=6)
    _, sight = lines_of_sight(view)
    # The floor z = -3 goes on in all images: a path to it is as long as if there were no mirrors.
    whole = 3.0 / np.abs(sight[..., 2])
    met = np.rint(0.5 * np.abs(whole * sight[..., 1]))
    is_clear = np.abs(0.5 * np.abs(whole * sight[..., 1]) % 1.0 - 0.5) > 0.02
    for count in (1, 2, 3):
        here = is_clear & (met == count) & (sight[..., 1] > 0.0)
        assert here.sum() > 20, count
        np.testing.assert_allclose(frame.truth.path_length()[here], whole[here], rtol=2e-5)
        first = (2.0 if count > 1 else np.inf) / sight[..., 1]
        np.testing.assert_allclose(
            frame.truth.distance()[here], np.minimum(first, whole - 1.0 / sight[..., 1])[here], rtol=2e-5
        )


def test_orthographic_depth_is_from_the_plane_of_the_camera() -> None:
    room = Room()
    room.add_rectangle((0.0, 2.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    room.add_rectangle((0.0, -3.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 4.0))
    eye = np.array([0.0, -1.0, 0.0])
    view = look_at(eye, np.array([0.0, 2.0, 0.0]), 32, 32, 0.5)
    clip = np.diag([1.0, 1.0, -2.0 / 100.0, 1.0])
    clip[2, 3] = -1.0
    view = replace(view, view_to_clip=clip)
    truth = drawn(with_mirrors(room, 1), view).truth
    # (the wall behind the camera's plane is met on the way back)
    np.testing.assert_allclose(truth.depth(), 8.0, rtol=1e-6)
    np.testing.assert_allclose(truth.incidence(), 0.0, atol=1e-3)


def test_rays_in_float64_say_the_same() -> None:
    """A bumpy mirror: from where the eye's rays meet its mesh, with its shading normals, to a bumpy thing's mesh."""
    room = Room()
    room.add_mirror(Bumpy(0.15), 96)
    scene = room.arrays()
    place = np.diag([0.5, 0.8, 0.6, 1.0])
    place[:3, 3] = [1.0, -2.0, 0.5]
    other = replace(scene.instances[0], object_id=2, matrix=place, materials=(0,))
    scene = replace(scene, instances=(*scene.instances, other))
    view = look_at(np.array([0.0, -6.0, 1.0]), np.zeros(3), 80, 60, 0.25)
    frame = drawn(scene, view)
    mesh = scene.meshes[0]
    turn = np.linalg.inv(place[:3, :3]).T
    mirror = MeshRays(mesh.positions, mesh.corner_normals, mesh.triangles)
    thing = MeshRays(mesh.positions @ place[:3, :3].T + place[:3, 3], mesh.corner_normals @ turn.T, mesh.triangles)
    origin, sight = (rays.reshape(-1, 3) for rays in lines_of_sight(view))
    first, cover = mirror.first_hits(origin, sight), thing.first_hits(origin, sight)
    on_mirror = (first.distance < cover.distance) & np.isfinite(first.distance)
    distance = np.where(on_mirror, first.distance, 0.0)
    seen, facing = origin + distance[:, None] * sight, np.nan_to_num(first.normal)
    cosine = -np.einsum("ij,ij->i", sight, facing)
    ray = unit(sight + 2.0 * cosine[:, None] * facing)
    onward, own = thing.first_hits(seen, ray), mirror.first_hits(seen, ray, 1e-3)
    shows = on_mirror & np.isfinite(onward.distance) & (onward.distance < own.distance) & (cosine > 0.2)
    truth = frame.truth
    found = (frame.truth.mirror_id().ravel() == MIRROR) & (truth.distance().ravel() < FAR_AWAY)
    both = shows & found & (np.linalg.norm(truth.normal().reshape(-1, 3) - onward.normal, axis=1) < 0.2)
    assert shows.sum() > 200 and both.sum() > 0.97 * shows.sum()
    assert np.median(np.linalg.norm(truth.normal().reshape(-1, 3) - onward.normal, axis=1)[both]) < 2e-5
    assert np.median(np.abs(truth.distance().ravel() - onward.distance)[both]) < 1e-5
    np.testing.assert_allclose(truth.incidence().ravel()[both], np.arccos(cosine)[both], atol=1e-4)


def test_a_scene_without_a_mirror_in_view_has_empty_pictures() -> None:
    room = Room()
    room.add_rectangle((0.0, 2.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    view = look_at(np.array([0.0, -1.0, 0.0]), np.array([0.0, -2.0, 0.0]), 16, 12, 0.5)
    for scene in (with_mirrors(room, 1), with_mirrors(room)):
        truth = drawn(scene, view).truth
        assert truth.depth().shape == (12, 16) and truth.uv().shape == (12, 16, 3)
        assert not truth.depth().any() and not truth.mirror_id().any()
