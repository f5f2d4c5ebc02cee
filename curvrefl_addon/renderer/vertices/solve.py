# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex solve: a shader finds the reflection point of every position of a geometry, by compute where it can.

A method is one function, `solve` of its shader file `gpu_shaders/solvers/<method>.comp.glsl`, between what all share:
`solver.glsl` before it and `solver_main.glsl` after it. What of the reflector it reads is named in the catalog and
bound from here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...optics.catalog import Method, entry_of
from ...optics.snell import index_in_range
from ...optics.solvers.newton_region import STEPS as REGION_STEPS
from ...optics.solvers.secant_star import NEWTON_STEPS
from ...optics.surfaces.curvature_regions import SEEDS, Regions
from ...scene.arrays import LARGEST_COORDINATE, Float64Array
from ...scene.camera.view import View
from ..device.context import gpu_cache
from ..device.cubes import cube_texture
from ..device.records import empty_index_texture, empty_record_texture, record_texture
from ..device.shaders import Block, Image, Piece, flags, named, uniform_block
from ..device.uniform_struct import glsl_struct
from ..device.ways.features import Features, features
from ..device.ways.record_pass import MARKS, RecordPass, build_record_pass, marks_for
from .solution import VertexSolution

MOST_STRAGGLERS_AT_ONCE = 1 << 14
"""Invocations of a clean-up pass, which share whatever the first pass has left"""
SAMPLERS: dict[str, tuple[tuple[str, str], ...]] = {
    "radial": (("FLOAT_CUBE", "radial"),),
    "parametric": (
        ("FLOAT_2D", "surface_point"),
        ("FLOAT_2D", "surface_du"),
        ("FLOAT_2D", "surface_dv"),
        ("FLOAT_CUBE", "uv_of_direction"),
    ),
    "screen": (("FLOAT_2D", "screen_position"), ("FLOAT_2D", "screen_normal")),
    "previous": (("FLOAT_2D", "previous_points"), ("FLOAT_2D", "previous_virtual")),
    "plane": (),
}
"""What a method's `maps` are to its shader: kind and name of each sampler, beside `positions`"""
_BLOCK = np.dtype(
    [
        ("world_to_map", "f4", (4, 4)),
        ("map_to_world", "f4", (4, 4)),
        ("map_to_search", "f4", (4, 4)),
        ("eye", "f4", 4),  # homogeneous, map frame
        ("plane", "f4", 4),
        ("search_start", "f4", 2),
        ("focal_pixels", "f4"),
        ("tolerance", "f4"),  # pixels
        ("bound", "f4"),
        ("side", "f4"),
        ("count", "i4"),
        ("steps", "i4"),  # of the method's search
        ("newton_steps", "i4"),  # of one descent at its end
        ("has_last_frame", "i4"),
        ("is_same_view", "i4"),  # as the last frame's: a vertex that has not moved keeps what it showed
        ("is_convex", "i4"),
        ("first_rung", "i4"),
        ("region", "i4"),
        ("index", "f4"),  # of refraction, beyond the surface over that on the eye's side
        ("unused", "i4"),
    ]
)
"""The block `solver`, std140; fields without a word here are those of `Reflector`, or arguments of functions below"""


@dataclass(frozen=True)
class Reflector:
    """What a solve knows of one reflector. Map frame: `world_to_map`'s, meters."""

    world_to_map: Float64Array
    """(4, 4) rigid"""
    bound: float
    """No point of it is farther from the origin of the map frame, meters"""
    textures: Mapping[str, Any] = field(default_factory=dict)
    """By the sampler names of the method's maps"""
    side: float = 1.0
    """1: it reflects on its outer side, seen from the star center; -1: on its inner side"""
    plane: Sequence[float] = (0.0, 0.0, 1.0, 0.0)
    """Unit normal n and offset d in the map frame, n . p = d"""
    map_to_search: Float64Array = field(default_factory=lambda: np.eye(4))
    """(4, 4) homogeneous point in the map frame to texels of the screen maps"""
    start: Sequence[float] = (0.0, 0.0)
    """Texel where a search on the screen maps begins"""
    is_convex: bool = False
    """Closed and convex: a line enters it once"""
    index: float = 1.0
    """Of refraction beyond the surface over that on the eye's side, for methods that refract"""


