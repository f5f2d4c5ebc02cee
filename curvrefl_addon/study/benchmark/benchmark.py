# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the device does per second: vertex solves and, apart from them, draws of what was solved; mirror rays. Before
that, whether it does the right thing."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ...output import folder_to_publish
from ...renderer.device.context import platform_facts
from ...renderer.proofs.proving import prove_all
from ...renderer.proofs.report import summary
from ...renderer.proofs.verdict import take_verdict
from ...report.table import NO_NUMBER, aligned, number
from .rays import measure_rays
from .solves import STATES, measure_solves

VERTEX_COUNTS = (10_000, 100_000, 1_000_000, 10_000_000)
TRIANGLE_COUNTS = (1_000, 10_000, 125_000, 500_000, 2_000_000)


@dataclass(frozen=True, slots=True)
class Limits:
    """Of the device, as its maker states them; None where the user did not say."""

    bandwidth: float | None = None
    """Of its memory, GB/s"""
    flops: float | None = None
    """In float32, TFLOP/s"""

    def share(self, bytes_each: float, operations_each: float, per_second: float) -> dict[str, float | None]:
        """Parts of the limits that so much work takes, were every byte to come from memory."""
        return {
            "of_bandwidth": None if self.bandwidth is None else 1e-9 * bytes_each * per_second / self.bandwidth,
            "of_flops": None if self.flops is None else 1e-12 * operations_each * per_second / self.flops,
        }


def measure_benchmark(
    vertices: int, triangles: int, limits: Limits, folder: Path, say: Callable[[str], None]
) -> dict[str, Any]:
    """Everything up to so many vertices and triangles.

    benchmark.json and benchmark.txt in `folder` are written anew with each row, so that a run that is stopped leaves
    what it has.
    """
    proving = prove_all()
    take_verdict(proving.verdict)
    say(f"{summary(proving.verdict)}.")
    report: dict[str, Any] = {"device": platform_facts(), "limits": asdict(limits), "proofs": proving.found}
    report |= {"failures": proving.verdict.as_json()["failures"], "solves": [], "rays": []}
    solves = measure_solves(_up_to(VERTEX_COUNTS, vertices), say)
    rays = measure_rays(_up_to(TRIANGLE_COUNTS, triangles), say)
    for name, rows, states in (("solves", solves, STATES), ("rays", rays, ("quick", "best"))):
        for row in rows:
            for state in states:
                rate = row.get(f"{state}_{name}_per_second")
                if rate is not None:
                    shares = limits.share(row[f"{state}_bytes"], row[f"{state}_operations"], rate)
                    row |= {f"{state}_{share}": value for share, value in shares.items()}
            report[name].append(row)
            with folder_to_publish(folder) as part:
                (part / "benchmark.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
                (part / "benchmark.txt").write_text(format_benchmark(report) + "\n", encoding="utf-8")
    return report


def format_benchmark(report: dict[str, Any]) -> str:
    """As lines of text."""
    device = report["device"]
    lines = [f"{device['renderer']} ({device['vendor']}), {device['version']}, {device['backend']}", ""]
    for name, failure in report["failures"].items():
        lines += [f"Not right: {name}, {failure['words']}; now: {report['proofs'][name]}.", ""]
    table: list[tuple[str, ...]] = [_SOLVE_TITLES]
    for row in report["solves"]:
        for state in STATES:
            if row["left_out"] or row[f"{state}_ms"] is None:
                continue
            table.append((*_solve_cells(row, state), *_share_cells(row, state)))
    lines += [*aligned(table), ""]
    table = [_RAY_TITLES]
    for row in report["rays"]:
        for state in ("quick", "best"):
            if not row["left_out"]:
                table.append((*_ray_cells(row, state), *_share_cells(row, state)))
    lines += [*aligned(table), ""]
    lines += [f"Left out: {_what(row)}: {row['left_out']}." for row in _all(report) if row["left_out"]]
    lines += [
        "Times are medians, with quartiles; of each in the mean of as many as were asked for at once, between two",
        f"waits for the device. {_waits(report)}",
        "Submit is the processor's share: where it is nearly all, the device was idle (or is a program, as llvmpipe).",
        "Bytes and operations are counted in the shaders, texels of 16 bytes.",
    ]
    return "\n".join(lines)


_WORK_TITLES = ("bytes", "operations", "of bandwidth", "of flops")
_SOLVE_TITLES: tuple[str, ...] = (
    "vertices",
    "method",
    "start",
    "solve ms",
    "",
    "at once",
    "submit ms",
    "M/s",
    "iterations",
    "draw ms",
    *_WORK_TITLES,
)
_RAY_TITLES: tuple[str, ...] = (
    "triangles",
    "hierarchy",
    "walk ms",
    "",
    "at once",
    "submit ms",
    "M rays/s",
    "nodes",
    "triangles tested",
    *_WORK_TITLES,
)


def _solve_cells(row: dict[str, Any], state: str) -> tuple[str, ...]:
    return (
        f"{row['solved']:,}",
        row["method"],
        state,
        *_time_cells(row, state),
        number(1e-6 * row[f"{state}_solves_per_second"], 2),
        number(row[f"{state}_iterations"], 2),
        _ms(row["draw_ms"]),
    )


def _ray_cells(row: dict[str, Any], state: str) -> tuple[str, ...]:
    return (
        f"{row['in_scene']:,}",
        state,
        *_time_cells(row, state),
        number(1e-6 * row[f"{state}_rays_per_second"], 2),
        number(row[f"{state}_nodes"], 1),
        number(row[f"{state}_tested"], 1),
    )


def _time_cells(row: dict[str, Any], state: str) -> tuple[str, ...]:
    name = f"{state}_ms"
    return (
        _ms(row[name]),
        f"{_ms(row[f'{name}_q1'])}..{_ms(row[f'{name}_q3'])}",
        str(row[f"{state}_at_once"]),
        _ms(row[f"{state}_submit_ms"]),
    )


def _ms(value: float) -> str:
    """Three digits, of whatever size."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _waits(report: dict[str, Any]) -> str:
    """What a wait for nothing takes."""
    times = [row["empty_wait_ms"] for row in _all(report) if not row["left_out"]]
    return f"A wait for nothing takes {_ms(min(times))} to {_ms(max(times))} ms." if times else ""


def _share_cells(row: dict[str, Any], state: str) -> tuple[str, ...]:
    shares = (row[f"{state}_of_bandwidth"], row[f"{state}_of_flops"])
    return (
        number(row[f"{state}_bytes"], 0),
        number(row[f"{state}_operations"], 0),
        *(NO_NUMBER if share is None else f"{100.0 * share:.2g} %" for share in shares),
    )


def _all(report: dict[str, Any]) -> list[dict[str, Any]]:
    return [*report["solves"], *report["rays"]]


def _what(row: dict[str, Any]) -> str:
    if "vertices" in row:
        return f"{row['method']} with {row['vertices']:,} vertices"
    return f"exact with {row['triangles']:,} triangles"


def _up_to(counts: tuple[int, ...], most: int) -> tuple[int, ...]:
    """Those below `most`, and `most` itself."""
    return (*(count for count in counts if count < most), most)
