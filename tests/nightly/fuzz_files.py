# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged .blend files through the verb `render`: none hangs, none writes outside its output, none is our failure.

    .venv/bin/python tests/nightly/fuzz_files.py [--count 1000] [--start 0]

A process opens many files; where Blender's own reader crashes, which the supervisor says in a sentence, the next
process goes on behind the file that it died of.
"""

from __future__ import annotations

import argparse
import os
import selectors
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / folder) for folder in ("", "blender", "nightly")]

from mutations import mutated  # noqa: E402

OPEN_FILES = Path(__file__).with_name("open_files.py")
SECONDS = 60.0
"""That a file may take; a small picture takes less than one"""
BATCH = 100


@dataclass(slots=True)
class Fuzzed:
    """What came of the files."""

    outcomes: Counter[str] = field(default_factory=Counter)
    """How many were "shown", "refused", made Blender "crashed", "failed" by our own failure, or "hung" """
    bad: list[str] = field(default_factory=list)
    """Numbers of those that hung or failed, and files that lie where none may"""


def fuzz(content: bytes, count: int, start: int, folder: Path) -> Fuzzed:
    """Open `count` damaged files in `folder`, which is empty."""
    result = Fuzzed()
    for name in ("files", "cwd", "home", "tmp", "out", "cache"):
        (folder / name).mkdir()
    # Blender makes folders for thumbnails in a home that is new to it.
    whole = folder / "files" / "whole.blend"
    whole.write_bytes(content)
    _open([whole], [-1], folder, result)
    if result.outcomes != {"shown": 1}:
        raise RuntimeError(f"the file is not shown when it is whole: {result}")
    result.outcomes.clear()
    before = _all_in(folder)
    numbers = list(range(start, start + count))
    while numbers:
        batch = numbers[:BATCH]
        files = [folder / "files" / f"{number}.blend" for number in batch]
        for file, number in zip(files, batch, strict=True):
            file.write_bytes(mutated(content, number))
        done = _open(files, batch, folder, result)
        result.bad += [f"written outside: {path}" for path in sorted(_all_in(folder) - before - {*files})]
        for file in files:
            file.unlink()
        numbers = numbers[done:]
    return result


def _all_in(folder: Path) -> set[Path]:
    """All but what is written to the output, and to temporary files by processes that die."""
    return {path for name in ("cwd", "home", "files") for path in (folder / name).rglob("*")}


def _open(files: list[Path], numbers: list[int], folder: Path, result: Fuzzed) -> int:
    """Open the files in one process until it dies; returns how many it has dealt with."""
    environment = os.environ | {
        "HOME": str(folder / "home"),
        "TMPDIR": str(folder / "tmp"),
        "MESA_SHADER_CACHE_DIR": str(folder / "cache"),
    }
    command = [sys.executable, str(OPEN_FILES), str(folder / "out"), *map(str, files)]
    log = folder / "tmp" / "log"
    with (
        log.open("wb") as errors,
        subprocess.Popen(
            command, env=environment, cwd=folder / "cwd", stdout=subprocess.PIPE, stderr=errors, text=True
        ) as process,
    ):
        current = -1
        for line in _lines(process):
            word, *rest = line.split()
            if word == "START":
                current = int(rest[0])
            elif word == "END":
                outcome = {"0": "shown", "2": "refused"}.get(rest[1], "failed")
                result.outcomes[outcome] += 1
                if outcome == "failed":
                    result.bad.append(f"{numbers[current]} failed:\n{log.read_text(errors='replace')[-2000:]}")
            elif word == "HUNG":
                result.outcomes["hung"] += 1
                result.bad.append(f"{numbers[current]} hung")
                process.kill()
                return current + 1
    if process.returncode < 0:
        result.outcomes["crashed"] += 1
        return current + 1
    if current + 1 != len(files):
        raise RuntimeError(f"the process ended with {process.returncode}:\n{log.read_text(errors='replace')[-2000:]}")
    return len(files)


def _lines(process: subprocess.Popen[str]):
    """What it says, and "HUNG" when that is nothing for long."""
    assert process.stdout is not None
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        while True:
            if not selector.select(SECONDS):
                yield "HUNG"
                return
            line = process.stdout.readline()
            if not line:
                return
            if line.startswith(("START ", "END ")):
                yield line


def seed_file(folder: Path) -> bytes:
    """A small scene, not packed, so that damage gets to what is in it."""
    import bpy
    from small_scene import build_scene

    build_scene()
    path = folder / "seed.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False, compress=False)
    return path.read_bytes()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--start", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as seeds:
        result = fuzz(seed_file(Path(seeds)), options.count, options.start, Path(folder))
    print(dict(result.outcomes))
    print("\n".join(result.bad))
    return 1 if result.bad else 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)
