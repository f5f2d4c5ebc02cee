# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The search along the projected bisector field (Estalella et al. 2005, section 4) on a star-shaped reflector, float64.

This is the reference that `bisector_cube.comp.glsl` is held to; both follow the same steps in the same order.

At the reflection point the bisector B of the directions to eye and vertex is the normal N. Both are projected to the
plane that touches the sphere of directions at the current point, as the paper projects them to the face of its cube;
their difference is the field, whose sink is the reflection point. The midpoint rule follows it, with two reads of the
map a step. What the paper leaves open is chosen so:

* **Start in the region of interest**, the part that both eye and vertex see: on the great circle between their
  directions, the nearer to one of them the lower that one stands over the reflector.
* **Step**: half a step lets a field that falls evenly fall to a half where the whole step is right. How far it has
  fallen says at once how long the step should be; where it has turned round, the midpoint is past the sink and its
  field is not followed. A contact vertex needs steps as short as its height.
* **Error function**: a step after which it is larger, or that leaves what the eye sees, is not taken, and the next one
  is shorter.
* **Concave pieces**: the field's sink is there for things past the focus; before it, for near things, it is a source.
  Where the first half step makes the error larger the field is followed backwards.
* **Hidden vertices** end behind the tangent plane of the point that was found. They are searched for again as their
  mirror image in the tangent plane of every point (section 6.1): the inverse search.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import status
from ..fermat import sample, towards_eye
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import tangent_frame

STEPS = 9
"""The most that figure 8 of the paper shows"""
SMALLEST_ERROR = 2.5e-9
"""Where the search stops: 1e-4 radians"""
FIRST_STEP, SHORTEST_STEP, LONGEST_STEP = 1.0, 1e-4, 4.0
RIGHT_FALL = 0.5
"""Of the field over half a step that is as long as it should be"""
LARGEST_FALL = 0.9
"""From which on the field at the middle is not followed"""
LEAST_FACTOR, LARGEST_FACTOR = 0.05, 2.0
"""By which a step becomes another"""
REJECTED = 0.3
"""The same where the error has become larger"""
HALVINGS = 3
"""Of the way from the eye's direction to a start that the eye does not see"""
LONGEST_MOVE = 0.5
"""Radians"""
LEAST_COSINE = 0.2
"""To u, under which a direction meets the tangent plane too far away"""
LARGEST_MISS = 0.1
"""Radians between bisector and normal from which on the end of a search is no reflection point"""


@dataclass(frozen=True)
class Found:
    """Result for n vertices, relative to the star center."""

    u: Float64Array
    """(n, 3) where the search ended"""
    position: Float64Array
    """(n, 3)"""
    status: np.ndarray
    """(n,) codes of `status`"""
    iterations: np.ndarray
    """(n,)"""


@dataclass(frozen=True)
class _Place:
    """Points of the reflector and what the field is made of; (n, 3) each."""

    u: Float64Array
    position: Float64Array
    normal: Float64Array
    bisector: Float64Array

    @property
    def error(self) -> Float64Array:
        """(n,) (1 - B . N) / 2 (equation 1), without the cancellation."""
        difference = self.bisector - self.normal
        return 0.25 * _dot(difference, difference)

    @property
    def field(self) -> Float64Array:
        """The projected bisector direction."""
        return _on_plane(self.bisector, self.u) - _on_plane(self.normal, self.u)

    def where(self, chosen: np.ndarray, other: _Place) -> _Place:
        """`other` where `chosen` (n,), else this."""
        pairs = zip(
            (other.u, other.position, other.normal, other.bisector),
            (self.u, self.position, self.normal, self.bisector),
            strict=True,
        )
        return _Place(*(np.where(chosen[:, None], a, b) for a, b in pairs))


def solve(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, steps: int = STEPS, side: float = 1.0
) -> Found:
    """Reflection points of vertices (n, 3) for the homogeneous eye (4,); `side` is -1 for a hollow mirror."""
    search = _Search(surface, eye, vertices, side)
    start = search.at(_start(surface, eye, vertices, side), np.zeros(len(vertices), bool))
    end, iterations = search.follow(start, np.ones(len(vertices), bool), False, steps)
    behind = (_dot(end.normal, vertices - end.position) <= 0.0) | ~search.sees_eye(end)
    again, more = search.follow(search.at(end.u, behind), behind, True, steps)
    end = end.where(behind, again)
    miss = end.error > 0.25 * LARGEST_MISS**2
    code = np.where(miss, status.UNSOLVED, np.where(behind, status.HIDDEN, status.REFLECTED))
    return Found(end.u, end.position, code, iterations + more)


