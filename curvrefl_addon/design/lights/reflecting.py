# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror's mesh as a view sees it: what each place of it reflects, as fine as the picture needs. float64, no bpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array
from ...scene.camera.view import View

PIECE = 8.0
"""Pixels: longer edges are split, as between corners what is reflected is taken to change evenly"""
MOST_PARTS = 16
"""Of an edge at once; what is still long then, and seen, is split again"""
ROUNDS = 4


@dataclass(frozen=True, slots=True)
class PlacedMirror:
    """World space."""

    name: str
    positions: Float64Array
    """(n, 3) of corners"""
    normals: Float64Array
    """(n, 3) unit shading normals"""
    triangles: NDArray[np.int32]
    """(m, 3), counter-clockwise from where the normals point"""
    is_solid: bool
    """Only its fronts are seen from outside"""


@dataclass(frozen=True, slots=True)
class Reflecting:
    """The parts of a mirror that a view may see, in triangles that are small in its picture."""

    view: View
    points: Float64Array
    """(n, 3) corners"""
    normals: Float64Array
    """(n, 3) shading normals, towards the eye's side and not of unit length within a triangle of the mesh"""
    directions: Float64Array
    """(n, 3) unit, of the rays that the corners reflect"""
    pixels: Float64Array
    """(n, 2) from the bottom left"""
    triangles: NDArray[np.int64]
    """(m, 3)"""


def reflecting(mirror: PlacedMirror, view: View) -> Reflecting:
    """Of one mirror in a view; may be empty."""
    triangles = mirror.triangles.astype(np.int64)
    corners = mirror.positions[triangles]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    towards = view.eye[:3] - corners[:, 0] * view.eye[3]
    is_front = np.einsum("ij,ij->i", facing, towards) > 0.0
    fronts = _Soup(mirror.positions, mirror.normals, triangles[is_front])
    backs = _Soup(mirror.positions, -mirror.normals, triangles[~is_front & (not mirror.is_solid)])
    done: list[_Soup] = []
    left = [fronts, backs]
    for number in range(ROUNDS):
        found = [part for soup in left for part in _by_parts(soup.seen(view), view)]
        is_last = number == ROUNDS - 1
        done += [soup for soup, parts in found if parts == 1 or is_last]
        left = [soup.split(parts) for soup, parts in found if parts > 1 and not is_last]
    points = np.concatenate([soup.points for soup in done])
    normals = np.concatenate([soup.normals for soup in done])
    offsets = np.cumsum([0, *(len(soup.points) for soup in done)])
    triangles = np.concatenate([soup.triangles + offset for soup, offset in zip(done, offsets, strict=False)])
    ahead = _ahead(points, view)
    pixels = np.zeros((len(points), 2))
    pixels[ahead > 0.0] = view.project(points[ahead > 0.0])
    triangles = triangles[(ahead[triangles] > 0.0).all(axis=1)]
    return Reflecting(view, points, normals, reflected(points, normals, view), pixels, triangles)


def reflected(points: Float64Array, normals: Float64Array, view: View) -> Float64Array:
    """(n, 3) unit directions that lines of sight to points (n, 3) go on in, about normals (n, 3) of any length."""
    incoming = unit(points * view.eye[3] - view.eye[:3])
    normal = unit(normals)
    return incoming - 2.0 * np.einsum("ij,ij->i", incoming, normal)[:, None] * normal


def _ahead(points: Float64Array, view: View) -> Float64Array:
    """(n,) above 0 where a point has a place in the picture."""
    row = view.world_to_clip[3]
    return points @ row[:3] + row[3]


@dataclass(frozen=True, slots=True)
class _Soup:
    """Triangles (m, 3) of points (n, 3) with normals (n, 3)."""

    points: Float64Array
    normals: Float64Array
    triangles: NDArray[np.int64]

    def of(self, triangles: NDArray[np.int64]) -> _Soup:
        """These alone, and only their points."""
        used, numbers = np.unique(triangles, return_inverse=True)
        return _Soup(self.points[used], self.normals[used], numbers.reshape(-1, 3))

    def seen(self, view: View) -> _Soup:
        """Those that are on no outer side of one of the picture's edges, nor behind the eye."""
        clip = self.points @ view.world_to_clip[[0, 1, 3], :3].T + view.world_to_clip[[0, 1, 3], 3]
        x, y, w = (clip[:, column][self.triangles] for column in range(3))
        out = (w <= 0.0).all(axis=1)
        for axis in (x, y):
            out |= (axis > w).all(axis=1) | (axis < -w).all(axis=1)
        return self.of(self.triangles[~out])

    def split(self, parts: int) -> _Soup:
        """Each into parts^2."""
        rows = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
        number = {place: index for index, place in enumerate(rows)}
        weights = np.array([(parts - i - j, i, j) for i, j in rows], np.float64) / parts
        up = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in rows if i + j < parts]
        down = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in rows if i + j < parts - 1]
        points, normals = (
            np.einsum("pk,tkc->tpc", weights, values[self.triangles]).reshape(-1, 3)
            for values in (self.points, self.normals)
        )
        offsets = np.arange(len(self.triangles))[:, None, None] * len(rows)
        return _Soup(points, normals, (np.array(up + down, np.int64)[None] + offsets).reshape(-1, 3))


def _by_parts(soup: _Soup, view: View) -> list[tuple[_Soup, int]]:
    """What is to be split into the same number of parts, a power of two, and that number."""
    ahead = _ahead(soup.points, view)
    pixels = np.zeros((len(soup.points), 2))
    pixels[ahead > 0.0] = view.project(soup.points[ahead > 0.0])
    corners = pixels[soup.triangles]
    longest = np.max([np.abs(corners[:, k] - corners[:, k - 1]).max(axis=1) for k in range(3)], axis=0)
    wanted = np.clip(longest / PIECE, 1.0, MOST_PARTS)
    parts = np.exp2(np.ceil(np.log2(wanted) - 1e-9)).astype(np.int64)
    # (What goes past the eye is long, whatever its corners' places.)
    parts = np.where((ahead[soup.triangles] > 0.0).all(axis=1), parts, MOST_PARTS)
    if (parts == 1).all():
        return [(soup, 1)]
    return [(soup.of(soup.triangles[parts == number]), int(number)) for number in np.unique(parts)]