def solve_vertices(
    method: str,
    view: View,
    reflector: Reflector,
    positions: Any,
    count: int,
    steps: int = 0,
    tolerance: float = 0.05,
    previous: VertexSolution | None = None,
    at_rest: bool = False,
    first_rung: int = 0,
) -> VertexSolution:
    """Solve `count` records of the `positions` texture with a method that has a compute shader of its own.

    `steps` of the search, 0 for the method's own number; `tolerance` in pixels of `view`; `previous` is the solution of
    the same positions in the frame before, for methods that start from it. It is the result too where nothing has
    changed: `at_rest` says so of positions and maps. `first_rung` leaves starts of the clean-up pass out.
    """
    block = _vertices_block(method, view, reflector, count, steps, tolerance, first_rung)
    if at_rest and previous is not None and previous.inputs == _inputs(method, block):
        return previous
    solve = PreparedSolve(method, reflector, block, positions, count, previous)
    solve.run()
    return solve.solution


def prepare_solve(
    method: str,
    view: View,
    reflector: Reflector,
    positions: Any,
    count: int,
    tolerance: float = 0.05,
    previous: VertexSolution | None = None,
    steps: int = 0,
) -> PreparedSolve:
    """As `solve_vertices`, but nothing has been run yet."""
    block = _vertices_block(method, view, reflector, count, steps, tolerance)
    return PreparedSolve(method, reflector, block, positions, count, previous)


class PreparedSolve:
    """The dispatches of one solve: run again, for timing, they do the same again."""

    def __init__(
        self,
        method: str,
        reflector: Reflector,
        block: np.ndarray,
        positions: Any,
        count: int,
        previous: VertexSolution | None,
    ) -> None:
        """`block` of a solve without a last frame."""
        inputs = _inputs(method, block)
        block["has_last_frame"] = previous is not None
        block["is_same_view"] = previous is not None and previous.inputs == inputs
        self.solution = VertexSolution(empty_record_texture(count), empty_record_texture(count), count, inputs)
        """There once it has run"""
        self._method, self._entry, self._device = method, entry_of(method), features()
        self._images = self.solution.images
        self._marks = None
        if self._entry.stragglers and self._device.lists:
            self._images |= {"stragglers": empty_index_texture(count), "straggler_count": empty_index_texture(1)}
        elif self._entry.stragglers and not self._device.compute:
            self._marks = marks_for(self.solution.reflection_points)
        self._textures = {
            **reflector.textures,
            "positions": positions,
            "previous_points": positions if previous is None else previous.reflection_points,
            "previous_virtual": positions if previous is None else previous.virtual_positions,
        }
        # Bound by reference only: it has to outlive the dispatches.
        self._uniforms = uniform_block(block)

    def run(self) -> None:
        """Have the GPU do it; returns before it has."""
        self.run_first()
        if name := self._entry.stragglers:
            # A list is shared by as many invocations as there are.
            count = self.solution.count
            self._run(name, min(count, MOST_STRAGGLERS_AT_ONCE) if self._device.lists else count)

    def run_first(self) -> None:
        """The first of the two passes of a method that has two, else all."""
        if "straggler_count" in self._images:
            self._images["straggler_count"].clear(format="UINT", value=(0,))
        self._run(self._method, self.solution.count)

    @property
    def listed(self) -> tuple[Any, Any] | None:
        """Textures of the list that the first pass makes and of its length, if it makes one."""
        return (self._images["stragglers"], self._images["straggler_count"]) if "stragglers" in self._images else None

    def _run(self, name: str, count: int) -> None:
        solver = _solver_pass(name, self._method, self._entry, self._device)
        shader = solver.shader
        shader.bind()
        shader.uniform_block("solver", self._uniforms)
        for sampler in ("positions", *(sampler for _, sampler in _samplers(self._entry))):
            shader.uniform_sampler(sampler, self._textures[sampler])
        solver.run(self._images, count, marks=self._marks)


def solve_region(
    view: View,
    reflector: Reflector,
    regions: RegionTextures,
    region: int,
    positions: Any,
    count: int,
    tolerance: float = 0.05,
) -> VertexSolution:
    """Images of `count` records of `positions` in one region of a mirror that bends both ways; UNSOLVED is none."""
    block = _solver_block(view, reflector, count, REGION_STEPS, tolerance)
    block["region"] = region
    solution = VertexSolution(empty_record_texture(count), empty_record_texture(count), count)
    # Bound by reference only: it has to outlive the dispatch.
    uniforms = uniform_block(block)
    solver = _region_pass(features())
    shader = solver.shader
    shader.bind()
    shader.uniform_block("solver", uniforms)
    shader.uniform_sampler("positions", positions)
    shader.uniform_sampler("radial", reflector.textures["radial"])
    shader.uniform_sampler("region_masks", regions.masks)
    shader.uniform_sampler("region_seeds", regions.seeds)
    solver.run(solution.images, count)
    return solution


