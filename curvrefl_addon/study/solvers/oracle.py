# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All reflection points of vertices on a star-shaped surface, in float64: what every method is judged by.

The gradient of the path length is bracketed on a dense grid of directions: a node whose bisector is closer to the
normal than those of its neighbors starts a Newton search for a zero of the gradient, of any kind; so do a few
directions between eye and vertex, for vertices in contact whose reflection hides between nodes, and directions on both
sides of a point that is nearly degenerate, for images about to merge at a caustic. What converges, lies on the right
side and is no copy is a reflection point.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...optics.fermat import SurfaceSample, path_gradient, sample, towards_eye
from ...optics.solvers.descent import guess, tangent_frame
from ...optics.surfaces.cube_map import nearest_texel, texel_directions
from ...optics.surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .reflection_points import MAXIMUM, MINIMUM, SADDLE, ReflectionPoints

BLOCK = 128
"""Vertices that are bracketed at a time: their errors at all nodes should stay in a processor's cache"""
MOST_BRACKETS = 32
"""Nodes of the grid from which one vertex's searches start"""
FACING = -0.15
"""Cosine: nodes whose normal turns farther from eye or vertex bracket nothing"""
LARGEST_ERROR = 0.3
"""(1 - B . N) / 2 of a node that brackets"""
STEPS = 40
LONGEST_STEP = 0.2
"""Radians"""
TRIALS = 8
CONVERGED = 1e-9
"""Radians that the last Newton step may move"""
SAME = 1e-6
"""Radians between two ends that count as one"""
DEGENERATE = 0.35
"""Ratio of the eigenvalues of the gradient's derivative under which another image may be close"""
BESIDE = (0.02, 0.08, 0.25)
"""Radians beside such a point where searches start again"""
ROUNDS_BESIDE = 3
MARCH_STEPS = 96


