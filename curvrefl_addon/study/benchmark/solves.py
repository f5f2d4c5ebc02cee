# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex solves per second, and apart from them the draw of the triangles that were solved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...errors import InputError
from ...optics.surfaces.radial_surfaces import Bumpy
from ...renderer.device.context import most_texels
from ...renderer.device.records import TEXTURE_WIDTH
from ...renderer.geometry.chunk import Chunk, Placed
from ...renderer.measured.hall import hall, radial_mesh, view_of_mirror
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...renderer.surfaces.materials import Materials
from ...renderer.surfaces.primary import draw_primary
from ...renderer.surfaces.surface_buffer import SurfaceBuffer
from ...renderer.surfaces.view_block import view_block
from ...renderer.vertices.mirror_solver import MirrorSolver
from ...renderer.vertices.reflected import draw_reflected
from ...renderer.vertices.solution import SolvedChunk, VertexSolution, statistics
from ...renderer.vertices.solve import PreparedSolve, prepare_solve
from ...report.repeats import timing_columns
from ...scene.arrays import InstanceArrays
from .gpu_timing import empty_wait, time_on_gpu

METHODS_MEASURED = ("newton", "secant_star")
STATES = ("cold", "warm", "still")
"""Without a last frame; the eye has moved a bit since; nothing has, so that what is reflected keeps its records"""
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


def measure_solves(counts: tuple[int, ...], say: Callable[[str], None]) -> Iterator[dict[str, Any]]:
    """A row per method and count; `left_out` says why there are no times."""
    scene = hall(1000)
    for method in METHODS_MEASURED:
        renderer = Renderer(scene, Settings(method=method, samples=1))
        try:
            expected, before = 0.0, counts[0]
            for count in counts:
                row: dict[str, Any] = {"method": method, "vertices": count, "left_out": ""}
                expected *= count / before
                before = count
                row["left_out"] = _why_not(count, expected)
                if not row["left_out"]:
                    say(f"{method}: {count:,} vertices")
                    try:
                        row |= _measured(renderer, Materials(scene), count)
                        expected = 1e-3 * row["cold_ms"]
                    except (InputError, MemoryError, RuntimeError) as error:
                        row["left_out"] = str(error) or "there is not enough memory"
                yield row
        finally:
            renderer.free()


def _why_not(count: int, seconds: float) -> str:
    rows, most = -(-2 * count // TEXTURE_WIDTH), most_texels()
    if rows > most:
        return f"the driver's textures have at most {most} rows, {rows} are needed"
    if seconds > LONGEST:
        return f"a solve would take about {seconds:.0f} s"
    return ""


def _measured(renderer: Renderer, materials: Materials, count: int) -> dict[str, Any]:
    mirror = renderer.mirrors[0]
    solver = MirrorSolver(mirror)
    shape = mirror.shape(renderer.settings.map_resolution)
    own = renderer.geometry.of_instance(mirror.index)
    rows = max(round(np.sqrt(count / 2.0)), 3)
    mesh = radial_mesh(Bumpy(SHELL_BUMPS, SHELL * shape.bound), rows - 1, 2 * rows)
    instance = InstanceArrays("shell", 9, 0, np.eye(4), (0,))
    chunk = Chunk([Placed(instance, mesh, mesh, np.zeros(len(mesh.triangles), np.int8))])
    settings = renderer.settings
    method = settings.entry

    def prepared(turn: float, previous: VertexSolution | None = None) -> PreparedSolve:
        view = view_of_mirror(*SIZE, MIRROR_PIXELS, turn)
        reflector = solver.reflector(view, settings, own, materials)
        tolerance = 0.1 * settings.pixel_tolerance
        return prepare_solve(
            settings.method, view, reflector, chunk.positions, chunk.position_count, tolerance, previous
        )

    # Each is run again and again on what it was prepared with, so that memory holds two solutions and no more: those of
    # ten million vertices take 320 MB each.
    cold = prepared(0.0)
    cold.run()
    cold.solution.wait()
    empty_ms = empty_wait(cold.solution.wait)
    columns: dict[str, Any] = {"solved": mesh.positions.shape[0], "triangles": len(mesh.triangles)}
    columns |= {"empty_wait_ms": empty_ms} | _timed("cold", cold, empty_ms)
    if "previous" in method.maps:
        columns |= _timed("warm", prepared(TURN, cold.solution), empty_ms)
        columns |= _timed("still", prepared(0.0, cold.solution), empty_ms, searches=False)
    else:
        columns |= timing_columns("warm_ms", None) | timing_columns("still_ms", None)
    for state in STATES:
        time = columns[f"{state}_ms"]
        columns[f"{state}_solves_per_second"] = None if time is None else 1e3 * columns["solved"] / time
    view = view_of_mirror(*SIZE, MIRROR_PIXELS)
    uniforms = view_block(view)
    seen, shown = SurfaceBuffer(*SIZE), SurfaceBuffer(*SIZE)
    draw_primary(seen, [own], materials, uniforms)
    parts = [SolvedChunk(chunk, chunk.batches(np.ones(1, bool)), cold.solution)]
    window = mirror.window(view)

    def draw() -> None:
        shown.clear()
        draw_reflected(shown, seen, 1, None, parts, materials, uniforms, shape.bound, window)

    return columns | time_on_gpu(draw, shown.wait, empty_ms, REPEATS, SECONDS).columns("draw")


def _timed(state: str, solve: PreparedSolve, empty_ms: float, searches: bool = True) -> dict[str, Any]:
    """Times, iterations, and what these make of bytes and operations a vertex; the records have those of the last
    search, which may not have been now."""
    columns = time_on_gpu(solve.run, solve.solution.wait, empty_ms, REPEATS, SECONDS).columns(state)
    numbers = statistics([solve.solution])
    mean = numbers["iterations"]["mean"] if searches else 0.0
    return columns | {
        f"{state}_iterations": mean,
        f"{state}_unsolved": numbers["unconverged"],
        f"{state}_bytes": SOLVE_BYTES + FETCHES * FETCH_BYTES * mean,
        f"{state}_operations": OPERATIONS * mean,
    }
