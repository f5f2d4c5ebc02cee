# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many pixels a radial map moves what a mirror shows, next to the mesh that it stands for. Pure numpy.

At points P of the mesh the map has another normal, by d radians across the surface, and another radius. The map's own
reflection point of the same vertex then lies at P + s. To first order the bisector of the unit vectors to the eye and
to the vertex stays along the map's normal when

    ((1/a + 1/b) (I - sin^2 t q q^T) + 2 cos t S) s = -2 cos t d

in the tangent plane: a and b are the distances of eye and vertex, t the angle of incidence, q the direction in the
tangent plane in which the eye lies, S how the map's normals turn along the surface. (Differentiate
h = (E-P)/|E-P| + (V-P)/|V-P|, whose length is 2 cos t, and its tangential part, which the normal's turn must match.)
A farther vertex moves farther, so the farthest one is taken.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.cube_map import CubeMapSurface
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays
from ...scene.camera.view import View
from .placed_mesh import SurfaceSamples, surface_samples
from .reflector_map import ReflectorMap

SAMPLES = 2048
"""Points of the mesh that are compared"""
FEWEST_SAMPLES = 256
"""Fewer of them say too little of a part of the mirror"""
SHARE = 0.998
"""Of the mirror's pixels that must be right: more than is asked for, as what hides most of the mirror from the eye is
not known"""
MOST_BALLS = 64
"""More objects are taken as being everywhere"""


