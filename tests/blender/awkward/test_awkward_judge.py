# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The judge of awkward scenes tells right from wrong, and outlives a Blender that does not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from awkward import attempt, judge
from scenes.awkward import SCENES

NAMES = ["view_agx", "fog_cube", "plain"]
ATTEMPT = """
import json, os, sys
from pathlib import Path
given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
with (Path(given[0]) / "attempts.jsonl").open("a") as file:
    for name in given[1:]:
        print(json.dumps({"name": name}), file=file, flush=True)
        if name == "fog_cube":
            os._exit(139)
        print(json.dumps({"name": name, "off": 0.0, "finite": True, "warnings": []}), file=file, flush=True)
os._exit(0)
"""


def test_a_blender_that_dies_counts_for_one_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = tmp_path / "attempt.py"
    script.write_text(ATTEMPT)
    monkeypatch.setattr(judge, "ATTEMPT", script)
    results = list(judge.try_scenes(NAMES, tmp_path, 1))
    assert [result["name"] for result in results] == NAMES
    assert [result["outcome"] for result in results] == [judge.RIGHT, judge.CRASH, judge.RIGHT]
    assert "139" in results[1]["crash"]


@pytest.mark.parametrize(
    ("result", "words", "outcome"),
    [
        ({"off": 0.0, "finite": True, "warnings": []}, (), judge.RIGHT),
        ({"off": 0.02, "finite": True, "warnings": []}, ("glass",), judge.RIGHT),
        ({"off": 0.021, "finite": True, "warnings": ["Glass is not drawn."]}, ("glass",), judge.WARNED),
        ({"off": 0.021, "finite": True, "warnings": ["Hair is not drawn."]}, ("glass",), judge.WRONG),
        ({"off": 0.5, "finite": True, "warnings": ["Hair is not drawn."]}, (), judge.WRONG),
        ({"off": 0.0, "finite": False, "warnings": []}, (), judge.NOT_FINITE),
        ({"refused": "The camera is panoramic."}, (), judge.REFUSED),
        ({"crash": "Traceback"}, (), judge.CRASH),
    ],
)
def test_outcomes(result: dict[str, object], words: tuple[str, ...], outcome: str) -> None:
    assert judge.outcome_of(result, words) == outcome


def test_blocks_are_off_in_any_channel_and_by_their_mean() -> None:
    right = np.full((40, 40, 4), 0.5, np.float32)
    assert attempt.share_off(right, right) == 0.0
    noisy = right.copy()
    noisy[::2] += 0.2
    noisy[1::2] -= 0.2
    assert attempt.share_off(noisy, right) == 0.0
    green = right.copy()
    green[:4, :8, 1] += 0.09
    assert attempt.share_off(green, right) == 2 / 100
    green[:4, :8, 1] -= 0.02
    assert attempt.share_off(green, right) == 0.0
    assert attempt.share_off(right[:20], right) == 1.0


def test_references_follow_their_source() -> None:
    """What a builder calls counts as its source, what it does not call does not."""
    source = attempt.source_of(SCENES["view_agx"].build)
    assert 'add_object("Floor"' in source and "def view_agx" in source
    assert "def view_raw" not in source and "def add_lamp" not in source


def test_unknown_names_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert judge.judge(["no_such_scene"]) == 2
    assert "no_such_scene" in capsys.readouterr().err


def test_the_collection_is_large_and_each_scene_says_what_it_is_about() -> None:
    assert len(SCENES) >= 150
    texts = [scene.text for scene in SCENES.values()]
    assert all(texts) and len(set(texts)) == len(texts)
