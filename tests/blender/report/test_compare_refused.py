# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons that fail or are refused say why and leave nothing behind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from curvrefl.curvrefl_addon.errors import InputError
from report.stand_ins import FailingRenderer, PickyRenderer, run


def test_nothing_is_left_by_a_failure(blend: Path, tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="broke down"):
        run(blend, tmp_path / "out", FailingRenderer)
    existing = tmp_path / "existing"
    existing.mkdir()
    (existing / "mine.txt").write_text("kept")
    with pytest.raises(RuntimeError, match="broke down"):
        run(blend, existing, FailingRenderer)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ball & floor.blend", "existing"]
    assert [path.name for path in existing.iterdir()] == ["mine.txt"]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"width": 0}, "resolution"),
        ({"height": 100_000}, "resolution"),
        ({"samples": 0}, "samples"),
        ({"light": "moon"}, "direct, full"),
        ({"methods": ["secant_moon"]}, "secant_star"),
        ({"methods": []}, "secant_star"),
        ({"peers": ["cycles3"]}, "cycles1"),
        ({"reflector_names": ["bal"]}, "ball"),
        ({"camera": "nobody"}, "camera"),
    ],
)
def test_bad_input_is_named_and_writes_nothing(
    blend: Path, tmp_path: Path, changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        run(blend, tmp_path / "out", **changes)
    assert [path.name for path in tmp_path.iterdir()] == ["ball & floor.blend"]


def test_method_that_cannot_show_the_reflector_is_left_out_and_said(blend: Path, tmp_path: Path) -> None:
    methods = ["secant_uv", "secant_star", "planar"]
    report = run(blend, tmp_path / "out", PickyRenderer, methods=methods, peers=[])
    assert list(report["methods"]) == ["secant_star"]
    assert report["warnings"][:2] == ["Without secant_uv: Not by secant_uv.", "Without planar: Not by planar."]
    assert not (tmp_path / "out" / "planar.png").exists()


def test_reflector_that_no_method_can_show_is_an_error(blend: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"Not by secant_uv\."):
        run(blend, tmp_path / "out", PickyRenderer, methods=["secant_uv", "planar"])
    assert not (tmp_path / "out").exists()


def test_output_that_cannot_be_a_folder(blend: Path, tmp_path: Path) -> None:
    for output in (blend, blend / "inside"):
        with pytest.raises(InputError, match="folder"):
            run(blend, output)
