# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A full disk: one sentence, exit code 1 or 2, and nothing is there that was not there before."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from small_scene import saved

if sys.platform == "win32":
    pytest.skip("there are no limits to lower", allow_module_level=True)

from faults.limits import largest_file

pytestmark = pytest.mark.usefixtures("gpu")

BALL = ("--reflector", "Mirror Ball")
TWENTY_SIZES = (0, 1, 7, 8, 30, 33, 60, 100, 150, 200, 250, 300, 330, 350, 400, 1000, 3000, 5000, 8000, 12000)
"""Bytes, less than the pass beside the picture takes"""


def arguments(verb: str, file: Path, output: Path) -> list[str]:
    match verb:
        case "render.png" | "render.exr":
            passes = ["--passes", "color,position", "--output", str(output / f"x{verb[-4:]}")]
            return ["render", str(file), *BALL, "--samples", "1", *passes]
        case "compare":
            quick = ["--method", "exact", "--samples", "1", "--peers", "none"]
            return ["compare", str(file), *BALL, *quick, "--output", str(output)]
        case "bake":
            return ["bake", str(file), *BALL, "--resolution", "16", "--output", str(output)]
        case "benchmark":
            return ["benchmark", "--vertices", "1000", "--triangles", "1000", "--output", str(output)]
    raise AssertionError(verb)


CASES = [
    *[("render.png", size) for size in TWENTY_SIZES],
    *[("render.exr", size) for size in (0, 500, 12000)],
    *[("compare", size) for size in (200, 1500, 3000)],
    *[("bake", size) for size in (0, 1000, 20000)],
    ("benchmark", 100),
]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return saved(tmp_path_factory.mktemp("scene"))


@pytest.mark.parametrize(("verb", "size"), CASES)
def test_a_verb(verb: str, size: int, file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = arguments(verb, file, tmp_path / "out")
    with largest_file(size):
        code = cli.main(given)
    # (capfd would write it into a file)
    err = capsys.readouterr().err
    assert code in (1, 2), err
    assert re.fullmatch(r"curvrefl: Cannot write .*File too large.*\.\n", err), err
    assert list(tmp_path.iterdir()) == []


def test_what_was_there_stays(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.png").write_text("old")
    with largest_file(1000):
        assert cli.main(arguments("render.png", file, tmp_path)) == 2
    capsys.readouterr()
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("x.png", "old")]
    assert cli.main(arguments("render.png", file, tmp_path)) == 0
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


@pytest.fixture
def scene() -> Iterator[None]:
    from small_scene import build_scene

    build_scene()
    registration.register()
    bpy.data.objects["Mirror Ball"].curvrefl.is_mirror = True
    yield
    registration.unregister()


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("size", [0, 200])
@pytest.mark.parametrize("operator", ["save_preview.png", "save_preview.exr", "bake_reflector", "compare_with_cycles"])
def test_an_operator(operator: str, size: int, tmp_path: Path) -> None:
    name, _, suffix = operator.partition(".")
    call = getattr(bpy.ops.curvrefl, name)
    options = {
        "save_preview": {"filepath": str(tmp_path / f"x.{suffix}"), "samples": 1},
        "bake_reflector": {"reflector": "Mirror Ball", "folder": str(tmp_path / "maps")},
        "compare_with_cycles": {
            "output": str(tmp_path / "report"),
            "methods": {"exact"},
            "peers": set(),
            "samples": 1,
            "width": 32,
            "height": 24,
        },
    }[name]
    with pytest.raises(RuntimeError, match=r"Cannot write .*File too large"), largest_file(size):
        call(**options)
    assert list(tmp_path.iterdir()) == []
