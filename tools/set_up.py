# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes `.venv` with the pinned requirements; the launcher calls it with a CPython 3.13 when its stamp is missing.

Two starts at once take turns, an interrupted installation is done again, and an environment that already has
everything is adopted as it is.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
PYTHON = VENV / "bin" / "python"
REQUIREMENTS = (ROOT / "requirements.txt", ROOT / "requirements-dev.txt")
STAMP = VENV / "curvrefl-installed.txt"
"""A copy of the requirements, written last; the launcher compares it"""
UNDER_WAY = VENV / "curvrefl-installing"
"""Is there while an installation runs, and after one that was interrupted"""

_HAS_EVERYTHING = """
import importlib.metadata, sys
if sys.implementation.name != "cpython" or sys.version_info[:2] != (3, 13):
    sys.exit(3)
for line in sys.argv[1:]:
    name, _, version = line.partition("==")
    try:
        if importlib.metadata.version(name) != version:
            sys.exit(4)
    except importlib.metadata.PackageNotFoundError:
        sys.exit(4)
import bpy, numpy
"""
_OTHER_PYTHON = 3


def main() -> int:
    """Exit code 0: `.venv` is ready; 1: the installation failed; 2: something of the user's is in the way."""
    lock = os.open(ROOT, os.O_RDONLY)
    # The kernel lets go of the lock however this process ends, so it cannot go stale.
    fcntl.flock(lock, fcntl.LOCK_EX)
    wanted = b"".join(path.read_bytes() for path in REQUIREMENTS)
    if STAMP.is_file() and STAMP.read_bytes() == wanted and os.access(PYTHON, os.X_OK):
        return 0
    if UNDER_WAY.exists() or (STAMP.exists() and not os.access(PYTHON, os.X_OK)):
        shutil.rmtree(VENV)
    if os.path.lexists(VENV):
        state = _check()
        if state == 0:
            _write_stamp(wanted)
            return 0
        if state == _OTHER_PYTHON:
            _say(f"curvrefl: {VENV} is not a CPython 3.13 environment: move it away so that one can be made.")
            return 2
    return _install(wanted)


def _check() -> int:
    """0: adopt it; `_OTHER_PYTHON`: not ours to use; anything else: packages are missing."""
    if not os.access(PYTHON, os.X_OK):
        return _OTHER_PYTHON
    command = [str(PYTHON), "-c", _HAS_EVERYTHING, *_pins()]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


def _pins() -> list[str]:
    lines = [line.strip() for path in REQUIREMENTS for line in path.read_text().splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def _install(wanted: bytes) -> int:
    _say("curvrefl: setting up once: Blender 5.2 as a Python module and tools (about 1.4 GB in .venv) ... ", end="")
    start = time.monotonic()
    fresh = not VENV.exists()
    VENV.mkdir(exist_ok=True)
    UNDER_WAY.touch()
    STAMP.unlink(missing_ok=True)
    try:
        if fresh:
            venv.create(VENV, with_pip=True)
        command = [str(PYTHON), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"]
        for path in REQUIREMENTS:
            command += ["-r", str(path)]
        subprocess.run(command, check=True, capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        output = error.stderr or error.stdout or ""
        _say(f"failed\n{output if isinstance(output, str) else output.decode(errors='replace')}")
        _say("curvrefl: the installation failed (see above); the next start tries again.")
        return 1
    _write_stamp(wanted)
    UNDER_WAY.unlink()
    _say(f"done in {time.monotonic() - start:.0f} s")
    return 0


def _say(text: str, end: str = "\n") -> None:
    print(text, end=end, file=sys.stderr, flush=True)


def _write_stamp(wanted: bytes) -> None:
    part = STAMP.with_suffix(".part")
    part.write_bytes(wanted)
    os.replace(part, STAMP)


if __name__ == "__main__":
    sys.exit(main())
