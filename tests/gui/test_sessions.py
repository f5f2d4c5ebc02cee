# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How sessions are played: a crash hides nothing that comes after it, and scripts see what any extension may see."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from window import Session, play_situations

PRIVATE = re.compile(r"_[a-z]\w*")


def test_what_comes_after_a_crash_is_played(tmp_path: Path) -> None:
    asked: list[list[str]] = []

    def play(names: Sequence[str]) -> Session:
        asked.append(list(names))
        seen: dict[str, Any] = {"situations": {}}
        for name in names:
            seen["situations"][name] = {}
            if name.startswith("deadly"):
                return Session(tmp_path, seen, f"{name} printed;")
            seen["situations"][name]["repaired"] = True
        return Session(tmp_path, {**seen, "finished": True}, "all printed;")

    found = play_situations(["one", "deadly", "two", "deadly too", "three"], play)
    assert asked == [["one", "deadly", "two", "deadly too", "three"], ["two", "deadly too", "three"], ["three"]]
    assert list(found.seen["situations"]) == ["one", "deadly", "two", "deadly too", "three"]
    failed = {name: item["error"] for name, item in found.seen["situations"].items() if "error" in item}
    assert list(failed) == ["deadly", "deadly too"]
    assert "deadly printed;" in failed["deadly"]
    assert found.seen["finished"]
    assert found.printed == "deadly printed;deadly too printed;all printed;"


def test_a_window_that_plays_nothing_is_not_opened_again(tmp_path: Path) -> None:
    asked: list[Sequence[str]] = []

    def play(names: Sequence[str]) -> Session:
        asked.append(names)
        return Session(tmp_path, {"situations": {}}, "no display")

    with pytest.raises(AssertionError, match="no display"):
        play_situations(["one", "two"], play)
    assert len(asked) == 1


@pytest.mark.parametrize("path", sorted(Path(__file__).parent.rglob("*.py")), ids=lambda path: path.name)
def test_nothing_private_is_read(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        name = node.attr if isinstance(node, ast.Attribute) else node.value if isinstance(node, ast.Constant) else ""
        assert not (isinstance(name, str) and PRIVATE.fullmatch(name)), f"line {node.lineno}: {name}"
