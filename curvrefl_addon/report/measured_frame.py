# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of a renderer with its times, and its errors against what Cycles shows."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from ..renderer.noise import Convergence
from ..renderer.truth.shown_points import ShownPoints
from ..renderer.truth.truth import MirrorTruth
from ..scene.arrays import Float32Array, Int32Array, SceneArrays
from ..scene.camera.shutter import Moment
from ..scene.camera.view import View
from ..scene.materials.color_spaces import scene_to_rec709
from .geometry_reference import GeometryReference
from .metrics import BoolArray, GeometryError, flip_in_mask, geometry_error, missing_flip, psnr_in_mask
from .repeats import Timing, repeated

TIMED_FRAMES = 3
ENOUGH_SECONDS = 5.0
"""Of timed frames, after which no other one begins"""


class FrameLike(Protocol):
    """What is read of `renderer.renderer.Frame`."""

    times_ms: dict[str, float]
    warnings: tuple[str, ...]
    choice: dict[str, object] | None
    convergence: Convergence | None
    bounced_light: str

    @property
    def solve(self) -> dict[str, Any]: ...
    @property
    def truth(self) -> MirrorTruth: ...
    def color(self) -> Float32Array: ...
    def mask(self) -> Int32Array: ...
    def reflected_position(self) -> Float32Array: ...
    def reflected_object(self) -> Int32Array: ...


class RendererLike(Protocol):
    """What is used of `renderer.renderer.Renderer`."""

    def render(self, view: View, *, moments: Sequence[Moment] = ()) -> FrameLike: ...
    def settle(self) -> None: ...
    def free(self) -> None: ...


@dataclass(frozen=True, slots=True)
class MeasuredFrame:
    """Everything that is read of a frame, so that its renderer can be freed."""

    color: Float32Array
    mask: Int32Array
    reflected_position: Float32Array
    reflected_object: Int32Array
    times: dict[str, Timing]
    """By step: bake, solve, draw, and frame = solve + draw"""
    solve: dict[str, Any]
    warnings: tuple[str, ...]
    choice: dict[str, object] | None
    """What `auto` has chosen, and why"""
    convergence: Convergence | None
    """How many sub-frames are in it, and what is left of its error"""
    bounced_light: str = ""
    """How light between surfaces was found, or why not"""
    points: ShownPoints | None = None
    """What rays find of what the mirrors show, where that was asked for"""

    @property
    def times_ms(self) -> dict[str, float]:
        """Medians by step."""
        return {name: timing.median for name, timing in self.times.items()}


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """One comparison, before it is left, for whoever keeps more of it than a report does. Pictures are (h, w, 4),
    scene-linear."""

    scene: SceneArrays
    view: View
    truth: GeometryReference
    reference: Float32Array
    frames: Mapping[str, MeasuredFrame]
    """By method; the first one has `points`"""
    peers: Mapping[str, Float32Array]
    folder: Path
    """Where the report's own files are"""


type Keep = Callable[[Compared], None]
"""Writes more files into the folder"""


def measure_frame(
    renderer: RendererLike,
    view: View,
    repeats: int = TIMED_FRAMES,
    moments: Sequence[Moment] = (),
    reads_points: bool = False,
) -> MeasuredFrame:
    """The picture, with these `moments` if any, and its times; frees the renderer."""
    try:
        frame, times = _timed_frames(renderer, view, repeats, moments)
        return MeasuredFrame(
            color=frame.color(),
            mask=frame.mask(),
            reflected_position=frame.reflected_position(),
            reflected_object=frame.reflected_object(),
            times=times,
            solve=frame.solve,
            warnings=frame.warnings,
            choice=frame.choice,
            convergence=frame.convergence,
            bounced_light=frame.bounced_light,
            points=frame.truth.points if reads_points else None,
        )
    finally:
        renderer.free()


def measure_times(renderer: RendererLike, view: View, repeats: int = TIMED_FRAMES) -> dict[str, Timing]:
    """The times alone; frees the renderer."""
    try:
        return _timed_frames(renderer, view, repeats, ())[1]
    finally:
        renderer.free()


def _timed_frames(
    renderer: RendererLike, view: View, repeats: int, moments: Sequence[Moment]
) -> tuple[FrameLike, dict[str, Timing]]:
    """One warming frame (shaders compile, resources load), then the timed ones; the last of them, and times by step."""

    def draw() -> FrameLike:
        return renderer.render(view, moments=moments) if moments else renderer.render(view)

    draw()
    renderer.settle()
    frames = repeated(draw, repeats, ENOUGH_SECONDS)
    steps = frames[0].times_ms
    return frames[-1], {name: Timing(tuple(frame.times_ms[name] for frame in frames)) for name in steps}


def image_error(test: Float32Array, reference: Float32Array, mask: BoolArray) -> dict[str, float | None]:
    """FLIP and PSNR of scene-linear pictures over `mask` (h, w).

    None where there is no number: no pixels, no FLIP package, equal pictures.
    """
    test, reference = scene_to_rec709(test), scene_to_rec709(reference)
    psnr = psnr_in_mask(test, reference, mask)
    # JSON has no infinity.
    flip = None if missing_flip() else flip_in_mask(test, reference, mask)
    return {"flip": flip, "psnr": None if psnr == math.inf else psnr}


def frame_geometry_error(frame: MeasuredFrame, truth: GeometryReference) -> GeometryError:
    """See `metrics.geometry_error`."""
    return geometry_error(
        mask=frame.mask,
        reflected_position=frame.reflected_position,
        reflected_object=frame.reflected_object,
        reference_mask=truth.mask,
        reference_reflector_position=truth.reflector_position,
        reference_reflected_position=truth.reflected_position,
        reference_reflected_object=truth.reflected_object,
        reference_valid=truth.valid,
    )
