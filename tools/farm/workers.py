# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A farm on one machine: workers that run the tasks of a job bundle side by side. One that is killed is gone, and its
task goes to another.

workers.py FILE.blend --reflector A --frames 1-48 --output DIR ...: the same comparison over frames by two workers, of
which one is killed in the middle, and by one machine; says whether the reports are the same, byte for byte.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from farm import farm_tools  # noqa: E402

SESSION = ROOT / "tools" / "farm" / "session.py"
LAUNCHER = ROOT / "curvrefl"
POLL = 0.02
"""Seconds between two looks at what a worker that is to be killed has done"""


@dataclass
class Run:
    """A task, once started."""

    worker: int
    step: str
    task: Mapping[str, Sequence[str]]
    told: list[dict[str, Any]] = field(default_factory=list)
    """What its session told, as it came"""
    ended: str = ""
    """done, failed or killed"""

    @property
    def lines(self) -> list[str]:
        """What it printed."""
        return [item["line"] for item in self.told if "line" in item]

    @property
    def status(self) -> str:
        """What its session told last of what it does."""
        return next((item["status"] for item in reversed(self.told) if item.get("status")), "")

    @property
    def frames(self) -> list[int]:
        """Those that it began to compare, in that order."""
        return [int(match[1]) for line in self.lines if (match := re.match(r"Frame (-?\d+) \(\d+ of \d+\)", line))]


@dataclass(frozen=True)
class Farm:
    """Workers that see the bundle and one output, each of which maps paths by the same rules."""

    programs: Path
    """Of `farm_tools`"""
    bundle: Path
    values: Mapping[str, str]
    """Parameters of the job, by name"""
    rules: Sequence[Mapping[str, str]] = ()
    """Of path mapping, as in Open Job Description"""
    temporary: Path = Path(tempfile.gettempdir())
    """Of the workers"""
    workers: int = 2

    def run(self, is_killed: Callable[[Run], bool] = lambda _run: False) -> list[Run]:
        """Run all steps, one after the other; a worker is killed once, where `is_killed` says so of what it runs.

        Ends where all tasks are done, one has failed, or no worker is left.
        """
        runs: list[Run] = []
        alive = list(range(self.workers))
        for step in self._session("plan"):
            left = list(step["tasks"])
            lock = threading.Lock()

            def work(worker: int, name: str = step["step"], left: list[Any] = left, lock: Any = lock) -> None:
                while True:
                    with lock:
                        failed = any(run.ended == "failed" for run in runs)
                        if failed or not left:
                            # (Another's task may come back.)
                            if failed or not any(not run.ended for run in runs):
                                return
                            task = None
                        else:
                            task = left.pop(0)
                            run = Run(worker, name, task)
                            runs.append(run)
                    if task is None:
                        time.sleep(POLL)
                        continue
                    ended = self._run(run, is_killed)
                    with lock:
                        if ended == "killed":
                            left.insert(0, task)
                            alive.remove(worker)
                        run.ended = ended
                    if ended == "killed":
                        return

            threads = [threading.Thread(target=work, args=(worker,)) for worker in alive]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            if left or any(run.ended == "failed" for run in runs):
                break
        return runs

    def _run(self, run: Run, is_killed: Callable[[Run], bool]) -> str:
        command = self._command("task", run.step, json.dumps(run.task), json.dumps(list(self.rules)))
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True, env=self._env())
        ended = threading.Event()
        was_killed = threading.Event()

        def watch() -> None:
            while not ended.wait(POLL):
                if is_killed(run):
                    kill_all(process.pid)
                    was_killed.set()
                    return

        watching = threading.Thread(target=watch)
        watching.start()
        assert process.stdout is not None
        for line in process.stdout:
            # (A line that breaks off is the last of one that was killed.)
            with contextlib.suppress(ValueError):
                run.told.append(json.loads(line))
        code = process.wait()
        ended.set()
        watching.join()
        return "killed" if was_killed.is_set() else "done" if code == 0 else "failed"

    def _session(self, verb: str, *arguments: str) -> list[dict[str, Any]]:
        result = subprocess.run(self._command(verb, *arguments), capture_output=True, text=True, env=self._env())
        if result.returncode != 0:
            raise RuntimeError(f"{verb} failed:\n{result.stdout}{result.stderr}")
        return [json.loads(line) for line in result.stdout.splitlines()]

    def _command(self, verb: str, *arguments: str) -> list[str]:
        python = str(self.programs / "python")
        return [python, str(SESSION), verb, str(self.bundle), json.dumps(dict(self.values)), *arguments]

    def _env(self) -> dict[str, str]:
        kept = {name: value for name, value in os.environ.items() if name not in ("CURVREFL_RUN", "OCIO")}
        return kept | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(self.temporary))


