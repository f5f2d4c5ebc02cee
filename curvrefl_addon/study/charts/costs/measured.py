# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of methods along axes, in turns."""

from __future__ import annotations

from collections.abc import Generator, Sequence

import numpy as np

from ....errors import InputError
from ....renderer.renderer import Renderer
from ....renderer.settings import Settings
from ....report.repeats import Timing
from .axes import Axis, Variant
from .scenes import Size
from .slopes import Cost

TURNS = 4
"""Frames of each method in each of the two rounds over an axis"""


def step_count(axes: Sequence[Axis]) -> int:
    """How many steps `cost_steps` has."""
    return 2 * sum(len(axis.values) for axis in axes)


def cost_steps(
    axes: Sequence[Axis], methods: Sequence[str], size: Size
) -> Generator[str, None, tuple[list[Cost], list[str]]]:
    """Time a picture of one sub-frame by each method along each axis; yields before each of `step_count` steps.

    At each amount the methods take turns, and each axis is measured twice, there and back: what else the machine does
    at one time counts against all methods, and not against large amounts alone. `size`: of the picture in our own
    scenes. A method that refuses a scene ends there, with the reason. Returns what was measured, and warnings.
    """
    costs: list[Cost] = []
    warnings: list[str] = []
    for axis in axes:
        times: dict[tuple[str, float], tuple[float, ...]] = {}
        amounts: dict[float, float] = {}
        reasons = {method: axis.refusal(method) for method in methods}
        for values in (axis.values, axis.values[::-1]):
            for value in values:
                yield f"{axis.name} {value:,g}"
                variant = axis.build(value, size)
                amounts[value] = _measure(variant, value, times, reasons, warnings)
        for method in methods:
            # (One that was refused on the way back has the amounts below that, which were measured twice.)
            measured = [value for value in axis.values if len(times.get((method, value), ())) == 2 * TURNS]
            timings = tuple(Timing(times[method, value]) for value in measured)
            costs.append(Cost(axis.name, method, tuple(amounts[value] for value in measured), timings, reasons[method]))
    return costs, list(dict.fromkeys(warnings))


def _measure(
    variant: Variant,
    value: float,
    times: dict[tuple[str, float], tuple[float, ...]],
    reasons: dict[str, str],
    warnings: list[str],
) -> float:
    """Add TURNS times of each method that has no reason against it; returns the amount."""
    amount = variant.amount
    renderers: dict[str, Renderer] = {}
    try:
        for method in [method for method, reason in reasons.items() if not reason]:
            try:
                settings = Settings(method=method, samples=1, bounces=variant.bounces)
                renderers[method] = Renderer(variant.arrays, settings)
                # Shaders compile, maps are drawn, hierarchies become as good as they will be.
                frame = renderers[method].render(variant.view)
                renderers[method].settle()
            except InputError as error:
                reasons[method] = str(error)
                if method in renderers:
                    renderers.pop(method).free()
                continue
            warnings += frame.warnings
            if amount is None:
                amount = float(np.count_nonzero(frame.mask()))
        turns = list(renderers)
        for number in range(TURNS):
            # (Another one is first each time.)
            first = number % max(len(turns), 1)
            for method in turns[first:] + turns[:first]:
                time = renderers[method].render(variant.view).times_ms["frame"]
                times[method, value] = (*times.get((method, value), ()), time)
    finally:
        for renderer in renderers.values():
            renderer.free()
    if amount is not None and amount <= 0.0:
        raise InputError("No mirror is in view of the camera: turn the camera, or name others.")
    return value if amount is None else amount
