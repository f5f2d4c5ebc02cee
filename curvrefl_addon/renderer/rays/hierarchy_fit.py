# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits the hierarchy of a mesh that deforms where it is: on the GPU, in the records that rays walk through.

The tree stays; a pass over its leaves makes triangles' records and leaves' boxes of the mesh's positions, which are all
that is uploaded, and a pass over each level, from below, the boxes of the nodes. The numbers are those that
`Hierarchy.fitted` finds. Trees get worse as a mesh gets another shape: what a tree costs is added up every few frames,
and read when the next one is fitted, as the GPU has long found it then.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import MeshArrays
from ..device.context import gpu_cache
from ..device.record_regions import RecordRegions
from ..device.records import empty_record_texture, read_records, record_texture
from ..device.shaders import Image, Piece, build_shader, dispatch, flags
from ..device.ways.features import features
from ..geometry.mesh_pieces import is_count
from ..geometry.vertex_uploads import VertexUploads
from .hierarchy import Hierarchy
from .ray_records import NODE_RECORDS, TRIANGLE_RECORDS

LARGEST_NUMBER = 1 << 24
"""Single precision holds whole numbers up to here"""
JUDGED = 8
"""A tree's cost is found each time that it has been fitted so often"""
SUMS = 256
"""Parts of the sum"""
_GROUP = 64


class HierarchyFit:
    """Of one tree over a mesh, which is on the GPU."""

    def __init__(self, hierarchy: Hierarchy, mesh: MeshArrays) -> None:
        inner = np.flatnonzero(hierarchy.count == 0)
        leaves = np.flatnonzero(hierarchy.count > 0)
        # (A root that is a leaf has its box in a node above it.)
        box = np.zeros(len(hierarchy.link), np.int64)
        for child in range(2):
            box[hierarchy.link[inner] + child] = NODE_RECORDS * np.arange(len(inner)) + 2 * child
        records = np.zeros((len(leaves), 4), np.float32)
        records[:, 0], records[:, 1], records[:, 2] = hierarchy.link[leaves], hierarchy.count[leaves], box[leaves]
        self._leaves = record_texture(records)
        self._leaf_count, self._node_count = len(leaves), len(inner)
        self._levels = _levels_to_fit(hierarchy, inner)
        self._corners_are_vertices = is_count(mesh.corner_vertex)
        self._fitted = 0
        self._sums: Any = None

    @staticmethod
    def serves(hierarchy: Hierarchy, mesh: MeshArrays) -> bool:
        """Whether the device fits trees, and records of so large a one hold the numbers that this takes."""
        if not (features().compute and features().fits):
            return False
        numbers = (NODE_RECORDS * len(hierarchy.link), len(hierarchy.order), len(mesh.corner_vertex))
        return max(*numbers, len(mesh.positions)) < LARGEST_NUMBER

    def fit(
        self,
        regions: RecordRegions,
        starts: Sequence[int],
        before: MeshArrays,
        mesh: MeshArrays,
        uploads: VertexUploads,
    ) -> None:
        """Boxes, triangles and normals of `mesh`, which is the mesh `before` with its vertices elsewhere; `starts`:
        first records of its nodes, triangles and corners."""
        nodes, triangles, corners = starts[:3]
        shader = _leaves_shader(self._corners_are_vertices)
        shader.bind()
        shader.uniform_sampler("leaves", self._leaves)
        shader.uniform_sampler("mesh_positions", uploads.texture(mesh.positions))
        shader.image("rays", regions.texture)
        shader.uniform_int("regions", (nodes, triangles, corners, self._leaf_count))
        dispatch(shader, self._leaf_count, _GROUP)
        if self._levels:
            shader = _nodes_shader()
            shader.bind()
            shader.image("rays", regions.texture)
            for first, count in self._levels:
                shader.uniform_int("nodes", (nodes, first, count, 0))
                dispatch(shader, count, _GROUP)
        if mesh.corner_normals is not before.corner_normals:
            shader = _corners_shader()
            shader.bind()
            shader.uniform_sampler("mesh_normals", uploads.texture(mesh.corner_normals))
            shader.image("rays", regions.texture)
            shader.uniform_int("corners", (corners, len(mesh.corner_normals)))
            dispatch(shader, len(mesh.corner_normals), _GROUP)
        if self._node_count and self._fitted % JUDGED == 0:
            self._add_up(regions, nodes)
        self._fitted += 1

    def _add_up(self, regions: RecordRegions, nodes: int) -> None:
        self._sums = empty_record_texture(SUMS)
        shader = _cost_shader()
        shader.bind()
        shader.uniform_sampler("rays", regions.texture)
        shader.image("sums", self._sums)
        shader.uniform_int("nodes", (nodes, self._node_count))
        dispatch(shader, SUMS, _GROUP)

    @property
    def is_judged(self) -> bool:
        """Whether there is a `cost` to be read."""
        return self._sums is not None

    def cost(self) -> float:
        """`Hierarchy.cost` of the tree as it was when it `is_judged`; read once."""
        assert self._sums is not None
        sums = read_records(self._sums, SUMS).astype(np.float64)
        self._sums = None
        return float(2.0 + sums[:, 0].sum() / max(sums[0, 3], 1e-30))


def _levels_to_fit(hierarchy: Hierarchy, inner: NDArray[np.int64]) -> list[tuple[int, int]]:
    """(first node, how many) of levels with nodes above nodes, from below; nodes are counted without leaves."""
    firsts = np.searchsorted(inner, hierarchy.levels)
    is_above = hierarchy.count[hierarchy.link[inner]] == 0
    is_above |= hierarchy.count[hierarchy.link[inner] + 1] == 0
    pairs = zip(firsts[:-1].tolist(), firsts[1:].tolist(), strict=True)
    return [(first, end - first) for first, end in pairs if is_above[first:end].any()][::-1]


_FITTED = Piece(
    images={"rays": Image(is_read=True)},
    defines={"NODE_RECORDS": NODE_RECORDS, "TRIANGLE_RECORDS": TRIANGLE_RECORDS},
    group=_GROUP,
)


@gpu_cache
def _leaves_shader(corners_are_vertices: bool) -> Any:
    samplers = {"leaves": "FLOAT_2D", "mesh_positions": "FLOAT_2D"}
    return build_shader(
        "fit leaves",
        _FITTED,
        Piece(
            samplers=samplers,
            constants={"regions": "IVEC4"},
            defines=flags(*(["CORNERS_ARE_VERTICES"] if corners_are_vertices else [])),
            compute="rays/fit_leaves.comp.glsl",
        ),
    )


@gpu_cache
def _nodes_shader() -> Any:
    return build_shader("fit nodes", _FITTED, Piece(constants={"nodes": "IVEC4"}, compute="rays/fit_nodes.comp.glsl"))


@gpu_cache
def _corners_shader() -> Any:
    return build_shader(
        "fit corners",
        _FITTED,
        Piece(
            samplers={"mesh_normals": "FLOAT_2D"},
            constants={"corners": "IVEC2"},
            compute="rays/fit_corners.comp.glsl",
        ),
    )


@gpu_cache
def _cost_shader() -> Any:
    return build_shader(
        "tree cost",
        Piece(
            samplers={"rays": "FLOAT_2D"},
            images={"sums": Image()},
            constants={"nodes": "IVEC2"},
            defines={"NODE_RECORDS": NODE_RECORDS, "SUMS": SUMS},
            group=_GROUP,
            compute="rays/tree_cost.comp.glsl",
        ),
    )
