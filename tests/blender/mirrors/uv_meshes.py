# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with UV maps whose surfaces are known, and their baking."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces import parametric_surfaces
from curvrefl.curvrefl_addon.renderer.mirrors.parametric_map import ParametricMap, bake_parametric
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MeshArrays
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds, read_mesh
from scenes.star_meshes import mesh_of


def grid_mesh(shape: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], cells: int = 64) -> MeshArrays:
    """`shape` gives points and normals at u and v; corners on a seam are two vertices at one place."""
    steps = np.linspace(0.0, 1.0, cells + 1)
    v, u = (part.ravel() for part in np.meshgrid(steps, steps, indexing="ij"))
    points, normals = shape(u, v)
    row, column = (part.ravel() for part in np.meshgrid(*[np.arange(cells)] * 2, indexing="ij"))
    a = row * (cells + 1) + column
    b, c, d = a + 1, a + cells + 2, a + cells + 1
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return replace(mesh_of(points, normals, triangles), corner_uv=np.column_stack([u, v]).astype(np.float32))


def torus_section(angle: float = np.pi / 2.0) -> MeshArrays:
    surface = parametric_surfaces.TorusSection(angle=angle)

    def shape(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = surface.sample(np.column_stack([u, v]))
        return at.position, at.normal

    return grid_mesh(shape)


def sheet(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A dented sheet, its hollow below."""
    x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
    return np.column_stack([x, y, 0.2 - 0.2 * (x**2 + y**2)]), np.column_stack([0.4 * x, 0.4 * y, np.ones_like(x)])


def uv_sphere(segments: int = 128, rings: int = 64) -> MeshArrays:
    """Blender's own, with its own UV map, shaded smooth."""
    import bmesh
    import bpy

    made = bmesh.new()
    made.loops.layers.uv.new("UVMap")
    bmesh.ops.create_uvsphere(made, u_segments=segments, v_segments=rings, radius=1.0, calc_uvs=True)
    for face in made.faces:
        face.smooth = True
    mesh = bpy.data.meshes.new("Ball")
    made.to_mesh(mesh)
    made.free()
    read = read_mesh(mesh, MeshNeeds(uv_map="")).mesh
    bpy.data.meshes.remove(mesh)
    return read


def bake(mesh: MeshArrays, matrix: np.ndarray | None = None, world_to_map: np.ndarray | None = None) -> ParametricMap:
    identity = np.eye(4)
    instance = InstanceArrays("Ball", 1, 0, identity if matrix is None else matrix, (0,))
    return bake_parametric(mesh, instance, identity if world_to_map is None else world_to_map)


def rigid(seed: int, place: tuple[float, float, float]) -> np.ndarray:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn * np.sign(np.linalg.det(turn)), place
    return matrix


SHAPES = {
    "torus": (lambda: torus_section(2.0 * np.pi), (True, True), False),
    "torus section": (torus_section, (False, True), True),
    "sheet": (lambda: grid_mesh(sheet), (False, False), True),
}
