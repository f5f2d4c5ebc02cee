# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tool that takes a frame apart, on a tiny scene: with rays of sharp mirrors, with paths, and with vertices."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import bpy
import pytest
from small_scene import saved

ROOT = Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tools" / "measure"))

import measure_frame  # noqa: E402

pytestmark = pytest.mark.usefixtures("gpu")


def roughen(ball: bpy.types.Object) -> None:
    """Mirrors that are not sharp follow paths."""
    ball.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.3


@pytest.mark.parametrize(
    ("method", "change", "passes"),
    [
        ("exact", None, {"primary", "classes", "walk", "shade"}),
        ("exact", roughen, {"primary", "step", "light"}),
        ("secant_star", None, {"primary", "solve", "reflected", "shade"}),
    ],
)
def test_every_pass_of_a_frame_has_its_time(
    method: str,
    change: object,
    passes: set[str],
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    file = saved(tmp_path, change)
    monkeypatch.setattr(measure_frame, "WIDTH", 48)
    monkeypatch.setattr(measure_frame, "HEIGHT", 36)
    arguments = ["measure_frame.py", f"{file}:Mirror Ball", "--method", method, "--repeats", "2"]
    monkeypatch.setattr(sys, "argv", arguments)
    capfd.readouterr()
    measure_frame.main()
    out = capfd.readouterr().out
    assert re.search(r"^scene, Mirror Ball, direct light: \d+ triangles", out, re.MULTILINE)
    times = {
        name: float(time) for name, time in re.findall(r"(?:    |, )([a-z ]+) (\d+\.\d)(?=,|$)", out, re.MULTILINE)
    }
    assert passes <= set(times) and sum(times.values()) > 0.0
    assert re.search(rf"  {method}, 1 sub-frame: frame .*; ratio \d+\.\d\d \(", out)


def test_a_files_mirrors_and_light_are_named_with_it() -> None:
    assert measure_frame.given("a.blend") == (Path("a.blend"), [], "direct")
    assert measure_frame.given("a.blend:Ball,Bowl:full") == (Path("a.blend"), ["Ball", "Bowl"], "full")
    with pytest.raises(measure_frame.argparse.ArgumentTypeError, match="no light"):
        measure_frame.given("a.blend:Ball:dim")
