# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report over frames, made of the folders of compared frames alone: the same bytes whoever compared them, in
whatever order. So times, which are others each time, are in files of their own.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...output import folder_to_publish
from ..charts.chart_draw import has_matplotlib
from .curves import draw_curves, draw_times
from .flicker import flicker, flicker_numbers, follow, holes, pops
from .kept import (
    PAGE,
    REFERENCE,
    REPORT,
    KeptFrame,
    differences,
    folder_of,
    frames_in,
    load_kept,
    made_of,
)
from .page import sequence_page
from .sheet import draw_sheet
from .summary import noise_warnings, reference_noise, rounded, summary, worst_frames
from .text import headline
from .times import times_of

FEWEST_FOLLOWED = 0.05
"""Share of the mirrors' pixels below which a frame shows something else than the one before: a cut"""
TIMES = "times.json"


def merge_frames(folder: Path, frames: range | None = None) -> dict[str, Any]:
    """Write the report over `frames` that are compared in `folder`, or over all that are there, from the first to the
    last; returns it.

    Raises InputError for frames that are missing, not whole, or made otherwise than the others, and for a folder that
    cannot be written.
    """
    asked = _whole_frames(folder, frames)
    told = [json.loads((folder_of(folder, frame) / REPORT).read_text(encoding="utf-8")) for frame in asked]
    entries = list(_measured(folder, asked, told))
    report = _report(asked, told, entries, made_of(folder_of(folder, asked[0])) or {})
    times = times_of(asked, told)
    with folder_to_publish(folder) as part:
        if has_matplotlib():
            draw_curves(report, part / "curves")
            draw_sheet(report, folder, part / "contact_sheet.png")
            draw_times(times, headline(report), part / "times")
        _write_json(part / TIMES, times)
        (part / PAGE).write_text(sequence_page(report, has_matplotlib()), encoding="utf-8")
        _write_json(part / REPORT, report)
    return report


def _whole_frames(folder: Path, frames: range | None) -> range:
    """Those that are asked for, or those there are by the step that they were made with."""
    if not folder.is_dir():
        raise InputError(f'There is no folder "{folder}": name the output of a comparison over frames.')
    there = {frame: made for frame in frames_in(folder) if (made := made_of(folder_of(folder, frame))) is not None}
    if not there:
        raise InputError(f'No frame is compared in "{folder}": name the output of `compare --frames`.')
    step = next(iter(there.values()))["step"]
    asked = range(min(there), max(there) + 1, step) if frames is None else frames
    if missing := [frame for frame in asked if frame not in there]:
        which = f"Frame {missing[0]} is" if len(missing) == 1 else f"Frames {numbers_of(missing)} are"
        raise InputError(f'{which} missing in "{folder}": compare what is left with --resume first.')
    first = there[asked[0]]
    if len(asked) > 1 and asked.step != first["step"]:
        raise InputError(
            f"The frames were compared for a step of {first['step']}, not of {asked.step}: merge them by that step."
        )
    for frame in asked:
        if other := differences(first, there[frame]):
            raise InputError(
                f"Frames {asked[0]} and {frame} were made with different {', '.join(other)}: compare all alike first."
            )
    return asked


