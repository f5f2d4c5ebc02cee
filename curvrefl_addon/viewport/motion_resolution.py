# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many pixels are drawn while something moves: as many as the time that a picture takes leaves room for.

Pure Python. All choices of `Scene.curvrefl.motion_resolution` ask for this but those in `FIXED`.
"""

from __future__ import annotations

FIXED = {"FULL": 1, "HALF": 2, "QUARTER": 4}
"""What width and height are divided by"""
STEPS = (1, 2, 3, 4, 6, 8)
"""Divisors to choose from"""
FIRST = 2
BUDGET_MS = 30.0
"""For one picture, the GPU's work included: what is left of a frame at 25 a second for Blender's own"""
TOO_SLOW = 1.3
"""In parts of the budget: less is no reason to change, as times waver"""
SLOW_AT_ONCE = 4.0
"""In parts of the budget: two pictures are enough to tell, one that compiles a shader is not"""
LEAST_GAIN = 0.85
"""What a coarser picture must take of the time of the finer, or fewer pixels help nothing"""
ALIKE = 1.5
"""A time has changed by more than this factor where something else is drawn"""
LOOKS = 3
"""Times of which the least counts: what else the machine does makes pictures slower, never faster"""
SELDOM = 8
"""Once it is known only one picture in so many is timed, since that waits for the GPU"""


class MotionResolution:
    """Of one region. `note` what pictures of its `divisor` take, while it `wants_time`."""

    def __init__(self) -> None:
        self.divisor = FIRST
        """Of width and height of the next picture"""
        self._times: list[float] = []
        """Last ones of this divisor, ms"""
        self._untimed = 0
        self._finer: tuple[int, float] | None = None
        """Where it has become coarser: divisor before, and what a picture took there"""
        self._limit: tuple[int, float] | None = None
        """A divisor beyond which fewer pixels have not helped, and what a picture took there"""

    def wants_time(self) -> bool:
        """Whether the next picture is to be timed; asked once for each."""
        self._untimed += 1
        return len(self._times) < LOOKS or self._untimed >= SELDOM

    def note(self, milliseconds: float) -> None:
        """A picture of this divisor has taken so long, until the GPU had finished."""
        self._untimed = 0
        self._times = [*self._times[1 - LOOKS :], milliseconds]
        time = min(self._times)
        if len(self._times) < LOOKS and (len(self._times) < 2 or time < SLOW_AT_ONCE * BUDGET_MS):
            return
        if self._finer is not None:
            finer, before = self._finer
            self._finer = None
            if time > LEAST_GAIN * before:
                self._limit = finer, before
                self._go_to(finer)
                return
        if self._limit is not None and self._is_new_at_limit(time):
            self._limit = None
        if time > TOO_SLOW * BUDGET_MS:
            coarser = self._fitting(time, [step for step in STEPS if step > self.divisor])
            if coarser is not None and self._limit is None:
                self._finer = self.divisor, time
                self._go_to(coarser)
        else:
            # (As if all of the time were pixels': the finer picture is sure to fit.)
            finer_steps = [step for step in STEPS if step < self.divisor]
            fitting = [step for step in finer_steps if self._scaled(time, step) <= BUDGET_MS]
            if fitting:
                self._go_to(fitting[0])

    def _is_new_at_limit(self, time: float) -> bool:
        """Whether other things are drawn than when fewer pixels did not help."""
        assert self._limit is not None
        divisor, before = self._limit
        return divisor == self.divisor and not before / ALIKE <= time <= before * ALIKE

    def _fitting(self, time: float, steps: list[int]) -> int | None:
        """The finest of these steps that should keep the budget, else the coarsest; None where there is none."""
        fitting = [step for step in steps if self._scaled(time, step) <= BUDGET_MS]
        return fitting[0] if fitting else steps[-1] if steps else None

    def _scaled(self, time: float, step: int) -> float:
        """What a picture of another divisor takes where all time goes with its pixels."""
        return time * (self.divisor / step) ** 2

    def _go_to(self, divisor: int) -> None:
        self.divisor, self._times = divisor, []
