# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report over frames as text for the terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...report.table import NO_NUMBER, aligned, number
from .summary import MEASURES


def headline(report: Mapping[str, Any]) -> str:
    """What was compared with what, in one line."""
    reference, frames = report["reference"], report["range"]
    width, height = report["resolution"]
    step = f" by {frames['step']}" if frames["step"] != 1 else ""
    return (
        f"{report['scene']}: {', '.join(report['reflectors'])}, {width} x {height}, frames {frames['first']} to "
        f"{frames['last']}{step}, against Cycles with {reference['samples']} samples of {reference['light']} light"
    )


def rows(report: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """A row for each method and peer: mean over frames, and the worst with its frame; after a row of titles."""
    found = [("", *(measure.label for measure in MEASURES.values()))]
    for group in ("methods", "peers"):
        for name, numbers in report[group].items():
            found.append((name, *(_cell(numbers.get(key), measure.decimals) for key, measure in MEASURES.items())))
    return found


def cut_sentences(report: Mapping[str, Any]) -> list[str]:
    """Where one frame does not follow the other, so that nothing is measured between them."""
    return [f"Cut before frame {cut['frame']}: {cut['why']}." for cut in report["cuts"]]


def format_sequence(report: Mapping[str, Any]) -> str:
    """As lines of text, columns aligned."""
    lines = [headline(report), "", *aligned(rows(report)), "(mean over frames; worst @ frame)", *cut_sentences(report)]
    lines += [f"Warning: {warning}" for warning in report.get("warnings", ())]
    return "\n".join(lines)


def _cell(numbers: Mapping[str, Any] | None, decimals: int) -> str:
    if numbers is None:
        return NO_NUMBER
    mean = number(numbers["mean"], decimals)
    # (Where all is zero no frame is the worst.)
    return f"{mean}; {number(numbers['worst'], decimals)} @ {numbers['worst_frame']}" if numbers["worst"] else mean
