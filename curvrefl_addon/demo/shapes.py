# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Outlines of things as numpy arrays: star-shaped bodies, turned shapes, tubes, boxes, planes.

All lengths are in meters, object space, Z up. Every closed shape has its faces outward (counter-clockwise).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..scene.arrays import Float64Array

type Numbers = Sequence[float] | Float64Array

type RadiusFunction = Callable[[Float64Array], Float64Array]
"""Unit directions (n, 3) -> distances (n,) of a star-shaped surface from its center."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Polygons with optional corner UVs."""

    positions: Float64Array
    """(vertices, 3)"""
    polygons: tuple[tuple[int, ...], ...]
    uv: Float64Array | None = None
    """(corners, 2) in the order of the polygons' corners"""

    def moved(self, offset: Numbers) -> Shape:
        return Shape(self.positions + np.asarray(offset, float), self.polygons, self.uv)

    def turned(self, angle: float, axis: int = 2) -> Shape:
        """Rotated about a coordinate axis through the origin by `angle` radians."""
        return Shape(self.positions @ rotation(angle, axis).T, self.polygons, self.uv)


def rotation(angle: float, axis: int = 2) -> Float64Array:
    """(3, 3) right-handed rotation about a coordinate axis by `angle` radians."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def joined(*shapes: Shape) -> Shape:
    """One shape of several. UVs are kept when every part has them."""
    positions, polygons, start = [], [], 0
    for shape in shapes:
        positions.append(shape.positions)
        polygons += [tuple(index + start for index in polygon) for polygon in shape.polygons]
        start += len(shape.positions)
    uvs = [shape.uv for shape in shapes if shape.uv is not None]
    uv = np.concatenate(uvs) if len(uvs) == len(shapes) else None
    return Shape(np.concatenate(positions), tuple(polygons), uv)


def cube_sphere_directions(cells: int) -> tuple[Float64Array, tuple[tuple[int, ...], ...]]:
    """Unit directions (6 cells^2 + 2, 3) of a sphere of 6 cells^2 quads of nearly equal size, and the quads."""
    tangent = np.tan(np.linspace(-0.25 * np.pi, 0.25 * np.pi, cells + 1))
    first, second = (a.ravel() for a in np.meshgrid(np.arange(cells + 1), np.arange(cells + 1), indexing="ij"))
    lattice, quads, start = [], [], 0
    corner = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    loop = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 4)
    for axis in range(3):
        for side in (0, cells):
            points = np.empty((len(first), 3), int)
            points[:, axis] = side
            points[:, (axis + 1) % 3] = first
            points[:, (axis + 2) % 3] = second
            lattice.append(points)
            quads.append((loop if side else loop[:, ::-1]) + start)
            start += len(points)
    unique, inverse = np.unique(np.concatenate(lattice), axis=0, return_inverse=True)
    points = tangent[unique]
    directions = points / np.linalg.norm(points, axis=1, keepdims=True)
    return directions, tuple(tuple(q) for q in inverse.reshape(-1)[np.concatenate(quads)].tolist())


def star_shape(radius: RadiusFunction, cells: int) -> Shape:
    """The star-shaped body `radius` about the origin, of 6 cells^2 quads."""
    directions, quads = cube_sphere_directions(cells)
    return Shape(directions * radius(directions)[:, None], quads)


def star_normals(radius: RadiusFunction, directions: Float64Array, step: float = 1e-4) -> Float64Array:
    """(n, 3) unit outward normals of a star-shaped surface, by central differences of its level function."""
    normals = np.empty_like(directions)
    points = directions * radius(directions)[:, None]
    size = step * np.linalg.norm(points, axis=1)
    for axis in range(3):
        offset = np.zeros_like(points)
        offset[:, axis] = size
        normals[:, axis] = (star_level(radius, points + offset) - star_level(radius, points - offset)) / (2.0 * size)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def star_level(radius: RadiusFunction, points: Float64Array) -> Float64Array:
    """(n,) distance from the center minus that of the surface in the same direction: negative inside."""
    distance = np.linalg.norm(points, axis=1)
    return distance - radius(points / distance[:, None])


def turned_profile(profile: Sequence[tuple[float, float]], segments: int) -> Shape:
    """A surface of revolution about Z of a profile of (radius, height) points from bottom to top.

    Points of radius zero at the ends become poles. Quads otherwise.
    """
    angle = 2.0 * np.pi * np.arange(segments) / segments
    circle = np.stack([np.cos(angle), np.sin(angle)], 1)
    positions: list[Float64Array] = []
    rings: list[list[int]] = []
    count = 0
    for radius, height in profile:
        points = (
            np.array([[0.0, 0.0, height]])
            if radius == 0.0
            else np.column_stack([circle * radius, np.full(segments, height)])
        )
        positions.append(points)
        rings.append([count] * segments if radius == 0.0 else list(range(count, count + segments)))
        count += len(points)
    polygons: list[tuple[int, ...]] = []
    for lower, upper in pairwise(rings):
        for i in range(segments):
            j = (i + 1) % segments
            loop = (lower[i], lower[j], upper[j], upper[i])
            polygons.append(tuple(dict.fromkeys(loop)))
    return Shape(np.concatenate(positions), tuple(polygons))


def ball(radius: float, segments: int) -> Shape:
    """A sphere of `segments` meridians and half as many bands, with longitude-latitude UVs."""
    bands = segments // 2
    latitude = np.linspace(-0.5 * np.pi, 0.5 * np.pi, bands + 1)
    profile = [(radius * float(np.cos(a)), radius * float(np.sin(a))) for a in latitude]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    shape = turned_profile(profile, segments)
    uv = []
    for band in range(bands):
        for i in range(segments):
            u0, u1, v0, v1 = i / segments, (i + 1) / segments, band / bands, (band + 1) / bands
            middle = 0.5 * (u0 + u1)
            if band == 0:
                uv += [(middle, v0), (u1, v1), (u0, v1)]
            elif band == bands - 1:
                uv += [(u0, v0), (u1, v0), (middle, v1)]
            else:
                uv += [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]
    return Shape(shape.positions, shape.polygons, np.array(uv))


def tube(path: Float64Array, radii: Numbers, segments: int, side: Numbers, capped: bool = True) -> Shape:
    """A round tube along `path` (n, 3) with a radius per point; `side` must not be parallel to the path anywhere."""
    path = np.asarray(path, float)
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    first = np.cross(tangent, np.asarray(side, float))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(tangent, first)
    angle = 2.0 * np.pi * np.arange(segments) / segments
    offset = first[:, None] * np.cos(angle)[None, :, None] + second[:, None] * np.sin(angle)[None, :, None]
    positions = (path[:, None] + offset * np.asarray(radii, float)[:, None, None]).reshape(-1, 3)
    polygons: list[tuple[int, ...]] = []
    for ring in range(len(path) - 1):
        for i in range(segments):
            a, b = ring * segments + i, ring * segments + (i + 1) % segments
            polygons.append((a, b, b + segments, a + segments))
    if capped:
        polygons.append(tuple(reversed(range(segments))))
        polygons.append(tuple(range((len(path) - 1) * segments, len(path) * segments)))
    return Shape(positions, tuple(polygons))


def box(size: Sequence[float], bevel: float = 0.0) -> Shape:
    """A box centered at the origin; with `bevel` its edges are cut off by that much (corners become triangles)."""
    half = 0.5 * np.asarray(size, float)
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    if bevel <= 0.0:
        return hull_faces(signs * half, _box_faces(signs))
    positions: list[Float64Array] = []
    keys: dict[tuple[int, int], int] = {}
    for corner, sign in enumerate(signs):
        for axis in range(3):
            inset = half - bevel
            inset[axis] = half[axis]
            keys[corner, axis] = len(positions)
            positions.append(sign * inset)
    polygons: list[tuple[int, ...]] = []
    for axis in range(3):
        for direction in (-1.0, 1.0):
            polygons.append(tuple(keys[c, axis] for c in range(8) if signs[c][axis] == direction))
        for c in range(8):
            if signs[c][axis] < 0:
                other = int(np.flatnonzero((signs == signs[c] * np.where(np.arange(3) == axis, -1, 1)).all(1))[0])
                i, j = (axis + 1) % 3, (axis + 2) % 3
                polygons.append((keys[c, i], keys[c, j], keys[other, j], keys[other, i]))
    polygons += [tuple(keys[c, axis] for axis in range(3)) for c in range(8)]
    return hull_faces(np.array(positions), polygons)


def _box_faces(signs: Float64Array) -> list[tuple[int, ...]]:
    return [
        tuple(int(c) for c in np.flatnonzero(signs[:, axis] == direction))
        for axis in range(3)
        for direction in (-1.0, 1.0)
    ]


def hull_faces(positions: Float64Array, polygons: Sequence[tuple[int, ...]]) -> Shape:
    """A convex shape about the origin whose flat faces are given as unordered vertex sets."""
    ordered = []
    for polygon in polygons:
        points = positions[list(polygon)]
        center = points.mean(0)
        normal = np.linalg.svd(points - center)[2][2]
        normal *= np.sign(normal @ center) or 1.0
        first = points[0] - center
        second = np.cross(normal, first)
        angle = np.arctan2((points - center) @ second, (points - center) @ first)
        ordered.append(tuple(polygon[i] for i in np.argsort(angle)))
    return Shape(positions, tuple(ordered))


def plane(size: Sequence[float], cells: Sequence[int] = (1, 1), tile: float = 0.0) -> Shape:
    """A level rectangle centered at the origin. UVs run over it once, or repeat every `tile` meters."""
    width, depth = float(size[0]), float(size[1])
    nx, ny = int(cells[0]), int(cells[1])
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, nx + 1), np.linspace(-0.5, 0.5, ny + 1))
    unit = np.column_stack([x.ravel(), y.ravel()])
    positions = np.column_stack([unit * [width, depth], np.zeros(len(unit))])
    index = np.arange((nx + 1) * (ny + 1)).reshape(ny + 1, nx + 1)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    scale = np.array([width, depth]) / tile if tile > 0.0 else np.ones(2)
    uv = (unit + 0.5) * scale
    return Shape(positions, tuple(tuple(q) for q in quads.tolist()), uv[quads.ravel()])


def projected(shape: Shape, tile: float) -> Shape:
    """The shape with UVs that repeat every `tile` meters on each face, seen along the axis that it faces most."""
    uv = []
    for polygon in shape.polygons:
        points = shape.positions[list(polygon)]
        # (Newell's sum, which any polygon has.)
        normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
        axis = int(np.abs(normal).argmax())
        kept = [(1, 2), (0, 2), (0, 1)][axis]
        uv.append(points[:, kept] / tile)
    return Shape(shape.positions, shape.polygons, np.concatenate(uv))


def block(low: Numbers, high: Numbers, bevel: float = 0.0) -> Shape:
    """A box between two corners."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    return box((high - low).tolist(), bevel).moved(0.5 * (low + high))