class RegionTextures:
    """Regions of one mirror on the GPU."""

    def __init__(self, regions: Regions) -> None:
        self.count = len(regions)
        masks = np.zeros((*regions.masks.shape, 4), np.float32)
        masks[..., 0] = regions.masks
        self.masks = cube_texture(masks, linear=False)
        seeds = np.zeros((regions.seeds.shape[0] * SEEDS, 4), np.float32)
        seeds[:, :3] = regions.seeds.reshape(-1, 3)
        self.seeds = record_texture(seeds)


def _inputs(method: str, block: np.ndarray) -> bytes:
    """See `VertexSolution`."""
    return method.encode() + block.tobytes()


def _vertices_block(
    method: str,
    view: View,
    reflector: Reflector,
    count: int,
    steps: int = 0,
    tolerance: float = 0.05,
    first_rung: int = 0,
) -> np.ndarray:
    """Of a solve by a method's own shader, without a last frame; see `solve_vertices`."""
    block = _solver_block(view, reflector, count, steps or entry_of(method).steps, tolerance)
    block["first_rung"] = first_rung
    return block


def _solver_block(view: View, reflector: Reflector, count: int, steps: int, tolerance: float) -> np.ndarray:
    """Of any solve, without what is special to one of them."""
    block = plain_block(count)
    block["world_to_map"] = reflector.world_to_map.T
    block["map_to_world"] = np.linalg.inv(reflector.world_to_map).T
    block["map_to_search"] = reflector.map_to_search.T
    block["eye"] = reflector.world_to_map @ view.eye
    block["plane"] = reflector.plane
    block["search_start"] = reflector.start
    block["focal_pixels"], block["tolerance"] = view.focal_pixels, tolerance
    block["bound"], block["side"], block["is_convex"] = reflector.bound, reflector.side, reflector.is_convex
    block["index"] = index_in_range(reflector.index)
    block["steps"], block["newton_steps"] = steps, NEWTON_STEPS
    return block


def plain_block(count: int) -> np.ndarray:
    """Of a solve of `count` vertices that asks nothing of eye and reflector; the map frame is the world."""
    block = np.zeros(1, _BLOCK)
    block["world_to_map"] = block["map_to_world"] = np.eye(4)
    block["count"] = count
    return block


def _samplers(entry: Method) -> list[tuple[str, str]]:
    return [pair for name in entry.maps for pair in SAMPLERS[name]]


_SOLVE = Piece(
    images={"reflection_points": Image(), "virtual_positions": Image()},
    blocks={"solver": Block("Solver", glsl_struct("Solver", _BLOCK))},
    defines={"LARGEST_COORDINATE": LARGEST_COORDINATE},
)
_SEEKING = replace(
    _SOLVE,
    images={**_SOLVE.images, "reflection_points": Image(is_read=True)},
    defines={**_SOLVE.defines, **flags("SEEKS_STRAGGLERS")},
)
_POSITIONS = Piece(samplers={"positions": "FLOAT_2D"})
_MAIN = Piece(compute="solver_pieces/solver_main.glsl")
_STRAGGLERS = Piece(
    images={
        "stragglers": Image("R32UI", "UINT_2D", is_read=True),
        "straggler_count": Image("R32UI", "UINT_2D_ATOMIC", is_read=True),
    }
)


def build_solver(name: str, label: str, device: Features, *pieces: Piece, around: Piece = _SOLVE) -> RecordPass:
    """The pass around `solve` of `gpu_shaders/solvers/<name>.comp.glsl`, which needs these pieces."""
    return build_record_pass(label, device, around, *pieces, Piece(compute=f"solvers/{name}.comp.glsl"), _MAIN)


@gpu_cache
def _solver_pass(name: str, method: str, entry: Method, device: Features) -> RecordPass:
    """Of `gpu_shaders/solvers/<name>.comp.glsl`, with what `method`, with this entry, gives its shaders."""
    pieces = [_POSITIONS, Piece(samplers={sampler: kind for kind, sampler in _samplers(entry)})]
    around, is_first = _SOLVE, name == method
    if entry.refracts:
        pieces.append(Piece(defines=flags("REFRACTS")))
    if entry.stragglers and device.lists:
        pieces += [_STRAGGLERS, Piece(defines=flags("LISTS_STRAGGLERS" if is_first else "TAKES_STRAGGLERS"))]
    elif entry.stragglers and is_first and not device.compute:
        pieces.append(MARKS)
    elif not is_first and device.compute:
        around = _SEEKING
    return build_solver(name, f"{name} of {method}", device, *pieces, around=around)


@gpu_cache
def _region_pass(device: Features) -> RecordPass:
    maps = Piece(samplers={**named("FLOAT_CUBE", "radial", "region_masks"), "region_seeds": "FLOAT_2D"})
    return build_solver("newton_region", "newton region", device, _POSITIONS, maps)
