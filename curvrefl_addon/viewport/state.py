# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the draw handlers hold, and how it is let go."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from ..scene.opened.areas import view_3d_areas
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


state = State()


def free_scene(key: tuple[int, str]) -> None:
    """Let go of a scene and of the pictures of it; its counters stay."""
    scene = state.scenes.pop(key)
    state.counters.update(scene.counters)
    for region in [region for region, picture in state.pictures.items() if picture.scene is scene]:
        del state.pictures[region]
    scene.free()


def forget_scenes() -> None:
    """Read all scenes as if they had never been seen."""
    for key in list(state.scenes):
        free_scene(key)
    redraw_all()


def redraw_all() -> None:
    """Draw all 3D viewports again; pictures of regions that are gone, as of a closed window, are let go."""
    there: set[int] = set()
    for area in view_3d_areas():
        area.tag_redraw()
        there.update(region.as_pointer() for region in area.regions)
    for gone in set(state.pictures) - there:
        del state.pictures[gone]
