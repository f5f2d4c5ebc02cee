# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time that passes, and renders that run, while the viewport draws."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
from scripted import in_view
from situations.opened_file import CAUSED, FOLDER, Steps, block, mirror, redraws, situation


def animate() -> None:
    for item in (block(), mirror()):
        item.keyframe_insert("location", frame=1)
        item.location.z += 0.5
        item.keyframe_insert("location", frame=10)
    bpy.context.scene.frame_end = 10


@situation
def playback() -> Steps:
    animate()
    with in_view():
        bpy.ops.screen.animation_play()
    frames: set[int] = set()

    def has_played() -> bool:
        frames.add(bpy.context.scene.frame_current)
        return len(frames) > 3

    yield has_played
    with in_view():
        bpy.ops.screen.animation_cancel()
    yield CAUSED


def rendered(animation: bool) -> Steps:
    """While it renders, what is drawn changes."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.render.filepath = str(Path(FOLDER) / "render_")
    bpy.context.preferences.view.render_display_type = "NONE"
    animate()
    scene.frame_end = 4
    ended: list[str] = []

    def complete(*_: Any) -> None:
        ended.append("complete")

    def canceled(*_: Any) -> None:
        ended.append("canceled")

    bpy.app.handlers.render_complete.append(complete)
    bpy.app.handlers.render_cancel.append(canceled)
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT", animation=animation)
    for _ in range(4):
        if not animation:
            block().location.x += 0.01
        yield from redraws(1)
    yield lambda: bool(ended)
    assert ended == ["complete"], ended
    yield CAUSED


@situation
def render_while_drawing() -> Steps:
    yield from rendered(animation=False)


@situation
def animation_rendered_while_drawing() -> Steps:
    yield from rendered(animation=True)
