# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the units of `renderer/costs/model.py` cost on the device in hand.

The passes themselves are timed, in halls made of numpy: rays followed, vertices solved, what was solved drawn. Each
unit is how much longer more of it takes, over how much more there is, so that what a pass takes at all is in none of
them. Work grows until the device takes long enough for it, so that a driver that is a program is measured as well as a
fast card; where even the most is done while it is asked for, a unit costs next to nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from ...optics.surfaces.radial_surfaces import Bumpy, unit
from ...scene.arrays import Float32Array, InstanceArrays
from ..choice import RAYS
from ..costs.table import Costs
from ..device.records import record_texture
from ..device.shaders import compiled
from ..geometry.chunk import Chunk, Placed
from ..surfaces.canvas import Canvas
from ..vertices.solution import SolvedChunk
from .hall import radial_mesh
from .hall_passes import TURN, HallPasses
from .timing import ENOUGH_MS, Stopwatch

FEW, MANY = 400, 8000
"""About how many triangles the two halls have that are compared"""
SMALL, SIZES = 32, (256, 512, 1024, 1536)
"""Widths of the pictures that are compared: a small one, and the first of the others that takes a while"""
TRIANGLES = (2_000, 8_000, 32_000, 128_000)
"""Of a shell around the mirror; the first, and the first of the others that takes a while"""
SHELL, SHELL_BUMPS = 2.5, 0.55
"""Its radius in radii of the mirror, and how far that goes up and down"""
POINTS = (1 << 12, 1 << 15, 1 << 18, 1 << 20)
"""Places around the mirror; likewise"""
NEAREST, FARTHEST = 1.3, 4.0
"""Between which they are, in radii of the mirror"""
LEAST = 1e-6
"""No unit costs less, microseconds"""


def measure_costs(found: Callable[[Costs, float], None]) -> Iterator[None]:
    """The work of a `Task`. Hands over what it has found at its end, and how restless the machine was meanwhile (see
    `Stopwatch.unrest`)."""
    measured = _Measured()
    try:
        yield from measured.prepare()
        costs = yield from measured.costs()
    finally:
        measured.free()
    found(costs, measured.watch.unrest)


