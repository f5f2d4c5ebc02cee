# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator: what the user selects and names reaches the comparison, and its results reach the user."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.renderer.device.context import GpuUnavailableError
from curvrefl.curvrefl_addon.report import compare
from curvrefl.curvrefl_addon.report.images import save_png
from curvrefl.curvrefl_addon.study.charts import chart
from curvrefl.operators.compare_with_cycles import TEXT_NAME, CURVREFL_OT_compare_with_cycles


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[list[dict[str, Any]]]:
    """The registered operator in a saved scene with two meshes; comparisons are recorded and make gray pictures."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for name in ("ball", "floor"):
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.object.name = name
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    recorded: list[dict[str, Any]] = []

    def record(
        _scene: Any, _layer: Any, reflectors: list[str], comparison: compare.Comparison, output: Path
    ) -> dict[str, Any]:
        recorded.append({"reflectors": reflectors, "comparison": comparison, "output": output})
        output.mkdir(exist_ok=True)
        for name in ("reference", "secant_star", "secant_star_error", *comparison.peers):
            save_png(output / f"{name}.png", np.full((3, 4, 3), 0.1 * len(recorded), np.float32))
        image = {"flip": 0.125, "psnr": 30.0}
        times = {"extract": 1.0, "bake": 1.0, "solve": 1.0, "draw": 1.0, "frame": 2.0}
        angle = {"median": 0.1, "p95": 0.2, "p99": 0.3}
        solve = {"vertices": 1, "reflected": 1, "hidden": 0, "unconverged": 0}
        return {
            "scene": "a.blend",
            "reflectors": reflectors,
            "resolution": [4, 3],
            "reference": {"engine": "CYCLES", "samples": 1, "light": comparison.light, "time_s": 1.0},
            "mask_pixels": 12,
            "methods": {
                "secant_star": {
                    "image": image,
                    "geometry": {"angle_deg": angle, "wrong_object": 0.0},
                    "time_ms": times,
                    "solve": solve,
                }
            },
            "peers": {peer: {"image": image, "time_ms": 3.0} for peer in comparison.peers},
        }

    monkeypatch.setattr(compare, "compare_open_scene", record)
    registration.register()
    yield recorded
    registration.unregister()


def select(*names: str) -> None:
    for obj in bpy.context.scene.objects:
        obj.select_set(obj.name in names)


def test_selected_meshes_are_the_reflectors(calls: list[dict[str, Any]], tmp_path: Path) -> None:
    select("floor", "camera")
    assert bpy.ops.curvrefl.compare_with_cycles(width=40, height=30, samples=9, light="full") == {"FINISHED"}
    assert calls[0]["reflectors"] == ["floor"]
    assert calls[0]["output"] == tmp_path / "curvrefl_comparison"
    comparison = calls[0]["comparison"]
    assert (comparison.width, comparison.height, comparison.samples, comparison.light) == (40, 30, 9, "full")
    assert comparison.peers == ("eevee",)


def test_named_reflectors_and_chosen_methods(calls: list[dict[str, Any]]) -> None:
    select()
    bpy.ops.curvrefl.compare_with_cycles(reflectors="ball, floor", methods={"secant_star"}, peers={"cycles8", "eevee"})
    assert calls[0]["reflectors"] == ["ball", "floor"]
    assert calls[0]["comparison"].methods == ("secant_star",)
    assert calls[0]["comparison"].peers == ("eevee", "cycles8")


def test_pictures_and_table_are_shown_and_replaced(calls: list[dict[str, Any]]) -> None:
    select("ball")
    names = {f"Curvrefl {name}" for name in ("reference", "secant_star", "secant_star_error", "eevee")}
    for _ in range(2):
        bpy.ops.curvrefl.compare_with_cycles()
        assert {image.name for image in bpy.data.images if image.name.startswith("Curvrefl")} == names
    shown = bpy.data.images["Curvrefl secant_star"]
    assert tuple(shown.size) == (4, 3)
    assert shown.pixels[0] == pytest.approx(124 / 255, abs=1e-6), "the second run's 0.2, as the screen shows it"
    text = bpy.data.texts[TEXT_NAME].as_string()
    assert text.count("0.1250") == 2 and "report.html" in text


def test_user_mistakes_are_reported(calls: list[dict[str, Any]]) -> None:
    select()
    with pytest.raises(RuntimeError, match="select a mesh"):
        bpy.ops.curvrefl.compare_with_cycles()
    select("ball")
    with pytest.raises(RuntimeError, match="Choose a folder"):
        bpy.ops.curvrefl.compare_with_cycles(output="")
    bpy.context.scene.camera = None
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvrefl.compare_with_cycles()
    assert calls == []


@pytest.mark.parametrize("every_setting", [False, True])
def test_no_gpu_is_one_sentence(
    calls: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch, every_setting: bool
) -> None:
    def refuse(*_arguments: Any) -> None:
        raise GpuUnavailableError("no OpenGL 4.3 context could be made: install a GPU driver")

    monkeypatch.setattr(compare, "compare_open_scene", refuse)
    monkeypatch.setattr(chart, "chart_open_scene", refuse)
    select("ball")
    with pytest.raises(RuntimeError) as raised:
        bpy.ops.curvrefl.compare_with_cycles(every_setting=every_setting)
    assert str(raised.value).strip() == "Error: no OpenGL 4.3 context could be made: install a GPU driver"


def test_a_gpu_that_is_not_there_ends_the_steps(calls: list[dict[str, Any]]) -> None:
    """In a window a comparison goes in steps: the one that reaches the GPU says so, and the scene is put back."""
    told: list[Any] = []

    def steps() -> Iterator[None]:
        raise GpuUnavailableError("no GPU: install a driver")
        yield

    operator = SimpleNamespace(
        _steps=steps(),
        _clear=lambda _context: told.append("cleared"),
        report=lambda kind, message: told.append((kind, message)),
    )
    operator._stop = lambda *arguments: CURVREFL_OT_compare_with_cycles._stop(operator, *arguments)
    assert CURVREFL_OT_compare_with_cycles._take_step(operator, bpy.context) == {"CANCELLED"}
    assert told == ["cleared", ({"ERROR"}, "no GPU: install a driver")]
