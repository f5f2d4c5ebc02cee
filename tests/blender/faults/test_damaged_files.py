# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A few of the damaged files that tests/nightly/fuzz_files.py opens by the thousand; names that are hard to write."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

import bpy
import pytest
from curvrefl.curvrefl_addon.command import cli
from nightly.fuzz_files import fuzz, seed_file
from small_scene import saved

pytestmark = [
    pytest.mark.usefixtures("gpu"),
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="names of bytes, limits of memory"),
]

BALL = ("--reflector", "Mirror Ball")
QUICK = (*BALL, "--method", "exact", "--samples", "1")


@pytest.mark.skipif(bool(bpy.app.binary_path), reason="opens them in the wheel")
def test_damaged_files_neither_hang_nor_write_elsewhere(tmp_path: Path) -> None:
    folder = tmp_path / "fuzzed"
    folder.mkdir()
    result = fuzz(seed_file(tmp_path), 25, 0, folder)
    assert result.bad == []
    assert result.outcomes["shown"] > 0 and result.outcomes["refused"] > 0
    assert sum(result.outcomes.values()) == 25


def test_names_that_are_no_utf_8(tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    odd = Path(os.fsdecode(os.fsencode(tmp_path) + b"/odd\xff"))
    odd.mkdir()
    file = odd / "scene.blend"
    shutil.copy(saved(tmp_path), file)
    capfdbinary.readouterr()
    assert cli.main(["render", str(file), *QUICK, "--passes", "color,object", "--output", str(odd / "x.png")]) == 0
    assert cli.main(["compare", str(file), *QUICK, "--peers", "none", "--output", str(odd / "report")]) == 0
    out, err = capfdbinary.readouterr()
    assert err == b""
    assert b"odd\xff/report/report.html" in out
    assert sorted(path.name for path in odd.iterdir()) == ["report", "scene.blend", "x.png", "x_object.exr"]
    for name in ("\udcff", "Mirror Ball,\udcff"):
        assert cli.main(["render", str(file), "--reflector", name, "--output", str(odd / "y.png")]) == 2
        assert capfdbinary.readouterr()[1].count(b"\n") == 1


def refused(code: int, capfd: pytest.CaptureFixture[str]) -> str:
    err = capfd.readouterr().err
    assert code == 2 and re.fullmatch(r"curvrefl: .*\.\n", err), err
    return err


@pytest.mark.parametrize("name", ["a" * 300 + ".png", f"new/{'ä' * 200}/x.png", "a" * 245 + ".png"])
def test_names_that_are_too_long(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path)
    capfd.readouterr()
    code = cli.main(["render", str(file), *QUICK, "--passes", "color,iterations", "--output", str(tmp_path / name)])
    assert "File name too long" in refused(code, capfd)
    assert [path.name for path in tmp_path.iterdir()] == ["files"]
    code = cli.main(["render", str(tmp_path / f"{'b' * 300}.blend"), *QUICK, "--output", str(tmp_path / "x.png")])
    assert "too long" in refused(code, capfd)


def test_links_are_followed(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path)
    capfd.readouterr()
    (tmp_path / "real").mkdir()
    for name, target in (("a.png", "real/b.png"), ("loop.png", "loop.png"), ("device.png", "/dev/full")):
        (tmp_path / name).symlink_to(target)
    (tmp_path / "folder").symlink_to("nowhere")
    for before in (None, "old"):
        if before is not None:
            (tmp_path / "real" / "b.png").write_text(before)
        assert cli.main(["render", str(file), *QUICK, "--output", str(tmp_path / "a.png")]) == 0
        assert (tmp_path / "a.png").is_symlink()
        assert (tmp_path / "real" / "b.png").read_bytes().startswith(b"\x89PNG")
    for name, said in (("loop.png", "symbolic links"), ("device.png", "a device"), ("folder/x.png", "link to nothing")):
        code = cli.main(["render", str(file), *QUICK, "--output", str(tmp_path / name)])
        assert said in refused(code, capfd)
    assert Path("/dev/full").is_char_device()
