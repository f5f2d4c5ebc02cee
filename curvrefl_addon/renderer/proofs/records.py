# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over records: placing and copying, and the list that the first pass of a solve leaves to the second."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ...optics import status
from ...scene.arrays import Float32Array, InstanceArrays
from ..device.record_regions import RecordRegions
from ..device.records import TEXTURE_WIDTH, read_records, record_texture
from ..device.shaders import compiled
from ..device.textures import read_texture
from ..geometry.chunk import Chunk, Placed
from ..geometry.vertex_uploads import VertexUploads
from ..vertices.solve import prepare_solve
from .cases import EYE, ball, records_of, vertices_around, view_of_origin
from .proof import Found, Work
from .searches import CASES, PIXELS
from .walk import deformed

MOST_OFF = 1e-5
"""Of a placed vertex, in parts of its distance from the origin"""
LISTED = 3000
"""Vertices that may be put into a list: groups on all processors of a GPU add to it at once"""


def prove_records() -> Work:
    """Vertices placed, one instance moved by itself and deformed, and records copied to where others were."""
    mesh = ball(16)
    meshes = mesh, deformed(mesh)
    matrices = [
        np.eye(4),
        np.array([[0.0, -2.0, 0.0, 1.0], [1.0, 0.0, 0.5, 2.0], [0.0, 0.3, 1.0, -3.0], [0, 0, 0, 1.0]]),
    ]
    placed = [
        Placed(InstanceArrays("", 7 + k, 0, matrix, (0,)), mesh, mesh, np.zeros(len(mesh.triangles), np.int8), mirror=k)
        for k, matrix in enumerate(matrices)
    ]

    def place() -> Chunk:
        chunk = Chunk([placed[0], placed[0]])
        chunk.move({1: placed[1]})
        chunk.deform({1: replace(placed[1], mesh=meshes[1], drawn=meshes[1])}, VertexUploads())
        return chunk

    chunk = yield from compiled(place)
    yield
    count = len(mesh.positions)
    positions = read_records(chunk.positions, 2 * count).astype(np.float64).reshape(2, count, 4)
    corners = read_records(chunk.corners, 4 * count).astype(np.float64).reshape(2, count, 2, 4)
    yield
    off = 0.0
    for k, matrix in enumerate(matrices):
        world = meshes[k].positions @ matrix[:3, :3].T + matrix[:3, 3]
        normals = meshes[k].corner_normals @ np.linalg.inv(matrix[:3, :3])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        size = np.linalg.norm(world, axis=1).max()
        off = max(off, float(np.abs(positions[k, :, :3] - world).max() / size))
        off = max(off, float(np.abs(corners[k, :, 0, :3] - normals).max()))
        is_named = (positions[k, :, 3] == 7 + k).all() and (corners[k, :, 1, 3] == k).all()
        off = off if is_named else np.inf
    copied = yield from _copied()
    return Found(off if copied else np.inf, MOST_OFF, "of their distance")


def _copied() -> Generator[None, None, bool]:
    """Whether regions of a texture that has grown hold what was put there."""
    numbers = np.arange(4 * 5 * TEXTURE_WIDTH, dtype=np.float32).reshape(-1, 4)
    parts: list[Float32Array] = [numbers[:100], numbers[100 : 3 * TEXTURE_WIDTH], numbers[3 * TEXTURE_WIDTH :]]
    regions = RecordRegions()
    starts = regions.put(parts[:2])
    regions.replace(starts[0], parts[2][:50])
    starts += regions.put(parts[2:])
    yield
    held = read_records(regions.texture, regions.texture.height * TEXTURE_WIDTH)
    expected = [np.concatenate([parts[2][:50], parts[0][50:]]), *parts[1:]]
    return all(
        np.array_equal(held[start : start + len(part)], part) for start, part in zip(starts, expected, strict=True)
    )


def prove_list() -> Work:
    """That the list holds each vertex which the first pass has not settled once, and no other."""
    case = CASES["newton"]
    vertices = vertices_around(case.surface, LISTED)
    positions = record_texture(records_of(vertices))
    solve = prepare_solve("newton", view_of_origin(EYE, *PIXELS), case.reflector, positions, LISTED, steps=1)
    solve.run_first()
    yield
    if solve.listed is None:
        # It goes by another way already, which the proof of the method itself judges.
        return Found(0.0, 0.0, "entries")
    listed, length = solve.listed
    count = int(read_texture(length, 1)[0, 0, 0])
    numbers = read_texture(listed, 1).ravel()[: min(count, LISTED)].astype(np.int64)
    left = np.flatnonzero(solve.solution.read()[1] == status.UNSOLVED)
    wrong = len(np.setxor1d(numbers, left)) + abs(count - len(left))
    return Found(float(wrong) if len(left) else np.inf, 0.0, "entries")
