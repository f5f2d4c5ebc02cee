# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a solve takes against how many vertices it has: Roger & Holzschuch 2006, figure 10, finds it linear."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from ...errors import InputError
from ...renderer.geometry.chunk import Chunk, Placed
from ...renderer.mirrors.baked_shape import BakedShape
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...renderer.surfaces.materials import Materials
from ...renderer.vertices.mirror_solver import MirrorSolver
from ...report.repeats import Timing, repeated
from ...scene.arrays import Float32Array, Float64Array, InstanceArrays, MeshArrays, SceneArrays
from ...scene.camera.view import View
from .vertex_curves import Curve, counts_up_to

ROUNDS, COUNT_REPEATS, COUNT_SECONDS = 3, 10, 0.3
NEAR, FAR = 1.1, 4.0
"""Distances of the vertices, in the reflector's own radii"""


def vertex_count_steps(
    arrays: SceneArrays, view: View, methods: Sequence[str], largest: int
) -> Generator[str, None, list[Curve]]:
    """Solve more and more vertices on a shell around the first reflector; yields before each of `counts_up_to`."""
    solving = [name for name in methods if Settings(method=name).entry.solves_vertices]
    if not solving:
        return []
    renderer = Renderer(arrays, Settings(method="environment_cube"))
    try:
        mirror = renderer.mirrors[0]
        solver = MirrorSolver(mirror)
        shape = mirror.shape(renderer.settings.map_resolution)
        own = renderer.geometry.of_instance(mirror.index)
        materials = Materials(arrays)
        timings: dict[str, list[Timing]] = {name: [] for name in solving}
        reasons: dict[str, str] = {}
        counts = counts_up_to(largest)
        for count in counts:
            yield f"Solving {count:,} vertices"
            chunk = _shell(shape, count)
            times: dict[str, tuple[float, ...]] = dict.fromkeys(solving, ())
            # Method after method, and again: what else the machine does at one time would count against single ones.
            for _ in range(ROUNDS):
                for name in solving:
                    if name in reasons:
                        continue
                    try:
                        times[name] += _times(solver, view, Settings(method=name), chunk, own, materials)
                    except InputError as error:
                        reasons[name] = str(error)
            for name in solving:
                if name not in reasons:
                    timings[name].append(Timing(times[name]))
        return [
            Curve(name, reason=reasons[name]) if name in reasons else Curve(name, counts, tuple(timings[name]))
            for name in solving
        ]
    finally:
        renderer.free()


def _times(
    solver: MirrorSolver, view: View, settings: Settings, chunk: Chunk, own: Any, materials: Materials
) -> tuple[float, ...]:
    """Milliseconds of each repeat."""

    def solve() -> float:
        start = perf_counter()
        for part in solver.solve(view, settings, [(chunk, ())], own, materials)[0]:
            part.solution.wait()
        return 1e3 * (perf_counter() - start)

    # Shaders compile, grids are built.
    solve()
    return tuple(repeated(solve, COUNT_REPEATS, COUNT_SECONDS))


def _shell(shape: BakedShape, count: int) -> Chunk:
    """`count` vertices all around the mirror as a chunk of its own."""
    matrix: Float64Array = np.eye(4)
    matrix[:3, 3] = shape.center
    mesh = MeshArrays(
        name="shell",
        positions=shell_positions(count, shape.bound),
        corner_vertex=np.arange(count, dtype=np.int32),
        corner_normals=np.zeros((count, 3), np.float32),
        corner_uv=None,
        triangles=np.array([[0, 1, 2]], np.int32),
        triangle_slot=np.zeros(1, np.int32),
    )
    instance = InstanceArrays("shell", 0, 0, matrix, (0,))
    return Chunk([Placed(instance, mesh, mesh, np.zeros(1, np.int8))])


def shell_positions(count: int, radius: float) -> Float32Array:
    """(count, 3) points around the origin, neighbors in the list near in space as in meshes."""
    share = (np.arange(count) + 0.5) / count
    z = 1.0 - 2.0 * share
    # A spiral from pole to pole whose turns lie as far apart as its points.
    longitude = np.sqrt(np.pi * count) * np.arccos(z)
    ring = np.sqrt(1.0 - z**2)
    directions = np.column_stack([ring * np.cos(longitude), ring * np.sin(longitude), z])
    wave = 0.5 + 0.5 * np.sin(5.0 * directions[:, 0] + 1.0) * np.cos(4.0 * directions[:, 1])
    return (radius * (NEAR + (FAR - NEAR) * wave)[:, None] * directions).astype(np.float32)
