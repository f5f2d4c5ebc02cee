# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All animations by name; `tools/make_scenes.py` writes them as .blend files."""

from __future__ import annotations

from . import kitchen
from .stage import Animation

ANIMATIONS = {
    "kitchen": Animation(
        kitchen.build, (kitchen.POT,), 15005, "Estalella et al. 2005, 2006: a kitchen, and a flight to a bowl of metal"
    ),
}
