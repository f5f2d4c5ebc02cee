# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring the device: made-up times give the costs that they are made of; nothing of it shows, nothing is left.

No test looks at how long anything really takes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.costs.table import Costs
from curvrefl.curvrefl_addon.renderer.device import frame_buffers, textures
from curvrefl.curvrefl_addon.renderer.measured import timing, unit_costs
from curvrefl.curvrefl_addon.renderer.measured.hall_passes import HallPasses
from curvrefl.curvrefl_addon.renderer.measured.spread_run import SpreadRun, Task
from curvrefl.curvrefl_addon.renderer.measured.timing import Stopwatch
from curvrefl.curvrefl_addon.renderer.measured.unit_costs import measure_costs
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.vertices.solve import PreparedSolve

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """As little work as there can be."""
    for name, value in (("MANY", 1600), ("SIZES", (64,)), ("TRIANGLES", (200, 800)), ("POINTS", (256, 512))):
        monkeypatch.setattr(unit_costs, name, value)
    monkeypatch.setattr(timing, "MOST_AT_ONCE", 1)
    monkeypatch.setattr(timing, "REPEATS", 2)


class Clock:
    """Goes on only by what is done."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def __call__(self) -> float:
        return self.seconds

    def spend(self, microseconds: float) -> None:
        self.seconds += 1e-6 * microseconds


def run_through(clock: Clock | None = None) -> list[tuple[Costs, float]]:
    found: list[tuple[Costs, float]] = []
    run = SpreadRun([Task("Measuring", lambda: measure_costs(lambda costs, unrest: found.append((costs, unrest))))])
    run.finish()
    assert run.failure == ""
    return found


def spending(monkeypatch: pytest.MonkeyPatch, owner: type, name: str, spend: Callable[..., None]) -> None:
    """Let a method take made-up time."""
    real = getattr(owner, name)

    def method(self: Any, *arguments: Any, **keywords: Any) -> Any:
        result = real(self, *arguments, **keywords)
        spend(self, *arguments)
        return result

    monkeypatch.setattr(owner, name, method)


@pytest.mark.parametrize("speed", [1.0, 100.0])
def test_made_up_times_give_the_costs_they_are_made_of(
    small: None, monkeypatch: pytest.MonkeyPatch, speed: float
) -> None:
    """Passes take what a device of these costs would take them, and something for being asked for at all."""
    wanted = Costs(
        pixel_by_ray=2.0,
        pixel_by_ray_per_doubling=0.5,
        layer_drawn=0.7,
        pixel_cleared=0.3,
        triangle_drawn=0.9,
        vertex_solved=3.0,
        edges_asked=1.5,
        solve_begun=0.0,
        pixel_shaded=4.0,
    )
    clock = Clock()
    monkeypatch.setattr(timing, "perf_counter", clock)
    asked = {"walk": 50.0, "draw": 90.0, "solve": 400.0, "rest": 500.0, "see": 20.0}

    def pixels(one: HallPasses) -> float:
        """Of the mirror, whose share of a picture is taken as the same at every size."""
        if "share" not in shares:
            shares["share"] = one.mirror_pixels() / one.size**2
        return shares["share"] * one.size**2

    shares: dict[str, float] = {}

    def walk(one: HallPasses) -> None:
        each = wanted.pixel_by_ray + wanted.pixel_by_ray_per_doubling * np.log2(one.triangles)
        clock.spend((asked["walk"] + each * pixels(one)) / speed)

    def draw(one: HallPasses, parts: Any, window: Any = None) -> None:
        triangles = sum(len(part.chunk.triangles) for part in parts)
        layers = one.layers * pixels(one) if window is None else 0.0
        clock.spend((asked["draw"] + wanted.triangle_drawn * triangles + wanted.layer_drawn * layers) / speed)

    spending(monkeypatch, HallPasses, "see", lambda _one: clock.spend(asked["see"] / speed))
    spending(monkeypatch, HallPasses, "walk", walk)
    spending(monkeypatch, HallPasses, "draw", draw)
    spending(
        monkeypatch,
        HallPasses,
        "clear",
        lambda one, _parts: clock.spend(wanted.pixel_cleared * one.size**2 / speed),
    )
    spending(
        monkeypatch,
        PreparedSolve,
        "run",
        lambda solve: clock.spend((30.0 + wanted.vertex_solved * solve.solution.count) / speed),
    )
    real_reflect = Renderer.reflect

    def solved(self: Renderer, *arguments: Any, at_rest: bool = False, **keywords: Any) -> Any:
        before = clock.seconds
        found = real_reflect(self, *arguments, at_rest=at_rest, **keywords)
        clock.seconds = before
        count = sum(solution.count for solution in found.solutions)
        each = wanted.vertex_solved + (wanted.edges_asked if at_rest else 0.0)
        clock.spend((asked["rest" if at_rest else "solve"] + each * count) / speed)
        return found

    monkeypatch.setattr(Renderer, "reflect", solved)
    halls: list[HallPasses] = []
    spending(monkeypatch, HallPasses, "look", lambda one, _size: halls.append(one))

    def frame(_renderer: Renderer, *_arguments: Any) -> None:
        one = halls[-1]
        each = wanted.pixel_by_ray + wanted.pixel_by_ray_per_doubling * np.log2(one.triangles)
        clock.spend((asked["see"] + asked["walk"] + (each + wanted.pixel_shaded) * pixels(one)) / speed)

    spending(monkeypatch, Renderer, "add_sub_frame", frame)
    ((found, unrest),) = run_through()
    assert unrest == pytest.approx(1.0)
    expected = {name: cost / speed for name, cost in asdict(wanted).items()}
    # Solving and drawing begin with more than rays do; what their pictures of a few pixels take is not told from that.
    expected["solve_begun"] = (asked["solve"] + asked["draw"] - asked["walk"]) / speed
    few_pixels = 32**2 * 5.0 / speed
    for name, cost in asdict(found).items():
        if name == "solve_begun":
            assert abs(cost - expected[name]) < few_pixels, name
        else:
            assert cost == pytest.approx(expected[name], rel=0.05), name


def test_a_measuring_run_does_not_show_and_leaves_nothing(small: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is drawn to meanwhile, pixel for pixel."""
    freed: list[Renderer] = []
    spending(monkeypatch, Renderer, "free", freed.append)
    color, depth = textures.empty_texture(40, 30), textures.depth_texture(40, 30)
    target = frame_buffers.frame_buffer(color, depth=depth)
    found: list[Costs] = []
    run = SpreadRun([Task("Measuring", lambda: measure_costs(lambda costs, _unrest: found.append(costs)))])
    with target.bind():
        target.clear(color=(0.1, 0.2, 0.3, 0.4), depth=0.5)
        while not run.is_done:
            run.advance()
        seen = frame_buffers.read_colors(frame_buffers.active_frame_buffer(), 40, 30)
    assert run.failure == "" and len(found) == 1
    np.testing.assert_allclose(seen, np.broadcast_to([0.1, 0.2, 0.3, 0.4], seen.shape), atol=1e-6)
    np.testing.assert_array_equal(textures.read_texture(depth, 1), 0.5)
    assert len(freed) == 2


