# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of what the solver found: every vertex that it counts, and the triangles that are left out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticOptions
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.batches import indexed_batch
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.vertices.solution import SolvedChunk, VertexSolution, statistics
from shading.mirror_ball import COLORS, EYE, VIEW, Ball, close_to, drawn

pytestmark = pytest.mark.usefixtures("gpu")


def solved_ball_points() -> tuple[np.ndarray, np.ndarray]:
    """Points of the ball that the eye sees, in a lattice, and a status for each."""
    place = np.stack(np.meshgrid(np.linspace(-0.6, 0.6, 7), np.linspace(-0.6, 0.6, 6)), -1).reshape(-1, 2)
    right, up = VIEW.world_to_view[0, :3], VIEW.world_to_view[1, :3]
    across = place[:, :1] * right + place[:, 1:] * up
    points = across + np.sqrt(1 - (across**2).sum(1))[:, None] * unit(EYE)
    codes = np.array([status.REFLECTED, status.HIDDEN, status.UNSOLVED, status.INVALID])
    return points, codes[np.arange(len(points)) * 7 % 4]


def solution_of(points: np.ndarray, code: np.ndarray) -> VertexSolution:
    """As the solver stores it: each vertex a meter from its point, and where it is itself if it was not found."""
    behind = points - unit(EYE - points)
    behind[code == status.UNSOLVED] = points[code == status.UNSOLVED] + [1.0, 0.0, 0.0]
    packed = code + 4 * 3
    return VertexSolution(
        record_texture(np.column_stack([points, packed])),
        record_texture(np.column_stack([behind, np.ones(len(points))])),
        len(points),
    )


def solved_chunk(points: np.ndarray, code: np.ndarray, triangles: np.ndarray) -> Any:
    corners = np.zeros((len(points), 2, 4), np.float32)
    corners[:, 0, 3] = np.arange(len(points))
    chunk: Any = SimpleNamespace(
        positions=record_texture(np.column_stack([points, np.ones(len(points))])),
        corners=record_texture(corners.reshape(-1, 4)),
    )
    batches = ((0, indexed_batch(triangles)),) if len(triangles) else ()
    return SolvedChunk(chunk, batches, solution_of(points, code))


def test_status_shows_every_vertex_that_the_statistics_count() -> None:
    ball = Ball()
    points, code = solved_ball_points()
    part = solved_chunk(points, code, np.zeros((0, 3), np.int32))
    nothing = ball.shows(ball.point, np.zeros(ball.mask.shape, bool))
    picture = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=6.0), parts=((part,),))
    pixels = np.floor(VIEW.project(points)).astype(int)
    there = picture[pixels[:, 1], pixels[:, 0]][None]
    found = {
        "reflected": int(close_to(there, COLORS.converged).sum()),
        "hidden": int(close_to(there, tuple(0.6 * np.array(COLORS.hidden))).sum()),
        "failed": int(close_to(there, COLORS.failed).sum()),
    }
    counts = statistics([part.solution])
    # A vertex that is no number has no place to be shown at.
    invalid = int((code == status.INVALID).sum())
    assert found == {
        "reflected": counts["reflected"],
        "hidden": counts["hidden"],
        "failed": counts["unconverged"] - invalid,
    }
    assert min(found.values()) > 5 and invalid > 5
    without = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=0.0), parts=((part,),))
    assert close_to(without, COLORS.background)[ball.mask].all()


def test_status_leaves_out_vertices_that_the_reflection_covers() -> None:
    ball = Ball()
    points, _ = solved_ball_points()
    part = solved_chunk(points, np.zeros(len(points), int), np.zeros((0, 3), np.int32))
    pixels = np.floor(VIEW.project(points)).astype(int)
    all_over = np.ones(ball.mask.shape, bool)
    for distance, visible in ((0.5, False), (1.5, True)):
        cover = ball.shows(ball.point + distance * ball.ray, all_over)
        picture = drawn(VIEW, ball.seen(), cover, "STATUS", DiagnosticOptions(point_size=6.0), parts=((part,),))
        there = close_to(picture, COLORS.converged)[pixels[:, 1], pixels[:, 0]]
        assert there.all() if visible else not there.any()


def test_status_hatches_triangles_that_are_left_out() -> None:
    ball = Ball()
    points, _ = solved_ball_points()
    code = np.zeros(len(points), int)
    triangles = np.array([[0, 2, 15], [3, 5, 18], [23, 25, 38]], np.int32)
    code[15] = code[3] = status.UNSOLVED
    code[18] = status.INVALID
    part = solved_chunk(points, code, triangles)
    nothing = ball.shows(ball.point, np.zeros(ball.mask.shape, bool))
    picture = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=0.0), parts=((part,),))
    failed = close_to(picture, COLORS.failed) | close_to(picture, tuple(0.35 * np.array(COLORS.failed)))
    x, y = np.floor(VIEW.project(points[triangles].mean(axis=1))).astype(int).T
    assert failed[y, x].tolist() == [True, False, False]
    assert 0 < failed.sum() < 0.15 * ball.mask.sum()