@dataclass(frozen=True)
class _Search:
    surface: RadialSurface
    eye: Float64Array
    vertices: Float64Array
    side: float

    def at(self, u: Float64Array, inverse: np.ndarray) -> _Place:
        here = sample(self.surface, u)
        normal = self.side * here.normal
        height = _dot(self.vertices - here.position, normal)
        seen = self.vertices - np.where(inverse, 2.0 * height, 0.0)[:, None] * normal
        bisector = unit(towards_eye(self.eye, here.position) + unit(seen - here.position))
        return _Place(u, here.position, normal, bisector)

    def sees_eye(self, place: _Place) -> np.ndarray:
        """(n,)"""
        return _dot(place.normal, towards_eye(self.eye, place.position)) > 0.0

    def follow(self, here: _Place, wanted: np.ndarray, inverse: bool, steps: int) -> tuple[_Place, np.ndarray]:
        """Follow the field from `here` for the `wanted` vertices (n,); where it ends and the number of steps (n,)."""
        count = len(wanted)
        mirrored = np.full(count, inverse)
        step = np.full(count, FIRST_STEP)
        sense = np.ones(count)
        iterations = np.zeros(count, int)
        for number in range(steps):
            active = wanted & (here.error > SMALLEST_ERROR)
            if not active.any():
                break
            iterations[active] += 1
            first = sense[:, None] * here.field
            middle = self.at(_moved(here.u, 0.5 * step[:, None] * first), mirrored)
            second = sense[:, None] * middle.field
            fall = np.linalg.norm(second - first, axis=1) / np.maximum(np.linalg.norm(first, axis=1), 1e-30)
            factor = np.clip(RIGHT_FALL / np.maximum(fall, 1e-9), LEAST_FACTOR, LARGEST_FACTOR)
            step = np.where(active, np.clip(step * factor, SHORTEST_STEP, LONGEST_STEP), step)
            along = np.where((fall > LARGEST_FALL)[:, None], first, second)
            there = self.at(_moved(here.u, step[:, None] * along), mirrored)
            taken = active & (inverse | ((there.error <= here.error) & self.sees_eye(there)))
            if self.side < 0.0 and not inverse and number == 0:
                source = active & (middle.error > here.error)
                sense = np.where(source, -1.0, 1.0)
                taken &= ~source
            step = np.where(taken, step, REJECTED * step)
            here = here.where(taken, there)
        return here, iterations


def _start(surface: RadialSurface, eye: Float64Array, vertices: Float64Array, side: float) -> Float64Array:
    """(n, 3) between eye and vertex, in the region of interest; the opposite where a hollow mirror reflects better."""
    a, b = unit(np.broadcast_to(eye[:3], vertices.shape)), unit(vertices)
    eye_weight = np.ones(len(vertices))
    if eye[3] > 0.0:
        eye_weight = _weight(np.linalg.norm(eye[:3]), surface.radius(a[:1])[0] if len(a) else np.ones(0))
    vertex_weight = _weight(np.linalg.norm(vertices, axis=1), surface.radius(b)[0])
    share = eye_weight / np.maximum(eye_weight + vertex_weight, 1e-30)
    cosine = np.clip(_dot(a, b), -1.0, 1.0)
    across = b - cosine[:, None] * a
    length = np.linalg.norm(across, axis=1)
    angle = share * np.arctan2(length, cosine)
    across = np.where((length < 1e-6)[:, None], tangent_frame(a)[1], unit(across))

    def on_arc(angles: Float64Array) -> Float64Array:
        return np.cos(angles)[:, None] * a + np.sin(angles)[:, None] * across

    u = on_arc(angle)
    if side > 0.0:
        for _ in range(HALVINGS):
            here = sample(surface, u)
            angle = np.where(_dot(here.normal, towards_eye(eye, here.position)) > 0.0, angle, 0.5 * angle)
            u = on_arc(angle)
        return u

    def facing(directions: Float64Array) -> Float64Array:
        here = sample(surface, directions)
        return _dot(unit(towards_eye(eye, here.position) + unit(vertices - here.position)), here.normal)

    return np.where((facing(-u) < facing(u))[:, None], -u, u)


def _weight(distance: np.ndarray | np.floating, radius: Float64Array) -> Float64Array:
    """Height over the reflector as 0 (contact) to 1 (far away)."""
    height = np.maximum(distance - radius, 0.0)
    return height / (height + radius)


def _on_plane(direction: Float64Array, u: Float64Array) -> Float64Array:
    """Where the line of a direction meets the plane that touches the sphere of directions at u, from u."""
    along = _dot(direction, u)
    bounded = np.where(along < 0.0, -1.0, 1.0) * np.maximum(np.abs(along), LEAST_COSINE)
    return direction / bounded[:, None] - u * (along / bounded)[:, None]


def _moved(u: Float64Array, offset: Float64Array) -> Float64Array:
    length = np.linalg.norm(offset, axis=1)
    return unit(u + offset * np.minimum(1.0, LONGEST_MOVE / np.maximum(length, 1e-30))[:, None])


def _dot(p: Float64Array, q: Float64Array) -> Float64Array:
    return np.einsum("ij,ij->i", p, q)
