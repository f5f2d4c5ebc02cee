# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of where methods fail: whole on a small scale, and its parts against what they spare themselves."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.renderer.mirrors.screen_maps import ScreenMaps
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.study.solvers import study_reflector
from curvrefl.curvrefl_addon.study.solvers.regimes import make_cases
from curvrefl.curvrefl_addon.study.solvers.solver_table import solver_table, study_view
from curvrefl.curvrefl_addon.study.solvers.study_reflector import StudyReflector
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from curvrefl.curvrefl_addon.study.stability import motion as stability_motion
from curvrefl.curvrefl_addon.study.stability import pictures as stability_pictures
from curvrefl.curvrefl_addon.study.stability import stability
from curvrefl.curvrefl_addon.study.stability.fuzz import fuzz
from curvrefl.curvrefl_addon.study.stability.scenes import trials
from curvrefl.curvrefl_addon.study.stability.stability import format_stability, measure_stability

pytestmark = pytest.mark.usefixtures("gpu")


class Page(HTMLParser):
    """What a page links to, and what is never closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links |= {value for name, value in attrs if name in ("href", "src") and value}
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_whole_on_a_small_scale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = [trial for trial in trials() if trial.name == "hollow mirror"]
    monkeypatch.setattr(stability, "trials", lambda: chosen)
    monkeypatch.setattr(stability_pictures, "SUB_FRAMES", 1)
    monkeypatch.setattr(stability, "MOVING", ("sphere",))
    monkeypatch.setattr(stability, "MOTION_VERTICES", 120)
    small_table = partial(solver_table, reflectors=("sphere",), regimes=("far",), timed=False, only_defaults=True)
    monkeypatch.setattr(stability, "solver_table", small_table)
    monkeypatch.setattr(stability, "fuzz", partial(fuzz, reflectors=("sphere",)))
    told: list[str] = []
    report = measure_stability(tmp_path / "out", 20, 1000, told.append)

    read = json.loads((tmp_path / "out" / "stability.json").read_text())
    assert set(read) == {"blender", "gpu", "seconds", "fuzz", "motion", "refused", "trials"}
    results = read["trials"]["hollow mirror"]["methods"]
    assert list(results) == list(METHODS)
    # Both sides of a bowl: the methods that need a closed mirror say so, and the others are drawn.
    assert {method for method, result in results.items() if result["refusal"]} == {"secant_star", "newton"}
    assert results["exact"]["differs"] == 0.0
    assert results["environment_cube"]["differs"] > 0.1
    page = Page((tmp_path / "out" / "stability.html").read_text())
    assert page.open == []
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert {result["file"] for result in results.values() if result["file"]} <= written & page.links
    assert page.links <= written
    for part in (
        "Drawing hollow mirror: Exact",
        "path of the eye at the sphere",
        "around the sphere: far",
        "Fuzzing the",
    ):
        assert any(part in line for line in told), part
    assert "Took" in format_stability(report)


def test_pictures_of_one_renderer_are_those_of_one_each(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stability_pictures, "SUB_FRAMES", 1)
    trial = next(trial for trial in trials() if trial.name == "contact")
    renderer = Renderer(trial.scene, Settings(method="exact", samples=1))
    try:
        shared = dict(stability_pictures._colors(renderer, trial))
    finally:
        renderer.free()
    for method in ("newton", "bisector_screen", "environment_parallax"):
        alone = Renderer(trial.scene, Settings(method=method, samples=1))
        expected = alone.render(trial.view).color()[..., :3]
        alone.free()
        found = shared[method]
        assert not isinstance(found, str)
        assert np.abs(found - expected).mean() < 1e-4 * expected.mean(), method


def test_vertices_that_nothing_is_known_of_are_followed_no_farther() -> None:
    study = STUDIES["saddle"]
    cases = make_cases(study, "near", 60)
    eyes, vertices = stability_motion._path("objects", cases.eye, cases.vertices)
    oracle = study.oracle()
    found = stability_motion._true_pixels(oracle, eyes, vertices)
    known = np.ones(len(cases.vertices), bool)
    for frame, (eye, here) in enumerate(zip(eyes, vertices, strict=True)):
        points = oracle.reflection_points(eye, here)
        known &= points.counts(len(here)) == 1
        assert np.array_equal(np.isfinite(found[frame, :, 0]), known)
        expected = study_view(eye).project(points.first(len(here))[known])
        assert np.abs(found[frame, known] - expected).max() < 1e-6
    assert 10 < known.sum() < len(known)


def test_screen_maps_are_drawn_once_for_a_view(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    draw: Callable[..., object] = ScreenMaps.draw

    def counted(self: ScreenMaps, *arguments: object) -> object:
        drawn.append(arguments)
        return draw(self, *arguments)

    monkeypatch.setattr(study_reflector.ScreenMaps, "draw", counted)
    reflector = StudyReflector(STUDIES["sphere"])
    cases = make_cases(STUDIES["sphere"], "near", 20)
    settings, view = Settings(method="bisector_screen"), study_view(cases.eye)
    first = reflector.solve("bisector_screen", view, settings, cases.vertices).read()
    turned = study_view(cases.eye * np.array([1.0, -1.0, 1.0, 1.0]))
    reflector.solve("bisector_screen", view, settings, cases.vertices)
    assert len(drawn) == 1
    reflector.solve("bisector_screen", turned, settings, cases.vertices)
    again = reflector.solve("bisector_screen", view, settings, cases.vertices).read()
    assert len(drawn) == 3
    assert all(np.array_equal(one, other) for one, other in zip(first, again, strict=True))


def test_every_method_is_fuzzed_with_the_same() -> None:
    told: list[str] = []
    results = fuzz(20_000, ("sphere", "bowl"), progress=told.append)
    assert len(told) == 2
    assert len({(item.triples, item.invalid) for item in results}) == 1
    assert results[0].triples >= 20_000
    assert fuzz(20_000, ("sphere", "bowl")) == results