def surface(points: Float64Array) -> Shape:
    """A sheet of quads through a lattice of points (rows, columns, 3), with UVs once over it."""
    rows, columns = points.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    v, u = np.meshgrid(np.linspace(0.0, 1.0, rows), np.linspace(0.0, 1.0, columns), indexing="ij")
    uv = np.column_stack([u.ravel(), v.ravel()])[quads.ravel()]
    return Shape(points.reshape(-1, 3), tuple(tuple(q) for q in quads.tolist()), uv)


def surface_samples(shape: Shape, spacing: float) -> Float64Array:
    """(n, 3) points all over a shape's surface, at most about `spacing` meters apart."""
    samples = [shape.positions]
    for polygon in shape.polygons:
        for i in range(1, len(polygon) - 1):
            a, b, c = (shape.positions[polygon[k]] for k in (0, i, i + 1))
            longest = max(np.linalg.norm(b - a), np.linalg.norm(c - b), np.linalg.norm(a - c))
            n = max(1, int(np.ceil(longest / spacing)))
            u, v = (t.ravel() / n for t in np.meshgrid(np.arange(n + 1), np.arange(n + 1)))
            inside = u + v <= 1.0 + 1e-9
            u, v = u[inside][:, None], v[inside][:, None]
            samples.append(a + u * (b - a) + v * (c - a))
    return np.concatenate(samples)


def slide_to_contact(shape: Shape, direction: Numbers, radius: RadiusFunction, center: Numbers, gap: float) -> Shape:
    """Push a shape that stands clear of a star-shaped body along `direction`, to `gap` meters short of touching it."""
    way = np.asarray(direction, float)
    way = way / np.linalg.norm(way)
    extent = float(np.ptp(shape.positions, axis=0).max())
    points = surface_samples(shape, extent / 40.0) - np.asarray(center, float)
    if (star_level(radius, points) <= 0.0).any():
        raise ValueError("The shape to slide stands in the body already.")
    free, blocked = 0.0, 0.0
    step = 0.1 * extent
    while not (star_level(radius, points + blocked * way) <= 0.0).any():
        blocked += step
        if blocked > 1e3 * extent:
            raise ValueError("The shape never meets the body in that direction.")
    free = blocked - step
    for _ in range(40):
        middle = 0.5 * (free + blocked)
        if (star_level(radius, points + middle * way) <= 0.0).any():
            blocked = middle
        else:
            free = middle
    return shape.moved((free - gap) * way)
