# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that are said not to meet their own mirror again, against every triangle."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.rays import escape_cones
from curvrefl.curvrefl_addon.renderer.rays.escape_cones import CELLS, EscapeBuild, EscapeCones
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from scenes.mirror_halls import slab
from scenes.star_meshes import inverted, joined, mesh_of, moved, star_mesh, torus

RAYS = 600


def dented() -> MeshArrays:
    """A ball with hollows."""
    ball = star_mesh(Ellipsoid(), 24)
    x, y, z = ball.positions.astype(np.float64).T
    radius = 1.0 + 0.12 * (np.sin(4.0 * x + 0.5) * np.cos(3.0 * y) + np.sin(5.0 * z + 1.0) * np.cos(3.0 * x))
    return mesh_of(ball.positions * radius[:, None], ball.corner_normals, ball.triangles)


def rays_off(mesh: MeshArrays, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (n, 3) on a mesh, ways (n, 3) outward from them, and the triangle (n,) that each is on."""
    rng = np.random.default_rng(seed)
    corners = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    triangle = rng.choice(len(corners), RAYS, p=area / area.sum())
    weights = rng.dirichlet((1.0, 1.0, 1.0), RAYS)
    ways = rng.normal(size=(RAYS, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    ways += 1.0001 * normals[triangle] / area[triangle, None]
    return np.einsum("nk,nkj->nj", weights, corners[triangle]), ways, triangle


def meets_front(mesh: MeshArrays, origins: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """(n,) whether a ray meets a triangle from the front, not where it sets out."""
    a, b, c = (mesh.positions[mesh.corner_vertex[mesh.triangles[:, k]]].astype(np.float64) for k in range(3))
    ab, ac = b - a, c - a
    found = np.zeros(len(origins), bool)
    for k, (origin, way) in enumerate(zip(origins, ways, strict=True)):
        across = np.cross(way, ac)
        determinant = np.einsum("ij,ij->i", ab, across)
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = origin - a
            u = np.einsum("ij,ij->i", offset, across) / determinant
            turned = np.cross(offset, ab)
            v = turned @ way / determinant
            range_ = np.einsum("ij,ij->i", ac, turned) / determinant
            hit = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (range_ > 1e-5) & (determinant > 0.0)
        found[k] = hit.any()
    return found


def escaping(found: EscapeCones, origins: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """(n,) as `exact.frag.glsl` has it."""
    cell = np.clip(np.floor((origins - found.low) / found.size).astype(int), 0, CELLS - 1)
    cones = found.cones[cell[:, 0] + CELLS * (cell[:, 1] + CELLS * cell[:, 2])]
    return np.einsum("ij,ij->i", cones[:, :3], ways) > cones[:, 3] * np.linalg.norm(ways, axis=1)


@pytest.mark.parametrize(
    ("name", "mesh", "share"),
    [
        ("torus", torus(0.9, 0.35), 0.3),
        ("dented", dented(), 0.3),
        ("two balls", joined(star_mesh(Ellipsoid(), 24), moved(star_mesh(Ellipsoid(), 24), (2.3, 0.0, 0.0))), 0.3),
        ("far from its origin", moved(torus(0.9, 0.35), (300.0, -200.0, 50.0)), 0.3),
        ("slab", slab(), 0.0),
        ("inside out", inverted(torus(0.9, 0.35)), 0.0),
    ],
)
def test_what_is_said_to_escape_does(name: str, mesh: MeshArrays, share: float) -> None:
    found = EscapeBuild(mesh).finished()
    for seed in (1, 2):
        origins, ways, _ = rays_off(mesh, seed)
        escapes = escaping(found, origins, ways)
        assert escapes.mean() >= share, name
        assert not meets_front(mesh, origins[escapes], ways[escapes]).any(), name


def test_from_inside_out_nothing_escapes() -> None:
    found = EscapeBuild(inverted(torus(0.9, 0.35))).finished()
    assert (found.cones[:, 3] > 1.0).all()


def test_too_many_large_triangles_have_no_cones(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(escape_cones, "MOST_OVERLAPS", 1000)
    build = EscapeBuild(torus(0.9, 0.35))
    assert not build.step()
    assert (build.finished().cones[:, 3] > 1.0).all()
