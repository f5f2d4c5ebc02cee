# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page that plays a comparison over frames, its script in Node, and which frames a contact sheet shows."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.study.sequence import merge, page
from curvrefl.curvrefl_addon.study.sequence.curves import color_of, draw_times
from curvrefl.curvrefl_addon.study.sequence.page import sequence_page
from curvrefl.curvrefl_addon.study.sequence.sheet import chosen_frames
from scenes.sequences.kept_frames import GRAY, kept_frame, write_frame

PLAYER = Path(page.__file__).with_name("player.js")
VOID = {"meta", "img", "input", "line"}
"""Elements without an end"""


class Elements(HTMLParser):
    """What is opened is closed; which ids there are, and what is linked to."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: set[str] = set()
        self.links: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        self.ids |= {value for name, value in attrs if name == "id" and value}
        self.links |= {value for name, value in attrs if name in ("src", "href") and value}

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture
def report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Three frames; the second is brighter, the third another camera's."""
    monkeypatch.setattr(merge, "has_matplotlib", lambda: False)
    for frame in (1, 2, 3):
        pictures = (GRAY, GRAY + 0.1 * (frame == 2), GRAY)
        camera = 'The </script> "other" one' if frame == 3 else "Camera"
        write_frame(tmp_path, kept_frame(frame, camera=camera, pictures=pictures), warnings=["Less <than> all."])
    return merge.merge_frames(tmp_path)


def test_the_page_holds_all_that_it_needs(report: dict[str, Any], tmp_path: Path) -> None:
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert text == sequence_page(report, has_sheet=False)
    found = Elements()
    found.feed(text)
    assert not found.open
    script = PLAYER.read_text(encoding="utf-8")
    asked = set(re.findall(r'\$\("([\w-]+)"\)', script)) | {"data", "mode-side", "mode-flip", "mode-difference"}
    assert len(asked) > 20 and asked <= found.ids
    assert all((tmp_path / link).is_file() for link in found.links), found.links
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "Less &lt;than&gt; all." in text
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])  # type: ignore[index]
    assert [frame["folder"] for frame in data["frames"]] == ["frame_0001", "frame_0002", "frame_0003"]
    assert data["frames"][2]["cut"].startswith('the camera is "The </script>')
    assert data["values"]["flicker"]["exact"][0] is None and data["values"]["flicker"]["exact"][1] > 0.09
    assert "cycles1" in data["values"]["flicker"] and "cycles1" not in data["values"]["pop"]
    assert set(data["colors"]) == {"exact", "cycles1"}
    with_sheet = Elements()
    with_sheet.feed(sequence_page(report))
    assert with_sheet.links - found.links == {"contact_sheet.png", "curves.svg", "times.svg"}


def test_the_players_functions() -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node.js is not installed")
    asked = """
const p = require(process.argv[1]);
console.log(JSON.stringify({
  stepped: [p.stepped(0, -1, 5), p.stepped(4, 1, 5), p.stepped(2, 1, 5)],
  indexAt: [p.indexAt(-9, 10, 100, 5), p.indexAt(60, 10, 100, 5), p.indexAt(999, 10, 100, 5), p.indexAt(3, 10, 0, 5)],
  xOf: [0, 2, 4].map((index) => p.xOf(index, 10, 100, 5)).concat(p.xOf(0, 10, 100, 1)),
  rangeOf: [p.rangeOf([[1, null], [3]]), p.rangeOf([[-1, 2]]), p.rangeOf([[null]]), p.rangeOf([[0, 0]])],
  runsOf: p.runsOf([null, 1, 2, null, 3], (x) => x, (y) => 10 * y),
  told: [p.told(null, 2), p.told(1.005, 1), p.told(undefined, 1)],
  worst: [p.worstFirst([1, null, 3, 3, 2], false), p.worstFirst([1, null, 3, 3, 2], true)],
  next: [p.nextWorst([2, 3, 4], 2), p.nextWorst([2, 3, 4], 4), p.nextWorst([2, 3, 4], 0), p.nextWorst([], 7)],
  keys: [p.actionOf(" "), p.actionOf("ArrowLeft"), p.actionOf("q")],
}));
"""
    result = subprocess.run([node, "-e", asked, str(PLAYER)], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout) == {
        "stepped": [4, 0, 3],
        "indexAt": [0, 2, 4, 0],
        "xOf": [10, 60, 110, 60],
        "rangeOf": [[0, 3], [-1, 2], [0, 1], [0, 1]],
        "runsOf": [[[1, 10], [2, 20]], [[4, 30]]],
        "told": ["-", "1.0", "-"],
        "worst": [[2, 3, 4, 0], [0, 4, 2, 3]],
        "next": [3, 2, 2, 7],
        "keys": ["play", "previous", ""],
    }


def test_a_contact_sheet_shows_the_worst_and_others_between() -> None:
    worst = {
        "flicker": [{"frame": 33, "method": "exact", "value": 1.0}, {"frame": 2, "method": "exact", "value": 0.5}],
        "pop": [{"frame": 33, "method": "exact", "value": 1.0}],
        "flip": [],
    }
    report = {"frames": [{"frame": number} for number in range(1, 49)], "worst": worst}
    chosen = chosen_frames(report)
    assert len(chosen) == 8 and list(chosen) == sorted(chosen)
    assert chosen[33] == ["worst: Flicker", "worst: Pop, pixels"]
    assert {1, 48} < set(chosen) and all(not what for frame, what in chosen.items() if frame != 33)
    assert np.diff(list(chosen)).max() < 12
    assert list(chosen_frames(report | {"frames": [{"frame": 5}], "worst": worst | {"flicker": [], "pop": []}})) == [5]


def test_times_are_drawn(tmp_path: Path) -> None:
    row = {"median": 10.0, "slow_frames": [3], "frames": {"1": 10.0, "2": 9.0, "3": 44.0}}
    draw_times({"methods": {"exact": row}}, "about", tmp_path / "times")
    text = (tmp_path / "times.svg").read_text()
    # (the curve, its legend, and the ring)
    assert text.count(color_of("exact", []).lower()) > 3 and (tmp_path / "times.png").is_file()
