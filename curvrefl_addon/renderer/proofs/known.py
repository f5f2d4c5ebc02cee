# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of the device in this session."""

from __future__ import annotations

from ..device.ways.features import features, use_features
from .verdict import Verdict

_known = [Verdict()]


def known_verdict() -> Verdict:
    """Nothing is wrong as long as nothing was proven."""
    return _known[0]


def take_verdict(verdict: Verdict) -> bool:
    """From now on use what it says; whether that is something else than before, so that what was drawn and solved
    until now may be wrong."""
    used, distrusted = features(), features().distrusted
    _known[0] = verdict
    use_features(verdict.features)
    return (used, distrusted) != (features(), features().distrusted)
