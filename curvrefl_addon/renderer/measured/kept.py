# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What has been measured, and what proofs have found, kept by device and driver in a file of the user's."""

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
from ..proofs.verdict import Verdict

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


type _Entries = list[dict[str, Any]]


@dataclass(frozen=True, slots=True)
class _Content:
    """Of the file, lists of devices."""

    devices: _Entries
    """With their costs"""
    proofs: _Entries
    """With what proofs have found"""

    def without(self, device: Mapping[str, str]) -> _Content:
        """What is of other devices."""
        own = _named(device, SAME_DEVICE)
        devices, proofs = (
            [entry for entry in entries if _named(entry["device"], SAME_DEVICE) != own]
            for entries in (self.devices, self.proofs)
        )
        return _Content(devices, proofs)


def read_kept(path: Path, device: Mapping[str, str]) -> Measured | None:
    """The costs of a device; None where none are kept. Raises InputError for a file that cannot be used."""
    for entry in _content(path).devices:
        if entry["device"] == _named(device, DEVICE):
            return Measured(Costs(**entry["costs"]), entry["measured"])
    return None


def read_verdict(path: Path, device: Mapping[str, str], versions: str) -> Verdict | None:
    """What proofs have found of a device by these versions of Blender and of the extension; as `read_kept`."""
    for entry in _content(path).proofs:
        if entry["device"] == _named(device, DEVICE) and entry["versions"] == versions:
            return Verdict.from_json(entry)
    return None


def keep(path: Path, device: Mapping[str, str], measured: Measured) -> None:
    """Keep it, in place of what was kept of this device; a damaged file is begun anew.

    Raises InputError where the file cannot be written.
    """
    content = _content_or_none(path)
    entry = {"device": _named(device, DEVICE), "measured": measured.when, "costs": asdict(measured.costs)}
    _write(path, _Content([*content.without(device).devices, entry], content.proofs))


def keep_verdict(path: Path, device: Mapping[str, str], versions: str, verdict: Verdict) -> None:
    """As `keep`."""
    content = _content_or_none(path)
    entry = {"device": _named(device, DEVICE), "versions": versions, **verdict.as_json()}
    _write(path, _Content(content.devices, [*content.without(device).proofs, entry]))


def forget(path: Path, device: Mapping[str, str]) -> None:
    """Keep nothing of a device. Raises InputError where the file cannot be written."""
    if path.exists():
        _write(path, _content_or_none(path).without(device))


def _content_or_none(path: Path) -> _Content:
    """Nothing of a file that is damaged."""
    try:
        return _content(path)
    except InputError:
        return _Content([], [])


def _content(path: Path) -> _Content:
    """All that is kept; nothing where there is no file, or one of another schema."""
    try:
        text = path.read_text(encoding="utf-8")
    except (FileNotFoundError, NotADirectoryError):
        return _Content([], [])
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        raise InputError(f'Cannot read "{path}" ({reason}): Measure This Device writes it anew.') from error
    try:
        content = json.loads(text)
        if content["schema"] != SCHEMA:
            return _Content([], [])
        found = _Content(content["devices"], content["proofs"])
        for entry in found.devices:
            _require_text(entry, "measured")
            Costs(**{name: entry["costs"][name] for name in NAMES})
            if len(entry["costs"]) != len(NAMES):
                raise ValueError("there are other costs")
        for entry in found.proofs:
            _require_text(entry, "versions")
            Verdict.from_json(entry)
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise InputError(f'"{path}" is damaged: Measure This Device writes it anew.') from error
    return found


def _require_text(entry: dict[str, Any], name: str) -> None:
    if not {type(entry["device"][fact]) for fact in DEVICE} == {type(entry[name])} == {str}:
        raise TypeError("no text where there should be some")


def _named(device: Mapping[str, str], names: tuple[str, ...]) -> dict[str, str]:
    return {name: device[name] for name in names}


def _write(path: Path, content: _Content) -> None:
    checked_folder(path.parent)
    write_whole(path, json.dumps({"schema": SCHEMA, **asdict(content)}, indent=1) + "\n")