class Oracle:
    """The surface, and its samples on the grid of directions."""

    def __init__(
        self,
        surface: RadialSurface,
        resolution: int = 16,
        side: float = 1.0,
        cover: Callable[[Float64Array], NDArray[np.bool_]] | None = None,
    ) -> None:
        """`resolution` nodes along an edge of each of six faces; `side` -1 for a hollow mirror; `cover` says which
        directions (n, 3) of an open one meet it.
        """
        self.surface = surface
        self.side = side
        self.cover = cover
        u = texel_directions(resolution).reshape(-1, 3)
        self._nodes = u
        self._at = sample(surface, u)
        self._neighbors = _neighbors(u, resolution)

    def reflection_points(self, eye: Float64Array, vertices: Float64Array) -> ReflectionPoints:
        """All of vertices (n, 3) for the homogeneous eye (4,), or for eyes (n, 4) one per vertex.

        Everything relative to the star center. A vertex that is not finite has none.
        """
        eyes = np.broadcast_to(eye, (len(vertices), 4))
        rows, u = self._starts(eye if eye.ndim == 1 else eyes, vertices)
        u, converged = self._polish(eyes[rows], vertices[rows], u)
        rows, u = _without_copies(rows[converged], u[converged])
        for _ in range(ROUNDS_BESIDE):
            more_rows, more = self._beside(eyes, vertices, rows, u)
            more, converged = self._polish(eyes[more_rows], vertices[more_rows], more)
            known = len(u)
            rows = np.concatenate([rows, more_rows[converged]])
            rows, u = _without_copies(rows, np.concatenate([u, more[converged]]))
            if len(u) == known:
                break
        kept = self._is_reflection(eyes[rows], vertices[rows], sample(self.surface, u))
        if self.cover is not None:
            kept &= self.cover(u)
        rows, u = rows[kept], u[kept]
        at = sample(self.surface, u)
        here_eyes, here = eyes[rows], vertices[rows]
        length = self._lengths(here_eyes, here, at.position)
        order = np.lexsort((length, rows))
        rows, u, length, here_eyes, here = rows[order], u[order], length[order], here_eyes[order], here[order]
        at = sample(self.surface, u)
        return ReflectionPoints(
            rows,
            u,
            at.position,
            length,
            self._signature(here_eyes, here, u),
            self._is_visible(at.position, here_eyes, here),
        )

    def _starts(self, eyes: Float64Array, vertices: Float64Array) -> tuple[NDArray[np.int64], Float64Array]:
        """Directions (m, 3) to search from, and the vertex of each (m,), for an eye (4,) or eyes (n, 4)."""
        finite = np.flatnonzero(np.isfinite(vertices).all(axis=1))
        nodes = np.arange(len(self._nodes))
        if eyes.ndim == 1:
            # Nodes that turn away from the only eye bracket nothing.
            towards = towards_eye(eyes, self._at.position)
            nodes = nodes[self.side * _dot(self._at.normal, towards) > FACING]
        at = SurfaceSample(
            self._at.position[nodes], self._at.normal[nodes], self._at.radius[nodes], self._at.gradient[nodes]
        )
        # All others have one row, the last.
        row_of_node = np.full(len(self._nodes), len(nodes))
        row_of_node[nodes] = np.arange(len(nodes))
        neighbors = row_of_node[self._neighbors[nodes]].T
        rows, directions = [], []
        for first in range(0, len(finite), BLOCK):
            block = finite[first : first + BLOCK]
            error = self._errors(at, eyes[None] if eyes.ndim == 1 else eyes[block], vertices[block])
            smallest = error[:-1] < LARGEST_ERROR
            for neighbor in neighbors:
                smallest &= error[:-1] <= error[neighbor]
            found, node = np.nonzero(smallest.T)
            rank = np.arange(len(found)) - np.searchsorted(found, found)
            few = rank < MOST_BRACKETS
            rows.append(block[found[few]])
            directions.append(self._nodes[nodes[node[few]]])
        all_eyes = np.broadcast_to(eyes, (len(vertices), 4))
        for start in self._between(all_eyes[finite], vertices[finite]):
            rows.append(finite)
            directions.append(start)
        return np.concatenate([np.zeros(0, np.int64), *rows]), np.concatenate([np.zeros((0, 3)), *directions])

    def _between(self, eyes: Float64Array, vertices: Float64Array) -> list[Float64Array]:
        """For vertices and eyes in contact: between their heights over the surface, and next to either."""
        if len(vertices) == 0:
            return []
        to_vertex, to_eye = unit(vertices), unit(eyes[:, :3])
        height = np.linalg.norm(vertices, axis=1) - self.surface.radius(to_vertex)[0]
        eye_height = np.linalg.norm(eyes[:, :3], axis=1) - self.surface.radius(to_eye)[0]
        share = np.where(
            eyes[:, 3] > 0.0, eye_height / np.where(height + eye_height == 0.0, 1.0, height + eye_height), 1.0
        )
        share = np.clip(share, 0.0, 1.0)[:, None]
        by_height = unit((1.0 - share) * to_eye + share * to_vertex + 1e-9)
        return [by_height, guess(eyes, vertices), self.side * unit(to_eye + to_vertex + 1e-9)]

    def _beside(
        self, eyes: Float64Array, vertices: Float64Array, rows: NDArray[np.int64], u: Float64Array
    ) -> tuple[NDArray[np.int64], Float64Array]:
        """Starts on both sides of ends that are nearly degenerate: images that are about to merge lie along the weaker
        direction, closer than a cell of the grid.
        """
        _, first, second, jacobian = self._derivatives(eyes[rows], vertices[rows], u)
        values, axes = np.linalg.eigh(0.5 * (jacobian + jacobian.transpose(0, 2, 1)))
        weaker = np.abs(values).argmin(axis=1)
        ratio = np.abs(values).min(axis=1) / np.maximum(np.abs(values).max(axis=1), 1e-300)
        near = np.flatnonzero(ratio < DEGENERATE)
        axis = axes[near, :, weaker[near]]
        direction = axis[:, :1] * first[near] + axis[:, 1:] * second[near]
        offsets = [sign * angle for angle in BESIDE for sign in (-1.0, 1.0)]
        starts = np.concatenate([np.zeros((0, 3)), *(unit(u[near] + offset * direction) for offset in offsets)])
        return np.tile(rows[near], len(offsets)), starts

    def _errors(self, at: SurfaceSample, eyes: Float64Array, vertices: Float64Array) -> Float64Array:
        """(k + 1, n) of `_mismatch` at k points of the surface, for vertices (n, 3) and eyes (n, 4) or (1, 4).

        1 where the point cannot show the vertex, and in the last row. Products of matrices: this is the inner loop.
        """
        normal = self.side * at.normal
        along_normal = _dot(normal, at.position)[:, None]
        squared = _dot(at.position, at.position)[:, None]

        def towards(points: Float64Array, w: Float64Array) -> tuple[Float64Array, Float64Array]:
            """Distance (or 1) and cosine to the normal, (k, points)."""
            distance = (points**2).sum(axis=1) - 2.0 * at.position @ (w[:, None] * points).T
            distance = np.where(w > 0.0, np.sqrt(np.maximum(distance + squared, 1e-30)), 1.0)
            return distance, (normal @ points.T - w * along_normal) / distance

        to_vertex, vertex_cosine = towards(vertices, np.ones(len(vertices)))
        to_eye, eye_cosine = towards(eyes[:, :3], eyes[:, 3])
        # (E - P w) . (V - P)
        between = (eyes[:, :3] * vertices).sum(axis=1) - at.position @ eyes[:, :3].T
        between = between + eyes[:, 3] * (squared - at.position @ vertices.T)
        error = np.ones((len(at.position) + 1, len(vertices)))
        some = self._may_show(vertex_cosine, eye_cosine)
        error[:-1][some] = self._mismatch(vertex_cosine, eye_cosine, between / (to_vertex * to_eye))[some]
        return error

    def _may_show(self, vertex_cosine: Float64Array, eye_cosine: Float64Array) -> NDArray[np.bool_]:
        """Whether nodes with these cosines of the ways to vertex and eye to the normal bracket something."""
        return (vertex_cosine > FACING) & (eye_cosine > FACING)

    def _mismatch(self, vertex_cosine: Float64Array, eye_cosine: Float64Array, between: Float64Array) -> Float64Array:
        """(1 - B . N) / 2, with the cosine between both ways."""
        return 0.5 - 0.5 * (vertex_cosine + eye_cosine) / np.sqrt(np.maximum(2.0 + 2.0 * between, 1e-12))

    def _gradient(self, eyes: Float64Array, vertices: Float64Array, u: Float64Array, at: SurfaceSample) -> Float64Array:
        """Of the path length at directions (m, 3)."""
        return path_gradient(eyes, vertices, u, at)

    def _lengths(self, eyes: Float64Array, vertices: Float64Array, points: Float64Array) -> Float64Array:
        """(m,) of the paths by way of points (m, 3)."""
        return np.linalg.norm(vertices - points, axis=1) + to_eye_length(eyes, points)

    def _is_visible(self, points: Float64Array, eyes: Float64Array, vertices: Float64Array) -> NDArray[np.bool_]:
        """(m,) whether both legs are free."""
        return self.is_free(points, np.insert(vertices, 3, 1.0, axis=1)) & self.is_free(points, eyes)

    def _polish(
        self, eyes: Float64Array, vertices: Float64Array, start: Float64Array
    ) -> tuple[Float64Array, NDArray[np.bool_]]:
        """Newton on the gradient from directions (m, 3), damped so that it never grows."""
        u = start.copy()
        converged = np.zeros(len(u), bool)
        active = np.arange(len(u))
        for _ in range(STEPS):
            if len(active) == 0:
                break
            here, eye, vertex = u[active], eyes[active], vertices[active]
            g, first, second, jacobian = self._derivatives(eye, vertex, here)
            step = _solved(jacobian, np.column_stack([_dot(g, first), _dot(g, second)]))
            size = np.linalg.norm(step, axis=1)
            converged[active[size < CONVERGED]] = True
            step *= np.minimum(1.0, LONGEST_STEP / np.maximum(size, 1e-300))[:, None]
            move = step[:, :1] * first + step[:, 1:] * second
            length = np.linalg.norm(g, axis=1)
            factor = np.ones(len(active))
            accepted = np.zeros(len(active), bool)
            for _ in range(TRIALS):
                open_rows = np.flatnonzero(~accepted)
                trial = unit(here[open_rows] + factor[open_rows, None] * move[open_rows])
                there = self._gradient(eye[open_rows], vertex[open_rows], trial, sample(self.surface, trial))
                better = np.linalg.norm(there, axis=1) < length[open_rows]
                u[active[open_rows[better]]] = trial[better]
                accepted[open_rows[better]] = True
                factor[open_rows] *= 0.4
                if accepted.all():
                    break
            active = active[accepted & (size >= CONVERGED)]
        return u, converged

    def _derivatives(
        self, eye: Float64Array, vertex: Float64Array, u: Float64Array
    ) -> tuple[Float64Array, Float64Array, Float64Array, Float64Array]:
        """Gradient (m, 3), tangent frame, and the gradient's derivative in that frame (m, 2, 2) by differences."""
        at = sample(self.surface, u)
        g = self._gradient(eye, vertex, u, at)
        first, second = tangent_frame(u)
        nearest = np.linalg.norm(vertex - at.position, axis=1)
        to_eye = np.linalg.norm(eye[:, :3] - at.position, axis=1)
        nearest = np.where(eye[:, 3] > 0.0, np.minimum(nearest, to_eye), nearest)
        delta = (1e-5 * np.minimum(1.0, nearest / at.radius) + 1e-12)[:, None]
        jacobian = np.empty((len(u), 2, 2))
        for column, direction in enumerate((first, second)):
            ends = [unit(u + sign * delta * direction) for sign in (1.0, -1.0)]
            up, down = (self._gradient(eye, vertex, end, sample(self.surface, end)) for end in ends)
            change = (up - down) / (2.0 * delta)
            jacobian[:, 0, column], jacobian[:, 1, column] = _dot(change, first), _dot(change, second)
        return g, first, second, jacobian

    def _is_reflection(self, eyes: Float64Array, vertices: Float64Array, at: SurfaceSample) -> NDArray[np.bool_]:
        normal = self.side * at.normal
        return (_dot(normal, towards_eye(eyes, at.position)) > 0.0) & (_dot(normal, vertices - at.position) > 0.0)

    def _signature(self, eyes: Float64Array, vertices: Float64Array, u: Float64Array) -> NDArray[np.int64]:
        *_, jacobian = self._derivatives(eyes, vertices, u)
        determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] * jacobian[:, 1, 0]
        trace = jacobian[:, 0, 0] + jacobian[:, 1, 1]
        return np.where(determinant < 0.0, SADDLE, np.where(trace > 0.0, MINIMUM, MAXIMUM))

    def is_free(self, points: Float64Array, ends: Float64Array) -> NDArray[np.bool_]:
        """(k,) whether the way from points (k, 3) of the surface to homogeneous ends (k, 4) meets it nowhere else.

        Marched in steps that grow from P; a fold thinner than a step is not found.
        """
        w = ends[:, 3:]
        way = np.where(w > 0.0, ends[:, :3] - w * points, 4.0 * self.surface.bound * ends[:, :3])
        # A convex closed shape is never in the way; a hollow one is left through its opening.
        inside = np.full(len(points), self.side < 0.0)
        free = np.ones(len(points), bool)
        for share in np.linspace(0.0, 1.0, MARCH_STEPS + 1)[1:] ** 2:
            rows = np.flatnonzero(free)
            here = points[rows] + share * way[rows]
            distance = np.linalg.norm(here, axis=1)
            now = np.zeros(len(rows), bool)
            near = np.flatnonzero(distance < self.surface.bound)
            u = unit(here[near])
            radius = self.surface.radius(u)[0] if len(near) else np.zeros(0)
            # In doubt nothing is crossed: at P itself the way has not left the surface yet.
            margin = np.where(inside[rows[near]], 1.0 + 1e-7, 1.0 - 1e-7)
            now[near] = distance[near] < margin * radius
            crossed = now != inside[rows]
            if self.cover is not None and crossed.any():
                crossed[crossed] = self.cover(unit(here[crossed]))
            free[rows[crossed]] = False
            inside[rows] = now
        return free


