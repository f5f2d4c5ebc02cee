# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the draw handlers hold."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from .region import RegionPicture
from .shown_scene import ViewportScene


@dataclass
class State:
    """All that lives while the switch is on."""

    handlers: list[Any] = field(default_factory=list)
    scenes: dict[tuple[int, str], ViewportScene] = field(default_factory=dict)
    """By the scene's session_uid and the view layer's name"""
    pictures: dict[int, RegionPicture] = field(default_factory=dict)
    """Per region; the one drawn last comes last"""
    frame_buffers: dict[int, Any] = field(default_factory=dict)
    """Per region, captured before its engine draws; of this redraw only"""
    failure: str = ""
    asked_at: float = -1e9
    """When the statistics were last asked for, on a monotonic clock"""
    counters: Counter[str] = field(default_factory=Counter)
    """Of scenes that are gone, and of pictures"""
