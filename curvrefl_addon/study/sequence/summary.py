# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers over frames: the mean, the median and the worst frame of each measure, and the frames to look at first."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

MOST_NOISE = 0.25
"""Share of a flicker that may be the reference's own noise"""
MOST_WORST = 5
"""Frames that are named for a measure"""
DIGITS = 6


@dataclass(frozen=True, slots=True)
class Measure:
    """One number of a method or peer in a frame."""

    label: str
    read: Callable[[Mapping[str, Any]], float | None]
    """From the entry of a method or peer; None where there is no such number"""
    decimals: int
    is_better_high: bool = False
    of_peers: bool = True


MEASURES: dict[str, Measure] = {
    "flip": Measure("FLIP", lambda entry: entry["image"]["flip"], 4),
    "psnr": Measure("PSNR, dB", lambda entry: entry["image"]["psnr"], 1, is_better_high=True),
    "flicker": Measure("Flicker", lambda entry: _inside(entry["flicker"], "mean"), 5),
    "flicker_p99": Measure("Flicker, p99", lambda entry: _inside(entry["flicker"], "p99"), 4),
    "pop": Measure("Pop, pixels", lambda entry: _inside(entry["pop"], "largest"), 3, of_peers=False),
    "angle_p95": Measure("Angle, p95, degrees", lambda entry: entry["geometry"]["angle_deg"]["p95"], 3, of_peers=False),
    "wrong_object": Measure("Wrong object", lambda entry: entry["geometry"]["wrong_object"], 4, of_peers=False),
    "holes": Measure("Holes, pixels", lambda entry: entry["holes"], 0, of_peers=False),
}


def values_of(entries: Sequence[Mapping[str, Any]], group: str, name: str, measure: str) -> list[float | None]:
    """Frame by frame, of a method or peer; None where there is no number."""
    read = MEASURES[measure].read
    return [None if name not in entry[group] else read(entry[group][name]) for entry in entries]


def names_of(entries: Sequence[Mapping[str, Any]], group: str) -> list[str]:
    """Methods or peers of any frame, in order."""
    return list(dict.fromkeys(name for entry in entries for name in entry[group]))


def summary(entries: Sequence[Mapping[str, Any]], group: str) -> dict[str, Any]:
    """By method or peer and measure: mean, median, worst and the frame of that, or None without a number."""
    found: dict[str, Any] = {}
    for name in names_of(entries, group):
        found[name] = {
            key: _summed(entries, values_of(entries, group, name, key), measure)
            for key, measure in MEASURES.items()
            if group == "methods" or measure.of_peers
        }
        if group == "methods":
            choices = [entry[group][name].get("choice") for entry in entries if name in entry[group]]
            if any(choices):
                found[name]["choices"] = list(dict.fromkeys(choice for choice in choices if choice))
    return found


def worst_frames(entries: Sequence[Mapping[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """By measure the worst frames of methods, the worst first; frames that are right are not among them."""
    found = {}
    for key, measure in MEASURES.items():
        rows = [
            (value if measure.is_better_high else -value, place, name, entry["frame"], value)
            for name in names_of(entries, "methods")
            for place, (entry, value) in enumerate(zip(entries, values_of(entries, "methods", name, key), strict=True))
            if value is not None and (measure.is_better_high or value > 0.0)
        ]
        found[key] = [
            {"frame": frame, "method": name, "value": value} for _, _, name, frame, value in sorted(rows)[:MOST_WORST]
        ]
    return found


def reference_noise(entries: Sequence[Mapping[str, Any]], samples: int) -> float | None:
    """Flicker (root mean square, mean over frames) that comes of the reference's own noise, which is in that of all
    methods and peers: None where no peer is Cycles.

    Of Cycles with n samples against a reference with N, whose noise is independent, the variance is as 1 / n + 1 / N.
    The peer with most samples tells.
    """
    counts = {
        name: int(name.removeprefix("cycles")) for name in names_of(entries, "peers") if name.startswith("cycles")
    }
    if not counts:
        return None
    name = max(counts, key=lambda name: counts[name])
    flickers = [entry["peers"][name]["flicker"] for entry in entries if name in entry["peers"]]
    known = [flicker["rms"] for flicker in flickers if flicker is not None]
    return float(np.mean(known)) * math.sqrt(counts[name] / (counts[name] + samples)) if known else None


def noise_warnings(entries: Sequence[Mapping[str, Any]], noise: float | None, samples: int) -> list[str]:
    """One sentence where the reference's noise is more than MOST_NOISE of what is measured of a method."""
    if noise is None:
        return []
    found = {}
    for name in names_of(entries, "methods"):
        flickers = [entry["methods"][name]["flicker"] for entry in entries if name in entry["methods"]]
        known = [flicker["rms"] for flicker in flickers if flicker is not None]
        if known and noise > MOST_NOISE * float(np.mean(known)):
            found[name] = noise / float(np.mean(known))
    if not found:
        return []
    shares = ", ".join(f"{100.0 * min(share, 1.0):.0f} % of {name}'s" for name, share in found.items())
    return [f"The noise of a reference with {samples} samples is {shares} flicker: take more samples to tell more."]


def rounded(value: float | None) -> float | None:
    """To so many digits as say something."""
    return None if value is None else float(f"{value:.{DIGITS}g}")


def _summed(
    entries: Sequence[Mapping[str, Any]], values: Sequence[float | None], measure: Measure
) -> dict[str, Any] | None:
    known = [(value, entry["frame"]) for value, entry in zip(values, entries, strict=True) if value is not None]
    if not known:
        return None
    numbers = np.array([value for value, _ in known], np.float64)
    worst = int(numbers.argmin() if measure.is_better_high else numbers.argmax())
    return {
        "mean": rounded(float(numbers.mean())),
        "median": rounded(float(np.median(numbers))),
        "worst": rounded(known[worst][0]),
        "worst_frame": known[worst][1],
    }


def _inside(numbers: Mapping[str, float] | None, key: str) -> float | None:
    return None if numbers is None else numbers[key]
