# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts from numbers that are known by construction: fronts, slopes, rows, axes and the drawn files."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.report.repeats import Timing, repeated
from curvrefl.curvrefl_addon.study.charts.chart_draw import draw_chart, draw_vertex_count, round_numbers
from curvrefl.curvrefl_addon.study.charts.chart_marks import (
    LEVELS,
    Mark,
    VertexAccuracy,
    front_marks,
    pareto_front,
    rows,
    write_csv,
)
from curvrefl.curvrefl_addon.study.charts.vertex_curves import Curve, Fit, counts_up_to, fitted
from curvrefl.curvrefl_addon.study.charts.vertex_curves import rows as curve_rows


def timing(milliseconds: float) -> Timing:
    """Quartiles 0.9 and 1.2 times the median."""
    return Timing((0.8 * milliseconds, milliseconds, 1.4 * milliseconds))


def method(name: str, value: float, time: float, error: float, wrong: float = 0.0, scene: str = "a") -> Mark:
    """All errors are `error`, all times `time`."""
    accuracy = VertexAccuracy(100, 50, timing(time), error, error, error, error, 0.25, 0.125)
    return Mark(
        scene,
        name,
        "pixel_tolerance",
        value,
        is_default=value == 0.5,
        times={"bake": timing(1.0), "solve": timing(2.0), "draw": timing(time - 2.0), "frame": timing(time)},
        flip=error,
        psnr=30.0,
        angle_deg=(0.5 * error, error, 2.0 * error),
        wrong_object=wrong,
        vertices=accuracy,
    )


PEER = Mark("a", "cycles", "samples", 8.0, is_peer=True, times={"frame": timing(500.0)}, flip=0.001, psnr=40.0)
REFUSED = Mark("a", "secant_uv", reason="It has no UV map.")


def test_front_leaves_out_what_another_beats() -> None:
    points = [(3.0, 1.0), (1.0, 5.0), (2.0, 5.0), (2.0, 3.0), (4.0, 0.5), (5.0, 0.5), (1.0, 6.0), (9.0, 9.0)]
    assert pareto_front(points) == [1, 3, 0, 4]


def test_front_of_equal_points_and_of_none() -> None:
    assert pareto_front([(1.0, 1.0), (1.0, 1.0)]) == [0]
    assert pareto_front([]) == []


def test_peers_are_on_the_picture_front_only() -> None:
    ours = method("secant_star", 0.5, 10.0, 0.1)
    assert front_marks(LEVELS["image"], [PEER, ours, REFUSED]) == [ours, PEER]
    assert front_marks(LEVELS["vertex"], [PEER, ours, REFUSED]) == [ours]


def test_angles_of_a_mirror_that_leaves_objects_out_lead_nothing() -> None:
    """The background behind a missing object lies in just the right direction."""
    right, empty = method("secant_star", 0.5, 10.0, 0.1, wrong=0.01), method("planar", 0.5, 5.0, 0.0, wrong=0.4)
    assert front_marks(LEVELS["angle"], [right, empty]) == [right]
    assert front_marks(LEVELS["object"], [right, empty]) == [empty, right]


def test_slope_of_a_power_of_the_count() -> None:
    counts = [1000, 20_000, 300_000]
    fit = fitted(counts, [2e-3 * count**1.25 for count in counts])
    assert fit is not None
    assert fit.slope == pytest.approx(1.25, rel=1e-12)
    assert fit.factor == pytest.approx(2e-3, rel=1e-9)
    assert fit.at(5000) == pytest.approx(2e-3 * 5000**1.25)
    assert fitted([1000], [1.0]) is None


def test_constant_part_of_the_time_is_no_part_of_the_slope() -> None:
    counts = counts_up_to(1_000_000)
    fit = fitted(counts, [30.0 + 5e-4 * count for count in counts])
    assert fit is not None
    assert fit.slope == pytest.approx(1.0, abs=0.02)
    assert fit.constant == pytest.approx(30.0, rel=0.03)
    bare = fitted(counts, [5e-4 * count for count in counts])
    assert bare is not None and bare.constant == 0.0 and bare.slope == pytest.approx(1.0)
    curve = Curve("secant_star", (1000, 2000), (timing(1.0), timing(4.0)))
    assert curve.fit is not None and curve.fit.slope == pytest.approx(2.0)


def test_counts_end_with_the_largest() -> None:
    assert counts_up_to(1_000_000) == (1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000)
    assert counts_up_to(20_000) == (1000, 3000, 10_000, 20_000)
    assert counts_up_to(1000) == (1000,)


def test_timing_has_median_and_quartiles() -> None:
    spread = Timing((5.0, 1.0, 3.0, 2.0, 4.0))
    assert (spread.median, spread.low, spread.high) == (3.0, 2.0, 4.0)
    single = Timing((7.0,))
    assert (single.median, single.low, single.high) == (7.0, 7.0, 7.0)
    assert single.joined(spread).times == (7.0, 5.0, 1.0, 3.0, 2.0, 4.0)


def test_repeats_end_with_the_number_or_the_time() -> None:
    assert repeated(lambda: "done", 3, 60.0) == ["done"] * 3
    assert repeated(lambda: "done", 3, 0.0) == ["done"], "once in any case"


