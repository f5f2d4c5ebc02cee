# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What has been measured, kept by device and driver in a file of the user's."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...output import checked_folder, write_whole
from ..costs.table import NAMES, Costs

SCHEMA = 1
"""Another one when the units mean something else: what was kept before counts for nothing then"""
DEVICE = ("vendor", "renderer", "version", "backend")
"""What tells devices and drivers apart, of `platform_facts`"""
SAME_DEVICE = ("vendor", "renderer", "backend")
"""Of these one driver is kept: an older one does not come back"""


@dataclass(frozen=True, slots=True)
class Measured:
    """The costs of a device."""

    costs: Costs
    when: str
    """Local time, ISO 8601"""

    @classmethod
    def now(cls, costs: Costs) -> Measured:
        """Measured just now."""
        return cls(costs, datetime.now().astimezone().isoformat(timespec="seconds"))


def read_kept(path: Path, device: Mapping[str, str]) -> Measured | None:
    """What is kept of a device; None where nothing is. Raises InputError for a file that cannot be used."""
    for entry in _entries(path):
        if entry["device"] == _named(device, DEVICE):
            return Measured(Costs(**entry["costs"]), entry["measured"])
    return None


def keep(path: Path, device: Mapping[str, str], measured: Measured) -> None:
    """Keep it, in place of what was kept of this device; a damaged file is begun anew.

    Raises InputError where the file cannot be written.
    """
    entry = {"device": _named(device, DEVICE), "measured": measured.when, "costs": asdict(measured.costs)}
    _write(path, [*_others(path, device), entry])


def forget(path: Path, device: Mapping[str, str]) -> None:
    """Keep nothing of a device. Raises InputError where the file cannot be written."""
    if path.exists():
        _write(path, _others(path, device))


def _others(path: Path, device: Mapping[str, str]) -> list[dict[str, Any]]:
    """Entries of other devices."""
    try:
        entries = _entries(path)
    except InputError:
        return []
    own = _named(device, SAME_DEVICE)
    return [entry for entry in entries if _named(entry["device"], SAME_DEVICE) != own]


def _entries(path: Path) -> list[dict[str, Any]]:
    """All that is kept; nothing where there is no file, or one of another schema."""
    try:
        text = path.read_text(encoding="utf-8")
    except (FileNotFoundError, NotADirectoryError):
        return []
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        raise InputError(f'Cannot read "{path}" ({reason}): Measure This Device writes it anew.') from error
    try:
        content = json.loads(text)
        if content["schema"] != SCHEMA:
            return []
        for entry in content["devices"]:
            if not {type(entry["device"][name]) for name in DEVICE} == {type(entry["measured"])} == {str}:
                raise TypeError("no text where there should be some")
            Costs(**{name: entry["costs"][name] for name in NAMES})
            if len(entry["costs"]) != len(NAMES):
                raise ValueError("there are other costs")
        devices: list[dict[str, Any]] = content["devices"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise InputError(f'"{path}" is damaged: Measure This Device writes it anew.') from error
    return devices


def _named(device: Mapping[str, str], names: tuple[str, ...]) -> dict[str, str]:
    return {name: device[name] for name in names}


def _write(path: Path, entries: list[dict[str, Any]]) -> None:
    checked_folder(path.parent)
    write_whole(path, json.dumps({"schema": SCHEMA, "devices": entries}, indent=1) + "\n")
