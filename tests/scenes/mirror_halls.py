# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror of any kind in a hall of random clutter, as scene arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from scenes.star_meshes import centroids, inverted, lattice, mesh_of, only, star_mesh, torus


def vase() -> MeshArrays:
    """A turned body that bends both ways, closed."""
    height = np.linspace(-1.0, 1.0, 49)[:, None]
    around = np.arange(64)[None] * np.pi / 32
    radius = 0.02 + 0.98 * np.sqrt(np.maximum(1.0 - height**2, 0.0)) * (0.55 + 0.25 * np.cos(4.0 * height))
    positions = np.stack(
        np.broadcast_arrays(radius * np.cos(around), radius * np.sin(around), 1.2 * height), -1
    ).reshape(-1, 3)
    mesh = mesh_of(positions, positions, lattice(49, 64))
    return replace(mesh, corner_normals=smooth_normals(mesh))


def bowl() -> MeshArrays:
    """The lower half of a ball, open: the eye sees into it."""
    ball = star_mesh(Ellipsoid(), 32)
    return only(ball, centroids(ball)[:, 2] < 0.0)


def wave() -> MeshArrays:
    """An open sheet with hills and hollows."""
    x, y = np.meshgrid(np.linspace(-1.2, 1.2, 41), np.linspace(-1.2, 1.2, 41), indexing="ij")
    z = 0.25 * np.sin(4.0 * x) * np.cos(3.0 * y)
    slope = np.stack(
        [-np.cos(4.0 * x) * np.cos(3.0 * y), 0.75 * np.sin(4.0 * x) * np.sin(3.0 * y), np.ones_like(x)], -1
    )
    quads = lattice(41, 41)
    # (the lattice joins its columns up: without those)
    return mesh_of(np.stack([x, y, z], -1).reshape(-1, 3), slope.reshape(-1, 3), quads[np.ptp(quads % 41, axis=1) < 40])


def smooth_normals(mesh: MeshArrays) -> np.ndarray:
    """(vertices, 3) means of the triangles' normals, by area."""
    corners = mesh.positions[mesh.triangles].astype(np.float64)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros((len(mesh.positions), 3))
    for k in range(3):
        np.add.at(total, mesh.triangles[:, k], normal)
    # The ends of a turned body are single points many times over.
    total[np.linalg.norm(total, axis=1) < 1e-9] = (0.0, 0.0, 1.0)
    return unit(total).astype(np.float32)


MIRRORS: dict[str, Callable[[], MeshArrays]] = {
    "sphere": lambda: star_mesh(Ellipsoid(), 32),
    "ellipsoid": lambda: star_mesh(Ellipsoid(1.2, 0.6, 0.4), 32),
    "torus": lambda: torus(0.9, 0.35),
    "vase": vase,
    "bowl": bowl,
    "wave": wave,
}


def hall(mirror: str, seed: int = 0, clutter: int = 24, scale: float = 1.0, mirrors: int = 1) -> SceneArrays:
    """A mirror of about unit size about the origin, balls, tori and slabs from contact to 6 radii around it, a floor.

    The clutter is placed by any matrices: turned, stretched, turned inside out. `scale` is of the whole scene;
    `mirrors`: so many copies of the mirror beside each other, object_id 1, 2, ...
    """
    rng = np.random.default_rng(seed)
    shape = MIRRORS[mirror]()
    shapes = [shape, star_mesh(Ellipsoid(), 6), torus(0.8, 0.3, 12), slab()]
    # The extraction winds triangles the other way for instances of negative scale; normals stay.
    turned = [replace(inverted(item), corner_normals=item.corner_normals) for item in shapes]
    instances = []
    for number in range(mirrors):
        matrix = np.eye(4)
        matrix[0, 3] = 2.6 * number
        instances.append(InstanceArrays(f"mirror {number}", number + 1, 0, matrix, (1,)))
    floor = np.diag([12.0, 12.0, 0.05, 1.0])
    floor[2, 3] = -1.35
    instances.append(InstanceArrays("floor", mirrors + 1, 3, floor, (0,)))
    for index in range(clutter):
        away = 1.05 + 5.0 * rng.random() ** 2
        linear = np.linalg.qr(rng.normal(size=(3, 3)))[0] * rng.uniform(0.05, 0.6, 3)
        matrix = np.eye(4)
        matrix[:3, :3] = linear
        size = float(np.linalg.norm(linear, axis=0).max())
        matrix[:3, 3] = unit(rng.normal(size=(1, 3)))[0] * (away + size)
        kind = 1 + int(rng.integers(3))
        mesh = kind + (4 if np.linalg.det(linear) < 0.0 else 0)
        instances.append(InstanceArrays(f"thing {index}", mirrors + 2 + index, mesh, matrix, (0,)))
    for number, instance in enumerate(instances):
        matrix = instance.matrix.copy()
        matrix[:3] *= scale
        instances[number] = replace(instance, matrix=matrix)
    materials = (MaterialArrays("gray"), MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1.0, roughness=0.0))
    return SceneArrays(
        (*shapes, *turned), tuple(instances), materials, (), (), WorldArrays((0.5, 0.5, 0.5)),
        tuple(range(1, mirrors + 1)),
    )  # fmt: skip


def slab() -> MeshArrays:
    """The cube from -1 to 1, flat-shaded."""
    corners = np.indices((2, 2, 2)).reshape(3, 8).T * 2.0 - 1.0
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    places = corners[quads].reshape(-1, 3)
    normals = np.repeat(
        np.cross(corners[quads[:, 1]] - corners[quads[:, 0]], corners[quads[:, 2]] - corners[quads[:, 0]]), 4, axis=0
    )
    triangles = (4 * np.arange(6)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    return mesh_of(places, normals, triangles)
