# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`render` and `compare` over frames: each with its own files, and what is there whole is not done again."""

from __future__ import annotations

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.output import numbered
from curvrefl.curvrefl_addon.report.images import load_exr
from curvrefl.curvrefl_addon.study.sequence import merge
from small_scene import saved

BALL = ("--reflector", "Mirror Ball")


def across(ball: bpy.types.Object) -> None:
    """The ball goes up, one unit a frame."""
    for frame in (1, 3):
        ball.location.z = frame - 2.0
        ball.keyframe_insert("location", frame=frame)
    for curve in ball.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def done(capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    capfd.readouterr()
    code = cli.main(list(arguments))
    out, err = capfd.readouterr()
    assert (code, err) == (0, "")
    return out


def test_files_have_their_frames_number() -> None:
    assert numbered(Path("a.png"), 3, False).name == "a.png"
    assert numbered(Path("a.png"), 3).name == "a_0003.png"
    assert numbered(Path("a_##_b.png"), 123, False).name == "a_123_b.png"
    assert numbered(Path("##.png"), -4).name == "-04.png"


@pytest.mark.usefixtures("gpu")
def test_render_over_frames_goes_on_where_it_was_stopped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file, out = saved(tmp_path, across), tmp_path / "out"
    given = ("render", str(file), *BALL, "--samples", "1", "--passes", "color,object", "--output", str(out / "a.exr"))
    said = done(capfd, *given, "--frames", "1-3:2")
    assert "Frame 3 (2 of 2)" in said and said.count("object 1:") == 1
    names = [f"a_000{frame}{end}.exr" for frame in (1, 3) for end in ("", "_object")]
    assert sorted(path.name for path in out.iterdir()) == sorted(names)
    heights = [np.argwhere(load_exr(out / f"a_000{frame}_object.exr")[..., 0] > 0)[:, 0].mean() for frame in (1, 3)]
    # (Rows count from the bottom; the block beside it is reflected higher and lower.)
    assert heights[1] - heights[0] > 4.0
    first = load_exr(out / "a_0001.exr")
    (out / "a_0001_object.exr").unlink()
    kept = (out / "a_0003.exr").stat().st_mtime_ns
    said = done(capfd, *given, "--frames", "1-3", "--resume")
    assert "1 of 3 frames are there already" in said and "Frame 2 (2 of 2)" in said
    assert np.array_equal(load_exr(out / "a_0001.exr"), first)
    assert (out / "a_0003.exr").stat().st_mtime_ns == kept and len(list(out.iterdir())) == 6


@pytest.mark.usefixtures("gpu")
def test_compare_over_frames_is_the_same_in_pieces(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A report each, and one over all: the same bytes where the last frame was compared first, by itself."""
    # (Drawings are tested by themselves: seconds each.)
    monkeypatch.setattr(merge, "has_matplotlib", lambda: False)
    file, out, apart = saved(tmp_path, across), tmp_path / "out", tmp_path / "apart"
    given = ("compare", str(file), *BALL, "--method", "exact", "--samples", "1", "--peers", "cycles1")
    given = (*given, "--resolution", "24x18")
    said = done(capfd, *given, "--frames", "1-3", "--output", str(out))
    assert "Frame 2 (2 of 3)" in said and "frames 1 to 3" in said
    folders = {f"frame_000{frame}" for frame in (1, 2, 3)}
    assert {path.name for path in out.iterdir() if path.is_dir()} == folders
    assert all((out / name / "report.html").is_file() for name in folders)
    done(capfd, *given, "--frames", "3", "--output", str(apart))
    said = done(capfd, *given, "--frames", "1-3", "--resume", "--output", str(apart))
    assert "1 of 3 frames are there already" in said
    assert "Report:" in done(capfd, "merge", str(apart))
    for path in (*(path for path in out.iterdir() if path.is_file()), *out.glob("frame_*/kept.*")):
        same = path.read_bytes() == (apart / path.relative_to(out)).read_bytes()
        assert same or path.name.startswith("times"), path
    report = json.loads((out / "report.json").read_text())
    # The ball itself moves: most of what it shows is followed, and shown as before.
    followed = [entry["followed"] for entry in report["frames"]]
    assert followed[0] is None and min(followed[1:]) > 0.6
    exact = report["methods"]["exact"]
    assert exact["pop"]["worst"] < 0.05 and exact["holes"]["worst"] == 0
    assert exact["flicker"]["worst"] < report["peers"]["cycles1"]["flicker"]["worst"]
    # What was made otherwise is not there already, and not merged.
    other = ("compare", str(file), *BALL, "--method", "exact", "--samples", "2", "--peers", "none")
    other = (*other, "--resolution", "24x18", "--frames", "2", "--resume", "--output", str(out))
    assert "there already" not in done(capfd, *other)
    assert cli.main(["merge", str(out)]) == 2
    assert "samples (1 and 2)" in capfd.readouterr().err


def test_one_frame_or_several(capfd: pytest.CaptureFixture[str]) -> None:
    given = ["render", "x.blend", *BALL, "--output", "x.png"]
    assert cli.main([*given, "--frame", "1", "--frames", "1-2"]) == 2
    assert "not allowed with" in capfd.readouterr().err
    assert cli.main([*given, "--frames", "2-1"]) == 2
    assert "the last comes after the first" in capfd.readouterr().err
