# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `chart` on a tiny scene, its numbers, and what it refuses."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.compare import Comparison
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene
from curvrefl.curvrefl_addon.study.charts import chart_data
from curvrefl.curvrefl_addon.study.charts.chart import chart_open_scene, open_scene_steps
from curvrefl.curvrefl_addon.study.charts.vertex_count import shell_positions
from curvrefl.curvrefl_addon.study.solvers.vertex_accuracy import VertexTruth
from curvrefl.operators.compare_with_cycles import TEXT_NAME
from small_scene import build_scene, saved

BALL = ("--reflector", "Mirror Ball")
QUICK = ("--resolution", "64x48", "--samples", "2", "--vertices", "3000")
FILES = ["chart.csv", "chart.png", "chart.svg", "vertex_count.csv", "vertex_count.png", "vertex_count.svg"]

pytestmark = pytest.mark.usefixtures("gpu")


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_charts_of_a_scene(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The UV method is refused by the ball, which has no UV map: that is said, and the rest is charted."""
    file, output = saved(tmp_path, lambda ball: ball.data.uv_layers.remove(ball.data.uv_layers[0])), tmp_path / "out"
    capfd.readouterr()
    methods = ("--method", "secant_star,secant_uv,environment_cube", "--peers", "cycles1")
    assert cli.main(["chart", str(file), *BALL, *QUICK, *methods, "--output", str(output)]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert sorted(path.name for path in output.iterdir()) == FILES
    shares = [int(share) for share in re.findall(r"^ *(\d+) %  ", out, re.MULTILINE)]
    assert shares == sorted(shares) and shares[0] == 0 and shares[-1] == 100 and len(shares) > 15
    assert "secant_uv is left out" in out

    marks = table(output / "chart.csv")
    assert {row["scene"] for row in marks} == {"scene"}
    star = [row for row in marks if row["name"] == "secant_star"]
    cube = [row for row in marks if row["name"] == "environment_cube"]
    (refused,) = [row for row in marks if row["name"] == "secant_uv"]
    (cycles,) = [row for row in marks if row["kind"] == "peer"]
    assert "UV map" in refused["reason"] and refused["frame_ms"] == ""
    assert [row["is_default"] for row in star].count("True") == 1
    for row in [*star, *cube, cycles]:
        assert float(row["frame_ms_q1"]) <= float(row["frame_ms"]) <= float(row["frame_ms_q3"])
        assert 0.0 < float(row["flip"]) < 1.0
    assert {row["frame_ms_repeats"] for row in star + cube} == {"4"}, "two rounds of two"
    for row in star:
        assert all(math.isfinite(float(row[name])) for name in ("angle_p95_deg", "wrong_object", "vertex_max_px"))
        assert float(row["solve_ms_per_million"]) > 0.0
        # The block's 8 corners, split as the mirror needs it.
        assert int(row["vertices"]) == int(row["judged_vertices"]) > 8
        assert float(row["vertex_p95_px"]) < 0.05
    assert all(row["vertices"] == row["vertex_front"].replace("False", "") == "" for row in cube)
    assert min(float(row["wrong_object"]) for row in cube) > max(float(row["wrong_object"]) for row in star)

    counts = table(output / "vertex_count.csv")
    assert [row["vertices"] for row in counts if row["method"] == "secant_star"] == ["1000", "3000"]
    assert all(float(row["solve_ms"]) > 0.0 and math.isfinite(float(row["slope"])) for row in counts if row["vertices"])
    assert not [row for row in counts if row["method"] == "environment_cube"], "it solves no vertices"


def test_sub_frames_take_the_place_of_a_methods_own_setting(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Least first, in full light."""
    file, output = saved(tmp_path), tmp_path / "out"
    few = ("--method", "exact", "--sub-frames", "4,1", "--light", "full", "--peers", "cycles2", "--vertices", "1000")
    assert cli.main(["chart", str(file), *BALL, *QUICK[:4], *few, "--output", str(output)]) == 0
    marks = table(output / "chart.csv")
    assert [(row["name"], row["setting"], row["value"]) for row in marks] == [
        ("exact", "sub-frames", "1"),
        ("exact", "sub-frames", "4"),
        ("cycles", "samples", "2.0"),
    ]


@pytest.mark.parametrize("light", ["direct", "full"])
def test_ours_is_in_the_references_light(light: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In direct light it bounces off nothing, whatever the file says."""
    build_scene()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.cycles.diffuse_bounces = 3
    bounces = []

    def measured(renderer: Renderer, *_: object) -> None:
        bounces.append(renderer.scene.diffuse_bounces)
        raise InputError("That is enough.")

    monkeypatch.setattr(chart_data, "measure_frame", measured)
    chart_open_scene(scene, layer, ["Mirror Ball"], Comparison(("exact",), 32, 24, 1, light, ()), tmp_path / "out")
    assert bounces == [0 if light == "direct" else 3]


def test_the_objects_own_switch_names_the_mirrors(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Also where the extension is not registered, as in a plain Python."""
    registration.register()
    try:

        def switch(ball: bpy.types.Object) -> None:
            ball.curvrefl.is_mirror = True

        file = saved(tmp_path, switch)
    finally:
        registration.unregister()
    capfd.readouterr()
    few = ("--method", "planar", "--peers", "none", "--vertices", "1000")
    output = tmp_path / "out"
    assert cli.main(["chart", str(file), *QUICK[:4], *few, "--output", str(output)]) == 0
    assert not hasattr(bpy.types.Object, "curvrefl")
    assert len(table(output / "chart.csv")) == 1
    assert len(table(output / "vertex_count.csv")) == 1


def look_away(_ball: bpy.types.Object) -> None:
    bpy.data.objects["Eye"].rotation_euler = (np.pi / 2.0, 0.0, np.pi)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((), "marked as a mirror"),
        (("--reflector", "Mirror Bal"), "Mirror Ball"),
        ((*BALL, "--method", "magic"), "magic"),
        ((*BALL, "--peers", "luxrender"), "luxrender"),
        ((*BALL, "--sub-frames", "1,few"), "1,few"),
        ((*BALL, "--sub-frames", "0"), "out of range"),
        ((*BALL, "--vertices", "10"), "10"),
        ((*BALL, "missing.blend"), "missing.blend"),
        (("--reflector", "Block", "--method", "secant_star", "--peers", "none", "--vertices", "1000"), ""),
    ],
)
def test_what_is_refused_leaves_nothing(
    arguments: tuple[str, ...], named: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = saved(tmp_path, look_away)
    capfd.readouterr()
    assert cli.main(["chart", str(file), *QUICK[:4], *arguments, "--output", str(tmp_path / "out")]) == 2
    err = capfd.readouterr().err
    assert named in err and err.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["files"]


def test_vertices_are_judged_by_true_reflections() -> None:
    """Fewer steps of a fixed-step search end farther away, and a flat mirror for a ball far away."""
    build_scene()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    truth = VertexTruth(*read_render_scene(scene, layer, ["Mirror Ball"], 640, 480))
    try:
        truth.prepare()
        few, many, flat = (
            truth.measure(settings)
            for settings in (
                Settings(method="bisector_cube", steps=3),
                Settings(method="bisector_cube", steps=30),
                Settings(method="planar"),
            )
        )
    finally:
        truth.free()
    assert few and many and flat
    assert many.p95_px < 0.1 < few.p95_px < 10.0 < flat.p95_px
    assert few.vertices == many.vertices == flat.vertices


def test_shell_is_around_the_mirror() -> None:
    positions = shell_positions(5000, 2.0).astype(np.float64)
    distance = np.linalg.norm(positions, axis=1)
    assert distance.min() > 2.0 and distance.max() < 8.0 + 1e-5
    assert np.abs(positions.mean(axis=0)).max() < 1.0
    steps = np.linalg.norm(np.diff(positions / distance[:, None], axis=0), axis=1)
    assert np.median(steps) < 0.1, "neighbors in the list are neighbors in space"


def test_closing_leaves_nothing_and_the_operator_shows_the_table(tmp_path: Path) -> None:
    file = saved(tmp_path)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    comparison = Comparison(("planar",), 32, 24, 1, "direct", ())
    steps = open_scene_steps(scene, layer, ["Mirror Ball"], comparison, tmp_path / "out")
    labels = [next(steps).label for _ in range(3)]
    steps.close()
    assert labels[0] == "Reading the scene"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["files"]

    registration.register()
    try:
        bpy.ops.curvrefl.compare_with_cycles(
            reflectors="Mirror Ball",
            methods={"planar"},
            peers={"cycles1"},
            width=32,
            height=24,
            samples=1,
            every_setting=True,
            output=str(tmp_path / "out"),
        )
    finally:
        registration.unregister()
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == FILES[:3]
    text = bpy.data.texts[TEXT_NAME].as_string()
    assert file.stem in text and "planar" in text and "cycles" in text and "chart.csv" in text
