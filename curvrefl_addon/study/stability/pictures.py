# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every method shows of a trial, and in how much of the mirror that is not what Exact shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...optics.catalog import METHODS, label_of
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...report.display import display_transform
from ...report.images import save_png
from ...scene.arrays import Float32Array
from .scenes import Trial

SUB_FRAMES = 4
LIMIT = 0.1
"""Of a display value from 0 to 1: a pixel off by more in red, green or blue shows something else"""
JUDGE = "exact"


@dataclass(frozen=True, slots=True)
class TrialPicture:
    """What one method does in a trial."""

    file: str
    """Name of the picture; empty where the method refuses the mirror"""
    refusal: str
    """Why there is none"""
    differs: float
    """Share of the mirror's pixels that show something else than `exact` does; NaN without a picture"""


def draw_trial(trial: Trial, folder: Path, progress: Callable[[str], None]) -> dict[str, TrialPicture]:
    """Pictures of all methods, by method, written as TRIAL_METHOD.png."""
    results: dict[str, TrialPicture] = {}
    renderer = Renderer(trial.scene, _settings(JUDGE))
    try:
        frame = renderer.render(trial.view)
        right, mask = display_transform(frame.color()[..., :3]), frame.mask() > 0
        for method, found in _colors(renderer, trial):
            progress(f"Drawing {trial.name}: {label_of(method)}")
            if isinstance(found, str):
                results[method] = TrialPicture("", found, float("nan"))
                continue
            file = f"{trial.name.replace(' ', '_')}_{method}.png"
            save_png(folder / file, np.ascontiguousarray(found))
            off = np.abs(display_transform(found) - right).max(axis=-1) > LIMIT
            results[method] = TrialPicture(file, "", float(off[mask].mean()))
    finally:
        renderer.free()
    return results


def _colors(renderer: Renderer, trial: Trial) -> Iterator[tuple[str, Float32Array | str]]:
    """By method a picture (h, w, 3), or why there is none. One renderer: what methods share is made once."""
    for method in METHODS:
        try:
            renderer.configure(_settings(method))
        except InputError as error:
            yield method, str(error)
        else:
            yield method, renderer.render(trial.view).color()[..., :3]


def _settings(method: str) -> Settings:
    return Settings(method=method, samples=SUB_FRAMES)
