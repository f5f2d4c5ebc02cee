# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks whether a headless GPU context can be had, without risking this process.

Where a driver is missing or too old, `gpu.init()` of Blender 5.2 does not raise: it aborts or crashes. On Linux a
copy of the process, made in a tenth of a second, tries first.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import warnings
from typing import NoReturn

import gpu

PATIENCE_SECONDS = 30.0
"""A driver that takes longer is believed to come up"""
_NO_CONTEXT = 1


def headless_gpu_fails() -> str:
    """Why `gpu.init()` would fail, or nothing when it works or cannot be tried here."""
    if sys.platform != "linux":
        return ""
    with warnings.catch_warnings():
        # Forking beside threads is risky where the copy goes on; this one only starts a driver and ends.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        _try_and_exit()
    status = _wait(child)
    if status is None or status == 0:
        return ""
    if status == _NO_CONTEXT:
        return "Blender found no usable driver"
    return f"the driver is missing or too old: starting it ended with {signal.Signals(-status).name}"


def _try_and_exit() -> NoReturn:
    """In the copy: silently exit with 0 where it works, `_NO_CONTEXT` where it does not, or by a signal."""
    code = _NO_CONTEXT
    try:
        import resource

        # Blender's own handler would write a crash report, the system a core file.
        for crash in (signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL, signal.SIGSEGV):
            signal.signal(crash, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        gpu.init()
        code = 0
    finally:
        # Nothing of the original's may be flushed or closed here.
        os._exit(code)


def _wait(child: int) -> int | None:
    """Exit code of the copy, minus the signal that ended it, or None where it took too long."""
    end = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < end:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.005)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None
