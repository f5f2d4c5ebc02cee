# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""UV-mapped meshes are baked against shapes that are known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.parametric_surfaces import SampledMap
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.mirrors.parametric_map import MOST_OVERLAP, _islands
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from mirrors.uv_meshes import SHAPES, bake, grid_mesh, rigid, sheet, uv_sphere
from scenes.star_meshes import inverted, mesh_of

pytestmark = pytest.mark.usefixtures("gpu")


def normals_of(surface: SampledMap) -> np.ndarray:
    textures = (surface.surface_point, surface.surface_du, surface.surface_dv)
    return np.stack([texture[..., 3] for texture in textures], axis=-1).astype(float)


def test_uv_sphere_is_baked() -> None:
    baked = bake(uv_sphere())
    surface = baked.surface
    points, normals = surface.surface_point[..., :3].astype(float), normals_of(surface)
    # Chords of 2.8 degrees lie within 1 - cos(2 deg) of the sphere, the diagonals of its quads included.
    radius = np.linalg.norm(points, axis=-1)
    assert radius.max() <= 1.0 + 1e-6 and radius.min() > 0.9993
    np.testing.assert_allclose(normals, points / radius[..., None], atol=2e-3)
    # The pole rows leave out every second triangle.
    assert baked.cover == pytest.approx(1.0 - 1.0 / 64.0, abs=1e-3)
    assert surface.wraps == (True, False) and not surface.is_open and surface.solid is not None

    # Away from the poles f is longitude and latitude, up to where the longitude begins and which way it runs.
    rows = slice(32, 480)
    v = (np.arange(512) + 0.5)[rows, None] / 512.0
    np.testing.assert_allclose(points[rows, :, 2], -np.cos(np.pi * v) + np.zeros((1, 512)), atol=2e-3)
    up = np.array([0.0, 0.0, 1.0])
    eastwards = np.cross(up, points[rows])
    du, dv = surface.surface_du[rows, :, :3], surface.surface_dv[rows, :, :3]
    np.testing.assert_allclose(du, 2.0 * np.pi * eastwards, atol=0.03)
    northwards = unit(up - normals[rows, :, 2:] * normals[rows])
    np.testing.assert_allclose(dv, np.pi * northwards, atol=0.03)


def test_tangents_are_perpendicular_to_shading_normals() -> None:
    """Also where those are not the surface's own, as Cycles reflects about them."""
    mesh = uv_sphere(32, 16)
    bent = unit(mesh.corner_normals + 0.3 * np.sin(7.0 * mesh.positions[mesh.corner_vertex]))
    surface = bake(replace(mesh, corner_normals=bent.astype(np.float32))).surface
    normals = normals_of(surface)
    assert np.linalg.norm(normals - surface.surface_point[..., :3], axis=-1).max() > 0.1
    for tangent in (surface.surface_du, surface.surface_dv):
        np.testing.assert_allclose((tangent[..., :3] * normals).sum(axis=-1), 0.0, atol=1e-5)


def test_poles_close() -> None:
    """What the map leaves out at a pole is filled so that f goes around it without a step, and f_u vanishes at it."""
    surface = bake(uv_sphere(32, 16)).surface
    points = surface.surface_point[..., :3].astype(float)
    for row in (0, -1):
        assert np.linalg.norm(points[row] - [0.0, 0.0, np.sign(points[row, 0, 2])], axis=-1).max() < 0.02
    steps = np.linalg.norm(points - np.roll(points, 1, axis=1), axis=-1)
    # The middle of the triangles' sides at the pole is where they are twice as wide as the whole row's mean step.
    assert steps.max() < 2.1 * np.pi * 2.0 / 512.0
    ring = np.linalg.norm(surface.surface_du[..., :3], axis=-1).mean(axis=1)
    assert ring[0] < 0.05 * ring[256] and ring[-1] < 0.05 * ring[256]


@pytest.mark.parametrize("name", SHAPES)
def test_grids_are_baked(name: str) -> None:
    make, wraps, is_open = SHAPES[name]
    mesh = make()
    surface = bake(mesh).surface
    assert surface.wraps == wraps and surface.is_open == is_open and surface.solid is None
    assert mesh.corner_uv is not None
    uv = mesh.corner_uv.astype(float)
    inner = ((uv > 0.01) & (uv < 0.99)).all(axis=1)
    at = surface.sample(uv[inner])
    np.testing.assert_allclose(at.position, mesh.positions[inner], atol=5e-3)
    np.testing.assert_allclose(at.normal, mesh.corner_normals[inner], atol=5e-3)
    step = 1.0 / 64.0
    for tangent, offset in ((at.du, [step, 0.0]), (at.dv, [0.0, step])):
        ahead, behind = (surface.sample(uv[inner] + sign * np.array(offset)).position for sign in (1, -1))
        error = np.linalg.norm(tangent - (ahead - behind) / (2.0 * step), axis=1) / np.linalg.norm(tangent, axis=1)
        clear = ((uv[inner] > 0.03) & (uv[inner] < 0.97)).all(axis=1)
        assert error[clear].max() < 0.02


