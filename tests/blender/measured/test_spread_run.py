# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that is spread over redraws: a slice each, the GPU's state as it was, and no error gets out."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from curvrefl.curvrefl_addon.renderer.measured.spread_run import SpreadRun, Task

pytestmark = pytest.mark.usefixtures("gpu")


def noting(seen: list[str], name: str, slices: int) -> Task:
    def work() -> Iterator[None]:
        try:
            for number in range(slices):
                seen.append(f"{name}{number}")
                yield
        finally:
            seen.append(f"{name} freed")

    return Task(f"Doing {name}", work)


def test_tasks_are_done_one_after_the_other_a_slice_each() -> None:
    seen: list[str] = []
    run = SpreadRun([noting(seen, "a", 2), noting(seen, "b", 1)])
    assert seen == [], "nothing before it is advanced"
    steps = []
    while not run.is_done:
        label = run.label
        run.advance()
        steps.append((label, len(seen)))
    assert seen == ["a0", "a1", "a freed", "b0", "b freed"]
    assert steps == [("Doing a", 1), ("Doing a", 2), ("Doing a", 3), ("Doing b", 4), ("Doing b", 5)]
    assert (run.slices, run.failure, run.label) == (5, "", "")
    run.advance()
    assert run.slices == 5


def test_a_failure_ends_the_run_and_is_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    seen: list[str] = []

    def fails() -> Iterator[None]:
        yield
        raise RuntimeError("the driver has gone away.")

    run = SpreadRun([Task("Measuring", fails), noting(seen, "b", 1)])
    run.finish()
    assert run.is_done and seen == []
    assert run.failure == "Measuring has failed: the driver has gone away."
    assert "RuntimeError" in capsys.readouterr().err


def test_canceling_frees_what_was_made_and_leaves_the_rest() -> None:
    seen: list[str] = []
    run = SpreadRun([noting(seen, "a", 9), noting(seen, "b", 1)])
    run.advance()
    run.cancel()
    run.advance()
    assert run.is_done and seen == ["a0", "a freed"]
    # (Before its first slice there is nothing to free.)
    SpreadRun([noting(seen, "c", 1)]).cancel()
    assert seen == ["a0", "a freed"]


@pytest.mark.parametrize("ending", ["yield", "return", "error", "cancel"])
def test_the_state_is_as_it_was(ending: str) -> None:
    import gpu

    def unruly() -> Iterator[None]:
        try:
            gpu.state.blend_set("ADDITIVE")
            gpu.state.depth_test_set("ALWAYS")
            gpu.state.depth_mask_set(True)
            if ending in ("yield", "cancel"):
                yield
            if ending == "error":
                raise RuntimeError("for a reason")
        finally:
            gpu.state.blend_set("MULTIPLY")

    def state() -> tuple[object, ...]:
        return gpu.state.blend_get(), gpu.state.depth_test_get(), gpu.state.depth_mask_get()

    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(False)
    before = state()
    try:
        run = SpreadRun([Task("Setting the state", unruly)])
        run.advance()
        assert state() == before
        act: Callable[[], None] = run.cancel if ending == "cancel" else run.finish
        act()
        assert state() == before and run.is_done
    finally:
        gpu.state.blend_set("NONE")
        gpu.state.depth_test_set("NONE")
