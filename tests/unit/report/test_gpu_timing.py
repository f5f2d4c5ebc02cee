# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of a GPU that waits are dear on, by a clock that the test turns."""

from __future__ import annotations

import pytest
from curvrefl.curvrefl_addon.report import repeats
from curvrefl.curvrefl_addon.study.benchmark import gpu_timing
from curvrefl.curvrefl_addon.study.benchmark.gpu_timing import MOST_AT_ONCE, WORTH, empty_wait, time_on_gpu


class Device:
    """Takes `work` seconds for each thing asked for, `submit` to ask, and `price` to wait."""

    def __init__(self, work: float, submit: float, price: float) -> None:
        self.work, self.submit, self.price = work, submit, price
        self.now = self.done_at = 0.0

    def act(self) -> None:
        self.now += self.submit
        self.done_at = max(self.done_at, self.now) + self.work

    def wait(self) -> None:
        self.now = max(self.now, self.done_at) + self.price


@pytest.fixture
def device(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Device:
    chosen = Device(*request.param)
    for module in (gpu_timing, repeats):
        monkeypatch.setattr(module, "perf_counter", lambda: chosen.now)
    return chosen


@pytest.mark.parametrize("device", [(50e-6, 5e-6, 1e-3), (3e-6, 2e-6, 1e-4), (2.0, 1e-3, 1e-3)], indirect=True)
def test_what_is_shorter_than_a_wait_is_timed_right(device: Device) -> None:
    empty_ms = empty_wait(device.wait)
    assert empty_ms == pytest.approx(1e3 * device.price)
    found = time_on_gpu(device.act, device.wait, empty_ms, 10, 1e9)
    assert 1.0 <= found.timing.median / (1e3 * device.work) <= 1.0 + 1.2 / WORTH
    assert found.submit_ms == pytest.approx(1e3 * device.submit)
    assert len(found.timing.times) == 10
    # No more at once than it takes.
    assert found.at_once == 1 or found.at_once * device.work < 2.0 * WORTH * device.price


@pytest.mark.parametrize("device", [(0.0, 0.0, 1.0)], indirect=True)
def test_what_takes_no_time_ends(device: Device) -> None:
    assert time_on_gpu(device.act, device.wait, 1e3, 3, 1e9).at_once == MOST_AT_ONCE