def test_directions_lead_to_their_points() -> None:
    surface = bake(uv_sphere()).surface
    u = unit(np.random.default_rng(2).normal(size=(1000, 3)))
    found = unit(surface.sample(surface.uv_of_direction(u)).position)
    # Half the diagonal of a texel of 90 / 64 degrees; a pole's parameters are anything.
    assert np.degrees(np.arccos((found * u).sum(axis=1)))[np.abs(u[:, 2]) < 0.99].max() < 1.5
    assert surface.solid is not None
    np.testing.assert_allclose(surface.solid.radius(u)[0], 1.0, atol=2e-3)


@pytest.mark.parametrize("mirrored", [False, True], ids=["stretched", "mirrored"])
def test_placed_meshes_are_baked_in_the_map_frame(mirrored: bool) -> None:
    matrix, world_to_map = rigid(3, (4.0, -1.0, 2.0)), rigid(4, (0.3, 0.2, 0.1))
    stretch = np.diag([2.0, 1.0, -0.5 if mirrored else 0.5, 1.0])
    world_to_map = world_to_map @ np.linalg.inv(matrix)
    surface = bake(uv_sphere(), matrix @ stretch, world_to_map).surface
    back = np.linalg.inv(world_to_map @ matrix @ stretch)
    on_ball = surface.surface_point[..., :3] @ back[:3, :3].T + back[:3, 3]
    radius = np.linalg.norm(on_ball, axis=-1)
    assert radius.max() < 1.0 + 1e-5 and radius.min() > 0.999
    outwards = unit((on_ball / radius[..., None]) @ back[:3, :3])
    assert (normals_of(surface) * outwards).sum(axis=-1).min() > 0.999
    # df/du is the placed surface's: taken back to the ball it runs eastwards.
    east = surface.surface_du[128:384, :, :3] @ back[:3, :3].T
    np.testing.assert_allclose(east, 2.0 * np.pi * np.cross([0, 0, 1], on_ball[128:384]), atol=0.05)


def test_normals_point_outwards_of_an_inverted_mesh() -> None:
    surface = bake(inverted(uv_sphere(32, 16))).surface
    assert (normals_of(surface) * surface.surface_point[..., :3]).sum(axis=-1).min() > 0.9


def test_an_unwelded_seam_still_wraps() -> None:
    half = grid_mesh(lambda u, v: (2 * [np.column_stack([np.cos(np.pi * u), np.sin(np.pi * u), v])])[:2])
    whole = grid_mesh(lambda u, v: (2 * [np.column_stack([np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), v])])[:2])
    assert bake(half).surface.wraps == (False, False)
    assert bake(whole).surface.wraps == (True, False)


def with_uv(change: Callable[[np.ndarray], np.ndarray]) -> MeshArrays:
    mesh = uv_sphere(32, 16)
    assert mesh.corner_uv is not None
    return replace(mesh, corner_uv=change(mesh.corner_uv.astype(np.float64)).astype(np.float32))


def islands() -> MeshArrays:
    """Two sheets that share the square."""
    left, right = grid_mesh(sheet, 8), grid_mesh(sheet, 8)
    assert left.corner_uv is not None and right.corner_uv is not None
    count = len(left.positions)
    joined = mesh_of(
        np.concatenate([left.positions, right.positions + 3.0]),
        np.concatenate([left.corner_normals, right.corner_normals]),
        np.concatenate([left.triangles, right.triangles + count]),
    )
    uv = np.concatenate([left.corner_uv * [0.49, 1.0], right.corner_uv * [0.49, 1.0] + [0.51, 0.0]])
    return replace(joined, corner_uv=uv.astype(np.float32))


REFUSED = {
    "has no UV map": lambda: replace(uv_sphere(8, 4), corner_uv=None),
    "overlaps itself": lambda: with_uv(
        lambda uv: np.column_stack([np.minimum(2.0 * uv[:, 0], 2.0 - 2.0 * uv[:, 0]), uv[:, 1]])
    ),
    "covers only": lambda: with_uv(lambda uv: 0.8 * uv),
    "reaches out of the unit square": lambda: with_uv(lambda uv: uv * [2.0, 1.0]),
    "not finite": lambda: with_uv(lambda uv: np.where(uv > 0.9, np.nan, uv)),
    "in 2 islands": islands,
}


@pytest.mark.parametrize("words", REFUSED)
def test_unfit_maps_are_refused(words: str) -> None:
    with pytest.raises(InputError) as refusal:
        bake(REFUSED[words]())
    text = str(refusal.value)
    assert (
        words in text and text.startswith(("The UV map of", '"Ball"')) and text.endswith(".") and text.count(". ") == 0
    )


def test_islands_are_counted_as_by_flooding() -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        points = int(random.integers(3, 120))
        groups = random.integers(points, size=(int(random.integers(1, 60)), 3))
        parts: list[set[int]] = []
        for triangle in groups.tolist():
            joined = [part for part in parts if part & set(triangle)]
            parts = [part for part in parts if not part & set(triangle)] + [set(triangle).union(*joined)]
        assert _islands(groups, np.ones(len(groups))) == sum(
            sum(bool(part & set(triangle)) for triangle in groups.tolist()) > MOST_OVERLAP * len(groups)
            for part in parts
        )
