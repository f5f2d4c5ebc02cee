# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a render that are drawn on for the frames after them.

Each frame is drawn from so many before it and from nothing else, so that it is the same whoever has drawn these: those
that this process has drawn already are kept, and others are drawn first.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence

import bpy

from ..errors import InputError
from ..renderer.exposure import ALL, Turn, with_frames_before
from ..renderer.frame import Frame
from ..renderer.renderer import Renderer
from ..renderer.reuse.kept_frame import KeptFrame
from ..renderer.surfaces.canvas import Canvas
from ..scene.camera.shutter import Moment, ReadMoment, read_moments
from ..scene.changes import Changes
from ..settings_table import NAMED, Settings

type Drawn = tuple[Frame, Canvas | None, Renderer]
"""A frame, its mirrors alone where they are asked for, and what has drawn it"""


class Reuse:
    """How many sub-frames a frame has itself, and how many with those before it."""

    def __init__(self, settings: Settings) -> None:
        self.samples = settings.samples
        """Of each frame"""
        most = NAMED["samples"].hard[1]
        assert most is not None
        self.count = max(min(settings.reuse_frames, int(most) // self.samples - 1), 0)
        """Frames before each: as many as leave no more sub-frames than there can be"""

    @property
    def samples_of_all(self) -> int:
        """Sub-frames of a frame and those before it together."""
        return self.samples * (self.count + 1)

    def turn(self, number: int) -> Turn:
        """Which of these the frame `number` has."""
        return Turn(number, self.count + 1) if self.count else ALL


class EarlierFrames:
    """Of one view layer."""

    def __init__(self) -> None:
        self._kept: dict[int, KeptFrame | None] = {}
        """By frame; None for those that serve no other: another camera's, or without these mirrors"""
        self._made_for: Hashable = None

    def draw(
        self,
        scene: bpy.types.Scene,
        camera: bpy.types.Object,
        still: Moment,
        moments: Sequence[Moment],
        made_for: Hashable,
        reuse: Reuse,
        read: tuple[ReadMoment, ReadMoment],
        go_to: Callable[[int, float], None],
        draw: Callable[[Moment, Sequence[Moment], int], Drawn],
    ) -> tuple[Frame, Canvas | None]:
        """The present frame with those before it, `scene.frame_step` apart.

        `made_for`: another one where frames kept do not serve; `read`: a frame, and a moment of its shutter; `draw`
        draws a moment as the frame of a number. What `go_to` shows is as before at the end.
        """
        if made_for != self._made_for:
            self._kept, self._made_for = {}, made_for
        now, part, step = scene.frame_current, scene.frame_subframe, scene.frame_step
        before = [now - step * number for number in range(reuse.count, 0, -1)]
        self._kept = {number: kept for number, kept in self._kept.items() if number in before}
        missing = [number for number in before if number not in self._kept]
        try:
            for number in missing:
                go_to(number, part)
                self._kept[number] = self._drawn_there(
                    scene, camera, number + part, number // step, reuse, read, go_to, draw
                )
        finally:
            if missing:
                go_to(now, part)
        frame, alone, renderer = draw(still, moments, now // step)
        used = [kept for number in before if (kept := self._kept[number]) is not None]
        picture, mirrors, self._kept[now] = with_frames_before(renderer, frame, alone, used)
        frame.color_texture = picture.texture
        return frame, mirrors

    @staticmethod
    def _drawn_there(
        scene: bpy.types.Scene,
        camera: bpy.types.Object,
        time: float,
        number: int,
        reuse: Reuse,
        read: tuple[ReadMoment, ReadMoment],
        go_to: Callable[[int, float], None],
        draw: Callable[[Moment, Sequence[Moment], int], Drawn],
    ) -> KeptFrame | None:
        if scene.camera != camera:
            return None
        try:
            still = Moment(*read[0](Changes(frame=True)))
        except InputError:
            return None
        moments, _ = read_moments(scene, still, reuse.samples, read[1], go_to, time)
        frame, alone, renderer = draw(still, moments, number)
        return with_frames_before(renderer, frame, alone, ())[2]
