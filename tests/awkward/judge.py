# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges awkward scenes: `./curvrefl test awkward [NAME..]`, or its sample among the other tests.

A picture is right where at most 2 % of its blocks of 4 x 4 pixels are off as the screen shows them; else a warning has
to name the cause. A refusal is a sentence instead of a picture. All else fails: silently wrong, crash, not finite.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from blender_process import script_command

ATTEMPT = Path(__file__).with_name("attempt.py")
MOST_OFF = 0.02
LONGEST = 240.0
"""Seconds for one scene, its reference included, on a busy machine"""
RIGHT, WARNED, REFUSED = "right", "warned", "refused"
WRONG, CRASH, NOT_FINITE = "silently wrong", "crash", "not finite"
OUTCOMES = (RIGHT, WARNED, REFUSED, WRONG, CRASH, NOT_FINITE)
FAILURES = (WRONG, CRASH, NOT_FINITE)
BATCH = 12
"""Scenes in one Blender: shaders are compiled once for all of them"""


def try_scenes(names: Sequence[str], folder: Path, processes: int) -> Iterator[dict[str, Any]]:
    """Tries them in child processes; yields a result each, with its `outcome`."""
    from scenes.awkward import SCENES

    batches = [list(names[start : start + BATCH]) for start in range(0, len(names), BATCH)]
    with ThreadPoolExecutor(processes) as pool:
        for results in pool.map(lambda job: _try_batch(job[0], job[1], folder), enumerate(batches)):
            for result in results:
                yield result | {"outcome": outcome_of(result, SCENES[result["name"]].words)}


def _try_batch(number: int, names: list[str], folder: Path) -> list[dict[str, Any]]:
    """Results of the scenes; one that its process dies of is a crash, and the rest goes on in another."""
    place = folder / f"batch{number}"
    place.mkdir(parents=True, exist_ok=True)
    lines = place / "attempts.jsonl"
    lines.unlink(missing_ok=True)
    results: dict[str, dict[str, Any]] = {}
    left = list(names)
    while left:
        with (place / "output.txt").open("w+", encoding="utf-8", errors="replace") as said:
            command = script_command(ATTEMPT, str(place), *left)
            child = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT, env=_environment())
            ended = _wait(child, lines)
            said.seek(0)
            end_of_output = said.read()[-2000:]
        written = lines.read_text(encoding="utf-8").splitlines() if lines.is_file() else []
        results = {}
        for line in written:
            results[json.loads(line)["name"]] = json.loads(line)
        for name, result in results.items():
            if len(result) == 1:
                results[name] = result | {"crash": f"{ended}\n{end_of_output}"}
                with lines.open("a", encoding="utf-8") as file:
                    print(json.dumps(results[name]), file=file)
        if not any(name in results for name in left):
            raise RuntimeError(f"The Blender that tries {', '.join(left)} {ended}: {end_of_output}")
        left = [name for name in left if name not in results]
    return [results[name] for name in names]


def _wait(child: subprocess.Popen[bytes], lines: Path) -> str:
    """Waits for the child; one that says nothing for too long is ended. Returns how it ended."""
    size, since = -1, time.monotonic()
    while True:
        try:
            return f"ended with exit code {child.wait(timeout=1.0)}"
        except subprocess.TimeoutExpired:
            now = lines.stat().st_size if lines.is_file() else 0
            if now != size:
                size, since = now, time.monotonic()
            elif time.monotonic() - since > LONGEST:
                child.kill()
                child.wait()
                return f"said nothing for {LONGEST:.0f} s"


def _environment() -> dict[str, str]:
    """One thread each for the software renderer and numpy: several run side by side."""
    return {"LP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} | dict(os.environ)


def outcome_of(result: dict[str, Any], words: Sequence[str]) -> str:
    """One of OUTCOMES."""
    if "crash" in result:
        return CRASH
    if "refused" in result:
        return REFUSED
    if not result["finite"]:
        return NOT_FINITE
    if result["off"] <= MOST_OFF:
        return RIGHT
    named = any(word.lower() in warning.lower() for warning in result["warnings"] for word in words)
    return WARNED if named else WRONG


def table_line(result: dict[str, Any]) -> str:
    """A row: name, outcome, share of blocks that are off, what was said."""
    said = list(result.get("warnings", ()))
    said += [result["refused"]] if "refused" in result else []
    said += [result["crash"].strip().splitlines()[-1]] if "crash" in result else []
    off = f"{100.0 * result['off']:.1f} %" if "off" in result else ""
    return f"| {result['name']} | {result['outcome']} | {off} | {' / '.join(said)} |".replace("\n", " ")


def summary(results: Sequence[dict[str, Any]]) -> str:
    counts = Counter(result["outcome"] for result in results)
    return f"{len(results)} scenes: " + ", ".join(f"{counts[outcome]} {outcome}" for outcome in OUTCOMES)


def judge(names: Sequence[str], keep: Path | None = None, processes: int | None = None) -> int:
    """Tries the scenes named (all where none is) and prints their table; 0 where none fails, 2 for an unknown name.

    Pictures stay in `keep`, with the table and results as JSON, where it is given.
    """
    from scenes.awkward import SCENES

    for name in names:
        if name not in SCENES:
            print(f"curvrefl: there is no awkward scene {name}.", file=sys.stderr)
            return 2
    chosen = list(dict.fromkeys(names)) or list(SCENES)
    folder = Path(tempfile.mkdtemp(prefix="curvrefl-awkward-")) if keep is None else keep
    try:
        results = []
        for result in try_scenes(chosen, folder, processes or min(os.cpu_count() or 1, 4)):
            results.append(result)
            print(table_line(result), flush=True)
        if keep is not None:
            (keep / "results.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
    finally:
        if keep is None:
            shutil.rmtree(folder, ignore_errors=True)
    for result in results:
        if "crash" in result:
            print(f"--- {result['name']}:\n{result['crash']}")
    print(summary(results))
    return 1 if any(result["outcome"] in FAILURES for result in results) else 0