def _measured(folder: Path, frames: range, told: Sequence[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """The entries of the report, frame by frame; two frames are in memory at a time."""
    before: KeptFrame | None = None
    for frame, report in zip(frames, told, strict=True):
        now = load_kept(folder_of(folder, frame))
        yield _entry(now, before, report)
        before = now


def _entry(now: KeptFrame, before: KeptFrame | None, report: Mapping[str, Any]) -> dict[str, Any]:
    followed = follow(now, before) if before is not None else None
    pixels = int(np.count_nonzero(now.mask))
    share = len(followed.pixel) / pixels if followed is not None and pixels else None
    cut = _cut(now, before, share)
    entry: dict[str, Any] = {
        "frame": now.frame,
        "camera": now.camera,
        "mask_pixels": pixels,
        "followed": rounded(share),
    }
    if cut:
        entry["cut"] = cut
    methods: dict[str, Any] = {}
    peers: dict[str, Any] = {}
    for name in (*report["methods"], *report["peers"]):
        is_method = name in report["methods"]
        source = report["methods" if is_method else "peers"][name]
        known: dict[str, Any] = {"image": source["image"]}
        flickers = pop = None
        if before is not None and followed is not None and not cut and name in before.pictures:
            flickers = flicker_numbers(flicker(now, before, followed, name))
            pop = pops(now, before, followed, name) if is_method and name in before.shown else None
        if is_method:
            known |= {"geometry": source["geometry"], "holes": holes(now, name)}
            known["pop"] = pop and {"largest": rounded(pop.largest), "p99": rounded(pop.p99), "pixel": list(pop.pixel)}
            if "choice" in source:
                known["choice"] = source["choice"]["method"]
        known["flicker"] = flickers and {key: rounded(value) for key, value in flickers.items()}
        (methods if is_method else peers)[name] = known
    entry |= {"methods": methods, "peers": peers}
    if warnings := report.get("warnings"):
        entry["warnings"] = warnings
    return entry


def _cut(now: KeptFrame, before: KeptFrame | None, share: float | None) -> str:
    """Why a frame does not follow the one before; empty where it does, or where there is none."""
    if before is None:
        return ""
    if now.camera != before.camera:
        return f'the camera is "{now.camera}" after "{before.camera}"'
    if now.before["reason"]:
        return f"frame {now.before['frame']} could not be read for it ({now.before['reason'].rstrip('.')})"
    if share is not None and share < FEWEST_FOLLOWED:
        return f"{100.0 * share:.1f} % of the mirrors' pixels show what they showed before"
    return ""


def _report(
    frames: range, told: Sequence[Mapping[str, Any]], entries: Sequence[Mapping[str, Any]], made: Mapping[str, Any]
) -> dict[str, Any]:
    first = told[0]
    samples = first[REFERENCE]["samples"]
    noise = reference_noise(entries, samples)
    report = {
        "scene": first["scene"],
        "reflectors": first["reflectors"],
        "resolution": first["resolution"],
        "blender": first["blender"],
        "gpu": sorted({report["gpu"] for report in told}),
        "made": made,
        REFERENCE: {name: value for name, value in first[REFERENCE].items() if name != "time_s"}
        | {"flicker_rms": rounded(noise)},
        "range": {"first": frames[0], "last": frames[-1], "step": made["step"], "count": len(frames)},
        "cuts": [{"frame": entry["frame"], "why": entry["cut"]} for entry in entries if "cut" in entry],
        "methods": summary(entries, "methods"),
        "peers": summary(entries, "peers"),
        "worst": worst_frames(entries),
        "frames": list(entries),
    }
    if warnings := [*_warnings(entries), *noise_warnings(entries, noise, samples)]:
        report["warnings"] = warnings
    return report


def _warnings(entries: Sequence[Mapping[str, Any]]) -> list[str]:
    """Each sentence once, with the frames that it is of where those are not all."""
    found: dict[str, list[int]] = {}
    for entry in entries:
        for warning in entry.get("warnings", ()):
            found.setdefault(warning, []).append(entry["frame"])
    return [text if len(frames) == len(entries) else f"{_named(frames)}: {text}" for text, frames in found.items()]


def _named(frames: Sequence[int]) -> str:
    return f"Frame {frames[0]}" if len(frames) == 1 else f"Frames {numbers_of(frames)}"


def numbers_of(frames: Sequence[int]) -> str:
    """Ascending numbers as `1 to 3, 7`."""
    runs: list[list[int]] = []
    for frame in frames:
        if runs and frame == runs[-1][-1] + 1:
            runs[-1].append(frame)
        else:
            runs.append([frame])
    texts = [f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs]
    return ", ".join(texts)


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
