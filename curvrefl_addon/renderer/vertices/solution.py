# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a vertex solve gives: its record textures, and the parts of a scenery that have them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...optics import status
from ...scene.arrays import Int32Array
from ..device.frame_buffers import frame_buffer, wait_for
from ..device.records import read_records
from ..geometry.chunk import Batches, Chunk
from ..geometry.chunk_attributes import CornerAttributes


@dataclass(frozen=True)
class VertexSolution:
    """Record textures of one solve (see `solver.glsl`); world space."""

    reflection_points: Any
    """Per position: P xyz, status + 4 iterations"""
    virtual_positions: Any
    """Per position: where the vertex seems to be, and |PV|"""
    count: int
    inputs: bytes = b""
    """All that it was solved from beside positions and maps"""

    @property
    def images(self) -> dict[str, Any]:
        """By the names that solvers have for them."""
        return {"reflection_points": self.reflection_points, "virtual_positions": self.virtual_positions}

    def read(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """P (n, 3), status (n,), iterations (n,), virtual positions with |PV| (n, 4); waits for the GPU."""
        points = read_records(self.reflection_points, self.count)
        packed = np.rint(points[:, 3]).astype(np.int32)
        return points[:, :3], packed & 3, packed >> 2, read_records(self.virtual_positions, self.count)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        wait_for(frame_buffer(self.reflection_points))


@dataclass(frozen=True)
class Pieces:
    """Parts of triangles as record textures, laid out as those of a `Chunk`."""

    positions: Any
    corners: Any
    triangles: Int32Array
    """(n, 3) index into corners"""
    corner_position: Int32Array
    """(corners,) index into positions"""
    placed_chunk: Chunk
    """That they are of"""
    make_attributes: Callable[[], CornerAttributes]

    @cached_property
    def attributes(self) -> CornerAttributes:
        """What programs read at its corners; the instances are those of the chunk that it is of."""
        return self.make_attributes()


@dataclass(frozen=True)
class SolvedChunk:
    """A part of a mirror's scenery with its reflection points."""

    chunk: Chunk | Pieces
    """Whose triangles `batches` index; pieces are of triangles that had an edge split (`curved_edges`)"""
    batches: Batches
    solution: VertexSolution
    image: int = 0
    """0 for the image that every vertex has, or that says why not; 1, 2, ... for one in a region of the mirror"""
    whole: NDArray[np.bool_] | None = None
    """(triangles of the chunk,) which are in `batches`, the others' parts are pieces; None: all"""

    @property
    def places(self) -> Int32Array:
        """(n, 3) the triangles that `batches` draw, index into positions."""
        places = self.chunk.corner_position[self.chunk.triangles]
        return places if self.whole is None else places[self.whole]


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
