# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mirrors show at the pixels' centers, point by point, as rays have found it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array, SceneArrays
from ...scene.camera.view import View

NOTHING = -1
"""In place of an instance: the background"""


@dataclass(frozen=True, slots=True, eq=False)
class ShownPoints:
    """Of the n pixels whose centers show a mirror. World space, float64."""

    view: View
    pixel: NDArray[np.int64]
    """(n,) number in a picture (h, w) with row 0 at the bottom"""
    mirror: NDArray[np.int64]
    """(n,) index of the mirror's instance in the scene"""
    seen: Float64Array
    """(n, 3) point of the mirror"""
    facing: Float64Array
    """(n, 3) its unit shading normal, towards the eye"""
    instance: NDArray[np.int64]
    """(n,) index of the instance that is shown, NOTHING for the background"""
    triangle: NDArray[np.int64]
    """(n,) of its mesh"""
    weights: Float64Array
    """(n, 3) of the triangle's corners"""
    shown: Float64Array
    """(n, 4) the point that is shown (last number 1), or the background's unit direction (0)"""
    normal: Float64Array
    """(n, 3) unit shading normal there, towards the mirror; 0 for the background"""
    albedo: Float64Array
    """(n, 3) base color there, scene-linear; 0 for the background"""
    way: Float64Array
    """(n,) meters from the mirror, over all further mirrors that are followed, to the first surface that is none;
    infinite where that is the background"""

    @property
    def is_surface(self) -> NDArray[np.bool_]:
        """(n,) not the background."""
        return self.instance >= 0


def points_of_ways(scene: SceneArrays, view: View, ways: Mapping[str, Any], mirrors: Mapping[int, int]) -> ShownPoints:
    """Of what `renderer.shown.rays.read_ways` has read of a view; `mirrors`: instances by mirrors' numbers."""
    if not ways:
        return no_points(view)
    numbers = np.rint(ways["seen_color"][..., 3]).astype(np.int64).ravel()
    pixel = np.flatnonzero(np.isin(numbers, list(mirrors)))

    def at(name: str) -> Float64Array:
        values = ways[name].reshape(len(numbers), -1)[pixel]
        return np.asarray(values, np.float64)

    index = np.zeros(int(numbers.max(initial=0)) + 1, np.int64)
    for number, instance in mirrors.items():
        if number < len(index):
            index[number] = instance
    position, hit = at("shown_position"), at("hit")
    is_surface = position[:, 3] > 0.5
    instances = np.where(is_surface, np.rint(hit[:, 0]).astype(np.int64), NOTHING)
    triangle = np.rint(hit[:, 1]).astype(np.int64)
    weights = np.column_stack([1.0 - hit[:, 2] - hit[:, 3], hit[:, 2:]])
    shown = np.zeros((len(pixel), 4))
    shown[is_surface, :3] = places_on(scene, instances[is_surface], triangle[is_surface], weights[is_surface])
    shown[~is_surface, :3] = position[~is_surface, :3]
    shown[:, 3] = is_surface
    return ShownPoints(
        view=view,
        pixel=pixel,
        mirror=index[numbers[pixel]],
        seen=at("seen_position")[:, :3],
        facing=at("seen_normal")[:, :3],
        instance=instances,
        triangle=triangle,
        weights=weights,
        shown=shown,
        normal=np.where(is_surface[:, None], at("shown_normal")[:, :3], 0.0),
        albedo=np.where(is_surface[:, None], at("shown_color")[:, :3], 0.0),
        way=at("way")[:, 0],
    )


def no_points(view: View) -> ShownPoints:
    """Of a view without a mirror."""
    none, numbers = np.zeros((0, 3)), np.zeros(0, np.int64)
    return ShownPoints(
        view, numbers, numbers, none, none, numbers, numbers, none, np.zeros((0, 4)), none, none, np.zeros(0)
    )


def places_on(
    scene: SceneArrays, instance: NDArray[np.int64], triangle: NDArray[np.int64], weights: Float64Array
) -> Float64Array:
    """(n, 3) world places on triangles of instances, by weights (n, 3) of their corners."""
    found = np.empty((len(instance), 3))
    for number in np.unique(instance).tolist():
        here, item = instance == number, scene.instances[number]
        mesh = scene.meshes[item.mesh]
        corners = mesh.positions[mesh.corner_vertex[mesh.triangles[triangle[here]]]].astype(np.float64)
        place = np.einsum("nk,nkj->nj", weights[here], corners)
        found[here] = place @ item.matrix[:3, :3].T + item.matrix[:3, 3]
    return found
