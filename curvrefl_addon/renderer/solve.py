# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex solve: a compute shader finds the reflection point of every position of a geometry.

One shader file per method (`gpu_shaders/<method>.comp.glsl`) over `solver.glsl`; the float64 reference of each is in
`optics/<method>.py`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import gpu
import numpy as np

from ...gpu_shaders.loader import load
from ..optics import secant_star, status
from ..scene.arrays import Float64Array
from ..scene.view import View
from .gpu_objects import dispatch, empty_record_texture, read_records, uniform_block

GROUP = 64
_BLOCK = np.dtype(
    [
        ("world_to_map", "f4", (4, 4)),
        ("map_to_world", "f4", (4, 4)),
        ("eye", "f4", 4),
        ("counts", "i4", 4),
        ("screen", "f4", 4),
    ]
)


@dataclass(frozen=True)
class VertexSolution:
    """Record textures of one solve (see `solver.glsl`); world space."""

    reflection_points: Any
    """Per position: P xyz, status + 4 iterations"""
    virtual_positions: Any
    """Per position: where the vertex seems to be, and |PV|"""
    count: int

    def read(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """P (n, 3), status (n,), iterations (n,), virtual positions with |PV| (n, 4); waits for the GPU."""
        points = read_records(self.reflection_points, self.count)
        packed = np.rint(points[:, 3]).astype(np.int32)
        return points[:, :3], packed & 3, packed >> 2, read_records(self.virtual_positions, self.count)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        target = gpu.types.GPUFrameBuffer(color_slots=(self.reflection_points,))
        with target.bind():
            target.read_color(0, 0, 1, 1, 4, 0, "FLOAT")


def statistics(solutions: Sequence[VertexSolution]) -> dict[str, Any]:
    """Counts and iterations over all solutions as `report.json` has them; waits for the GPU."""
    parts = [solution.read() for solution in solutions]
    code = np.concatenate([np.zeros(0, np.int32), *(part[1] for part in parts)])
    iterations = np.concatenate([np.zeros(0, np.int32), *(part[2] for part in parts)])
    searched = iterations[code == status.REFLECTED]
    some = len(searched) > 0
    return {
        "vertices": len(code),
        "reflected": len(searched),
        "hidden": int((code == status.HIDDEN).sum()),
        "unconverged": int((code >= status.UNSOLVED).sum()),
        "iterations": {
            "mean": float(searched.mean()) if some else 0.0,
            "p99": float(np.percentile(searched, 99)) if some else 0.0,
            "max": int(searched.max()) if some else 0,
        },
    }


def solve_vertices(
    method: str,
    view: View,
    world_to_map: Float64Array,
    radial: Any,
    bound: float,
    positions: Any,
    count: int,
    search_steps: int = secant_star.SEARCH_STEPS,
    newton_steps: int = secant_star.NEWTON_STEPS,
    tolerance: float = 0.05,
) -> VertexSolution:
    """Solve `count` records of the `positions` texture against the radial cube map `radial`.

    `world_to_map` (4, 4) is rigid, `bound` the largest radius in metres, `tolerance` in pixels of `view`.
    """
    map_to_world = np.linalg.inv(world_to_map)
    eye = world_to_map @ view.eye
    block = np.zeros(1, _BLOCK)
    block["world_to_map"] = world_to_map.T
    block["map_to_world"] = map_to_world.T
    block["eye"] = eye
    block["counts"] = (count, search_steps, newton_steps, 0)
    block["screen"] = (view.focal_pixels, tolerance, bound, 0.0)
    solution = VertexSolution(empty_record_texture(count), empty_record_texture(count), count)
    # Bound by reference only: it has to outlive the dispatch.
    uniforms = uniform_block(block)
    shader = _solver_shader(method)
    shader.bind()
    shader.uniform_block("solver", uniforms)
    shader.uniform_sampler("positions", positions)
    shader.uniform_sampler("radial", radial)
    shader.image("reflection_points", solution.reflection_points)
    shader.image("virtual_positions", solution.virtual_positions)
    dispatch(shader, count, GROUP)
    return solution


@cache
def _solver_shader(method: str) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source("struct Solver { mat4 world_to_map; mat4 map_to_world; vec4 eye; ivec4 counts; vec4 screen; };")
    info.uniform_buf(0, "Solver", "solver")
    info.sampler(0, "FLOAT_2D", "positions")
    info.sampler(1, "FLOAT_CUBE", "radial")
    info.image(0, "RGBA32F", "FLOAT_2D", "reflection_points", qualifiers={"WRITE"})
    info.image(1, "RGBA32F", "FLOAT_2D", "virtual_positions", qualifiers={"WRITE"})
    info.local_group_size(GROUP, 1)
    info.compute_source(load(f"{method}.comp.glsl"))
    return gpu.shader.create_from_info(info)
