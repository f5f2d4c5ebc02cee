# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time against amounts: scenes that differ in that alone, what is measured of them, and the verb on tiny pictures."""

from __future__ import annotations

import csv
from collections.abc import Generator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.study.charts.costs import axes as costs_axes
from curvrefl.curvrefl_addon.study.charts.costs import measured, scenes
from curvrefl.curvrefl_addon.study.charts.costs.axes import AXES, OF_FILES, Axis, Variant, axes_of_file, doubled
from curvrefl.curvrefl_addon.study.charts.costs.chart import costs_chart_steps
from curvrefl.curvrefl_addon.study.charts.costs.measured import cost_steps, step_count
from curvrefl.curvrefl_addon.study.charts.costs.scenes import triangles_of
from small_scene import saved

SIZE = (64, 48)
FILES = ["costs.csv", "costs.png", "costs.svg"]

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Triangles, and frames of each method."""
    monkeypatch.setattr(scenes, "TRIANGLES", 2000)
    monkeypatch.setattr(measured, "TURNS", 1)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def mask_of(variant: Variant) -> np.ndarray:
    renderer = Renderer(variant.arrays, Settings(method="exact", samples=1))
    try:
        return renderer.render(variant.view).mask()
    finally:
        renderer.free()


def amounts_of(scene: SceneArrays) -> dict[str, float]:
    """What an axis may vary, as it is in a scene."""
    used = {index for instance in scene.instances for index in instance.materials}
    programs = [scene.materials[index].program for index in used]
    return {
        "triangles": triangles_of(scene),
        "lights": len(scene.lights),
        "images": sum(program is not None for program in programs),
        "image-size": max((image.width * image.height for image in scene.images), default=0),
        "mirrors": len(scene.reflectors),
    }


@pytest.mark.parametrize("name", ["triangles", "lights", "images", "image-size", "mirrors"])
def test_scenes_along_an_axis_differ_in_its_amount_alone(name: str) -> None:
    first, last = (AXES[name].build(value, SIZE) for value in AXES[name].values[1:3])
    before, after = amounts_of(first.arrays), amounts_of(last.arrays)
    assert (before.pop(name), after.pop(name)) == (first.amount, last.amount)
    assert first.amount is not None and last.amount is not None and first.amount < last.amount
    if name == "images":
        before.pop("image-size"), after.pop("image-size")
    assert before == after


def test_all_triangles_are_near_what_is_asked_for() -> None:
    for value in AXES["triangles"].values[:4]:
        assert AXES["triangles"].build(value, SIZE).amount == pytest.approx(value, rel=0.35)


def test_many_mirrors_take_the_pixels_of_one() -> None:
    pixels = [np.count_nonzero(mask_of(AXES["mirrors"].build(count, SIZE))) for count in (1, 4, 16)]
    assert pixels[0] > 200
    assert pixels[1:] == pytest.approx([pixels[0]] * 2, rel=0.1)


def test_pixels_are_counted_in_the_picture() -> None:
    small, large = (AXES["pixels"].build(scale, SIZE) for scale in (0.5, 1.0))
    assert (small.view.width, small.view.height, small.amount) == (32, 24, None)
    counts = [np.count_nonzero(mask_of(variant)) for variant in (small, large)]
    assert counts[1] == pytest.approx(4 * counts[0], rel=0.1)
    (cost,), _ = taken(cost_steps([replace(AXES["pixels"], values=(0.5, 1.0))], ["exact"], SIZE))
    assert cost.amounts == tuple(counts)


def test_more_bounces_show_more() -> None:
    """Each number of those charted, until mirrors that show each other end."""
    axis = AXES["bounces"]
    pictures = []
    for value in axis.values[:3]:
        variant = axis.build(value, SIZE)
        assert variant.bounces == variant.amount == value
        renderer = Renderer(variant.arrays, Settings(method="exact", samples=1, bounces=variant.bounces))
        pictures.append(renderer.render(variant.view).color())
        renderer.free()
    for few, more in pairwise(pictures):
        assert (np.abs(few - more).max(axis=-1) > 0.01).mean() > 0.02


def taken(steps: Generator[str, None, Any]) -> Any:
    """What a generator returns."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def test_methods_that_cannot_are_left_out_with_the_reason() -> None:
    """The UV search has no UV map in our scenes, and what solves vertices shows no mirror in another."""
    axes = [replace(AXES["lights"], values=(1, 2)), replace(AXES["bounces"], values=(1, 2))]
    labels = []
    steps = cost_steps(axes, ["exact", "secant_uv", "newton"], SIZE)
    while True:
        try:
            labels.append(next(steps))
        except StopIteration as end:
            costs, _warnings = end.value
            break
    assert labels == [
        "lights 1",
        "lights 2",
        "lights 2",
        "lights 1",
        "bounces 1",
        "bounces 2",
        "bounces 2",
        "bounces 1",
    ]
    assert len(labels) == step_count(axes)
    found = {(cost.axis, cost.method): cost for cost in costs}
    assert "UV map" in found["lights", "secant_uv"].reason and found["lights", "secant_uv"].amounts == ()
    assert found["bounces", "newton"].reason == costs_axes.ONE_MIRROR
    for key in (("lights", "exact"), ("lights", "newton"), ("bounces", "exact")):
        assert found[key].amounts == (1, 2) and found[key].reason == ""
        assert [len(timing.times) for timing in found[key].timings] == [2 * measured.TURNS] * 2


