# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line's manners: exit codes, one sentence for bad usage, and nothing written."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.command import cli, verbs
from curvrefl.curvrefl_addon.errors import InputError

VERBS = ("demo", "test", "render", "film", "compare", "merge", "chart", "bake", "build", "check", "images", "release")
FILE = ("x.blend", "--reflector", "Ball")


def one_sentence(capfd: pytest.CaptureFixture[str]) -> str:
    """What was said on stderr, which must be one line, with nothing on stdout."""
    out, err = capfd.readouterr()
    assert out == ""
    assert re.fullmatch(r"curvrefl: \S.*\.\n", err), err
    return err


def test_help_names_every_verb_and_ends_well(capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--help"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert all(re.search(rf"^ +{verb} ", out, re.MULTILINE) for verb in VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help(verb: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main([verb, "--help"]) == 0
    assert f"curvrefl {verb}" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ([], "VERB"),
        (["chrt"], "chrt"),
        (["demo", "--speed"], "--speed"),
        (["test", "everything"], "everything"),
        (["render", "x.blend", "--output", "x.png"], "--reflector"),
        (["render", *FILE], "--output"),
        (["render", *FILE, "--output", "OUT/x.jpg"], ".png"),
        (["render", *FILE, "--output", "OUT/x"], ".exr"),
        (["render", *FILE, "--output", "OUT"], "must end in"),
        (["render", *FILE, "--output", "OUT/x.png", "--resolution", "640"], "640x480"),
        (["render", *FILE, "--output", "OUT/x.png", "--resolution", "0x480"], "out of range"),
        (["render", *FILE, "--output", "OUT/x.png", "--resolution", "640x99999"], "out of range"),
        (["render", *FILE, "--output", "OUT/x.png", "--resolution", "-640x480"], "--resolution"),
        (["render", *FILE, "--output", "OUT/x.png", "--samples", "0"], "0"),
        (["render", *FILE, "--output", "OUT/x.png", "--samples", "1000000"], "1000000"),
        (["render", *FILE, "--output", "OUT/x.png", "--samples", "many"], "many"),
        (["render", *FILE, "--output", "OUT/x.png", "--frame", "1.5"], "1.5"),
        (["render", *FILE, "--output", "OUT/x.png", "--frame", "9999999"], "9999999"),
        (["render", *FILE, "--output", "OUT/x.png", "--passes", "color,tangent"], "tangent"),
        (["render", *FILE, "--output", "OUT/x.png", "--passes", ","], "pass"),
        (["render", *FILE, "--output", "OUT/x.png", "--method", "magic"], "secant_star"),
        (["render", "x.blend", "--reflector", " , ", "--output", "OUT/x.png"], "reflector"),
        (["compare", *FILE, "--output", "OUT/a-file"], "a-file"),
        (["compare", *FILE, "--output", "OUT/a-file/below"], "a-file"),
        (["compare", *FILE, "--output", "OUT/new", "--method", "secant_star,magic"], "magic"),
        (["compare", *FILE, "--output", "OUT/new", "--peers", "luxrender"], "luxrender"),
        (["compare", *FILE, "--output", "OUT/new", "--light", "candle"], "candle"),
        (["compare", *FILE, "--output", "OUT/new", "--samples", "0"], "0"),
        (["compare", *FILE, "--output", "OUT/new", "--resolution", "1x"], "1x"),
        (["chart", "--output", "OUT/new"], "FILE.blend"),
        (["chart", "--against", "weather", "--output", "OUT/new"], "weather"),
        (["chart", "--against", "lights", "--output", "OUT/new", "--peers", "none"], "--peers"),
        (["chart", "--against", "lights", "--output", "OUT/new", "--sub-frames", "4"], "--sub-frames"),
        (["chart", "--against", "lights", "--output", "OUT/new", "--light", "full"], "FILE.blend"),
        (["chart", "--against", "lights", "--output", "OUT/new", "--light", "candle"], "candle"),
        (["chart", "--against", "lights", "--output", "OUT/new", "--reflector", "Ball"], "FILE.blend"),
        (["chart", "a.blend", "b.blend", "--against", "pixels", "--output", "OUT/new"], "one FILE.blend"),
        (["chart", "--against", "lights", "--output", "OUT/a-file"], "a-file"),
        (["chart", *FILE], "--output"),
        (["chart", *FILE, "--output", "OUT/a-file"], "a-file"),
        (["chart", *FILE, "--output", "OUT/new", "--method", "magic"], "magic"),
        (["chart", *FILE, "--output", "OUT/new", "--peers", "luxrender"], "luxrender"),
        (["chart", *FILE, "--output", "OUT/new", "--light", "candle"], "candle"),
        (["chart", *FILE, "--output", "OUT/new", "--vertices", "999"], "999"),
        (["bake", *FILE, "--output", "OUT/new", "--resolution", "4"], "4"),
        (["bake", *FILE, "--output", "OUT/new", "--resolution", "100000"], "100000"),
        (["bake", "x.blend", "--reflector", "A,B", "--output", "OUT/new"], "one reflector"),
        (["build", "--output", "OUT/a-file"], "a-file"),
        (["demo", "--output", "OUT/a-file"], "a-file"),
        (["check", "everything"], "everything"),
        (["images", "cellar.jpg"], "cellar.jpg"),
        (["release"], "VERSION"),
        (["release", "banana"], "banana"),
        (["release", "99.0.0", "--output", "OUT/a-file"], "a-file"),
    ],
)
def test_bad_usage_is_one_sentence(
    arguments: list[str], named: str, tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Said before anything is read (x.blend is not there), with exit code 2."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "OUT").mkdir()
    (tmp_path / "OUT" / "a-file").write_text("mine")
    assert cli.main(arguments) == 2
    assert named in one_sentence(capfd)
    assert [path.name for path in tmp_path.rglob("*")] == ["OUT", "a-file"]
    assert (tmp_path / "OUT" / "a-file").read_text() == "mine"


def test_the_users_mistake_is_two_and_our_failure_one(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def mistaken(_options: argparse.Namespace) -> int:
        raise InputError("Give it a name.")

    def failing(_options: argparse.Namespace) -> int:
        raise ZeroDivisionError("by our fault")

    def stopped(_options: argparse.Namespace) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(verbs, "demo", mistaken)
    assert cli.main(["demo"]) == 2
    assert one_sentence(capfd) == "curvrefl: Give it a name.\n"

    monkeypatch.setattr(verbs, "demo", failing)
    assert cli.main(["demo"]) == 1
    assert "ZeroDivisionError: by our fault" in capfd.readouterr().err

    monkeypatch.setattr(verbs, "demo", stopped)
    assert cli.main(["demo"]) == 130
    assert one_sentence(capfd) == "curvrefl: stopped by SIGINT; nothing is left of this run.\n"


def test_options_reach_the_verb(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[argparse.Namespace] = []

    def record(options: argparse.Namespace) -> int:
        seen.append(options)
        return 0

    monkeypatch.setattr(verbs, "render", record)
    monkeypatch.setattr(verbs, "compare", record)
    assert cli.main(["render", *FILE, "--resolution", "64X32", "--frame", "-3", "--output", "a.exr"]) == 0
    assert (seen[0].resolution, seen[0].frame, seen[0].camera) == ((64, 32), -3, None)
    assert cli.main(["compare", *FILE, "--output", "d"]) == 0
    assert (seen[1].light, seen[1].samples, seen[1].resolution) == ("full", 256, None)
