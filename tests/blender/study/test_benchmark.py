# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark counts what it says it counts; its times are no matter of tests."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.renderer.proofs.table import PROOFS
from curvrefl.curvrefl_addon.study.benchmark import benchmark
from curvrefl.curvrefl_addon.study.benchmark.benchmark import Limits, measure_benchmark
from curvrefl.curvrefl_addon.study.benchmark.solves import FETCH_BYTES, FETCHES, SOLVE_BYTES

pytestmark = pytest.mark.usefixtures("gpu")


def test_benchmark_writes_counts_and_a_table(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out"
    sizes = ["--vertices", "2000", "--triangles", "3000", "--bandwidth", "20", "--flops", "0.5"]
    assert cli.main(["benchmark", *sizes, "--output", str(output)]) == 0
    assert sorted(path.name for path in output.iterdir()) == ["benchmark.json", "benchmark.txt"]
    report = json.loads((output / "benchmark.json").read_text())
    assert all(report["device"].values())
    assert set(report["proofs"]) == {proof.name for proof in PROOFS} and report["failures"] == {}
    assert report["limits"] == {"bandwidth": 20.0, "flops": 0.5}
    assert [(row["method"], row["vertices"]) for row in report["solves"]] == [("newton", 2000), ("secant_star", 2000)]
    for row in report["solves"]:
        assert not row["left_out"]
        assert row["solved"] == pytest.approx(2000, rel=0.1)
        assert row["cold_unsolved"] == 0
        assert 1.0 < row["cold_iterations"] < 20.0
        assert row["cold_bytes"] == SOLVE_BYTES + FETCHES * FETCH_BYTES * row["cold_iterations"]
        assert row["cold_solves_per_second"] == pytest.approx(1e3 * row["solved"] / row["cold_ms"])
        assert row["cold_of_bandwidth"] > 0.0 and row["cold_of_flops"] > 0.0
        assert row["cold_at_once"] >= 1
        assert 0.0 < row["cold_submit_ms"] <= row["cold_ms_q3"] * row["cold_at_once"]
        assert row["empty_wait_ms"] > 0.0
    newton, secant = report["solves"]
    # A frame later the search begins where it ended.
    assert newton["warm_iterations"] < newton["cold_iterations"]
    assert secant["warm_ms"] is None and secant["still_ms"] is None
    # What has not moved is not searched for.
    assert newton["still_ms"] is not None and newton["still_iterations"] == 0.0
    assert [row["triangles"] for row in report["rays"]] == [1000, 3000]
    for row in report["rays"]:
        assert not row["left_out"]
        assert row["rays"] > 10_000
        for state in ("quick", "best"):
            # Every ray looks at the top level's root; some meet more.
            assert row[f"{state}_nodes"] > 1.0
            assert row[f"{state}_tested"] > 0.0
            assert row[f"{state}_entered"] > 0.0
    text = capfd.readouterr().out
    assert (output / "benchmark.txt").read_text().strip() in text


def test_a_run_that_is_stopped_leaves_its_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(benchmark, "measure_solves", lambda *_: iter([{"method": "m", "vertices": 5, "left_out": "x"}]))

    def one_and_stopped(*_: object) -> Iterator[dict[str, object]]:
        yield {"triangles": 7, "left_out": "y"}
        raise KeyboardInterrupt

    monkeypatch.setattr(benchmark, "measure_rays", one_and_stopped)
    with pytest.raises(KeyboardInterrupt):
        measure_benchmark(2000, 2000, Limits(), tmp_path, lambda _line: None)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["benchmark.json", "benchmark.txt"]
    report = json.loads((tmp_path / "benchmark.json").read_text())
    assert (len(report["solves"]), len(report["rays"])) == (1, 1)


def test_shares_of_limits() -> None:
    shares = Limits(bandwidth=100.0, flops=2.0).share(bytes_each=200.0, operations_each=1000.0, per_second=1e8)
    assert shares == {"of_bandwidth": pytest.approx(0.2), "of_flops": pytest.approx(0.05)}
    assert Limits().share(1.0, 1.0, 1.0) == {"of_bandwidth": None, "of_flops": None}


@pytest.mark.parametrize("value", ["0", "-3", "many", "1e400"])
def test_limits_are_numbers_above_zero(value: str) -> None:
    assert cli.main(["benchmark", "--bandwidth", value]) == cli.BAD_INPUT
