# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether memory will do for what a file asks for, before it is taken: past that, systems end a program unasked."""

from __future__ import annotations

from pathlib import Path

from .errors import InputError

_SYSTEM = Path("/proc/meminfo")
_LIMITS = (
    (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory.current")),
    (
        Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
        Path("/sys/fs/cgroup/memory/memory.usage_in_bytes"),
    ),
)
"""Of containers: what may be used, what is"""


def available_bytes() -> int | None:
    """Memory that can be taken without swapping; None where the system does not tell."""
    try:
        lines = _SYSTEM.read_text(encoding="ascii").splitlines()
        free = next(int(line.split()[1]) << 10 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration, ValueError):
        return None
    for limit, used in _LIMITS:
        try:
            free = min(free, max(int(limit.read_text()) - int(used.read_text()), 0))
        except (OSError, ValueError):  # (no such limit)
            continue
    return free


def exceeds_memory(needed: int) -> bool:
    """Whether so many bytes are more than can be taken, as far as the system tells."""
    free = available_bytes()
    return free is not None and needed > free


def require_memory(needed: int, what: str, remedy: str) -> None:
    """Raises InputError where so many bytes cannot be taken; `what` needs them, and `remedy` is what can be done."""
    if exceeds_memory(needed):
        free = available_bytes() or 0
        raise InputError(f"{what} needs about {needed / 1e9:.1f} GB of memory and {free / 1e9:.1f} are free: {remedy}.")
