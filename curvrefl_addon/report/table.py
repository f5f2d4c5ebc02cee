# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A comparison as text for the terminal, and the numbers as people read them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NO_NUMBER = "-"

_COLUMNS = (
    "",
    "FLIP",
    "PSNR dB",
    "angle deg: median",
    "p95",
    "p99",
    "wrong object",
    "solve ms",
    "draw ms",
    "frame ms",
)


def number(value: float | None, decimals: int) -> str:
    """`value` with so many decimals; a dash for None."""
    return NO_NUMBER if value is None else f"{value:.{decimals}f}"


def decibels(psnr: float | None, flip: float | None) -> str:
    """PSNR is None in a report both for equal pictures and for none; FLIP tells which."""
    return "equal" if psnr is None and flip == 0.0 else number(psnr, 1)


def percent(share: float | None) -> str:
    return NO_NUMBER if share is None else f"{100.0 * share:.2f} %"


def milliseconds(value: float | None) -> str:
    """Three digits are enough to read a time."""
    if value is None:
        return NO_NUMBER
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def headline(report: dict[str, Any]) -> str:
    """What was compared with what, in one line."""
    reference = report["reference"]
    width, height = report["resolution"]
    return (
        f"{report['scene']}: {', '.join(report['reflectors'])}, {width} x {height}, {report['mask_pixels']} mirror "
        f"pixels, against Cycles with {reference['samples']} samples of {reference['light']} light "
        f"({reference['time_s']:.1f} s)"
    )


def rows(report: dict[str, Any]) -> list[tuple[str, ...]]:
    """One row of text per method and per peer, after a row of column titles."""
    table: list[tuple[str, ...]] = [_COLUMNS]
    for name, method in report["methods"].items():
        image, geometry, times = method["image"], method["geometry"], method["time_ms"]
        angle = geometry["angle_deg"]
        table.append(
            (
                name,
                number(image["flip"], 4),
                decibels(image["psnr"], image["flip"]),
                number(angle["median"], 3),
                number(angle["p95"], 2),
                number(angle["p99"], 2),
                percent(geometry["wrong_object"]),
                milliseconds(times["solve"]),
                milliseconds(times["draw"]),
                milliseconds(times["frame"]),
            )
        )
    for name, peer in report["peers"].items():
        image = peer["image"]
        gaps = (NO_NUMBER,) * 6
        table.append(
            (
                name,
                number(image["flip"], 4),
                decibels(image["psnr"], image["flip"]),
                *gaps,
                milliseconds(peer["time_ms"]),
            )
        )
    return table


def format_table(report: dict[str, Any]) -> str:
    """The report of `compare` as lines of text, columns aligned."""
    lines = [headline(report), "", *aligned(rows(report))]
    lines += [f"Warning: {warning}" for warning in report.get("warnings", ())]
    return "\n".join(lines)


def aligned(table: Sequence[tuple[str, ...]]) -> list[str]:
    """Lines of cells, the first column to the left."""
    widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
    lines = []
    for row in table:
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        lines.append("  ".join(cells).rstrip())
    return lines
