# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flicker, pops and holes of frames in which they are known by construction."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.study.sequence.flicker import (
    flicker,
    flicker_numbers,
    follow,
    holes,
    pops,
)
from curvrefl.curvrefl_addon.study.sequence.kept import FAILED, Shown
from scenes.sequences.kept_frames import GRAY, HEIGHT, OBJECTS, WIDTH, kept_frame

X, Y = np.meshgrid(np.arange(WIDTH, dtype=float), np.arange(HEIGHT, dtype=float))


def gray(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[..., None], 3, axis=2)


@pytest.mark.parametrize(("shift", "squares"), [((0.0, 0.0), 1.0), ((0.5, 0.5), 0.25), ((0.0, 0.25), 0.625)])
def test_white_noise_has_the_flicker_that_its_deviation_says(shift: tuple[float, float], squares: float) -> None:
    """Of one frame and, between pixels, of the other: sqrt(1 + squared weights) times the deviation."""
    random = np.random.default_rng(5)
    sigma = 0.02
    frames = []
    for frame in (1, 2):
        noisy = 0.5 + gray(random.normal(0.0, sigma, (HEIGHT, WIDTH)))
        frames.append(kept_frame(frame, shift, pictures=(GRAY, noisy, noisy)))
    before, now = frames
    numbers = flicker_numbers(flicker(now, before, follow(now, before), "exact"))
    assert numbers is not None
    deviation = sigma * np.sqrt(1.0 + squares)
    assert numbers["rms"] == pytest.approx(deviation, rel=0.04)
    assert numbers["mean"] == pytest.approx(deviation * np.sqrt(2.0 / np.pi), rel=0.04)
    assert numbers["p95"] == pytest.approx(deviation * 1.96, rel=0.08)


@pytest.mark.parametrize("shift", [(3.0, -2.0), (0.3, 0.7)])
def test_what_moves_as_the_truth_does_not_flicker(shift: tuple[float, float]) -> None:
    """A picture with an error that is fixed to what is seen; between pixels that is a slope, which is linear there."""
    is_whole = shift[0].is_integer()

    def texture(dx: float, dy: float) -> np.ndarray:
        x, y = X + dx, Y + dy
        return gray(0.5 + (0.2 * np.sin(0.9 * x) * np.cos(0.7 * y) if is_whole else 0.002 * x - 0.003 * y))

    def picture(dx: float, dy: float) -> tuple[np.ndarray, ...]:
        right = texture(dx, dy)
        return right, 0.1 + 0.8 * right, right

    before = kept_frame(1, pictures=picture(0.0, 0.0))
    now = kept_frame(2, shift, pictures=picture(*shift))
    followed = follow(now, before)
    assert len(followed.pixel) > 0.8 * WIDTH * HEIGHT
    numbers = flicker_numbers(flicker(now, before, followed, "exact"))
    assert numbers is not None and max(numbers.values()) < 2e-6
    # (Left where it was on the screen it does.)
    stuck = kept_frame(2, shift, pictures=(texture(*shift), texture(0.0, 0.0), GRAY))
    still = flicker_numbers(flicker(stuck, before, followed, "exact"))
    assert still is not None and still["mean"] > 1e-3


def test_what_is_wrong_alike_in_all_frames_does_not_flicker() -> None:
    before, now = (kept_frame(frame, (0.4, 0.2), pictures=(GRAY, GRAY + 0.25, GRAY)) for frame in (1, 2))
    numbers = flicker_numbers(flicker(now, before, follow(now, before), "exact"))
    assert numbers == pytest.approx({"mean": 0.0, "p95": 0.0, "p99": 0.0, "rms": 0.0}, abs=1e-7)


def test_only_what_was_seen_before_is_followed() -> None:
    """Hidden by another object, or by the same one nearer by; beside the picture; in another mirror; unknown."""
    left, low = X < 20, Y < 10
    block = np.where(left, 3, 2).astype(np.int32)
    cases: list[tuple[dict[str, Any], dict[str, Any], np.ndarray]] = [
        ({"object": block, "objects": OBJECTS | {3: "Sheet"}}, {}, ~left),
        ({"distance": np.where(left, 2.0, 3.0).astype(np.float32)}, {}, ~left),
        ({"mask": np.where(low, 2, 1).astype(np.int32)}, {}, ~low),
        ({}, {"place": np.where(low[..., None], np.nan, 0.0).astype(np.float32) * np.ones(2)}, ~low),
        ({}, {"place": np.where(left[..., None], -20.0, 0.0).astype(np.float32) * np.array([1.0, 0.0])}, ~left),
        # The object has another number now.
        ({}, {"objects": {1: "Mirror", 5: "Block"}, "object": np.full((HEIGHT, WIDTH), 5, np.int32)}, X >= 0),
    ]
    for before, now, expected in cases:
        followed = follow(kept_frame(2, **now), kept_frame(1, **before))
        seen = np.zeros(WIDTH * HEIGHT, bool)
        seen[followed.pixel] = True
        np.testing.assert_array_equal(seen.reshape(HEIGHT, WIDTH), expected)


def test_background_is_followed_as_background() -> None:
    nothing = np.zeros((HEIGHT, WIDTH), np.int32)
    endless = np.full((HEIGHT, WIDTH), np.inf, np.float32)
    sky = {"object": nothing, "distance": endless}
    assert len(follow(kept_frame(2, distance_before=endless, **sky), kept_frame(1, **sky)).pixel) == WIDTH * HEIGHT
    assert len(follow(kept_frame(2, distance_before=endless, **sky), kept_frame(1)).pixel) == 0


def test_a_pop_is_what_moves_farther_than_in_truth() -> None:
    """A method that is off by the same vector in both frames has none; one pixel that jumps is found."""
    off = np.full((HEIGHT, WIDTH, 2), 1.5, np.float32)
    objects = np.full((HEIGHT, WIDTH), 2, np.int32)
    before = kept_frame(1, shown={"exact": Shown(objects, off)})
    jumps = off.copy()
    jumps[30, 40] += (3.0, -4.0)
    for shift in ((0.0, 0.0), (0.3, 0.6)):
        steady = kept_frame(2, shift, shown={"exact": Shown(objects, off)})
        found = pops(steady, before, follow(steady, before), "exact")
        assert found is not None and found.largest == pytest.approx(0.0, abs=1e-6)
        now = replace(steady, shown={"exact": Shown(objects, jumps)})
        found = pops(now, before, follow(now, before), "exact")
        assert found is not None and found.largest == pytest.approx(5.0, abs=1e-5) and found.pixel == (40, 30)
    other = objects.copy()
    other[30, 40] = 1
    shows_another = replace(now, shown={"exact": Shown(other, jumps)})
    found = pops(shows_another, before, follow(shows_another, before), "exact")
    assert found is not None and found.largest < 1e-5


def test_holes_are_where_something_is_seen_in_truth() -> None:
    objects = np.full((HEIGHT, WIDTH), 2, np.int32)
    assert holes(kept_frame(), "exact") == 0
    objects[10:13, 20:24] = 0
    objects[30, 30] = FAILED
    objects[0, 0] = 0
    kept = kept_frame(shown={"exact": Shown(objects, np.zeros((HEIGHT, WIDTH, 2), np.float32))})
    # (The picture's corner is an edge.)
    assert holes(kept, "exact") == 13
    empty = kept.object.copy()
    empty[:, 20:] = 0
    assert holes(replace(kept, object=empty), "exact") == 0
