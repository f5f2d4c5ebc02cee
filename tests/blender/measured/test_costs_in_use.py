# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`auto` counts with the costs of the device: made-up ones, and what it does then."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.choice import RAYS, VERTICES, Choice
from curvrefl.curvrefl_addon.renderer.costs import model
from curvrefl.curvrefl_addon.renderer.costs.table import SHIPPED, Costs, costs_in_use, use_costs
from curvrefl.curvrefl_addon.renderer.measured.hall import hall, view_of_mirror
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings

pytestmark = pytest.mark.usefixtures("gpu")
SOLVING = ("layer_drawn", "pixel_cleared", "triangle_drawn", "vertex_solved", "solve_begun")
SMALL, LARGE = view_of_mirror(320, 240, 100), view_of_mirror(1280, 960, 1150)


@pytest.fixture(autouse=True)
def shipped_before_and_after() -> Iterator[None]:
    assert costs_in_use() == SHIPPED
    yield
    use_costs(SHIPPED)


@pytest.fixture(scope="module")
def renderer(gpu: None) -> Iterator[Renderer]:
    made = Renderer(hall(400), Settings(method="auto", samples=1))
    yield made
    made.free()


def choice(renderer: Renderer, costs: Costs, view: object = SMALL, is_still: bool = False) -> Choice:
    use_costs(costs)
    found = renderer.reflect(view, is_still=is_still).choice
    assert found is not None
    return found


def test_the_choice_follows_the_costs(renderer: Renderer) -> None:
    """A device that solves for nothing, and one that follows rays for nothing: the other way round for both views."""
    assert choice(renderer, SHIPPED, SMALL).methods == (RAYS,)
    assert choice(renderer, SHIPPED, LARGE).methods == (VERTICES,)
    free = dict.fromkeys(SOLVING, 0.0)
    assert choice(renderer, replace(SHIPPED, **free), SMALL).methods == (VERTICES,)
    quick = replace(SHIPPED, pixel_by_ray=1e-6, pixel_by_ray_per_doubling=1e-6)
    assert choice(renderer, quick, LARGE).methods == (RAYS,)


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_only_proportions_count(renderer: Renderer, factor: float) -> None:
    scaled = Costs(**{name: factor * getattr(SHIPPED, name) for name in SHIPPED.__slots__})
    for view in (SMALL, LARGE):
        assert choice(renderer, scaled, view).why == choice(renderer, SHIPPED, view).why


@pytest.mark.parametrize(
    ("name", "is_still"),
    [
        ("layer_drawn", False),
        ("pixel_cleared", False),
        ("triangle_drawn", False),
        ("vertex_solved", False),
        ("solve_begun", False),
        ("edges_asked", True),
    ],
)
def test_each_cost_of_solving_counts(renderer: Renderer, name: str, is_still: bool) -> None:
    """Where it is immense, rays are followed; edges are asked about in stills alone."""
    immense = replace(SHIPPED, **{name: 1e6})
    assert choice(renderer, SHIPPED, LARGE).methods == (VERTICES,)
    assert choice(renderer, immense, LARGE, is_still).methods == (RAYS,)
    if is_still:
        assert choice(renderer, immense, LARGE).methods == (VERTICES,)


def test_a_clear_choice_looks_at_no_pixel(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where solving costs more even if the mirror filled its window, which most views tell at once."""
    counted: list[float] = []
    real = model.mirror_pixels

    def count(*arguments: Any) -> float:
        counted.append(real(*arguments))
        return counted[-1]

    monkeypatch.setattr(model, "mirror_pixels", count)
    clear = choice(renderer, SHIPPED, SMALL)
    assert clear.methods == (RAYS,) and not counted and "cost at least" in clear.why
    assert choice(renderer, SHIPPED, LARGE).methods == (VERTICES,) and len(counted) == 1
    # It is the same choice as with all pixels counted, also where that is close.
    window = renderer.mirrors[0].window(SMALL)
    for factor in np.geomspace(0.002, 2.0, 25):
        costs = replace(SHIPPED, **{name: factor * getattr(SHIPPED, name) for name in SOLVING})
        chosen = choice(renderer, costs, SMALL)
        with monkeypatch.context() as patched:
            patched.setattr(Mirror, "window", lambda _mirror, view: (0, 0, view.width << 10, view.height))
            patched.setattr(model, "mirror_pixels", lambda *arguments: real(*arguments[:3], window))
            assert choice(renderer, costs, SMALL).methods == chosen.methods
    assert 1 < len(counted) < 26


def test_shading_counts_for_no_choice(renderer: Renderer) -> None:
    for cost in (0.0, 1e6):
        assert choice(renderer, replace(SHIPPED, pixel_shaded=cost), SMALL).why == choice(renderer, SHIPPED).why
