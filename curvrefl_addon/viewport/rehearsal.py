# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture that nobody sees, drawn over some redraws, so that those that are seen find their shaders made."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace

from ..pacing.pieces import OutOfTime, paced
from ..renderer.reflection import Reflection
from ..renderer.renderer import Renderer
from ..renderer.surfaces.canvas import Canvas
from ..scene.camera.view import View

SHARE = 8
"""Of a picture's width and height, one part: what is made is the same"""
PATIENT_ATTEMPTS, LEAST_SECONDS = 64, 0.01
"""After so many attempts each takes so much longer, twice that after as many again, and so on: what is drawn anew in
every attempt gets done all the same"""


class Rehearsal:
    """Of pictures of one renderer, at rest or while something moves."""

    def __init__(self, renderer: Renderer, at_rest: bool) -> None:
        self.left = "shaders"
        """What is made next; nothing once all is there"""
        self.made_for: tuple[Hashable, bool] = (renderer.ingredients, at_rest)
        """It serves as long as these are the same"""
        self._renderer, self._at_rest = renderer, at_rest
        self._attempts = 0

    def advance(self, view: View, seconds: float) -> bool:
        """Go on for about so long, one piece at least; whether all is there."""
        self._attempts += 1
        more = LEAST_SECONDS * 2.0 ** min(self._attempts // PATIENT_ATTEMPTS, 20) - LEAST_SECONDS
        try:
            with paced(seconds + more):
                self._draw(view)
        except OutOfTime as left:
            self.left = str(left)
            return False
        self.left = ""
        return True

    def _draw(self, view: View) -> None:
        whole: Reflection = self._renderer.reflect(view, at_rest=self._at_rest)
        width, height = max(view.width // SHARE, 1), max(view.height // SHARE, 1)
        small = replace(whole, view=replace(whole.view, width=width, height=height, lens=None))
        canvas = Canvas.of_size(width, height)
        self._renderer.add_sub_frame(canvas, small, 0, 1.0, mirrors_only=True)
