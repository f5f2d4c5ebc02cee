# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How to render: `Settings` are declared in the table of all settings, and checked here."""

from __future__ import annotations

from ..settings_table import RENDERER, Settings

__all__ = ["Settings", "check_settings"]


def check_settings(settings: Settings) -> None:
    """Raise InputError for what is out of range."""
    for item in RENDERER:
        item.check(getattr(settings, item.name))