class MapFit:
    """Errors of a map at points spread evenly over its mesh; map frame, meters, float64."""

    def __init__(self, mesh: MeshArrays, instance: InstanceArrays, baked: ReflectorMap) -> None:
        samples: SurfaceSamples = surface_samples(mesh, instance, baked, SAMPLES)
        surface = CubeMapSurface(baked.radial)
        points, normals = samples.points, samples.normals
        radii = np.linalg.norm(points, axis=1)
        directions = points / radii[:, None]
        map_radii, map_normals = _normals(surface, directions)
        helper = np.where(np.abs(normals[:, :1]) < 0.6, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
        first = unit(np.cross(normals, helper))
        axes = np.stack([first, np.cross(normals, first)], axis=1)
        self._points, self._normals, self._axes = points, normals, axes
        self._normal_offsets = np.einsum("nki,ni->nk", axes, map_normals - normals)
        self._facing = samples.facing
        # The tangential part of a normal that is turned by more than a right angle says too little.
        self._is_lost = np.einsum("ni,ni->n", map_normals, normals) < 0.5
        self._radius_offsets = np.abs(map_radii - radii)
        step = 2.0 * radii / baked.resolution
        slopes = []
        for k in range(2):
            ahead, behind = (
                _normals(surface, unit(points + sign * step[:, None] * axes[:, k]))[1] for sign in (1.0, -1.0)
            )
            slopes.append(np.einsum("nki,ni->nk", axes, (ahead - behind) / (2.0 * step[:, None])))
        turned = np.stack(slopes, axis=2)
        self._slopes = 0.5 * (turned + turned.transpose(0, 2, 1))

    def pixel_error(
        self,
        view: View,
        world_to_map: Float64Array,
        centers: Float64Array,
        radii: Float64Array,
        share: float = SHARE,
    ) -> float:
        """How far the map moves what the mirror shows in `view`, in pixels: the share's percentile over the mirror's
        pixels that may show any of the balls `centers` (n, 3), world space, and `radii` (n,).

        `world_to_map` is where the map is now. 0 where the eye sees none of these pixels, infinite where the map's
        normals do not tell the mirror's points apart.
        """
        eye = world_to_map @ view.eye
        to_eye = eye[:3] - eye[3] * self._points
        away = np.linalg.norm(to_eye, axis=1)
        to_eye /= np.maximum(away, 1e-30)[:, None]
        facing = np.einsum("ni,ni->n", to_eye, self._facing)
        cosine = np.einsum("ni,ni->n", to_eye, self._normals)
        seen = self._in_picture(np.flatnonzero(facing > 0.0), view, world_to_map)
        distance = self._distances(seen, to_eye, cosine, world_to_map, centers, radii)
        seen, distance = seen[distance > 0.0], distance[distance > 0.0]
        if len(seen) == 0:
            return 0.0
        to_eye, cosine, away, facing = to_eye[seen], cosine[seen], away[seen], facing[seen]
        # In pixels per meter across the line of sight; an orthographic eye is infinitely far away.
        near = np.zeros(len(seen)) if view.is_orthographic else 1.0 / away
        scale = view.focal_pixels * (np.ones(len(seen)) if view.is_orthographic else near)
        plane = np.einsum("nki,ni->nk", self._axes[seen], to_eye)
        matrix = 2.0 * cosine[:, None, None] * self._slopes[seen]
        curvature = near + 1.0 / distance
        matrix[:, 0, 0] += curvature * (1.0 - plane[:, 0] ** 2)
        matrix[:, 1, 1] += curvature * (1.0 - plane[:, 1] ** 2)
        across = -curvature * plane[:, 0] * plane[:, 1]
        matrix[:, 0, 1] += across
        matrix[:, 1, 0] += across
        determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] * matrix[:, 1, 0]
        # A normal that is turned away from the eye where its face is seen is no mirror's to any solver.
        lost = (determinant <= 0.0) | (matrix[:, 0, 0] + matrix[:, 1, 1] <= 0.0) | self._is_lost[seen] | (cosine <= 0.0)
        inverse = 1.0 / np.where(lost, 1.0, determinant)
        d = 2.0 * cosine[:, None] * self._normal_offsets[seen]
        step = inverse[:, None] * np.column_stack(
            [
                matrix[:, 1, 1] * d[:, 0] - matrix[:, 0, 1] * d[:, 1],
                matrix[:, 0, 0] * d[:, 1] - matrix[:, 1, 0] * d[:, 0],
            ]
        )
        # What of it lies along the line of sight is not seen.
        along = np.einsum("nk,nk->n", step, plane)
        length = np.sqrt(np.maximum((step**2).sum(axis=1) - along**2, 0.0))
        sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
        errors = scale * (length + 2.0 * sine * self._radius_offsets[seen])
        # To first order no more: the angle of incidence is another one at the end of the step.
        turned = np.linalg.norm(np.einsum("nkl,nl->nk", self._slopes[seen], step), axis=1) + near * np.abs(along)
        errors[lost | (turned + np.linalg.norm(self._normal_offsets[seen], axis=1) > 0.5 * cosine)] = np.inf
        weight = facing * scale**2
        order = np.argsort(errors)
        shares = np.cumsum(weight[order])
        return float(errors[order][min(np.searchsorted(shares, share * shares[-1]), len(order) - 1)])

    def _in_picture(self, seen: NDArray[np.int64], view: View, world_to_map: Float64Array) -> NDArray[np.int64]:
        """Those of the points that lie within the picture, or all where these are too few to speak for it."""
        to_clip = view.world_to_clip @ np.linalg.inv(world_to_map)
        clip = self._points[seen] @ to_clip[:, :3].T + to_clip[:, 3]
        inside = seen[(np.abs(clip[:, :2]) <= clip[:, 3:]).all(axis=1)]
        return inside if len(inside) >= FEWEST_SAMPLES else seen

    def _distances(
        self,
        seen: NDArray[np.int64],
        to_eye: Float64Array,
        cosine: Float64Array,
        world_to_map: Float64Array,
        centers: Float64Array,
        radii: Float64Array,
    ) -> Float64Array:
        """(seen,) distance to the farthest point of the balls that each point's reflected ray meets, 0 where none."""
        points = self._points[seen]
        balls = centers @ world_to_map[:3, :3].T + world_to_map[:3, 3]
        if len(balls) > MOST_BALLS:
            # As if every ray met the farthest.
            most = float((np.linalg.norm(balls, axis=1) + radii).max())
            return most + np.linalg.norm(points, axis=1)
        rays = 2.0 * cosine[seen, None] * self._normals[seen] - to_eye[seen]
        # (balls, seen), of all at once: a loop takes three times as long.
        along = balls @ rays.T - np.einsum("ni,ni->n", points, rays)
        square = (balls**2).sum(axis=1)[:, None] - 2.0 * (balls @ points.T) + (points**2).sum(axis=1)
        reach = radii[:, None]
        meets = (square - along * along < reach * reach) & (along > -reach)
        farthest = np.where(meets, np.sqrt(np.maximum(square, 0.0)) + reach, 0.0)
        return np.asarray(farthest.max(axis=0, initial=0.0))


def _normals(surface: CubeMapSurface, directions: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Radius (n,) and unit normal (n, 3) of the map in directions (n, 3)."""
    radius, gradient = surface.radius(directions)
    return radius, unit(radius[:, None] * directions - gradient)
