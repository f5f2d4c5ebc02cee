# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture knows of its own error: how far the mean of its sub-frames is from the mean of endlessly many.

The mean of n sub-frames is compared with that of half of them. With an error that falls as n^-p the square of their
difference d is on average e(n/2)^2 - e(n)^2 = (4^p - 1) e(n)^2, where e(n) is the error of the mean of n: e(n) =
d / sqrt(4^p - 1). By chance alone p is 1/2 and e(n) = d; evenly spread sub-frames are better than chance.

Where any beginning is spread evenly the half is the first one, and the last two powers of two are looked at. Else it is
half of all, once all are there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..scene.arrays import Float64Array
from ..scene.camera.sampling import is_progressive
from ..scene.camera.srgb import linear_to_srgb
from .device.batches import full_screen_triangle
from .device.context import gpu_cache
from .device.shaders import FULL_SCREEN, Piece, build_shader
from .device.state import drawing_state, set_viewport
from .surfaces.canvas import Canvas

MOST_PIXELS = 1 << 12
"""That are looked at: one in each square of as many as need be"""
FIRST = 8
"""Sub-frames that say anything"""
POWER, POWER_OF_ALL = 0.6, 0.75
"""Powers p of n by which errors fall, as measured; halves of what is spread evenly as a whole alone are the worse"""
SIGNS = "+---+-+++-++---+++--+-+-+--+-++-"
"""Which half a sub-frame belongs to. Half of the first 8, 16 and 32 are of each, and neither sees one side of a thing:
no Walsh function, by which such points are spread, is like it (least for 32 among 200,000 orders)"""


@dataclass(frozen=True, slots=True)
class Convergence:
    """How far a picture has come."""

    done: int
    """Sub-frames in it"""
    samples: int
    """That were asked for"""
    noise: float | None
    """Root mean square of its error over what is drawn in it, in parts of the display's range (by sRGB's curve); None
    where it is not known"""

    def __str__(self) -> str:
        """As "64 of 256, noise 0.8 %"; without the noise where that is not known."""
        count = str(self.done) if self.done == self.samples else f"{self.done} of {self.samples}"
        return ", ".join(filter(None, (count, self.noise_said)))

    @property
    def noise_said(self) -> str:
        """As "noise 0.8 %", or nothing."""
        return "" if self.noise is None else f"noise {100.0 * self.noise:.2g} %"

    def is_enough(self, noise_limit: float) -> bool:
        """Whether no more sub-frames are wanted; `noise_limit` in percent, 0 for none."""
        return self.done >= self.samples or (self.noise is not None and 100.0 * self.noise < noise_limit)


class NoiseMeter:
    """Follows one picture."""

    def __init__(self, canvas: Canvas, samples: int, weight: float) -> None:
        """`canvas` gets so many sub-frames, each with this weight."""
        self._canvas, self._samples, self._weight = canvas, samples, weight
        width, height = canvas.texture.width, canvas.texture.height
        self._step = max(int(np.ceil(np.sqrt(width * height / MOST_PIXELS))), 1)
        self._width, self._height = -(-width // self._step), -(-height // self._step)
        self._signed: Canvas | None = None
        self._half: Float64Array | None = None
        self._differences: list[tuple[int, float]] = []
        """Of so many sub-frames from half of them, root mean square"""
        self._done = 0

    def look(self, done: int) -> None:
        """After each sub-frame: `done` of them are in the canvas."""
        self._done = done
        if self._samples < FIRST:
            return
        if not is_progressive(self._samples):
            self._add_signed(done)
            if done == self._samples:
                assert self._signed is not None
                mean = self._mean(done)
                self._note(done, mean, mean - self._signed.pixels() / (done * self._weight))
        elif done & (done - 1) == 0:
            mean = self._mean(done)
            if self._half is not None:
                self._note(done, mean, self._half)
            self._half = mean

    @property
    def convergence(self) -> Convergence:
        """At the last look."""
        return Convergence(self._done, self._samples, self._noise())

    def _noise(self) -> float | None:
        if not self._differences or self._differences[-1][0] < FIRST:
            return None
        power = POWER if is_progressive(self._samples) else POWER_OF_ALL
        # (As of now, by that power.)
        found = [
            difference * (count / self._done) ** power / np.sqrt(4.0**power - 1.0)
            for count, difference in self._differences[-2:]
        ]
        return float(np.sqrt(np.mean(np.square(found))))

    def _note(self, done: int, mean: Float64Array, other: Float64Array) -> None:
        is_there = (mean != 0.0).any(axis=-1)
        difference = (_as_shown(mean[..., :3]) - _as_shown(other[..., :3]))[is_there]
        self._differences.append((done, float(np.sqrt((difference**2).mean())) if difference.size else 0.0))

    def _mean(self, done: int) -> Float64Array:
        """(h, w, 4) of the sub-frames so far, one pixel of each square."""
        small = Canvas.of_size(self._width, self._height)
        self._add(small, 1.0)
        return small.pixels() / np.float64(done * self._weight)

    def _add_signed(self, done: int) -> None:
        """The sum of sub-frames with their signs, out of the sums of their beginnings: of these count whose last
        sub-frame has another sign than the next."""
        if self._signed is None:
            self._signed = Canvas.of_size(self._width, self._height)
        sign, after = (self._sign(number) for number in (done - 1, done))
        if sign != after:
            self._add(self._signed, sign - after)

    def _sign(self, number: int) -> float:
        """So that the signed mean of all is half of what the halves' means differ by; 0 after the last."""
        if number >= self._samples:
            return 0.0
        signs = SIGNS[: self._samples]
        return (1.0 if signs[number] == "+" else -1.0) * self._samples / (2 * signs.count(signs[number]))

    def _add(self, small: Canvas, weight: float) -> None:
        shader = _thin_shader()
        with drawing_state(blend="ADDITIVE_PREMULT"), small.frame_buffer.bind():
            set_viewport(0, 0, self._width, self._height)
            shader.bind()
            shader.uniform_int("step_size", self._step)
            shader.uniform_float("weight", weight)
            shader.uniform_sampler("picture", self._canvas.texture)
            full_screen_triangle().draw(shader)


def _as_shown(linear: Float64Array) -> Float64Array:
    """By sRGB's curve, 0..1."""
    shown: Float64Array = linear_to_srgb(np.clip(np.nan_to_num(linear), 0.0, 1.0))
    return shown


@gpu_cache
def _thin_shader() -> Any:
    return build_shader(
        "thinned picture",
        FULL_SCREEN,
        Piece(
            samplers={"picture": "FLOAT_2D"},
            constants={"step_size": "INT", "weight": "FLOAT"},
            outputs={"color": "VEC4"},
            fragment="common/thinned.frag.glsl",
        ),
    )