def test_csv_has_a_row_per_mark_and_says_who_leads(tmp_path: Path) -> None:
    fast, slow = method("secant_star", 1.0, 10.0, 0.5), method("secant_star", 0.5, 20.0, 0.5)
    elsewhere = method("secant_star", 0.5, 30.0, 0.75, scene="b")
    write_csv(rows([fast, slow, PEER, REFUSED, elsewhere]), tmp_path / "chart.csv")
    with (tmp_path / "chart.csv").open(encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert list(table[0]) == [
        "scene", "kind", "name", "setting", "value", "is_default",
        "frame_ms", "frame_ms_q1", "frame_ms_q3", "frame_ms_repeats", "bake_ms", "solve_ms", "draw_ms",
        "flip", "psnr_db", "angle_median_deg", "angle_p95_deg", "angle_p99_deg", "wrong_object",
        "solve_ms_per_million", "solve_ms_per_million_q1", "solve_ms_per_million_q3", "solve_ms_per_million_repeats",
        "vertices", "judged_vertices", "vertex_median_px", "vertex_p95_px", "vertex_p99_px", "vertex_max_px",
        "misclassified", "unconverged", "image_front", "angle_front", "object_front", "vertex_front", "reason",
    ]  # fmt: skip
    assert [row["vertex_front"] for row in table] == ["True", "False", "False", "False", "True"], "one front a scene"
    assert [row["image_front"] for row in table] == ["True", "False", "True", "False", "True"]
    assert [row["kind"] for row in table] == ["method", "method", "peer", "method", "method"]
    assert (table[0]["frame_ms"], table[0]["frame_ms_q1"], table[0]["frame_ms_q3"]) == ("10.0", "9.0", "12.0")
    assert (table[0]["bake_ms"], table[0]["solve_ms"], table[0]["draw_ms"]) == ("1.0", "2.0", "8.0")
    assert (table[0]["is_default"], table[1]["is_default"]) == ("False", "True")
    assert table[2]["angle_p95_deg"] == table[2]["vertices"] == "", "no number is an empty cell"
    assert table[3]["reason"] == "It has no UV map." and table[3]["frame_ms"] == ""


def test_vertex_counts_as_rows() -> None:
    curves = [Curve("planar", reason="It is round."), Curve("secant_star", (1000, 3000), (timing(1.0), timing(3.0)))]
    table = curve_rows(curves)
    assert [row["vertices"] for row in table] == [None, 1000, 3000]
    assert table[1]["slope"] == pytest.approx(1.0)
    assert table[2]["fitted_ms"] == pytest.approx(3.0)
    assert table[0]["reason"] == "It is round."
    assert len({tuple(row) for row in table}) == 1, "all rows have all columns"


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (0.5, 2e4, [1.0, 10.0, 100.0, 1000.0, 10_000.0]),
        (0.9, 50.0, [1.0, 3.0, 10.0, 30.0]),
        (4.0, 30.0, [5.0, 10.0, 20.0]),
        (25.0, 60.0, [30.0, 40.0, 50.0]),
    ],
)
def test_axes_have_few_round_numbers(low: float, high: float, expected: list[float]) -> None:
    assert round_numbers(low, high) == pytest.approx(expected)


def test_charts_are_drawn_and_the_same_again(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    marks = [method("secant_star", 1.0, 10.0, 0.5), method("secant_star", 0.5, 20.0, 0.0), PEER, REFUSED]
    curves = [Curve("secant_star", (1000, 3000), (timing(1.0), timing(3.0))), Curve("planar", reason="It is round.")]
    for folder in (tmp_path / "one", tmp_path / "two"):
        folder.mkdir()
        draw_chart(marks, "Headline", folder)
        draw_vertex_count(curves, "Headline", folder)
        assert sorted(path.name for path in folder.iterdir()) == [
            "chart.png", "chart.svg", "vertex_count.png", "vertex_count.svg",
        ]  # fmt: skip
        assert (folder / "chart.png").read_bytes().startswith(b"\x89PNG")
        assert "</svg>" in (folder / "chart.svg").read_text(encoding="utf-8")
    for name in ("chart.svg", "vertex_count.svg"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_charts_of_what_could_not_be_measured_are_empty(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    draw_chart([REFUSED], "Headline", tmp_path)
    draw_vertex_count([Curve("planar", reason="It is round.")], "Headline", tmp_path)
    assert len(list(tmp_path.iterdir())) == 4


def test_missing_matplotlib_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(InputError, match="pip install matplotlib"):
        draw_chart([PEER], "Headline", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_line_of_a_fit() -> None:
    assert Fit(2.0, 0.5, 3.0).at(4.0) == 11.0


def test_every_method_has_a_look_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    from curvrefl.curvrefl_addon.diagnostics.colors import method_color
    from curvrefl.curvrefl_addon.optics.catalog import METHODS
    from curvrefl.curvrefl_addon.study.charts.chart_draw import STYLES, method_style

    assert set(STYLES) <= set(METHODS)
    for number in range(3):
        # Methods that nobody has chosen a look for.
        monkeypatch.setitem(METHODS, f"new_{number}", METHODS["planar"])
    assert len({method_style(name)[0] for name in METHODS}) == len(METHODS)
    assert len({method_color(name) for name in METHODS}) == len(METHODS)
