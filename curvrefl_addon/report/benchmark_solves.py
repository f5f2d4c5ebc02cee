# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex solves per second, and apart from them the draw of the triangles that were solved."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import gpu
import numpy as np

from ..errors import InputError
from ..optics.catalogue import METHODS
from ..optics.radial_surfaces import Bumpy
from ..renderer.chunk import Batches, Chunk, Placed
from ..renderer.frame import Renderer, Settings
from ..renderer.gpu_objects import TEXTURE_WIDTH
from ..renderer.materials import Materials
from ..renderer.solve import SolvedChunk, statistics
from ..renderer.surfaces import SurfaceBuffer, draw_primary, draw_reflected
from ..renderer.view_block import view_block
from ..scene.arrays import InstanceArrays
from .benchmark_scenes import hall, radial_mesh, view_of_mirror
from .repeats import Timing, repeated, timing_columns

METHODS_MEASURED = ("newton", "secant_star")
SIZE, MIRROR_PIXELS = (640, 480), 300
REPEATS, SECONDS = 15, 3.0
SHELL, SHELL_BUMPS = 2.5, 0.55
"""Vertices are 1.1 to 3.9 radii from the mirror's center, all around"""
TURN = 0.002
"""The eye goes round so far between two frames, radians: a pixel or so at the mirror"""
LONGEST = 20.0
"""A count is left out where the last one lets expect longer solves, seconds"""
SOLVE_BYTES = 4 * 16
"""Of each vertex beside the search: position read, two records written, map read at the start"""
FETCH_BYTES = 16
FETCHES, OPERATIONS = 3, 400
"""Of each iteration at least, counted in descent.glsl: one trial and two differences, with 75 operations each, path
change 60, second derivatives and step 90, the rest 25. Steps of the secant search need fewer."""


def measure_solves(counts: tuple[int, ...], say: Callable[[str], None]) -> list[dict[str, Any]]:
    """A row per method and count; `left_out` says why there are no times."""
    scene = hall(1000)
    rows = []
    for method in METHODS_MEASURED:
        renderer = Renderer(scene, Settings(method=method, samples=1))
        try:
            expected, before = 0.0, counts[0]
            for count in counts:
                row: dict[str, Any] = {"method": method, "vertices": count, "left_out": ""}
                rows.append(row)
                expected *= count / before
                before = count
                row["left_out"] = _why_not(count, expected)
                if row["left_out"]:
                    continue
                say(f"{method}: {count:,} vertices")
                try:
                    row |= _measured(renderer, Materials(scene), count)
                except (InputError, MemoryError, RuntimeError) as error:
                    row["left_out"] = str(error) or "there is not enough memory"
                    continue
                expected = 1e-3 * row["cold_ms"]
        finally:
            renderer.free()
    return rows


def _why_not(count: int, seconds: float) -> str:
    rows, most = -(-2 * count // TEXTURE_WIDTH), gpu.capabilities.max_texture_size_get()
    if rows > most:
        return f"the driver's textures have at most {most} rows, {rows} are needed"
    if seconds > LONGEST:
        return f"a solve would take about {seconds:.0f} s"
    return ""


def _measured(renderer: Renderer, materials: Materials, count: int) -> dict[str, Any]:
    mirror = renderer.mirrors[0]
    own = renderer.geometry.of_instance(mirror.index)
    rows = max(round(np.sqrt(count / 2.0)), 3)
    mesh = radial_mesh(Bumpy(SHELL_BUMPS, SHELL * mirror.bound), rows - 1, 2 * rows)
    instance = InstanceArrays("shell", 9, 0, np.eye(4), (0,))
    chunk = Chunk([Placed(instance, mesh, mesh, np.zeros(len(mesh.triangles), np.int8))])
    scenery: list[tuple[Chunk, Batches]] = [(chunk, chunk.batches(np.ones(1, bool)))]
    turn = 0.0

    parts: list[SolvedChunk] = []

    def solve() -> float:
        # (Of the last solve alone: those of ten million vertices take 320 MB each.)
        nonlocal turn, parts
        turn += TURN
        view = view_of_mirror(*SIZE, MIRROR_PIXELS, turn)
        start = perf_counter()
        solved = mirror.solve(view, renderer.settings, scenery, own, materials)
        for part in solved:
            part.solution.wait()
        time = 1e3 * (perf_counter() - start)
        parts = [part for part in solved if part.image == 0]
        return time

    def solve_cold() -> float:
        mirror.forget_solutions()
        return solve()

    solve_cold()
    cold = Timing(tuple(repeated(solve_cold, REPEATS, SECONDS)))
    columns: dict[str, Any] = {"solved": mesh.positions.shape[0], "triangles": len(mesh.triangles)}
    columns |= timing_columns("cold_ms", cold)
    columns |= _work("cold", parts)
    if "previous" in METHODS[renderer.settings.method].maps:
        columns |= timing_columns("warm_ms", Timing(tuple(repeated(solve, REPEATS, SECONDS))))
        columns |= _work("warm", parts)
    else:
        columns |= timing_columns("warm_ms", None)
    for state in ("cold", "warm"):
        time = columns[f"{state}_ms"]
        columns[f"{state}_solves_per_second"] = None if time is None else 1e3 * columns["solved"] / time
    view = view_of_mirror(*SIZE, MIRROR_PIXELS, turn)
    uniforms = view_block(view)
    seen, shown = SurfaceBuffer(*SIZE), SurfaceBuffer(*SIZE)
    draw_primary(seen, [own], materials, uniforms)

    def draw() -> float:
        shown.clear()
        start = perf_counter()
        window = mirror.window(view)
        draw_reflected(shown, seen, 1, None, parts, materials, uniforms, mirror.bound, window)
        with shown.frame_buffer.bind():
            shown.frame_buffer.read_color(0, 0, 1, 1, 4, 0, "FLOAT")
        return 1e3 * (perf_counter() - start)

    draw()
    return columns | timing_columns("draw_ms", Timing(tuple(repeated(draw, REPEATS, SECONDS))))


def _work(state: str, parts: list[SolvedChunk]) -> dict[str, Any]:
    """Iterations, and what they make of bytes and operations a vertex."""
    numbers = statistics([part.solution for part in parts])
    mean = numbers["iterations"]["mean"]
    return {
        f"{state}_iterations": mean,
        f"{state}_unsolved": numbers["unconverged"],
        f"{state}_bytes": SOLVE_BYTES + FETCHES * FETCH_BYTES * mean,
        f"{state}_operations": OPERATIONS * mean,
    }
