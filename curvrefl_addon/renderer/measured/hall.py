# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of any size to measure on, out of numpy alone: a mirror in the middle of clutter over a floor.

The shapes and places are the same at every size: more triangles only make them smoother, so that what a picture shows
hardly changes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit
from ...scene.arrays import (
    Float64Array,
    InstanceArrays,
    Int32Array,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from ...scene.camera.looking import look_at
from ...scene.camera.view import View
from ...scene.meshes.made import quad_mesh, smooth_mesh

THINGS = 24
"""Objects around the mirror"""
NEAREST, FARTHEST = 1.4, 6.0
"""Distances of their centers, in radii of the mirror"""
MIRROR_BANDS = 48
GRAY, CHROME = 0, 1
EYE = (0.0, -6.0, 2.0)


def hall(triangles: int, things: int = THINGS, as_one: bool = False, seed: int = 0) -> SceneArrays:
    """An ellipsoid mirror, a floor, and about so many `triangles` in bumpy balls and tori around.

    With `as_one` all these are one mesh: the largest that the scene can have, and one that can deform as a whole.
    """
    rng = np.random.default_rng(seed)
    meshes = [radial_mesh(Ellipsoid(1.0, 0.8, 0.7), MIRROR_BANDS, 2 * MIRROR_BANDS), _floor()]
    instances = [
        InstanceArrays("mirror", 1, 0, np.eye(4), (CHROME,)),
        InstanceArrays("floor", 2, 1, np.eye(4), (GRAY,)),
    ]
    clutter, matrices = [], []
    for index in range(things):
        rows = max(round(np.sqrt(triangles / things / 4.0)), 3)
        clutter.append(torus_mesh(0.8, 0.3, rows, 2 * rows) if index % 3 == 0 else bumpy_mesh(rows, index))
        matrices.append(placed(rng))
    if as_one:
        meshes.append(joined(clutter, matrices))
        instances.append(InstanceArrays("clutter", 3, 2, np.eye(4), (GRAY,)))
    else:
        for index, (mesh, matrix) in enumerate(zip(clutter, matrices, strict=True)):
            instances.append(InstanceArrays(f"thing {index}", 3 + index, len(meshes), matrix, (GRAY,)))
            meshes.append(mesh)
    materials = (MaterialArrays("gray"), MaterialArrays("chrome", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0))
    return SceneArrays(tuple(meshes), tuple(instances), materials, (), (), WorldArrays((0.5, 0.5, 0.5)), (1,))


def view_of_mirror(width: int, height: int, mirror_pixels: float, turn: float = 0.0) -> View:
    """The mirror in the middle, about so many pixels wide; `turn`: the eye goes around it so far, radians."""
    eye = np.array(EYE)
    turned = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]]) @ eye
    # The half width of the mirror at the eye's distance takes half of `mirror_pixels` of half of `width`.
    slope = (1.0 / np.linalg.norm(eye)) * width / mirror_pixels
    return look_at(turned, np.zeros(3), width, height, 2.0 * np.arctan(slope))


def radial_mesh(surface: RadialSurface, rows: int, columns: int) -> MeshArrays:
    """A star-shaped surface over latitudes and longitudes: 2 rows columns triangles."""
    polar = np.linspace(0.0, np.pi, rows + 1)[:, None]
    around = np.arange(columns)[None] * 2.0 * np.pi / columns
    u = np.stack(np.broadcast_arrays(np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)), -1)
    u = u.reshape(-1, 3)
    radius, gradient = surface.radius(u)
    normals = unit(radius[:, None] * u - gradient)
    return smooth_mesh("mesh", radius[:, None] * u, normals, _lattice(rows + 1, columns, wrap_rows=False))


def bumpy_mesh(rows: int, seed: int) -> MeshArrays:
    """A ball with bumps, each seed another one."""
    return radial_mesh(Bumpy(0.1 + 0.05 * (seed % 5)), rows, 2 * rows)


def torus_mesh(ring: float, tube: float, rows: int, columns: int) -> MeshArrays:
    """About the z axis."""
    a, b = np.meshgrid(np.arange(rows) * 2.0 * np.pi / rows, np.arange(columns) * 2.0 * np.pi / columns, indexing="ij")
    normals = np.stack([np.cos(a) * np.cos(b), np.cos(a) * np.sin(b), np.sin(a)], -1).reshape(-1, 3)
    centers = ring * np.stack([np.cos(b), np.sin(b), np.zeros_like(b)], -1).reshape(-1, 3)
    return smooth_mesh("mesh", centers + tube * normals, unit(normals), _lattice(rows, columns, wrap_rows=True))


def joined(meshes: Sequence[MeshArrays], matrices: Sequence[Float64Array]) -> MeshArrays:
    """All in one, each by a matrix that turns and scales alike in all directions."""
    starts = np.concatenate([[0], np.cumsum([len(mesh.positions) for mesh in meshes])])
    places = [m.positions @ a[:3, :3].T + a[:3, 3] for m, a in zip(meshes, matrices, strict=True)]
    normals = [m.corner_normals @ a[:3, :3].T for m, a in zip(meshes, matrices, strict=True)]
    triangles = [mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]
    return smooth_mesh("mesh", np.concatenate(places), unit(np.concatenate(normals)), np.concatenate(triangles))


def placed(rng: np.random.Generator) -> Float64Array:
    """A matrix (4, 4) of something of about unit size, between NEAREST and FARTHEST and above the floor."""
    size = rng.uniform(0.15, 0.5)
    away = NEAREST + size + (FARTHEST - NEAREST) * rng.random() ** 2
    direction = unit(rng.normal(size=(1, 3)) * (1.0, 1.0, 0.4))[0]
    matrix = np.eye(4)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    matrix[:3, :3] = size * turn * np.sign(np.linalg.det(turn))
    matrix[:3, 3] = away * direction
    matrix[2, 3] = max(matrix[2, 3], -0.9 + size)
    return matrix


def _floor() -> MeshArrays:
    corners = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]) * 9.0
    corners[:, 2] = -1.0
    return quad_mesh("mesh", corners, (0.0, 0.0, 1.0))


def _lattice(rows: int, columns: int, wrap_rows: bool) -> Int32Array:
    """Triangles of rows x columns vertices whose columns join up, and rows too if asked."""
    row, column = np.meshgrid(np.arange(rows if wrap_rows else rows - 1), np.arange(columns), indexing="ij")
    down, right = (row + 1) % rows, (column + 1) % columns
    a, b, c, d = (r * columns + q for r, q in ((row, column), (down, column), (down, right), (row, right)))
    quads = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], 2)
    return quads.reshape(-1, 3).astype(np.int32)
