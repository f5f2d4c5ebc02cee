# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a chart of time against error shows: marks, the levels they are judged at, and their Pareto fronts."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...report.repeats import Timing, timing_columns

MOST_WRONG = 0.05
"""Share of pixels with a wrong object above which the 95th percentile of the angles says nothing"""


@dataclass(frozen=True, slots=True)
class VertexAccuracy:
    """Of one method with one setting. Shares are of all judged vertices, errors of those that both the method and the
    oracle call reflected: on screen, to the nearest true reflection point. None where there is no such vertex."""

    vertices: int
    judged: int
    ms_per_million: Timing
    """Solve of all reflectors, milliseconds per million vertices"""
    median_px: float | None
    p95_px: float | None
    p99_px: float | None
    max_px: float | None
    misclassified: float
    """Share shown though hidden, or called hidden though shown"""
    unconverged: float


@dataclass(frozen=True, slots=True)
class Mark:
    """One method, or one of Blender's engines, with one setting on one scene; None where there is no such number."""

    scene: str
    name: str
    """Of `METHODS`, or `eevee` or `cycles`"""
    setting: str = ""
    """The setting that is varied"""
    value: float | None = None
    is_default: bool = False
    is_peer: bool = False
    times: Mapping[str, Timing] = field(default_factory=dict)
    """By step: bake, solve, draw, and frame, the whole picture; of peers frame alone"""
    flip: float | None = None
    psnr: float | None = None
    angle_deg: tuple[float | None, float | None, float | None] = (None, None, None)
    """Of what a mirror's pixel shows: median, p95, p99"""
    wrong_object: float | None = None
    """Share of the mirrors' pixels"""
    vertices: VertexAccuracy | None = None
    reason: str = ""
    """Why it could not be measured"""

    @property
    def frame(self) -> Timing | None:
        """Of the whole picture."""
        return self.times.get("frame")


@dataclass(frozen=True, slots=True)
class Level:
    """One way to set time against error: a row of panels."""

    title: str
    error_label: str
    time_label: str
    smallest: float
    """Errors below are drawn here"""
    timing: Callable[[Mark], Timing | None]
    error: Callable[[Mark], float | None]
    may_lead: Callable[[Mark], bool] = lambda _mark: True
    """Whether a mark may be on the front"""


LEVELS: dict[str, Level] = {
    "image": Level(
        "Picture", "FLIP on the mirrors", "frame, ms", 1e-3, lambda mark: mark.frame, lambda mark: mark.flip
    ),
    "angle": Level(
        "What a pixel shows",
        "angle, 95th percentile, degrees",
        "frame, ms",
        1e-2,
        lambda mark: mark.frame,
        lambda mark: mark.angle_deg[1],
        # An object that is left out shows the background, which lies in just the right direction.
        lambda mark: mark.wrong_object is not None and mark.wrong_object <= MOST_WRONG,
    ),
    "object": Level(
        "What a pixel shows",
        "wrong object, % of the mirrors' pixels",
        "frame, ms",
        1e-2,
        lambda mark: mark.frame,
        lambda mark: None if mark.wrong_object is None else 100.0 * mark.wrong_object,
    ),
    "vertex": Level(
        "Vertices",
        "error, 95th percentile, pixels",
        "solve, ms per million vertices",
        1e-3,
        lambda mark: None if mark.vertices is None else mark.vertices.ms_per_million,
        lambda mark: None if mark.vertices is None else mark.vertices.p95_px,
    ),
}


def point(level: Level, mark: Mark) -> tuple[float, float] | None:
    """Time and error of a mark, where it has both."""
    timing, error = level.timing(mark), level.error(mark)
    return None if timing is None or error is None else (timing.median, error)


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the (time, error) that none of the others beats in one and at least equals in the other; by time.

    Of equal points the first.
    """
    front: list[int] = []
    for index in sorted(range(len(points)), key=lambda index: points[index]):
        if not front or points[index][1] < points[front[-1]][1]:
            front.append(index)
    return front


def front_marks(level: Level, marks: Iterable[Mark]) -> list[Mark]:
    """The marks of one scene that are on its front, by time."""
    placed = [(mark, where) for mark in marks if (where := point(level, mark)) is not None and level.may_lead(mark)]
    return [placed[index][0] for index in pareto_front([where for _, where in placed])]


def row(mark: Mark, fronts: Iterable[str] = ()) -> dict[str, Any]:
    """A mark as a row of chart.csv; `fronts`: names of the levels on whose front it is."""
    vertices = mark.vertices
    solve = None if vertices is None else vertices.ms_per_million
    on_front = set(fronts)
    return {
        "scene": mark.scene,
        "kind": "peer" if mark.is_peer else "method",
        "name": mark.name,
        "setting": mark.setting,
        "value": mark.value,
        "is_default": mark.is_default,
        **timing_columns("frame_ms", mark.frame),
        **{f"{name}_ms": mark.times[name].median if name in mark.times else None for name in ("bake", "solve", "draw")},
        "flip": mark.flip,
        "psnr_db": mark.psnr,
        **dict(zip(("angle_median_deg", "angle_p95_deg", "angle_p99_deg"), mark.angle_deg, strict=True)),
        "wrong_object": mark.wrong_object,
        **timing_columns("solve_ms_per_million", solve),
        "vertices": None if vertices is None else vertices.vertices,
        "judged_vertices": None if vertices is None else vertices.judged,
        "vertex_median_px": None if vertices is None else vertices.median_px,
        "vertex_p95_px": None if vertices is None else vertices.p95_px,
        "vertex_p99_px": None if vertices is None else vertices.p99_px,
        "vertex_max_px": None if vertices is None else vertices.max_px,
        "misclassified": None if vertices is None else vertices.misclassified,
        "unconverged": None if vertices is None else vertices.unconverged,
        **{f"{name}_front": name in on_front for name in LEVELS},
        "reason": mark.reason,
    }


def rows(marks: Sequence[Mark]) -> list[dict[str, Any]]:
    """All marks, of any number of scenes, with the fronts they are on; in the same order."""
    fronts: dict[int, list[str]] = {}
    for scene in dict.fromkeys(mark.scene for mark in marks):
        here = [mark for mark in marks if mark.scene == scene]
        for name, level in LEVELS.items():
            for mark in front_marks(level, here):
                fronts.setdefault(id(mark), []).append(name)
    return [row(mark, fronts.get(id(mark), ())) for mark in marks]


def write_csv(table: Sequence[dict[str, Any]], path: Path) -> None:
    """Rows of equal keys, at least one; an empty cell is no number."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(table[0]))
        writer.writeheader()
        writer.writerows(table)
