# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals where no supervisor answers them: `blender --command curvrefl VERB ...`.

Python's own handlers run when Blender comes back to Python, which in a render is after minutes. So a thread waits for
signals, too, and ends the program where its main thread has not by then.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sys
import threading
from collections.abc import Iterator
from types import FrameType
from typing import NoReturn

from ..supervised import is_supervised, remove_parts
from .inputs import say

STOPS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT") if hasattr(signal, name))
GRACE = 1.0
"""Seconds that the main thread has to end by itself"""


class StoppedError(BaseException):
    """A signal came."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number

    @property
    def exit_code(self) -> int:
        return 128 + self.number

    def __str__(self) -> str:
        return f"stopped by {signal.Signals(self.number).name}; nothing is half-written."


@contextlib.contextmanager
def answered_signals() -> Iterator[None]:
    """Meanwhile a signal that is to stop a program raises StoppedError, or ends it where that is not heard in time."""
    if is_supervised() or threading.current_thread() is not threading.main_thread():
        yield
        return
    # Those that are ignored are so for a reason, such as nohup. (None is a handler of Blender's own.)
    before = {number: old for number in STOPS if (old := signal.getsignal(number)) is not signal.SIG_IGN}
    heard, told = os.pipe()
    os.set_blocking(told, False)
    has_ended = threading.Event()
    watch = threading.Thread(target=_watch, args=(heard, has_ended, set(before)), daemon=True)
    watch.start()
    fd_before = signal.set_wakeup_fd(told, warn_on_full_buffer=False)
    try:
        for number in before:
            signal.signal(number, _raise)
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, signal.SIG_DFL if old is None else old)
        signal.set_wakeup_fd(fd_before)
        has_ended.set()
        os.write(told, b"\0")
        watch.join()
        os.close(told)
        os.close(heard)


def _raise(number: int, _frame: FrameType | None) -> NoReturn:
    # One is enough: what is cleaned up meanwhile is not to be interrupted.
    for other in STOPS:
        if signal.getsignal(other) is _raise:
            signal.signal(other, signal.SIG_IGN)
    raise StoppedError(number)


def _watch(heard: int, has_ended: threading.Event, numbers: set[int]) -> None:
    number = 0
    while number not in numbers:
        number = os.read(heard, 1)[0]
        if has_ended.is_set():
            return
    if not has_ended.wait(GRACE):
        remove_parts()
        blender = sys.modules.get("bpy")
        if blender is not None and blender.app.binary_path:
            shutil.rmtree(blender.app.tempdir, ignore_errors=True)
        stopped = StoppedError(number)
        say(str(stopped))
        os._exit(stopped.exit_code)
