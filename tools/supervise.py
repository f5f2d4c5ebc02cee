# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""supervise.py COMMAND..: runs a command so that it can be stopped at any moment and leaves nothing then.

Blender takes no notice of signals while it renders, and dies of some while it starts. So it runs in a session of its
own, with a temporary folder of its own, and this process, for which any Python from 3.8 on will do, waits for it: a
SIGINT, SIGTERM, SIGHUP or SIGQUIT ends all that the command has started, within two seconds, and removes what is half
written (see curvrefl_addon/supervised.py). The exit code is then 128 and the signal's number, and the launcher says
so. A command that dies by itself is one sentence on stderr and exit code 1.
"""

from __future__ import annotations

import contextlib
import importlib.util
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from types import ModuleType

RUN_FOLDER = "CURVREFL_RUN"
LEFTOVERS, PUBLISHING, SOFTLY, STAGE = "leftovers", "publishing", "softly", "stage"
"""Files in the run's folder; see curvrefl_addon/supervised.py"""

STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
WAITED_FOR = (*STOPS, signal.SIGCHLD, signal.SIGTSTP)
GRACE = 0.8
"""Seconds that a command has to end by itself, and to bring a move of results to its end"""
PR_SET_PDEATHSIG = 1
HELD_FOLDERS = pathlib.Path(__file__).resolve().parent.parent / "curvrefl_addon" / "held_folders.py"


def main(command: list[str]) -> int:
    """Run the command; returns its exit code."""
    signal.pthread_sigmask(signal.SIG_BLOCK, WAITED_FOR)
    _open_closed_streams()
    parent = os.getppid()
    _end_with_parent(signal.SIGTERM, parent)
    held_folders = _held_folders()
    try:
        run = _make_run_folder(held_folders)
    except OSError as error:
        _say(f"there is no temporary folder to write to ({error.strerror}): name one in TMPDIR.")
        return 2
    try:
        return _supervise(command, run)
    finally:
        _remove_leftovers(run)


def _supervise(command: list[str], run: str) -> int:
    child = _start(command, run)
    while True:
        number = signal.sigwait(WAITED_FOR)
        if number == signal.SIGTSTP:
            _pause(child)
        elif number in STOPS:
            if number == signal.SIGHUP and signal.getsignal(number) is signal.SIG_IGN:
                continue  # (nohup)
            _wait_for(lambda: not os.path.exists(os.path.join(run, PUBLISHING)))
            _end(child, softly=os.path.exists(os.path.join(run, SOFTLY)))
            return 128 + number
        else:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                _end_group(child)
                return _code(status, run)


def _start(command: list[str], run: str) -> int:
    """Start the command in a session of its own; returns its number."""
    parent = os.getpid()
    child = os.fork()
    if child:
        return child
    try:
        os.setsid()
        # The launcher starts us as shells start what goes on in the background: without SIGINT.
        for number in (signal.SIGINT, signal.SIGQUIT):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, WAITED_FOR)
        _end_with_parent(signal.SIGKILL, parent)
        # Where memory runs out it is not for others to be killed.
        with contextlib.suppress(OSError), open("/proc/self/oom_score_adj", "w") as file:
            file.write("500")
        temporary = os.path.join(run, "tmp")
        os.environ[RUN_FOLDER] = run
        # (Blender reads TEMP first)
        for name in ("TMPDIR", "TEMP", "TMP"):
            os.environ[name] = temporary
        # Without a home of its own Blender complains of its caches.
        if not os.access(os.environ.get("HOME") or "/", os.W_OK | os.X_OK):
            os.environ["HOME"] = temporary
        os.execvp(command[0], command)
    except OSError as error:
        _say(f"cannot start {command[0]} ({error.strerror}).")
    finally:
        os._exit(1)


def _code(status: int, run: str) -> int:
    """The exit code for the status of a command that has ended by itself."""
    if not os.WIFSIGNALED(status):
        return os.WEXITSTATUS(status)
    number = os.WTERMSIG(status)
    name = signal.Signals(number).name
    doing = _stage(run)
    if number == signal.SIGKILL:
        _say(f"Blender was killed ({name}){doing}, as happens when memory runs out: try less at once.")
    elif doing:
        _say(f"Blender ended unexpectedly ({name}){doing}: the file is damaged, or Blender has a fault that it meets.")
    else:
        _say(
            f"Blender ended unexpectedly ({name}): try another driver or Blender version, and report it if that helps."
        )
    return 1