@pytest.mark.parametrize("slices", [1, 2, 6, 12])
def test_a_run_that_is_canceled_leaves_nothing(small: None, monkeypatch: pytest.MonkeyPatch, slices: int) -> None:
    made: list[Renderer] = []
    freed: list[Renderer] = []
    spending(monkeypatch, HallPasses, "__init__", lambda one, _count: made.append(one.renderer))
    spending(monkeypatch, Renderer, "free", freed.append)
    found: list[Costs] = []
    run = SpreadRun([Task("Measuring", lambda: measure_costs(lambda costs, _unrest: found.append(costs)))])
    for _ in range(slices):
        run.advance()
    run.cancel()
    assert not found
    assert sorted(map(id, freed)) == sorted(map(id, made))


def test_the_stopwatch_takes_the_least_and_tells_unrest(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(timing, "perf_counter", clock)
    monkeypatch.setattr(timing, "REPEATS", 5)

    def measured(times: list[float]) -> tuple[float, float]:
        """Milliseconds of each `act` in turn; the last one again and again."""
        watch, left = Stopwatch(), list(times)
        running = watch.best_ms(lambda: clock.spend(1e3 * (left.pop(0) if len(left) > 1 else left[0])), lambda: None)
        while True:
            try:
                next(running)
            except StopIteration as end:
                return end.value, watch.unrest

    # (The first does not count.)
    assert measured([90.0, 20.0, 30.0, 10.0, 40.0, 20.0]) == (pytest.approx(10.0), pytest.approx(2.0))
    assert measured([7.0]) == (pytest.approx(7.0), pytest.approx(1.0))
    # What takes little is asked for many times at once, and for each it is the same.
    assert measured([0.01])[0] == pytest.approx(0.01)
