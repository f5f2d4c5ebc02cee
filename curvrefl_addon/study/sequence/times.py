# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long each frame took, and which took much longer than the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

SLOW = 3.0
"""Times the median"""


def times_of(frames: Sequence[int], told: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """From the reports of frames, milliseconds by frame: of methods with their steps, of peers, of the reference; each
    with its median and the frames over SLOW times that, the slowest first."""
    methods = list(dict.fromkeys(name for report in told for name in report["methods"]))
    peers = list(dict.fromkeys(name for report in told for name in report["peers"]))
    return {
        "methods": {name: _of_method(frames, told, name) for name in methods},
        "peers": {
            name: _row({frame: report["peers"][name]["time_ms"] for frame, report in zip(frames, told, strict=True)})
            for name in peers
        },
        "reference": _row(
            {frame: 1e3 * report["reference"]["time_s"] for frame, report in zip(frames, told, strict=True)}
        ),
    }


def slow_sentences(times: Mapping[str, Any]) -> list[str]:
    """Of which methods which frames are slow, the slowest first; one where none is."""
    found = [
        f"{name}: {', '.join(map(str, row['slow_frames']))}"
        for name, row in times["methods"].items()
        if row["slow_frames"]
    ]
    over = f"over {SLOW:g} times the median"
    return [f"Frames {over}, {text}" for text in found] or [f"No frame of a method took {over}."]


def _of_method(frames: Sequence[int], told: Sequence[Mapping[str, Any]], name: str) -> dict[str, Any]:
    known = {
        frame: report["methods"][name]["time_ms"]
        for frame, report in zip(frames, told, strict=True)
        if name in report["methods"]
    }
    steps = list(dict.fromkeys(step for times in known.values() for step in times if step != "frame"))
    return _row({frame: times["frame"] for frame, times in known.items()}) | {
        "steps": {step: {str(frame): times.get(step) for frame, times in known.items()} for step in steps}
    }


def _row(times: Mapping[int, float]) -> dict[str, Any]:
    middle = median(times.values())
    slow = sorted((frame for frame, time in times.items() if time > SLOW * middle), key=lambda frame: -times[frame])
    return {"median": middle, "slow_frames": slow, "frames": {str(frame): time for frame, time in times.items()}}
