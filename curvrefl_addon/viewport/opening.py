# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A renderer that is made over some redraws, until it has pictures to show."""

from __future__ import annotations

from collections.abc import Generator
from time import perf_counter

from ..renderer.appearance import MATERIALS
from ..renderer.renderer import Renderer
from ..renderer.settings import Settings
from ..scene.arrays import SceneArrays
from ..scene.camera.view import View
from .rehearsal import Rehearsal

SLICE_SECONDS = 0.06
"""Of a redraw, for what is not there yet: with one more piece of it, and the picture, about a tenth of a second"""
FORGOTTEN_SECONDS = 1.0
"""A look that no viewport has asked for so long is not wanted any more"""
IMAGE_SECONDS = 1.0
"""For materials and images before a picture is shown without those that are left"""


class Opening:
    """Of one look of a scene."""

    def __init__(self, scene: SceneArrays, settings: Settings, image_memory: int) -> None:
        self.scene, self.settings = scene, settings
        self.progress = "meshes"
        """What is done next"""
        self.renderer: Renderer | None = None
        """Once it can be told to draw, if not what it draws yet"""
        self._steps: Generator[str, None, Renderer] | None = Renderer.opened_in_steps(scene, settings, image_memory)
        self.asked_at = perf_counter()
        """When a viewport last wanted it"""
        self._image_seconds = 0.0
        self._rehearsal: Rehearsal | None = None

    def advance(self, view: View, seconds: float) -> bool:
        """Go on for about so long, one step at least; whether pictures of the view can be drawn now. Raises as the
        renderer's constructor and `Renderer.reflect`."""
        self.asked_at = perf_counter()
        end = self.asked_at + seconds
        while self.renderer is None or self._waits_for_images:
            if self.renderer is None:
                self._step()
            else:
                self._load(self.renderer, end - perf_counter())
            if perf_counter() >= end:
                return False
        made_for = (self.renderer.ingredients, False)
        if self._rehearsal is None or self._rehearsal.made_for != made_for:
            self._rehearsal = Rehearsal(self.renderer, at_rest=False)
        is_done = self._rehearsal.advance(view, end - perf_counter())
        self.progress = self._rehearsal.left
        return is_done

    def finish(self) -> Renderer:
        """The renderer, at once."""
        while self.renderer is None:
            self._step()
        return self.renderer

    def free(self) -> None:
        """Let go of what has been made."""
        if self._steps is not None:
            self._steps.close()
        if self.renderer is not None:
            self.renderer.free()
        self._steps = self.renderer = self._rehearsal = None

    @property
    def _waits_for_images(self) -> bool:
        assert self.renderer is not None
        return self.renderer.loading == MATERIALS and self._image_seconds < IMAGE_SECONDS

    def _step(self) -> None:
        assert self._steps is not None
        try:
            self.progress = next(self._steps)
        except StopIteration as made:
            self.renderer, self._steps = made.value, None

    def _load(self, renderer: Renderer, seconds: float) -> None:
        begun = perf_counter()
        self.progress = MATERIALS
        renderer.load_some(seconds)
        self._image_seconds += perf_counter() - begun