def to_eye_length(eyes: Float64Array, points: Float64Array) -> Float64Array:
    """(m,) |EP| from points (m, 3) to homogeneous eyes (m, 4); for eyes at infinity minus the way towards them."""
    distance = np.linalg.norm(eyes[:, :3] - points, axis=1)
    return np.where(eyes[:, 3] > 0.0, distance, -_dot(eyes[:, :3], points))


def _neighbors(u: Float64Array, resolution: int) -> NDArray[np.int64]:
    """(nodes, 8) the nodes around each: the texels where one would be on an endless face."""
    first, second = tangent_frame(u)
    spacing = 2.0 / resolution
    # The largest coordinate is the face's axis; a step of a texel there is `spacing` over the distance to the face.
    scale = spacing * np.abs(u).max(axis=1, keepdims=True)
    around = []
    for k in range(8):
        angle = 0.25 * np.pi * k
        moved = unit(u + scale * (1.0 if k % 2 == 0 else 1.3) * (np.cos(angle) * first + np.sin(angle) * second))
        face, row, column = nearest_texel(resolution, moved)
        around.append((face * resolution + row) * resolution + column)
    return np.stack(around, axis=1)


def _without_copies(rows: NDArray[np.int64], u: Float64Array) -> tuple[NDArray[np.int64], Float64Array]:
    """Ends (m, 3) of which no two of the same vertex are the same."""
    order = np.argsort(rows, kind="stable")
    rows, u = rows[order], u[order]
    rank = np.arange(len(rows)) - np.searchsorted(rows, rows)
    kept = np.ones(len(rows), bool)
    for back in range(1, int(rank.max(initial=0)) + 1):
        later = np.flatnonzero(rank >= back)
        same = np.linalg.norm(u[later] - u[later - back], axis=1) < SAME
        kept[later[same & kept[later - back]]] = False
    return rows[kept], u[kept]


def _solved(jacobian: Float64Array, g: Float64Array) -> Float64Array:
    """Newton steps (m, 2); along the gradient where the derivative is singular."""
    determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] * jacobian[:, 1, 0]
    safe = np.where(determinant == 0.0, 1.0, determinant)
    x = -(jacobian[:, 1, 1] * g[:, 0] - jacobian[:, 0, 1] * g[:, 1]) / safe
    y = -(jacobian[:, 0, 0] * g[:, 1] - jacobian[:, 1, 0] * g[:, 0]) / safe
    return np.where((determinant == 0.0)[:, None], -g, np.column_stack([x, y]))


def _dot(p: Float64Array, q: Float64Array) -> Float64Array:
    return np.einsum("ij,ij->i", p, q)
