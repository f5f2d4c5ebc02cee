# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as arrays, without Blender: star-shaped ones with their true normals, and some that are not star-shaped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays

BALL = "Ball"


def mesh_of(positions: Float64Array, normals: Float64Array, triangles: np.ndarray) -> MeshArrays:
    """A mesh whose corners are its vertices."""
    return MeshArrays(
        name="mesh",
        positions=positions.astype(np.float32),
        corner_vertex=np.arange(len(positions), dtype=np.int32),
        corner_normals=unit(normals).astype(np.float32),
        corner_uv=None,
        triangles=triangles.astype(np.int32),
        triangle_slot=np.zeros(len(triangles), np.int32),
    )


def lattice(rows: int, columns: int, wrap_rows: bool = False) -> np.ndarray:
    """Triangles of a lattice of rows x columns vertices whose columns join up (and rows too, if asked)."""
    row, column = np.meshgrid(np.arange(rows if wrap_rows else rows - 1), np.arange(columns), indexing="ij")
    down, right = (row + 1) % rows, (column + 1) % columns
    a, b, c, d = (r * columns + q for r, q in ((row, column), (down, column), (down, right), (row, right)))
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def star_mesh(surface: RadialSurface, bands: int) -> MeshArrays:
    """`surface` sampled at `bands` latitudes and twice as many longitudes: 4 bands^2 triangles."""
    polar = np.linspace(0.0, np.pi, bands + 1)[:, None]
    around = np.arange(2 * bands)[None] * np.pi / bands
    u = np.stack(np.broadcast_arrays(np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)), -1)
    u = u.reshape(-1, 3)
    r, gradient = surface.radius(u)
    return mesh_of(r[:, None] * u, r[:, None] * u - gradient, lattice(bands + 1, 2 * bands))


def torus(ring: float, tube: float, cells: int = 48) -> MeshArrays:
    """About the origin and the z axis."""
    a, b = np.meshgrid(*[np.arange(cells) * 2.0 * np.pi / cells] * 2, indexing="ij")
    normals = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    centers = ring * np.stack([np.cos(a), np.sin(a), np.zeros_like(a)], -1).reshape(-1, 3)
    return mesh_of(centers + tube * normals, normals, lattice(cells, cells, wrap_rows=True))


def prism(outline: Sequence[tuple[float, float]], fans: Sequence[tuple[int, int, int]], height: float) -> MeshArrays:
    """Flat-shaded prism over a counter-clockwise `outline` that `fans` triangulates, from z = 0 to `height`."""
    count = len(outline)
    points = np.array([(x, y, z) for z in (0.0, height) for x, y in outline])
    indices = [(c, b, a) for a, b, c in fans] + [(a + count, b + count, c + count) for a, b, c in fans]
    for i in range(count):
        j = (i + 1) % count
        indices += [(i, j, j + count), (i, j + count, i + count)]
    corners = points[np.array(indices)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return mesh_of(corners.reshape(-1, 3), np.repeat(normals, 3, axis=0), np.arange(3 * len(indices)).reshape(-1, 3))


def corner_block() -> MeshArrays:
    """An L of two arms 4 long and 1 thick: star-shaped about the unit cube where they meet, and nowhere else."""
    outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)]
    return prism(outline, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], 1.0)


def moved(mesh: MeshArrays, offset: Sequence[float], scale: float = 1.0) -> MeshArrays:
    """Scaled, then shifted."""
    return replace(mesh, positions=(mesh.positions * scale + np.array(offset)).astype(np.float32))


def welded(mesh: MeshArrays) -> MeshArrays:
    """Vertices in the same place made one, as at the poles of a `star_mesh`; corners stay."""
    positions, vertex = np.unique(np.round(mesh.positions, 5), axis=0, return_inverse=True)
    return replace(mesh, positions=positions, corner_vertex=vertex.astype(np.int32).ravel()[mesh.corner_vertex])


def inverted(mesh: MeshArrays) -> MeshArrays:
    """Inside out."""
    return replace(mesh, triangles=mesh.triangles[:, ::-1].copy(), corner_normals=-mesh.corner_normals)


def joined(*meshes: MeshArrays) -> MeshArrays:
    """All in one."""
    starts = np.concatenate([[0], np.cumsum([len(mesh.positions) for mesh in meshes])])
    return mesh_of(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.corner_normals for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def only(mesh: MeshArrays, kept: np.ndarray) -> MeshArrays:
    """The triangles `kept` (triangles,)."""
    return replace(mesh, triangles=mesh.triangles[kept], triangle_slot=mesh.triangle_slot[kept])


def centroids(mesh: MeshArrays) -> np.ndarray:
    """(triangles, 3)"""
    return mesh.positions[mesh.corner_vertex[mesh.triangles]].mean(axis=1)


def scene_of(mesh: MeshArrays, *matrices: Float64Array) -> SceneArrays:
    """One object (number 1) that is shown once per matrix, or once where it is."""
    return SceneArrays(
        meshes=(mesh,),
        instances=tuple(InstanceArrays(BALL, 1, 0, matrix, (0,)) for matrix in matrices or (np.eye(4),)),
        materials=(MaterialArrays("default"),),
        images=(),
        lights=(),
        world=WorldArrays(),
        reflectors=(1,),
    )
