# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL to a verb at random moments of its frames, and to all that it has started; then it is resumed to its end.

What is there then is compared with what an undisturbed run has made: render and film byte for byte, of a comparison all
but its times.

.venv/bin/python tests/nightly/kill_verbs.py [--count 20] [--seed N] [render|compare|film|video ..]
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
VERBS = {"render": 24, "compare": 12, "film": 6, "video": 6}
"""What is killed, and how many frames of it"""
SECONDS = 300.0
BALL = ("--reflector", "Mirror Ball")


@dataclass(slots=True)
class Killing:
    """What came of kills of one verb."""

    kills: int = 0
    wrong: list[str] = field(default_factory=list)
    """A sentence each"""


def arguments(verb: str, file: Path, frames: int, output: Path) -> list[str]:
    """Of so many frames into the folder `output`."""
    given = [str(file), *BALL, "--frames", f"1-{frames}", "--resume"]
    match verb:
        case "render":
            passes = ["--samples", "1", "--passes", "color,position", "--output", str(output / "f_####.png")]
            return ["render", *given, *passes]
        case "compare":
            quick = ["--method", "exact", "--samples", "1", "--peers", "none", "--resolution", "16x12"]
            return ["compare", *given, *quick, "--output", str(output)]
        case "film":
            return ["film", *given, "--samples", "1", "--layers", "--output", str(output / "f_####.png")]
        case "video":
            return ["film", *given, "--samples", "1", "--output", str(output / "film.mp4")]
    raise AssertionError(verb)


def kill_and_resume(verb: str, file: Path, frames: int, count: int, chance: random.Random, folder: Path) -> Killing:
    """Kill the verb `count` times within its frames, resume it to its end, and compare. `folder`: for all of it."""
    plain, out, temporary = folder / "plain", folder / "out", folder / "tmp"
    temporary.mkdir()
    with started(arguments(verb, file, frames, plain), temporary) as process:
        _wait_for_frames(process)
        start = time.monotonic()
        assert process.wait(SECONDS) == 0
        seconds = time.monotonic() - start
    found = Killing()
    while found.kills < count:
        with started(arguments(verb, file, frames, out), temporary) as process:
            if not _wait_for_frames(process):
                # It is done before it was killed so often: it has some of its frames to do again.
                for path in sorted(out.iterdir()):
                    if path.is_file() and chance.random() < 0.5:
                        path.unlink()
                    elif path.is_dir() and chance.random() < 0.5:
                        (path / "report.json").unlink()
                continue
            # (A video has no frames that are done: it is killed anywhere in it.)
            share = 0.9 if verb == "video" else min(2.0 / count, 0.9)
            time.sleep(chance.random() * share * seconds)
            found.kills += process.poll() is None
            _kill(process)
        found.wrong += _seen_in(out, verb)
    with started(arguments(verb, file, frames, out), temporary) as process:
        if process.wait(SECONDS) != 0:
            found.wrong.append(f"the resumed run ended with {process.returncode}")
    found.wrong += _differences(plain, out)
    found.wrong += [f"{path} is left" for path in temporary.iterdir()]
    found.wrong += [f"{path} is left" for path in folder.glob(".curvrefl-*")]
    return found


@contextlib.contextmanager
def started(given: list[str], temporary: Path) -> Iterator[subprocess.Popen[str]]:
    """The verb with these arguments, by the launcher, in a session of its own; it is killed at the end if it runs."""
    process = subprocess.Popen(
        [str(ROOT / "curvrefl"), *given],
        env={name: value for name, value in os.environ.items() if name != "CURVREFL_RUN"} | {"TMPDIR": str(temporary)},
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            _kill(process)
        assert process.stdout is not None
        process.stdout.close()


def _wait_for_frames(process: subprocess.Popen[str]) -> bool:
    """Whether the run has come to a frame; else it has none to do."""
    assert process.stdout is not None
    return any(line.startswith("Frame ") for line in process.stdout)


def _kill(process: subprocess.Popen[str]) -> None:
    """The group, and at once all that it has started in groups of their own."""
    started = [process.pid]
    for number in started:
        with contextlib.suppress(OSError):
            started += map(int, Path(f"/proc/{number}/task/{number}/children").read_text().split())
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    for number in started:
        with contextlib.suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
    process.wait(SECONDS)


def _seen_in(out: Path, verb: str) -> list[str]:
    """What is wrong with files that are there after a kill: each has to be whole."""
    from curvrefl.curvrefl_addon.written_files import is_whole

    files = [path for path in out.rglob("*") if path.is_file()] if out.is_dir() else []
    visible = [path for path in files if not any(part.startswith(".curvrefl-") for part in path.parts)]
    return [f"{path.name} of {verb} is half-written" for path in visible if not is_whole(path)]


def _differences(plain: Path, out: Path) -> list[str]:
    names = [{str(path.relative_to(folder)) for path in folder.rglob("*")} for folder in (plain, out)]
    found = [f"{name} is only there in one of the two runs" for name in sorted(names[0] ^ names[1])]
    for name in sorted(names[0] & names[1]):
        one, other = plain / name, out / name
        if one.is_file() and _content(one) != _content(other):
            found.append(f"{name} is another one than that of the undisturbed run")
    return found


def _content(path: Path) -> Any:
    """All that does not depend on how long something took."""
    if path.name == "times.json":
        return ""
    if path.suffix == ".json":
        report = json.loads(path.read_text(encoding="utf-8"))
        return _timeless(report)
    # (A page of a report shows its times; those over frames are in files of their own.)
    return "" if path.suffix in (".html", ".svg") else path.read_bytes()


def _timeless(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _timeless(one) for name, one in value.items() if not name.startswith("time")}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


def marked_scene(folder: Path) -> Path:
    """A ball that goes up past a block, as a file whose pictures say nothing of when they were made."""
    import bpy
    from small_scene import saved

    def across(ball: Any) -> None:
        scene: Any = bpy.context.scene
        scene.eevee.taa_render_samples = 1
        for name in ("date", "render_time", "memory"):
            setattr(scene.render, f"use_stamp_{name}", False)
        for frame in (1, 24):
            ball.location.z = 0.1 * frame - 1.2
            ball.keyframe_insert("location", frame=frame)

    return saved(folder, across)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verbs", nargs="*", choices=list(VERBS), default=list(VERBS))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    options = parser.parse_args()
    sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "blender")]
    import bootstrap

    bootstrap.load_package()
    print(f"Seed {options.seed}", flush=True)
    chance, is_right = random.Random(options.seed), True
    with tempfile.TemporaryDirectory() as name:
        file = marked_scene(Path(name))
        for verb in options.verbs:
            folder = Path(name, verb)
            folder.mkdir()
            found = kill_and_resume(verb, file, VERBS[verb], options.count, chance, folder)
            print(f"{verb}: {found.kills} kills, {len(found.wrong)} things wrong", *found.wrong, sep="\n", flush=True)
            is_right &= not found.wrong
    return 0 if is_right else 1


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)