class _Measured:
    """Two halls that differ in how fine things are, and what is found out in them."""

    def __init__(self) -> None:
        self.watch = Stopwatch()
        self._halls: list[HallPasses] = []

    def prepare(self) -> Generator[None]:
        """Make both."""
        for triangles in (FEW, MANY):
            self._halls.append((yield from compiled(partial(HallPasses, triangles))))
            yield
            yield from self._halls[-1].build_trees()

    def free(self) -> None:
        """Let go of them."""
        while self._halls:
            self._halls.pop().renderer.free()

    def costs(self) -> Generator[None, None, Costs]:
        """All of the table."""
        few, many = self._halls
        best_ms = self.watch.best_ms
        few.look(SMALL)
        yield from compiled(few.see)
        small_walk = yield from best_ms(few.walk, few.path.wait)
        parts = (yield from compiled(few.reflect)).parts[0]
        solved, drawn = _counts(parts)
        small_solve = yield from best_ms(few.reflect, few.wait_for_points)
        small_draw = yield from best_ms(lambda: few.draw(parts), few.shown.wait)
        triangle = yield from self._triangle()
        vertex = yield from self._vertex()

        walk, size = 0.0, SMALL
        for size in SIZES:
            few.look(size)
            yield from compiled(few.see)
            walk = yield from best_ms(few.walk, few.path.wait)
            if walk >= ENOUGH_MS:
                break
        pixels = few.mirror_pixels()
        more = pixels * (1.0 - (SMALL / size) ** 2)
        draw = yield from best_ms(lambda: few.draw(parts), few.shown.wait)
        touch = yield from best_ms(lambda: few.touch(parts), few.shown.wait)
        clear = yield from best_ms(lambda: few.clear(parts), few.shown.wait)
        shaded = yield from self._shaded(walk, pixels)
        rest, vertices = yield from self._at_rest(few)
        few.look(1)  # (its pictures go before those of the other hall are made)
        yield
        many.look(size)
        yield from compiled(many.see)
        many_walk = yield from best_ms(many.walk, many.path.wait)
        many_rest, many_vertices = yield from self._at_rest(many)

        by_ray = _slope(small_walk, walk, more)
        doublings = float(np.log2(many.triangles / few.triangles))
        doubling = min(max(_slope(walk, many_walk, pixels) / doublings, 0.0), by_ray / np.log2(few.triangles))
        # (What looking at edges takes at all is large: that is no vertex' own.)
        asked = min(_slope(rest, many_rest, many_vertices - vertices), _slope(0.0, many_rest, many_vertices))
        begun = 1e3 * (small_solve + small_draw - small_walk) - vertex * solved - triangle * drawn
        return Costs(
            pixel_by_ray=_rounded(by_ray - doubling * np.log2(few.triangles)),
            pixel_by_ray_per_doubling=_rounded(doubling),
            layer_drawn=_rounded(_slope(small_draw, draw, more * few.layers)),
            pixel_cleared=_rounded(_slope(touch, clear, size**2)),
            triangle_drawn=_rounded(triangle),
            vertex_solved=_rounded(vertex),
            edges_asked=_rounded(asked - vertex),
            solve_begun=_rounded(begun),
            pixel_shaded=_rounded(shaded),
        )

    def _triangle(self) -> Generator[None, None, float]:
        """Microseconds of a triangle of a shell, in the picture that is looked at, which is small."""
        few = self._halls[0]
        times: list[tuple[float, int]] = []
        for count in TRIANGLES:
            rows = round(np.sqrt(count / 4.0))
            mesh = radial_mesh(Bumpy(SHELL_BUMPS, SHELL * few.shape.bound), rows, 2 * rows)
            yield
            instance = InstanceArrays("shell", 9, 0, np.eye(4), (0,))
            chunk = Chunk([Placed(instance, mesh, mesh, np.zeros(len(mesh.triangles), np.int8))])
            yield
            solve = few.prepared(chunk.positions, chunk.position_count, 0.0, None)
            yield from compiled(solve.run)
            parts = (SolvedChunk(chunk, chunk.batches(np.ones(1, bool)), solve.solution),)
            yield
            time = yield from self.watch.best_ms(partial(few.draw, parts), few.shown.wait)
            times.append((time, len(mesh.triangles)))
            if time - times[0][0] >= ENOUGH_MS:
                break
        return _slope(times[0][0], times[-1][0], times[-1][1] - times[0][1])

    def _vertex(self) -> Generator[None, None, float]:
        """Microseconds of a vertex that starts from where it was reflected before the eye moved a little."""
        few = self._halls[0]
        times: list[float] = []
        for count in POINTS:
            positions = record_texture(_points(count, few.shape.bound))
            yield
            before = few.prepared(positions, count, 0.0, None)
            yield from compiled(before.run)
            yield
            solve = few.prepared(positions, count, TURN, before.solution)
            times.append((yield from self.watch.best_ms(solve.run, solve.solution.wait)))
            if times[-1] - times[0] >= ENOUGH_MS:
                break
        return _slope(times[0], times[-1], count - POINTS[0])

    def _shaded(self, walk: float, pixels: int) -> Generator[None, None, float]:
        """Microseconds of a mirror pixel of a whole frame, without what the eye sees itself and the walk."""
        few = self._halls[0]
        see = yield from self.watch.best_ms(few.see, few.seen.wait)
        few.renderer.configure(replace(few.renderer.settings, method=RAYS))
        reflection = yield from compiled(lambda: few.renderer.reflect(few.view))
        canvas = Canvas.of_size(few.size, few.size)

        def draw() -> None:
            few.renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True)

        frame = yield from self.watch.best_ms(draw, canvas.wait)
        few.renderer.configure(few.settings)
        return _slope(see + walk, frame, pixels)

    def _at_rest(self, one: HallPasses) -> Generator[None, None, tuple[float, int]]:
        """Milliseconds of a view at rest, and the vertices that were solved for it."""
        reflection = yield from compiled(one.rest)
        count = sum(solution.count for solution in reflection.solutions)
        return (yield from self.watch.best_ms(one.rest, one.wait_for_points)), count


def _slope(less: float, more: float, work: float) -> float:
    """Microseconds for each unit of so much more work, of milliseconds."""
    return 1e3 * (more - less) / work


def _counts(parts: tuple[SolvedChunk, ...]) -> tuple[int, int]:
    """Vertices and triangles."""
    return sum(part.solution.count for part in parts), sum(len(part.chunk.triangles) for part in parts)


def _points(count: int, bound: float) -> Float32Array:
    """(count, 4) places around a mirror, the same each time."""
    rng = np.random.default_rng(0)
    points = np.ones((count, 4), np.float32)
    away = rng.uniform(NEAREST * bound, FARTHEST * bound, (count, 1))
    points[:, :3] = away * unit(rng.normal(size=(count, 3)))
    return points


def _rounded(cost: float) -> float:
    """To four digits; what noise has made less than nothing costs next to nothing."""
    return float(f"{max(float(cost), LEAST):.4g}")