def _stage(run: str) -> str:
    """What the command was about, as " while it ..."; nothing where it has not told."""
    try:
        with open(os.path.join(run, STAGE), encoding="utf-8", errors="surrogateescape") as file:
            return f" while it {file.read()}"
    except OSError:
        return ""


def _end(child: int, softly: bool) -> None:
    """End the command and all that it has started: at once, or with time to end by itself."""
    everyone = _descendants(child)
    if softly:
        for number in everyone:
            _signal(number, signal.SIGTERM)
        _wait_for(lambda: _has_ended(child) and not any(map(_is_running, everyone)))
        # What was started meanwhile, too.
        everyone += _descendants(child)
    # (those first that have started the others: shells would say of them that they are gone)
    for number in everyone:
        _signal(number, signal.SIGKILL)
    _end_group(child)
    _wait_for(lambda: _has_ended(child))


def _end_group(child: int) -> None:
    with contextlib.suppress(OSError):  # (nobody is left)
        os.killpg(child, signal.SIGKILL)


def _pause(child: int) -> None:
    """Stop with all that we have started, until someone lets us go on."""
    everyone = _descendants(child)
    for number in everyone:
        _signal(number, signal.SIGSTOP)
    os.kill(os.getpid(), signal.SIGSTOP)
    for number in everyone:
        _signal(number, signal.SIGCONT)


def _descendants(process: int) -> list[int]:
    """The process and all that it has started, as far as the system tells."""
    found = [process]
    for number in found:
        try:
            for thread in os.listdir(f"/proc/{number}/task"):
                with open(f"/proc/{number}/task/{thread}/children") as file:
                    found += map(int, file.read().split())
        except OSError:
            continue
    return found


def _has_ended(child: int) -> bool:
    try:
        ended, _ = os.waitpid(child, os.WNOHANG)
    except ChildProcessError:
        return True
    return ended != 0


def _is_running(process: int) -> bool:
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def _signal(process: int, number: int) -> None:
    with contextlib.suppress(OSError):  # (it has ended)
        os.kill(process, number)


def _wait_for(is_done: Callable[[], bool]) -> None:
    """At most for the grace."""
    end = time.monotonic() + GRACE
    while not is_done() and time.monotonic() < end:
        time.sleep(0.01)


def _held_folders() -> ModuleType:
    """The file that knows folders which are held, without the package that it is in."""
    spec = importlib.util.spec_from_file_location("held_folders", HELD_FOLDERS)
    assert spec is not None and spec.loader is not None, "the file is beside us"
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _make_run_folder(held_folders: ModuleType) -> str:
    """A folder for this run alone, with one in it for all temporary files. It is held for as long as we run; those of
    runs that were killed are removed."""
    base = pathlib.Path(tempfile.gettempdir())
    held_folders.remove_abandoned(base)
    run, _held = held_folders.hold_new_folder(base, "curvrefl-")
    os.mkdir(os.path.join(run, "tmp"))
    return str(run)


def _remove_leftovers(run: str) -> None:
    try:
        with open(os.path.join(run, LEFTOVERS), "rb") as file:
            paths = file.read().split(b"\0")
    except OSError:
        paths = []
    for path in filter(None, paths):
        if os.path.isdir(path) and not os.path.islink(path):
            shutil.rmtree(path, ignore_errors=True)
        elif os.path.lexists(path):
            os.unlink(path)
    shutil.rmtree(run, ignore_errors=True)


def _open_closed_streams() -> None:
    """Of those that are closed, nothing comes in and nothing goes out: other files must not take their numbers."""
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
            os.set_inheritable(descriptor, True)


def _end_with_parent(number: int, parent: int) -> None:
    """Get that signal when the parent ends, also when it is killed, where the system can do that."""
    if not sys.platform.startswith("linux"):
        return
    import ctypes

    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)
    if os.getppid() != parent:
        os.kill(os.getpid(), number)


def _say(text: str) -> None:
    if sys.stderr is not None:
        print(f"curvrefl: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
