# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex solve by bounding grids: corners are searched for, vertices interpolated (`bisector_grid`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...scene.arrays import Float32Array
from ..device.context import gpu_cache
from ..device.records import empty_record_texture, record_texture
from ..device.shaders import Piece, named, uniform_block
from ..device.ways.features import Features, features
from ..device.ways.record_pass import RecordPass
from ..geometry.chunk import Chunk
from .bounding_grid import BoundingGrid, bounding_grid
from .solution import VertexSolution
from .solve import build_solver, plain_block

_SAMPLERS = ("cells", "corner_numbers", "grid_points", "grid_virtual", "positions")


class ChunkGrid:
    """Bounding grids of all instances of a chunk."""

    def __init__(self, chunk: Chunk, share: float) -> None:
        """`share` of the vertices that are to be solved."""
        known: dict[int, BoundingGrid] = {}
        corners: list[Float32Array] = []
        numbers, cells = [], []
        corner_start = cell_start = 0
        for index, item in enumerate(chunk.placed):
            grid = known.setdefault(id(item.drawn), bounding_grid(item.drawn.positions, share))
            corners.append(np.column_stack([grid.corners, np.full(len(grid.corners), index, np.float32)]))
            numbers.append(grid.cell_corners + corner_start)
            cells.append(np.column_stack([grid.local, grid.vertex_cell + cell_start]))
            corner_start += len(grid.corners)
            cell_start += len(grid.cell_corners)
        self.corner_count = corner_start
        self._sources = record_texture(np.concatenate(corners).astype(np.float32))
        self._cells = record_texture(np.concatenate(cells).astype(np.float32))
        self._numbers = record_texture(np.concatenate(numbers).reshape(-1, 4).astype(np.float32))
        self._count = chunk.position_count

    def solve(self, chunk: Chunk, search: Callable[[Any, int], VertexSolution]) -> VertexSolution:
        """Where the chunk's vertices reflect; `search` solves so many records of a texture of positions."""
        corners = search(chunk.place_points(self._sources, self.corner_count), self.corner_count)
        solution = VertexSolution(empty_record_texture(self._count), empty_record_texture(self._count), self._count)
        # Bound by reference only: it has to outlive the dispatch.
        uniforms = uniform_block(plain_block(self._count))
        interpolation = _interpolation_pass(features())
        shader = interpolation.shader
        shader.bind()
        shader.uniform_block("solver", uniforms)
        textures = (
            self._cells,
            self._numbers,
            corners.reflection_points,
            corners.virtual_positions,
            chunk.positions,
        )
        for name, texture in zip(_SAMPLERS, textures, strict=True):
            shader.uniform_sampler(name, texture)
        interpolation.run(solution.images, self._count)
        return solution


@gpu_cache
def _interpolation_pass(device: Features) -> RecordPass:
    return build_solver("bisector_grid", "bisector grid", device, Piece(samplers=named("FLOAT_2D", *_SAMPLERS)))
