# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that is spread over redraws: a slice each, the GPU's state as it was, and no error gets out."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, compiled
from curvrefl.curvrefl_addon.renderer.measured import spread_run
from curvrefl.curvrefl_addon.renderer.measured.spread_run import SpreadRun, Task
from curvrefl.gpu_shaders.loader import Snippet

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def every_yield_ends_a_slice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spread_run, "LEAST_SECONDS", 0.0)


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


def test_a_slice_goes_on_until_there_was_something_in_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spread_run, "LEAST_SECONDS", 1e9)
    seen: list[str] = []
    run = SpreadRun([noting(seen, "a", 3), noting(seen, "b", 2)])
    run.advance()
    assert run.is_done and run.slices == 1
    assert seen == ["a0", "a1", "a2", "a freed", "b0", "b1", "b freed"]


def test_a_shader_compiles_in_each_slice() -> None:
    """What needs three is begun three times; without `compiled` all compile at once."""
    made: dict[int, object] = {}
    begun: list[int] = []

    def needs_three() -> int:
        begun.append(len(made))
        for number in range(3):
            if number not in made:
                text = f"void main() {{ color = vec4({number}.0); }}"
                piece = Piece(outputs={"color": "VEC4"}, fragment=Snippet("color", text))
                made[number] = build_shader(f"color {number}", FULL_SCREEN, piece)
        return len(made)

    seen: list[int] = []

    def work() -> Iterator[None]:
        seen.append((yield from compiled(needs_three)))

    run = SpreadRun([Task("Compiling", work)])
    counts = []
    while not run.is_done:
        run.advance()
        counts.append(len(made))
    assert run.failure == "" and seen == [3]
    assert counts == [1, 2, 3] and begun == [0, 1, 2]
    made.clear()
    assert needs_three() == 3
