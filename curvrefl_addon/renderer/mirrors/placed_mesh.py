# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as it is placed, in meters, and points spread over its surface: what is baked, and what a map is held to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import InputError
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import LARGEST_COORDINATE, Float64Array, InstanceArrays, MeshArrays
from .reflector_map import ReflectorMap


@dataclass(frozen=True)
class PlacedMesh:
    """A mesh in axes parallel to the map frame, about the object's origin, in meters; float64."""

    name: str
    map_to_world: Float64Array
    """(4, 4) rigid, to the object's origin"""
    positions: Float64Array
    """(vertices, 3)"""
    normals: Float64Array
    """(corners, 3) unit"""
    corner_vertex: NDArray[np.int32]
    triangles: NDArray[np.int32]
    """(triangles, 3) index into corners, counter-clockwise seen from outside unless the mesh is inverted"""

    def triangle_positions(self) -> Float64Array:
        """(triangles, 3, 3)"""
        return self.positions[self.corner_vertex[self.triangles]]

    def from_world(self, point: ArrayLike) -> Float64Array:
        """(3,) of a point in world space. Raises InputError when it is none."""
        world = np.asarray(point, np.float64)
        if world.shape != (3,) or not np.isfinite(world).all():
            raise InputError("The star center must be three finite numbers: its x, y and z in world space.")
        return self.map_to_world[:3, :3].T @ (world - self.map_to_world[:3, 3])


def place_mesh(mesh: MeshArrays, instance: InstanceArrays) -> PlacedMesh:
    """Check a mesh and scale it to meters, leaving out the instance's rotation and place."""
    name = instance.object_name
    linear = np.asarray(instance.matrix[:3, :3], np.float64)
    if problem := _problem(mesh, instance.matrix):
        raise InputError(f'"{name}" {problem}', instance.object_id)
    rotation, stretch = polar(linear)
    mirrored = bool(np.linalg.det(stretch) < 0.0)
    map_to_world = np.eye(4)
    map_to_world[:3, :3] = rotation
    map_to_world[:3, 3] = instance.matrix[:3, 3]
    positions = mesh.positions.astype(np.float64) @ stretch.T
    return PlacedMesh(
        name=name,
        map_to_world=map_to_world,
        positions=positions,
        normals=unit(mesh.corner_normals.astype(np.float64) @ np.linalg.inv(stretch)),
        corner_vertex=mesh.corner_vertex,
        triangles=mesh.triangles[:, ::-1] if mirrored else mesh.triangles,
    )


def _problem(mesh: MeshArrays, matrix: Float64Array) -> str:
    """Why a mesh cannot be baked where `matrix` (4, 4) puts it, said of it; nothing where it can."""
    if len(mesh.triangles) == 0:
        return "has no faces: choose a mesh with a surface as reflector."
    if not np.isfinite(mesh.positions).all():
        return "has vertices that are not finite numbers: repair its mesh."
    if len(mesh.positions) and np.abs(mesh.positions).max() > LARGEST_COORDINATE:
        return "has vertices too far away to compute with: repair its mesh."
    if not np.isfinite(mesh.corner_normals).all():
        return "has normals that are not finite numbers: repair its mesh."
    if not np.isfinite(matrix).all():
        return "has a transform that is not finite: reset its location, rotation and scale."
    scales = np.linalg.svd(np.asarray(matrix[:3, :3], np.float64), compute_uv=False)
    if scales[2] <= 1e-9 * scales[0]:
        return "is scaled to zero along an axis: give it a scale other than 0."
    return ""


def polar(linear: Float64Array) -> tuple[Float64Array, Float64Array]:
    """The proper rotation and the stretch (3, 3), which may mirror, whose product is `linear`."""
    left, _, right = np.linalg.svd(np.asarray(linear, np.float64))
    rotation = left @ right
    if np.linalg.det(rotation) < 0.0:
        rotation = -rotation
    return rotation, rotation.T @ linear


@dataclass(frozen=True, slots=True)
class SurfaceSamples:
    """Points spread evenly over the area of a mesh's outside."""

    points: Float64Array
    """(n, 3) relative to the star center, in axes parallel to the map frame; none at the center itself"""
    normals: Float64Array
    """(n, 3) unit shading normals there, turned outwards"""
    facing: Float64Array
    """(n, 3) unit normals of the triangles there, turned outwards"""


def surface_samples(mesh: MeshArrays, instance: InstanceArrays, baked: ReflectorMap, count: int) -> SurfaceSamples:
    """At most `count` points of the placed mesh that was baked, in the map frame."""
    placed = place_mesh(mesh, instance)
    origin = placed.from_world(baked.center)
    corners = placed.triangle_positions() - origin
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inverted = float(np.einsum("ij,ij->", crossed, corners[:, 0])) < 0.0
    return samples_of(placed, corners, inverted, count)


def samples_of(placed: PlacedMesh, corners: Float64Array, inverted: bool, count: int) -> SurfaceSamples:
    """`corners` (triangles, 3, 3) are relative to the star center."""
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.sqrt(np.einsum("ij,ij->i", crossed, crossed))
    outward = np.einsum("ij,ij->i", crossed, corners[:, 0]) * (-1.0 if inverted else 1.0)
    areas[outward <= 0.0] = 0.0
    if not areas.any():
        return SurfaceSamples(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)))
    random = np.random.default_rng(0)
    chosen = random.choice(len(areas), count, p=areas / areas.sum())
    weights = random.dirichlet((1.0, 1.0, 1.0), count)
    points = np.einsum("ij,ijk->ik", weights, corners[chosen])
    normals = unit(np.einsum("ij,ijk->ik", weights, placed.normals[placed.triangles[chosen]]))
    facing = unit(crossed[chosen]) * (-1.0 if inverted else 1.0)
    kept = np.linalg.norm(points, axis=1) > 0.0
    points, normals, facing = points[kept], normals[kept], facing[kept]
    inwards = np.einsum("ij,ij->i", facing, normals) < 0.0
    return SurfaceSamples(points, np.where(inwards[:, None], -normals, normals), facing)
