# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What studios run job bundles with, in an environment of its own: Open Job Description's command line and sessions,
and what submits to Deadline Cloud.

Made once in the user's cache folder, by pip (about 110 MB).
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

PACKAGES = ("openjd-cli==0.8.0", "deadline==0.60.10")
"""(`openjd-sessions` and `openjd-model` come with the first in the versions that it takes.)"""
STAMP = "curvrefl-made.txt"
"""Written last: says that the environment is whole"""
SECONDS = 600


class NoFarmToolsError(Exception):
    """They cannot be had; the message says why."""


def find_or_make() -> Path:
    """The environment's folder of programs. Raises NoFarmToolsError, with a reason fit for a report."""
    recipe = " ".join((*PACKAGES, sys.version))
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "curvrefl"
    place = cache / f"openjd-{hashlib.sha256(recipe.encode()).hexdigest()[:12]}"
    try:
        cache.mkdir(parents=True, exist_ok=True)
        lock = os.open(cache, os.O_RDONLY)
    except OSError as error:
        raise NoFarmToolsError(f"the cache folder {cache} cannot be used: {error.strerror}") from error
    try:
        # (Let go however this process ends.)
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (place / STAMP).is_file():
            _make(place)
    finally:
        os.close(lock)
    return place / "bin"


def _make(place: Path) -> None:
    shutil.rmtree(place, ignore_errors=True)
    print("curvrefl: getting the tools of render farms by pip, once (about 110 MB) ...", file=sys.stderr, flush=True)
    python = str(place / "bin" / "python")
    options = ("--quiet", "--disable-pip-version-check", "--no-input")
    try:
        for command in (
            [sys.executable, "-m", "venv", str(place)],
            [python, "-m", "pip", "install", *options, *PACKAGES],
        ):
            result = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
            if result.returncode != 0:
                lines = (result.stdout + result.stderr).strip().splitlines()
                raise NoFarmToolsError(f"{' '.join(command[1:3])}: {lines[-1] if lines else result.returncode}")
        (place / STAMP).write_text(" ".join(PACKAGES), encoding="utf-8")
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoFarmToolsError(str(error)) from error
    finally:
        if not (place / STAMP).is_file():
            shutil.rmtree(place, ignore_errors=True)
