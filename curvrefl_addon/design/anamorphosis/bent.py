# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points bent back: where what is to be seen at a place in the mirror has to stand; and the other way round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ...optics.meshes.barycentric import barycentric
from ...scene.arrays import Float64Array
from ...scene.camera.view import View
from ..ways import WaysByMirrors, lines_through
from .lattice import cells_of
from .placed import Anamorphosis

OFF_SURFACE = 0.05
"""Share of a cell's longest side that a point of a curved surface may be off it"""


@dataclass(frozen=True, slots=True)
class Bent:
    """Points that stand elsewhere."""

    points: Float64Array
    """(n, 3) world space; NaN where there is no such place"""
    off_mirror: float
    """Share that is not seen at the mirror"""
    nowhere: float
    """Share for which the mirror shows none of the surfaces, or that would stand before the mirror, behind what it
    shows, or by another mirror"""


def bent_on_surfaces(
    ways: WaysByMirrors, view: View, mirrors: set[int], places: Float64Array, surfaces: set[int], off: float
) -> Bent:
    """Places of the view (n, 2), on the surfaces, by object_id, that the mirrors show there; `off` meters back on the
    ray, so that they stand clear of it and are seen at the same place."""
    found = ways.follow(*lines_through(view, places))
    seen = np.isin(found.mirror, list(mirrors))
    lands = seen & np.isin(found.object, list(surfaces))
    points = np.where(lands[:, None], found.end - off * found.direction, np.nan)
    return Bent(points, float((~seen).mean()), float((seen & ~lands).mean()))


def bent_in_depth(
    ways: WaysByMirrors,
    view: View,
    mirrors: set[int],
    places: Float64Array,
    points: Float64Array | None,
    depth: float = 0.0,
) -> Bent:
    """Places of the view (n, 2), as far from the mirror on the reflected ray as `points` (n, 3) are behind it on the
    line of sight, as an image is in a plane mirror; without points all so many meters."""
    found = ways.follow(*lines_through(view, places))
    seen = np.isin(found.mirror, list(mirrors))
    length = np.full(len(places), depth)
    if points is not None:
        _, towards = lines_through(view, places)
        length = np.einsum("ij,ij->i", points - found.point, towards)
    free = np.where(found.object > 0, np.linalg.norm(found.end - found.point, axis=1), np.inf)
    stands = seen & (length > 0.0) & (found.bounces == 1) & (length <= free)
    bent = np.where(stands[:, None], found.point + length[:, None] * found.direction, np.nan)
    return Bent(bent, float((~seen).mean()), float((seen & ~stands).mean()))


class SeenPlaces:
    """Where in the picture points of a surface are seen."""

    def __init__(self, anamorphosis: Anamorphosis, object_id: int) -> None:
        ends = anamorphosis.ways.end.reshape(*anamorphosis.shape, 3)
        here = anamorphosis.on(object_id)
        piece = np.where(here, anamorphosis.ways.instance, -1).reshape(anamorphosis.shape)
        cells = cells_of(ends, piece, anamorphosis.places)
        self._corners, self._values = cells.corners, cells.values
        count = len(cells.corners)
        triangles = np.arange(3 * count).reshape(-1, 3)
        self._tree = BVHTree.FromPolygons(cells.corners.reshape(-1, 3).tolist(), triangles.tolist()) if count else None

    def of(self, points: Float64Array) -> Float64Array:
        """(n, 2) of points (n, 3) in world space; NaN where the mirror does not show them."""
        places = np.full((len(points), 2), np.nan)
        if self._tree is None:
            return places
        near = [self._tree.find_nearest(Vector(point)) for point in points.tolist()]
        triangle = np.array([-1 if item[2] is None else item[2] for item in near])
        distance = np.array([np.inf if item[3] is None else item[3] for item in near])
        corners, values = self._corners[triangle], self._values[triangle]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        weights = barycentric(points, corners)
        found = np.einsum("nk,nkj->nj", weights, values)
        is_seen: NDArray[np.bool_] = (triangle >= 0) & (distance <= OFF_SURFACE * sides)
        places[is_seen] = found[is_seen]
        return places
