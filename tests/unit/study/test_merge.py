# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report over frames, of frames that are made up: what it says, what it refuses, and that it is the same again."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.study.sequence import merge
from curvrefl.curvrefl_addon.study.sequence.kept import Shown, load_kept, made_of
from curvrefl.curvrefl_addon.study.sequence.merge import merge_frames, numbers_of
from curvrefl.curvrefl_addon.study.sequence.text import format_sequence
from curvrefl.curvrefl_addon.study.sequence.times import slow_sentences
from scenes.sequences.kept_frames import GRAY, HEIGHT, MADE, WIDTH, kept_frame, write_frame


@pytest.fixture(autouse=True)
def _without_drawings(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take a second each."""
    monkeypatch.setattr(merge, "has_matplotlib", lambda: False)


def popping(output: Path, frames: range, bad: int, times: dict[int, float] | None = None, **changes: Any) -> None:
    """In the frame `bad` the method is brighter and 2 pixels off; it comes with its own warning."""
    objects = np.full((HEIGHT, WIDTH), 2, np.int32)
    for frame in frames:
        is_bad = frame == bad
        picture = GRAY + 0.125 if is_bad else GRAY
        shown = {"exact": Shown(objects, np.full((HEIGHT, WIDTH, 2), 2.0 * is_bad, np.float32))}
        kept = kept_frame(frame, (0.25, 0.0), pictures=(GRAY, picture, GRAY), shown=shown, **changes)
        warnings = ["Always."] + ["It pops."] * is_bad
        write_frame(output, kept, (times or {}).get(frame, 10.0), warnings=warnings)


def test_what_is_kept_is_read_again(tmp_path: Path) -> None:
    kept = kept_frame(7, (0.25, -0.5), distance=np.full((HEIGHT, WIDTH), np.inf, np.float32))
    found = load_kept(write_frame(tmp_path, kept))
    for item in fields(kept):
        one, two = getattr(kept, item.name), getattr(found, item.name)
        if item.name == "pictures":
            # (16 bits)
            assert all(np.allclose(one[name], two[name], rtol=5e-4) for name in one) and one.keys() == two.keys()
        elif item.name == "shown":
            np.testing.assert_array_equal(one["exact"].offset, two["exact"].offset)
            np.testing.assert_array_equal(one["exact"].object, two["exact"].object)
        elif isinstance(one, np.ndarray):
            np.testing.assert_array_equal(one, two)
        else:
            assert one == two
    assert made_of(tmp_path / "frame_0007") == MADE
    (tmp_path / "frame_0007" / "exact.png").write_bytes(b"\x89PNG broken off")
    assert made_of(tmp_path / "frame_0007") is None


def test_a_pop_is_found_at_its_frame(tmp_path: Path) -> None:
    popping(tmp_path, range(1, 7), bad=4, times={5: 31.0})
    report = merge_frames(tmp_path)
    exact = report["methods"]["exact"]
    assert exact["pop"]["worst_frame"] == 4
    assert exact["pop"]["worst"] == pytest.approx(8.0**0.5, rel=1e-5)
    assert exact["flicker"]["worst"] == pytest.approx(0.125, rel=2e-3)
    assert {item["frame"] for item in report["worst"]["flicker"][:2]} == {4, 5}
    assert report["worst"]["pop"][0]["frame"] == 4 and len(report["worst"]["pop"]) == 2
    flickers = [entry["methods"]["exact"]["flicker"] for entry in report["frames"]]
    assert flickers[0] is None and [round(item["mean"], 3) for item in flickers[1:]] == [0.0, 0.0, 0.125, 0.125, 0.0]
    assert report["peers"]["cycles1"]["flicker"]["worst"] == 0.0
    assert exact["flip"] == {"mean": 0.035, "median": 0.035, "worst": 0.06, "worst_frame": 6}
    assert exact["psnr"]["worst_frame"] == 6
    assert report["warnings"] == ["Always.", "Frame 4: It pops."]
    assert report["range"] == {"first": 1, "last": 6, "step": 1, "count": 6}
    assert report == json.loads((tmp_path / "report.json").read_text())
    times = json.loads((tmp_path / "times.json").read_text())
    assert times["methods"]["exact"]["slow_frames"] == [5] == times["reference"]["slow_frames"]
    assert times["methods"]["exact"]["median"] == 10.0 and times["peers"]["cycles1"]["frames"]["5"] == 62.0
    assert slow_sentences(times) == ["Frames over 3 times the median, exact: 5"]
    times["methods"]["exact"]["slow_frames"] = []
    assert slow_sentences(times) == ["No frame of a method took over 3 times the median."]
    assert "frames 1 to 6" in (said := format_sequence(report)) and "@ 4" in said


def test_a_merged_report_is_the_same_whatever_the_times_and_the_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(merge, "has_matplotlib", lambda: True)
    one, two = tmp_path / "one", tmp_path / "another place"
    popping(one, range(1, 4), bad=2)
    popping(two, range(3, 0, -1), bad=2, times={1: 77.0, 3: 5.0})
    merge_frames(one)
    merge_frames(two)
    files = sorted(path.name for path in one.iterdir() if path.is_file())
    drawn = ["contact_sheet.png", "curves.png", "curves.svg", "times.png", "times.svg"]
    assert files == sorted(["report.json", "report.html", "times.json", *drawn])
    for name in files:
        same = (one / name).read_bytes() == (two / name).read_bytes()
        assert same is not name.startswith("times"), name


def test_a_part_is_merged_by_itself(tmp_path: Path) -> None:
    popping(tmp_path, range(1, 6), bad=2)
    report = merge_frames(tmp_path, range(3, 6))
    assert [entry["frame"] for entry in report["frames"]] == [3, 4, 5]
    assert report["frames"][0]["followed"] is None and report["methods"]["exact"]["pop"]["worst"] == 0.0


def test_cuts_are_named_and_not_measured_over(tmp_path: Path) -> None:
    popping(tmp_path, range(1, 3), bad=0)
    popping(tmp_path, range(3, 5), bad=3, camera="Other")
    write_frame(tmp_path, kept_frame(5, camera="Other", place=np.full((HEIGHT, WIDTH, 2), np.nan, np.float32)))
    before = {"frame": 5, "camera": "", "reason": 'Mirror "A" has no faces.'}
    write_frame(tmp_path, kept_frame(6, camera="Other", before=before))
    report = merge_frames(tmp_path)
    assert report["cuts"] == [
        {"frame": 3, "why": 'the camera is "Other" after "Camera"'},
        {"frame": 5, "why": "0.0 % of the mirrors' pixels show what they showed before"},
        {"frame": 6, "why": 'frame 5 could not be read for it (Mirror "A" has no faces)'},
    ]
    not_measured = [entry["frame"] for entry in report["frames"] if entry["methods"]["exact"]["flicker"] is None]
    assert not_measured == [1, 3, 5, 6]
    assert 'Cut before frame 3: the camera is "Other"' in format_sequence(report)


def test_what_cannot_be_merged_is_said(tmp_path: Path) -> None:
    def refusal(frames: range | None = None) -> str:
        with pytest.raises(InputError) as error:
            merge_frames(tmp_path, frames)
        return str(error.value)

    assert "No frame is compared" in refusal()
    popping(tmp_path, range(1, 10), bad=0)
    shutil.rmtree(tmp_path / "frame_0004")
    (tmp_path / "frame_0007" / "kept.exr").write_bytes(b"")
    (tmp_path / "frame_0008" / "kept.json").write_text("{")
    assert refusal().startswith("Frames 4, 7, 8 are missing in")
    assert refusal(range(8, 9)).startswith("Frame 8 is missing in")
    assert refusal(range(9, 13)).startswith("Frames 10 to 12 are missing in")
    assert "for a step of 1, not of 2" in refusal(range(1, 4, 2))
    assert not (tmp_path / "report.json").exists()
    merge_frames(tmp_path, range(1, 4))
    shutil.rmtree(tmp_path / "frame_0002")
    popping(tmp_path, range(2, 3), bad=0, made=MADE | {"samples": 8, "settings": {"bounces": 2}})
    (tmp_path / "report.json").unlink()
    said = "Frames 1 and 2 were made with different samples (4 and 8), settings (None and {'bounces': 2}): compare all"
    assert refusal(range(1, 3)).startswith(said)
    assert not (tmp_path / "report.json").exists()


def test_numbers_are_told_in_runs() -> None:
    assert numbers_of([1]) == "1"
    assert numbers_of([1, 2, 4, 5, 6, 9]) == "1, 2, 4 to 6, 9"


def test_the_references_own_noise_is_found_by_a_peer(tmp_path: Path) -> None:
    """White noise of Cycles with 1 sample, and of a reference with 4, which has half of its deviation; a method without
    any flickers as that alone."""
    random = np.random.default_rng(4)

    def noisy(sigma: float) -> np.ndarray:
        return 0.5 + np.repeat(random.normal(0.0, sigma, (HEIGHT, WIDTH, 1)), 3, axis=2)

    for frame in range(1, 6):
        write_frame(tmp_path, kept_frame(frame, pictures=(noisy(0.02), GRAY, noisy(0.04))))
    report = merge_frames(tmp_path)
    rms = np.mean([entry["methods"]["exact"]["flicker"]["rms"] for entry in report["frames"][1:]])
    assert rms == pytest.approx(0.02 * 2.0**0.5, rel=0.03)
    assert report["reference"]["flicker_rms"] == pytest.approx(rms, rel=0.03)
    (warning,) = report["warnings"]
    assert re.match(r"The noise of a reference with 4 samples is (9[7-9]|100) % of exact's flicker", warning)
    assert "noise of a reference" in format_sequence(report)
