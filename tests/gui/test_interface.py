# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels draw, a click traces, the modal comparison can be canceled and gives what a script gets."""

from __future__ import annotations

from pathlib import Path

import pytest
from window import Session, run_interface_session
from window_blender import WindowBlender


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory, window_blender: WindowBlender, archive: Path) -> Session:
    return run_interface_session(window_blender, tmp_path_factory.mktemp("interface"), archive)


def test_no_panel_menu_or_handler_raises(session: Session) -> None:
    assert not session.seen["error"], session.seen["error"]
    assert "Traceback" not in session.printed, session.printed[-3000:]


def test_inspection_in_the_window(session: Session) -> None:
    """Combs and joints are drawn and told, the view is saved at its size, tables have their rows."""
    import bpy

    assert session.seen["combs"]["Sections"] == "1"
    assert int(session.seen["joints"]["Edges"]) > 4
    assert session.seen["joints are stale"]
    image = bpy.data.images.load(str(session.folder / "view.png"))
    assert image.size[0] > 400 and image.size[1] > 300
    tables = {
        what: (session.folder / f"{what}.csv").read_text().splitlines() for what in ("curvature", "combs", "joints")
    }
    assert len(tables["curvature"]) > 100
    assert len(tables["combs"]) == 151
    assert len(tables["joints"]) == 1 + int(session.seen["joints"]["Edges"])


def test_trace_by_a_click(session: Session) -> None:
    assert session.seen["trace is modal"]
    assert session.seen["trace after escape"] == [False, False]
    assert session.seen["trace"]["Mirror"] == "Kettle"


def test_escape_cancels_the_comparison_and_leaves_nothing(session: Session) -> None:
    assert session.seen["comparison is modal"]
    assert session.seen["comparison after escape"] == {
        "settings are back": True,
        "files": [],
        "left": [],
        "text": False,
    }


def test_modal_comparison_is_that_of_a_script(session: Session) -> None:
    modal, script = session.seen["report of the modal run"], session.seen["report of the script"]
    assert list(modal["methods"]) == list(script["methods"]) == ["secant_star", "environment_cube"]
    assert any("secant_uv" in warning and "UV map" in warning for warning in modal["warnings"])
    for name, method in modal["methods"].items():
        other = script["methods"][name]
        assert method["image"] == other["image"]
        assert method["solve"] == other["solve"]
        assert method["geometry"] == other["geometry"]
    assert session.seen["settings after all"]
    assert session.seen["image editor shows"] == "Curvrefl secant_star"