def kill_all(process: int) -> None:
    """SIGKILL a process and all that it and those have started, as when a machine goes down."""
    while found := [number for number in _started(process) if _runs(number)]:
        for number in found:
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)


def _started(process: int) -> list[int]:
    found = [process]
    for number in found:
        with contextlib.suppress(OSError):
            for children in Path(f"/proc/{number}/task").glob("*/children"):
                found += map(int, children.read_text().split())
    return found


def _runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def done_once(runs: Sequence[Run], frames: Sequence[int]) -> bool:
    """Whether all frames were compared, and each once: but for the one that a worker was at when it was killed."""
    counts = dict.fromkeys(frames, 0)
    at = []
    for run in runs:
        begun = run.frames
        if run.ended == "killed" and begun:
            at.append(begun.pop())
        for frame in begun:
            counts[frame] += 1
    return all(count == 1 or (count == 0 and frame in at) for frame, count in counts.items())


def different(one: Path, other: Path) -> list[str]:
    """What two comparisons over frames have otherwise: of their reports but for times, and of what frames keep."""
    names: set[str] = set()
    for folder in (one, other):
        names |= {path.name for path in folder.iterdir() if not path.is_dir() and not path.name.startswith("times")}
        names |= {str(path.relative_to(folder)) for path in folder.glob("frame_*/kept.*")}
    return sorted(name for name in names if _content(one / name) != _content(other / name))


def _content(path: Path) -> bytes | None:
    return path.read_bytes() if path.is_file() else None


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--output", type=Path, required=True, help="folder for the bundle and both comparisons")
    parser.add_argument("--frames", default="1-48")
    parser.add_argument("--frames-per-task", default="4")
    parser.add_argument("--after", type=int, default=12, help="frames that are there when one is killed (%(default)s)")
    options, more = parser.parse_known_args(arguments)
    output = options.output.absolute()
    output.mkdir(parents=True)
    try:
        programs = farm_tools.find_or_make()
    except farm_tools.NoFarmToolsError as error:
        print(f"curvrefl: no tools of render farms: {error}.", file=sys.stderr)
        return 2
    bundle, farmed, alone = (output / name for name in ("bundle", "farm", "alone"))
    given = [str(options.file), "--frames", options.frames, *more]
    made = ["--frames-per-task", options.frames_per_task, "--program", str(LAUNCHER), "--report", str(farmed)]
    subprocess.run([LAUNCHER, "farm", "openjd", *given, *made, "--output", bundle], check=True)
    farm = Farm(programs, bundle, {"File": str(options.file.absolute()), "Output": str(farmed)}, temporary=output)
    start = time.monotonic()
    killed: list[Run] = []

    def is_killed(run: Run) -> bool:
        if not killed and len(run.frames) > 1 and len(list(farmed.glob("frame_*/report.json"))) >= options.after:
            killed.append(run)
        return killed[:1] == [run] and not run.ended

    runs = farm.run(is_killed)
    print(f"{farm.workers} workers: {time.monotonic() - start:.0f} s, {[(run.ended, run.frames) for run in runs]}")
    start = time.monotonic()
    with (output / "alone.txt").open("w") as log:
        subprocess.run([LAUNCHER, "compare", *given, "--output", alone], check=True, stdout=log)
    print(f"one machine: {time.monotonic() - start:.0f} s")
    frames = [int(path.name.removeprefix("frame_")) for path in alone.glob("frame_*")]
    wrong = different(farmed, alone)
    once = bool(killed) and done_once(runs, frames)
    print(f"{len(frames)} frames; killed: {bool(killed)}; each done once: {once}; different: {wrong or 'nothing'}")
    return 0 if once and not wrong else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
