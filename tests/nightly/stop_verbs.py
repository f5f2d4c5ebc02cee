# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals to the launcher at many moments of a verb: each is answered in time, by one line, and nothing is left.

.venv/bin/python tests/nightly/stop_verbs.py [--count 60]
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
SECONDS = 60.0


@dataclass(frozen=True, slots=True)
class Stopped:
    """What came of a signal."""

    code: int
    seconds: float
    """From the signal to the end"""
    errors: str
    left: tuple[str, ...]
    """Files and folders that are there, and processes that run"""

    def answers(self, number: signal.Signals) -> bool:
        """Whether that is an answer to it; when it came is another matter."""
        said = f"curvrefl: stopped by {number.name}; nothing is half-written.\n"
        return (self.code, self.errors, self.left) == (128 + number, said, ())


def stop(arguments: list[str], number: signal.Signals, moment: float, folder: Path, to_all: bool) -> Stopped | None:
    """Start a verb that writes into folder/"out", send the signal `moment` seconds later; None where it was over.

    `to_all`: to its group of processes, as a terminal does, not to the launcher alone.
    """
    temporary = folder / "tmp"
    temporary.mkdir(exist_ok=True)
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # Shells start so what goes on in the background, and no shell below could change that.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    process = subprocess.Popen(
        [str(ROOT / "curvrefl"), *arguments, "--output", str(folder / "out" / "x.png")],
        env={name: value for name, value in os.environ.items() if name != "CURVREFL_RUN"} | {"TMPDIR": str(temporary)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    time.sleep(moment)
    if process.poll() is not None:
        process.communicate()
        return None
    started = _started(process.pid)
    start = time.monotonic()
    (os.killpg if to_all else os.kill)(process.pid, number)
    _, errors = process.communicate(timeout=SECONDS)
    seconds = time.monotonic() - start
    left = [str(path) for path in folder.rglob("*") if path != temporary]
    left += [f"process {number}" for number in started if _runs(number)]
    return Stopped(process.returncode, seconds, errors, tuple(left))


def _started(process: int) -> list[int]:
    found = [process]
    for number in found:
        try:
            found += map(int, Path(f"/proc/{number}/task/{number}/children").read_text().split())
        except OSError:
            continue
    return found


def _runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=60)
    count = parser.parse_args().count
    sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "blender")]
    chance = random.Random(1)
    answered = 0
    with tempfile.TemporaryDirectory() as name:
        from small_scene import saved

        scene = ["render", str(saved(Path(name))), "--reflector", "Mirror Ball"]
        for turn in range(count):
            number = SIGNALS[turn % 3]
            # (from the launcher's first lines into the picture)
            moment = 0.01 + 4.0 * (turn + chance.random()) / count
            with tempfile.TemporaryDirectory() as folder:
                large = [*scene, "--samples", "256", "--resolution", "1000x800"]
                stopped = stop(large, number, moment, Path(folder), to_all=turn % 2 == 1)
            is_good = stopped is not None and stopped.answers(number) and stopped.seconds < 2.0
            answered += is_good
            if not is_good:
                print(f"{number.name} after {moment:.2f} s: {stopped}")
    print(f"{answered} of {count} signals answered")
    return 0 if answered == count else 1


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)
