# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bug report needs of the device, as text."""

from __future__ import annotations

import platform
import tomllib
from functools import cache
from pathlib import Path

import bpy

from ..device.context import device_limits, platform_facts
from ..device.ways.features import FEATURES
from .proving import Proving
from .table import PROOFS
from .verdict import Verdict, joined

_MANIFEST = Path(__file__).resolve().parents[3] / "blender_manifest.toml"


def device_report(proving: Proving) -> str:
    """Of proofs that are through: versions, device, driver, limits, what of it is used and how each came out."""
    facts, failures = platform_facts(), {item.name: item for item in proving.verdict.failures}
    used = proving.verdict.features
    lines = [
        f"{versions()} ({_text(bpy.app.build_hash)}), {platform.platform()}",
        f"Device: {facts['renderer']} ({facts['vendor']}), {facts['kind']}",
        f"Driver: {facts['version']}, {facts['backend']}",
        f"Limits: {', '.join(f'{name} {value:,}' for name, value in device_limits().items())}",
        f"In use: {', '.join(name for name in FEATURES if name not in used.missing) or 'nothing of its own'}",
    ]
    if used.missing:
        lines.append(f"Not in use: {', '.join(used.missing)}")
    if used.distrusted:
        lines.append(f"Not taken by Automatic: {', '.join(sorted(used.distrusted))}")
    lines += ["", f"Proofs: {len(proving.found) - len(failures)} of {len(proving.found)} right"]
    for proof in PROOFS:
        if proof.name in proving.found:
            failure = failures.get(proof.name)
            how = "right" if failure is None else "another way" if failure.without else "WRONG"
            lines.append(f"  {how:12}{proof.name:18}{proving.found[proof.name]}")
            if failure is not None and failure.without:
                lines.append(f"  {'':12}{'':18}by the usual way: {failure.words}")
    return "\n".join(lines) + "\n"


def summary(verdict: Verdict) -> str:
    """In one line: how many proofs came out right, and which did not."""
    wrong = [item.name for item in verdict.failures]
    right = f"{len(verdict.proven) - len(wrong)} of {len(verdict.proven)} proofs are right"
    return right + (f", but not {joined(wrong)}" if wrong else "")


def versions() -> str:
    """What proofs hold for, beside device and driver: shaders are the extension's, and Blender runs them."""
    return f"Curvrefl {extension_version()}, Blender {bpy.app.version_string}"


@cache
def extension_version() -> str:
    """As in its manifest."""
    with _MANIFEST.open("rb") as file:
        return str(tomllib.load(file)["version"])


def _text(value: bytes | str) -> str:
    return value.decode("ascii", "replace") if isinstance(value, bytes) else value
