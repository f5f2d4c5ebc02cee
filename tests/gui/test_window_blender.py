# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which Blender the gui tests run in, and the reason where there is none."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import window_blender
from window_blender import NoWindowBlenderError, find_or_make, mirror_in

posix = pytest.mark.skipif(sys.platform == "win32", reason="the stand-in is a shell script")


def program(folder: Path, name: str, says: str) -> Path:
    path = folder / name
    path.write_text(f"#!/bin/sh\necho '{says}'\n", encoding="utf-8")
    path.chmod(0o755)
    return path


@pytest.fixture
def alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """No Blender named, no screen, and no programs but those in the returned folder."""
    for name in ("BLENDER", window_blender.VARIABLE, "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path


@posix
def test_application_gets_a_virtual_screen(alone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blender = program(alone, "blender", "Blender 5.2.1 LTS")
    program(alone, "xvfb-run", "")
    monkeypatch.setenv("BLENDER", str(blender))
    monkeypatch.setenv(window_blender.VARIABLE, "another")
    found = find_or_make()
    assert found.windowed[0] == "xvfb-run"
    assert found.windowed[-1] == str(blender)
    assert found.headless == (str(blender),)


@posix
@pytest.mark.skipif(sys.platform == "darwin", reason="there always is a display")
def test_application_without_a_screen_is_of_no_use(alone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BLENDER", str(program(alone, "blender", "Blender 5.2.1 LTS")))
    with pytest.raises(NoWindowBlenderError, match="display"):
        find_or_make()
    monkeypatch.setenv("DISPLAY", ":7")
    assert find_or_make().windowed == (str(alone / "blender"),)


@posix
@pytest.mark.parametrize("says", ["Blender 4.5.3 LTS", "Blender 5.1.0"])
def test_older_application_is_refused(alone: Path, monkeypatch: pytest.MonkeyPatch, says: str) -> None:
    monkeypatch.setenv("BLENDER", str(program(alone, "blender", says)))
    with pytest.raises(NoWindowBlenderError, match=r"and 5\.2 is needed"):
        find_or_make()


@posix
def test_command_is_taken_as_it_is(alone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program(alone, "opener", "")
    monkeypatch.setenv(window_blender.VARIABLE, "opener --screen 'a b'")
    assert find_or_make().windowed == ("opener", "--screen", "a b")


@pytest.mark.parametrize("variable", ["BLENDER", window_blender.VARIABLE])
def test_name_of_nothing_is_said(alone: Path, monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    monkeypatch.setenv(variable, "/nowhere/blender")
    with pytest.raises(NoWindowBlenderError, match=f"{variable} is '/nowhere/blender', which is not a program"):
        find_or_make()


@pytest.mark.usefixtures("alone")
def test_machine_on_which_no_root_can_be_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "freebsd14")
    with pytest.raises(NoWindowBlenderError, match="freebsd14"):
        find_or_make()
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(window_blender.os, "geteuid", lambda: 1000, raising=False)
    with pytest.raises(NoWindowBlenderError, match="root only"):
        find_or_make()
    monkeypatch.setattr(window_blender.os, "geteuid", lambda: 0, raising=False)
    with pytest.raises(NoWindowBlenderError, match="needs the program"):
        find_or_make()


@pytest.mark.parametrize(
    ("text", "mirror"),
    [
        ("Types: deb\n# http://old.example/debian\nURIs: http://a.example/debian/\nSuites: bookworm\n", "a.example"),
        ("URIs: http://b.example/debian-security\n\nURIs: https://c.example/debian\n", "c.example"),
        ("deb [arch=amd64 signed-by=/k] http://d.example/debian trixie main\n", "d.example"),
        ("# deb http://e.example/debian sid main\ndeb-src http://e.example/debian sid main\n", None),
        ("deb http://packages.example/cloud stable main\n", None),
    ],
)
def test_mirror_is_the_one_that_apt_uses(text: str, mirror: str | None) -> None:
    found = mirror_in(text)
    assert (found.split("/")[2] if found else None) == mirror
    assert found is None or found.endswith("/debian")
