# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the device computes what it should, as the viewports know it."""

from __future__ import annotations

from ..renderer.proofs.proving import Proving, prove_all
from ..renderer.proofs.verdict import Verdict, known_verdict, take_verdict
from . import handlers


def prove_device() -> Proving:
    """All proofs at once. Needs a GPU context."""
    proving = prove_all()
    take(proving.verdict)
    return proving


def take(verdict: Verdict) -> None:
    """Use what it says. What was drawn and solved by a way that is left is let go."""
    if take_verdict(verdict):
        handlers.forget_scenes()


def message() -> str:
    """For the panel: one sentence where something is wrong, else nothing."""
    return known_verdict().sentence