def test_renderers_are_freed_where_one_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    freed = []

    class Failing(Renderer):
        def render(self, *arguments: Any, **named: Any) -> Any:
            if self.settings.method == "newton":
                raise RuntimeError("the device is gone")
            return super().render(*arguments, **named)

        def free(self) -> None:
            freed.append(self.settings.method)
            super().free()

    monkeypatch.setattr(measured, "Renderer", Failing)
    with pytest.raises(RuntimeError, match="gone"):
        taken(cost_steps([replace(AXES["lights"], values=(1, 2))], ["exact", "newton"], SIZE))
    assert sorted(freed) == ["exact", "newton"]


def test_the_verb_charts_scenes_of_its_own(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("triangles", "lights"):
        monkeypatch.setitem(AXES, name, replace(AXES[name], values=AXES[name].values[:2]))
    output = tmp_path / "out"
    capfd.readouterr()
    arguments = ("--against", "lights,triangles", "--method", "exact,environment_cube", "--resolution", "64x48")
    assert cli.main(["chart", *arguments, "--output", str(output)]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert sorted(path.name for path in output.iterdir()) == FILES
    assert "point lamps with shadows" in out and "slope" in out and "100 %  Wrote" in out
    found = table(output / "costs.csv")
    assert [(row["axis"], row["method"]) for row in found[::2]] == [
        (axis, method) for axis in ("lights", "triangles") for method in ("exact", "environment_cube")
    ]
    assert [float(row["amount"]) for row in found[:4]] == [1.0, 2.0, 1.0, 2.0]
    assert [float(row["amount"]) for row in found[4:]] == pytest.approx([1e3, 4e3] * 2, rel=0.35)
    for row in found:
        assert float(row["frame_ms_q1"]) <= float(row["frame_ms"]) <= float(row["frame_ms_q3"])
        assert float(row["slope_q1"]) <= float(row["slope"]) <= float(row["slope_q3"])


def light_up(_ball: bpy.types.Object) -> None:
    for number in range(3):
        lamp = bpy.data.objects.new(f"Lamp {number}", bpy.data.lights.new("Lamp", "POINT"))
        lamp.location = (3.0 - number, -3.0, 3.0)
        bpy.context.scene.collection.objects.link(lamp)


def test_the_verb_charts_a_files_scene(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """With `all`, what there are two of."""
    file, output = saved(tmp_path, light_up), tmp_path / "out"
    capfd.readouterr()
    arguments = ("--reflector", "Mirror Ball", "--against", "all", "--method", "exact")
    assert cli.main(["chart", str(file), *arguments, "--output", str(output)]) == 0
    assert "Warning" not in capfd.readouterr().err
    found = table(output / "costs.csv")
    assert list(dict.fromkeys(row["axis"] for row in found)) == ["pixels", "lights", "bounces"]
    assert [float(row["amount"]) for row in found if row["axis"] == "lights"] == [1.0, 2.0, 3.0]
    pixels = [float(row["amount"]) for row in found if row["axis"] == "pixels"]
    assert pixels == sorted(pixels) and pixels[-1] == pytest.approx(4.0 * pixels[-3], rel=0.1)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--against", "triangles"), "triangles"),
        (("--against", "lights"), "too few lights"),
        (("--against", "pixels", "--reflector", "Mirror Bal"), "Mirror Ball"),
        (("--against", "pixels", "--method", "magic"), "magic"),
        (("--against", "pixels"), "No mirror is in view"),
    ],
)
def test_what_is_refused_leaves_nothing(
    arguments: tuple[str, ...], named: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def look_away(_ball: bpy.types.Object) -> None:
        bpy.data.objects["Eye"].rotation_euler = (np.pi / 2.0, 0.0, np.pi)

    file = saved(tmp_path, look_away)
    capfd.readouterr()
    given = ("--reflector", "Mirror Ball", *arguments)
    assert cli.main(["chart", str(file), *given, "--output", str(tmp_path / "out")]) == 2
    err = capfd.readouterr().err
    assert named in err and err.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["files"]


def test_closing_between_two_steps_leaves_nothing(tmp_path: Path) -> None:
    axis = replace(AXES["lights"], values=(1, 2))
    steps = costs_chart_steps([axis], ["exact"], SIZE, "", tmp_path / "out")
    assert [next(steps).label for _ in range(3)] == ["lights 1", "lights 2", "lights 2"]
    steps.close()
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_varied_by_less_of_what_it_has() -> None:
    variant = AXES["mirrors"].build(4, SIZE)
    lit = replace(variant.arrays, lights=AXES["lights"].build(2, SIZE).arrays.lights)
    axes: dict[str, Axis] = {axis.name: axis for axis in axes_of_file(["all"], lit, variant.view)}
    assert tuple(axes) == OF_FILES
    assert axes["mirrors"].values == (1, 2, 4) and axes["lights"].values == (1, 2)
    assert axes["mirrors"].build(2, SIZE).arrays.reflectors == variant.arrays.reflectors[:2]
    assert axes["lights"].build(1, SIZE).arrays.lights == lit.lights[:1]
    assert axes["pixels"].build(2.0, SIZE).view.width == 128
    with pytest.raises(InputError, match="too few lights"):
        axes_of_file(["lights"], variant.arrays, variant.view)
    assert [doubled(most) for most in (2, 3, 4, 9)] == [(1, 2), (1, 2, 3), (1, 2, 4), (1, 2, 4, 8, 9)]
