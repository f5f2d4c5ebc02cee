# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The checks of the source find what they are there for, and the verb says so."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks import shader_lines, sizes, source, spelling
from curvrefl.curvrefl_addon.command import cli


def write(root: Path, path: str, text: str) -> None:
    file = root / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def test_long_lines_of_shaders_are_named(tmp_path: Path) -> None:
    write(tmp_path, "gpu_shaders/rays/walk.glsl", f"{'x' * 119}\n{'y' * 120}\n")
    write(tmp_path, "tools/deep/down/a.glsl", "z" * 121)
    assert shader_lines.violations(tmp_path) == [
        "gpu_shaders/rays/walk.glsl:2: 120 characters, at most 119 are wanted.",
        "tools/deep/down/a.glsl:1: 121 characters, at most 119 are wanted.",
    ]


def test_large_files_and_folders_are_named(tmp_path: Path) -> None:
    write(tmp_path, "operators/just.py", "x\n" * 350)
    write(tmp_path, "operators/long.py", "x\n" * 351)
    write(tmp_path, "docs/long.py", "x\n" * 351)
    for number in range(14):
        write(tmp_path, f"tests/unit/test_{number}.py", "")
        write(tmp_path, f"tests/unit/__pycache__/test_{number}.pyc", "")
        write(tmp_path, f"tests/blender/test_{number}.py", "")
    write(tmp_path, "tests/blender/data.npy", "")
    assert sizes.violations(tmp_path) == [
        "operators/long.py: 351 lines, at most 350 are wanted.",
        "tests/blender: 15 files, at most 14 are wanted.",
    ]


def test_misspelled_words_are_named_in_names_too(tmp_path: Path) -> None:
    pytest.importorskip("codespell_lib")
    write(tmp_path, spelling.MORE, (source.ROOT / spelling.MORE).read_text())
    # (written in parts: this file is checked as well)
    british = ("base_col" + "our = 1", "class Neighb" + "ours:", "# recie" + "ved", "# neighb" + "ourhood")
    write(tmp_path, "curvrefl_addon/a.py", "\n".join([*british, "return {'CANCELLED'}", "textureLod = arange"]))
    found = spelling.violations(tmp_path)
    assert [line.split()[0] for line in found] == [f"curvrefl_addon/a.py:{number}:" for number in (1, 2, 3, 4)]


def test_a_failed_check_is_exit_code_1(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, "gpu_shaders/a.glsl", "x" * 120)
    assert source.run(["shaders"], tmp_path) == 1
    assert "a.glsl:1" in capfd.readouterr().out
    write(tmp_path, "gpu_shaders/a.glsl", "x")
    assert source.run(["shaders"], tmp_path) == 0
    assert capfd.readouterr().out == "shaders: passed\n"


def test_what_python_lacks_is_said_and_skipped(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(source.NEEDS, "lint", "no_such_module_here")
    assert source.run(["lint"], tmp_path) == 0
    assert "lacks no_such_module_here: lint is skipped" in capfd.readouterr().err


def test_the_verb_runs_the_named_checks(capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", "imports"]) == 0
    assert capfd.readouterr().out == "imports: passed\n"
    assert cli.main(["check", "cellar"]) == 2
    assert capfd.readouterr().err.startswith('curvrefl: There is no check "cellar": choose from lint, types, ')
