# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The supervisor with commands that stand for Blender: they hang, take no notice, start others, leave things, die."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SUPERVISE = ROOT / "tools" / "supervise.py"
SECONDS = 30.0

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals and /proc of Linux")

DEAF = """
import os, signal, subprocess, sys, time
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
run, half, sign = os.environ["CURVREFL_RUN"], sys.argv[1], sys.argv[2]
open(os.path.join(run, "leftovers"), "ab").write(os.fsencode(half) + b"\\0")
os.mkdir(half)
open(os.path.join(half, "part.png"), "w").write("half")
open(os.path.join(os.environ["TMPDIR"], "temporary"), "w").write("x")
other = subprocess.Popen(["sleep", "100"], start_new_session=True)
open(sign, "w").write(f"{os.getpid()} {other.pid}")
while True:
    time.sleep(100)
"""


def start(tmp_path: Path, script: str, *arguments: object, **options: object) -> subprocess.Popen[str]:
    (tmp_path / "tmp").mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, "-I", "-S", str(SUPERVISE), sys.executable, "-c", script, *map(str, arguments)],
        env=os.environ | {"TMPDIR": str(tmp_path / "tmp")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,  # type: ignore[call-overload]
    )


def wait_for(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + SECONDS
    while not is_so():
        assert time.monotonic() < end, "it does not come"
        time.sleep(0.01)


def runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def deaf(tmp_path: Path) -> tuple[subprocess.Popen[str], list[int]]:
    """A supervised command that takes no notice of signals, and the numbers of it and of what it has started."""
    sign = tmp_path / "sign"
    process = start(tmp_path, DEAF, tmp_path / "half", sign)
    wait_for(lambda: sign.exists() and len(sign.read_text().split()) == 2)
    return process, [int(number) for number in sign.read_text().split()]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_ends_all_and_leaves_nothing(number: signal.Signals, tmp_path: Path) -> None:
    process, started = deaf(tmp_path)
    process.send_signal(number)
    out, err = process.communicate(timeout=SECONDS)
    assert (process.returncode, out, err) == (128 + number, "", "")
    wait_for(lambda: not any(map(runs, started)))
    assert not (tmp_path / "half").exists()
    assert list((tmp_path / "tmp").iterdir()) == []


def test_a_supervisor_that_is_killed_takes_its_command_along(tmp_path: Path) -> None:
    process, (command, other) = deaf(tmp_path)
    process.kill()
    process.wait(SECONDS)
    wait_for(lambda: not runs(command))
    os.kill(other, signal.SIGKILL)  # (in a session of its own, and nobody's)
    process.communicate(timeout=SECONDS)


def test_results_are_moved_to_their_end(tmp_path: Path) -> None:
    script = """
import os, sys, time
publishing = os.path.join(os.environ["CURVREFL_RUN"], "publishing")
open(publishing, "w").close()
open(sys.argv[1] + "1", "w").close()
time.sleep(0.3)
open(sys.argv[1] + "2", "w").close()
os.unlink(publishing)
time.sleep(100)
"""
    process = start(tmp_path, script, tmp_path / "moved")
    wait_for((tmp_path / "moved1").exists)
    process.terminate()
    process.communicate(timeout=SECONDS)
    assert process.returncode == 143
    assert (tmp_path / "moved2").exists()


def test_who_asks_for_it_is_ended_softly(tmp_path: Path) -> None:
    script = """
import os, signal, sys, time
open(os.path.join(os.environ["CURVREFL_RUN"], "softly"), "w").close()
def undo(*_):
    open(sys.argv[1], "w").close()
    sys.exit(3)
signal.signal(signal.SIGTERM, undo)
open(sys.argv[2], "w").close()
time.sleep(100)
"""
    process = start(tmp_path, script, tmp_path / "undone", tmp_path / "sign")
    wait_for((tmp_path / "sign").exists)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=SECONDS)
    assert process.returncode == 130
    assert (tmp_path / "undone").exists()


@pytest.mark.parametrize(
    ("number", "stage", "said"),
    [
        (signal.SIGKILL, "", r"curvrefl: Blender was killed (SIGKILL), as happens when memory runs out"),
        (signal.SIGSEGV, "", r"curvrefl: Blender ended unexpectedly (SIGSEGV): try"),
        (signal.SIGABRT, 'read "x.blend"', 'unexpectedly (SIGABRT) while it read "x.blend": the file is damaged'),
    ],
)
def test_a_command_that_dies_is_a_sentence(number: signal.Signals, stage: str, said: str, tmp_path: Path) -> None:
    script = """
import os, resource, sys
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
if sys.argv[2]:
    open(os.path.join(os.environ["CURVREFL_RUN"], "stage"), "w").write(sys.argv[2])
os.kill(os.getpid(), int(sys.argv[1]))
"""
    process = start(tmp_path, script, int(number), stage)
    out, err = process.communicate(timeout=SECONDS)
    assert (process.returncode, out, err.count("\n")) == (1, "", 1)
    assert said in err
    assert list((tmp_path / "tmp").iterdir()) == []


def test_exit_codes_and_streams_go_through(tmp_path: Path) -> None:
    script = "import sys; print(sys.stdin.read(), sys.argv[1]); print('e', file=sys.stderr); sys.exit(7)"
    process = start(tmp_path, script, "a b", stdin=subprocess.PIPE)
    out, err = process.communicate("given", timeout=SECONDS)
    assert (process.returncode, out, err) == (7, "given a b\n", "e\n")


def test_a_command_that_is_not_there(tmp_path: Path) -> None:
    result = subprocess.run([sys.executable, str(SUPERVISE), "/nowhere/blender"], capture_output=True, text=True)
    assert (result.returncode, result.stderr.count("\n")) == (1, 1)
    assert "/nowhere/blender" in result.stderr


def test_paused_and_continued(tmp_path: Path) -> None:
    process, (command, _) = deaf(tmp_path)

    def state(number: int) -> str:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]

    process.send_signal(signal.SIGTSTP)
    wait_for(lambda: state(command) == "T" and state(process.pid) == "T")
    process.send_signal(signal.SIGCONT)
    wait_for(lambda: state(command) == "S")
    process.terminate()
    process.communicate(timeout=SECONDS)
    assert process.returncode == 143
