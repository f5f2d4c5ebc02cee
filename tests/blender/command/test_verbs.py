# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the verbs print and write for a good scene."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from blender_process import run_script
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_files import load
from curvrefl.curvrefl_addon.renderer.surfaces import primary
from curvrefl.curvrefl_addon.report.images import load_exr
from small_scene import RUN_VERB, SIZE, saved

BALL = ("--reflector", "Mirror Ball")
COMPARE = ("--method", "secant_star", "--samples", "2", "--peers", "none")

pytestmark = pytest.mark.usefixtures("gpu")


def done(arguments: list[str], capfd: pytest.CaptureFixture[str]) -> str:
    """What a verb that succeeds without a warning prints."""
    # (saving the scene has printed, too)
    capfd.readouterr()
    code = cli.main(arguments)
    out, err = capfd.readouterr()
    assert (code, err) == (0, "")
    return out


def test_render_is_silent_and_whole(tmp_path: Path) -> None:
    """In a Blender of its own, to its end: what is left on the GPU then would crash it."""
    output = tmp_path / "out" / "picture.png"
    result = run_script(RUN_VERB, "--", "render", str(saved(tmp_path)), *BALL, "--output", str(output))
    assert (result.returncode, result.stderr) == (0, "")
    assert "picture" not in result.stdout
    assert output.read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in output.parent.iterdir()] == ["picture.png"]


def test_render_says_how_many_sub_frames_and_what_noise_is_left(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    picture = ["render", str(saved(tmp_path)), *BALL, "--resolution", "24x18", "--output", str(tmp_path / "a.exr")]
    assert re.search(r"^Sub-frames: 256, noise \d[\d.e-]* %$", done([*picture, "--samples", "256"], capfd), re.M)
    ended = done([*picture, "--samples", "256", "--noise", "20"], capfd)
    assert re.search(r"^Sub-frames: (8|16|32|64) of 256, noise \d[\d.e-]* %$", ended, re.M)
    assert "Sub-frames: 4\n" in done([*picture, "--samples", "4"], capfd)
    assert load_exr(tmp_path / "a.exr").shape == (18, 24, 4)


def test_no_gpu_object_outlives_a_verb(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments = ["render", str(saved(tmp_path)), *BALL, "--samples", "1", "--output", str(tmp_path / "a.exr")]
    with monkeypatch.context() as change:
        for module in (cli, registration):
            change.setattr(module, "clear_gpu_caches", lambda: None)
        done(arguments, capfd)
    of_main, of_render = primary._primary_shader.caches
    assert of_main.cache_info().currsize > 0
    done(arguments, capfd)
    assert of_main.cache_info().currsize == of_render.cache_info().currsize == 0
    assert load_exr(tmp_path / "a.exr").shape == (SIZE[1], SIZE[0], 4)


def test_passes_lie_beside_the_picture(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out" / "picture.exr"
    chosen = ["--passes", "color,position,object,iterations", "--resolution", "40x30", "--samples", "1"]
    out = done(["render", str(saved(tmp_path)), *BALL, *chosen, "--output", str(output)], capfd)
    names = sorted(path.name for path in output.parent.iterdir())
    assert names == ["picture.exr", "picture_iterations.exr", "picture_object.exr", "picture_position.exr"]
    assert load_exr(output).shape == (30, 40, 4)
    (block,) = [int(line.split()[1].rstrip(":")) for line in out.splitlines() if line.endswith(": Block")]
    shown = load_exr(output.with_name("picture_object.exr"))[..., 0] == block
    # The block is to the right of the ball and as near: it is seen in the right half of the mirror, and is there.
    assert 0.005 < shown.mean() < 0.3
    assert np.flatnonzero(shown.any(axis=0)).mean() > 20
    position = load_exr(output.with_name("picture_position.exr"))[shown]
    np.testing.assert_array_equal(position[:, 3], 1.0)
    assert np.abs(position[:, :3] - (2.0, -1.0, 0.0)).max() < 0.5 + 0.05


def test_compare_prints_progress_then_its_table(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out"
    out = done(["compare", str(saved(tmp_path)), *BALL, *COMPARE, "--output", str(output)], capfd)
    lines = out.splitlines()
    assert lines[0] == "Reading the scene"
    assert lines[-1] == f"Report: {output / 'report.html'}"
    assert not [line for line in lines if "blend  " in line or "Saved" in line], "Blender's own notes are not results"
    assert lines.index("Rendering secant_star") < [line.split(" ")[0] for line in lines].index("secant_star")
    report = json.loads((output / "report.json").read_text())
    assert report["scene"] == "scene.blend"
    assert report["resolution"] == list(SIZE)
    assert (report["reference"]["samples"], report["reference"]["light"]) == (2, "full")
    assert list(report["methods"]) == ["secant_star"]
    assert report["peers"] == {}
    assert "warnings" not in report


def test_compare_names_the_tool_that_python_lacks(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    output = tmp_path / "out"
    out = done(["compare", str(saved(tmp_path)), *BALL, *COMPARE, "--output", str(output)], capfd)
    assert "Warning: FLIP is missing" in out
    report = json.loads((output / "report.json").read_text())
    assert "flip-evaluator" in report["warnings"][0]
    image = report["methods"]["secant_star"]["image"]
    assert image["flip"] is None
    assert image["psnr"] > 10.0
    assert "flip-evaluator" in (output / "report.html").read_text()


def test_bake_says_how_well_the_map_fits(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out"
    out = done(["bake", str(saved(tmp_path)), *BALL, "--resolution", "32", "--output", str(output)], capfd)
    assert out.startswith("Mirror Ball: star center (0, 0, 0)")
    assert "error in pixels at 32x24" in out
    baked = load(output)
    assert baked.radial.shape == (6, 32, 32, 4)
    np.testing.assert_allclose(baked.radial[..., 0], 1.0, atol=0.02)
