# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvrefl: curved mirror reflections in the viewport."""

from __future__ import annotations


def register() -> None:
    from .curvrefl_addon import registration

    registration.register()


def unregister() -> None:
    from .curvrefl_addon import registration

    registration.unregister()
