# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `farm`: bundles as Deadline Cloud's own package reads them before it sends them, and what is refused."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.farm.bundle import FLAMENCO_JOB_TYPE
from farm import farm_tools
from farm.workers import SESSION
from small_scene import saved

BALL = ("--reflector", "Mirror Ball")


@pytest.fixture(scope="module")
def programs() -> Path:
    try:
        return farm_tools.find_or_make()
    except farm_tools.NoFarmToolsError as error:
        pytest.skip(f"no tools of render farms: {error}")


def told(programs: Path, *arguments: str | Path) -> list[dict[str, Any]]:
    command = [str(programs / "python"), str(SESSION), *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return [json.loads(line) for line in result.stdout.splitlines()]


def test_what_is_submitted(programs: Path, tmp_path: Path) -> None:
    pictures = tmp_path / "pictures"
    pictures.mkdir()

    def with_pictures(_ball: bpy.types.Object) -> None:
        for name in ("plain.png", "tiles.1001.png", "tiles.1002.png", "film_01.png", "film_02.png", "not_ours.png"):
            image = bpy.data.images.new(name, 4, 4)
            image.save(filepath=str(pictures / name))
            bpy.data.images.remove(image)
        for name, source in (("plain.png", "FILE"), ("tiles.<UDIM>.png", "TILED"), ("film_01.png", "SEQUENCE")):
            image = bpy.data.images.load(str(pictures / name.replace("<UDIM>", "1001")))
            image.source = source
            image.filepath = str(pictures / name)
            image.use_fake_user = True

    file, bundle = saved(tmp_path, with_pictures), tmp_path / "bundle"
    given = ["--frames", "1-9:2", "--frames-per-task", "2", "--peers", "none", "--sub-frames", "3", "--camera", "Eye"]
    made = ["--program", "'/a b/blender' --command curvrefl", "--report", str(tmp_path / "report")]
    assert cli.main(["farm", "openjd", str(file), *BALL, *given, *made, "--output", str(bundle)]) == 0
    assert sorted(path.name for path in bundle.iterdir()) == [
        "asset_references.yaml",
        "parameter_values.yaml",
        "template.yaml",
    ]
    (sent,) = told(programs, "submission", bundle)
    names = ("film_01.png", "film_02.png", "plain.png", "tiles.1001.png", "tiles.1002.png")
    assert sent["assets"]["inputs"]["filenames"] == sorted([str(file), *(str(pictures / name) for name in names)])
    assert sent["assets"]["outputs"]["directories"] == [str(tmp_path / "report")]
    assert sent["job"] == {"File": {"path": str(file)}, "Output": {"path": str(tmp_path / "report")}}
    assert sent["controls"]["Light"] == "DROPDOWN_LIST" and sent["farm"] == {}
    values = {"File": str(file), "Output": str(tmp_path / "report")}
    compare, merge = told(programs, "plan", bundle, json.dumps(values))
    assert [task["Frames"][1] for task in compare["tasks"]] == ["1,3", "5,7", "9"]
    assert (merge["after"], merge["tasks"]) == (["Compare"], [{}])
    template = (bundle / "template.yaml").read_text(encoding="utf-8")
    for text in ('default: "/a b/blender"', '- "--command"', '- "--camera=Eye"', '- "--sub-frames=3"', '"32x24"'):
        assert text in template
    assert "$" not in "".join(line for line in template.splitlines() if not line.startswith("#"))


def test_flamencos_job_type_is_written(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["farm", "flamenco", "--output", str(tmp_path / "scripts")]) == 0
    (path,) = (tmp_path / "scripts").iterdir()
    assert capfd.readouterr().out == f"{path}\n" and path.read_bytes() == FLAMENCO_JOB_TYPE.read_bytes()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("--reflector", "Spoon"), "Spoon"),
        (("--camera", "Nose"), "Nose"),
        (("--camera", "{{Eye}}"), "{{Eye}}"),
        (("--method", "guess"), "guess"),
        (("--light", "dim"), "dim"),
        (("--program", " "), "program"),
    ],
)
def test_what_is_refused(change: tuple[str, ...], said: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path, lambda _ball: setattr(bpy.data.objects["Eye"], "name", "{{Eye}}"))
    given = ["farm", "openjd", str(file), *BALL, "--frames", "1-2", "--report", str(tmp_path / "report")]
    assert cli.main([*given, "--output", str(tmp_path / "bundle"), *change]) == 2
    assert said in capfd.readouterr().err
    assert not (tmp_path / "bundle").exists()


def test_systems_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["farm"]) == 2
    assert cli.main(["farm", "abacus"]) == 2
    assert "flamenco" in capfd.readouterr().err
