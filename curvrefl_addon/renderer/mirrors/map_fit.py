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

from ...optics.surfaces.cube_map import CubeMapSurface
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays
from ...scene.view import View
from .reflector_bake import SurfaceSamples, surface_samples
from .reflector_map import ReflectorMap

SAMPLES = 2048
"""Points of the mesh that are compared"""


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
        # The tangential part of a normal that is turned by more than a right angle says too little.
        self._is_hopeless = np.einsum("ni,ni->n", map_normals, normals) < 0.5
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

    def pixel_error(self, view: View, world_to_map: Float64Array, reach: float, share: float = 0.99) -> float:
        """The share's percentile over the mirror's pixels in `view` of how far the map moves what they show, in pixels.

        `world_to_map` is where the map is now, `reach` the distance of the farthest vertex from the mirror, meters. 0
        where the eye sees nothing of it, infinite where the map's normals do not tell its points apart.
        """
        eye = world_to_map @ view.eye
        to_eye = eye[:3] - eye[3] * self._points
        away = np.linalg.norm(to_eye, axis=1)
        to_eye /= np.maximum(away, 1e-30)[:, None]
        cosine = np.einsum("ni,ni->n", to_eye, self._normals)
        seen = cosine > 1e-3
        if not seen.any():
            return 0.0
        to_eye, cosine, away = to_eye[seen], cosine[seen], away[seen]
        # In pixels per meter across the line of sight; an orthographic eye is infinitely far away.
        near = 0.0 if view.is_orthographic else 1.0 / away
        scale = view.focal_pixels * (1.0 if view.is_orthographic else near)
        plane = np.einsum("nki,ni->nk", self._axes[seen], to_eye)
        matrix = 2.0 * cosine[:, None, None] * self._slopes[seen]
        sum_ = (near + 1.0 / max(reach, 1e-30)) * np.ones(len(cosine))
        matrix[:, 0, 0] += sum_ * (1.0 - plane[:, 0] ** 2)
        matrix[:, 1, 1] += sum_ * (1.0 - plane[:, 1] ** 2)
        across = -sum_ * plane[:, 0] * plane[:, 1]
        matrix[:, 0, 1] += across
        matrix[:, 1, 0] += across
        determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] * matrix[:, 1, 0]
        folded = (determinant <= 0.0) | (matrix[:, 0, 0] + matrix[:, 1, 1] <= 0.0) | self._is_hopeless[seen]
        inverse = 1.0 / np.where(folded, 1.0, determinant)
        d = 2.0 * cosine[:, None] * self._normal_offsets[seen]
        step = np.column_stack(
            [
                matrix[:, 1, 1] * d[:, 0] - matrix[:, 0, 1] * d[:, 1],
                matrix[:, 0, 0] * d[:, 1] - matrix[:, 1, 0] * d[:, 0],
            ]
        )
        step *= inverse[:, None]
        # What of it lies along the line of sight is not seen.
        length = np.sqrt(np.maximum((step**2).sum(axis=1) - np.einsum("nk,nk->n", step, plane) ** 2, 0.0))
        sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
        errors = scale * (length + 2.0 * sine * self._radius_offsets[seen])
        errors[folded] = np.inf
        weight = cosine * scale**2 * np.ones(len(cosine))
        order = np.argsort(errors)
        shares = np.cumsum(weight[order])
        return float(errors[order][min(np.searchsorted(shares, share * shares[-1]), len(order) - 1)])


def _normals(surface: CubeMapSurface, directions: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Radius (n,) and unit normal (n, 3) of the map in directions (n, 3)."""
    radius, gradient = surface.radius(directions)
    return radius, unit(radius[:, None] * directions - gradient)
