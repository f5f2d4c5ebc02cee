# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --command curvrefl ...` in a full Blender with the installed zip: the same results as the launcher's."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from window import SECONDS
from window_blender import WindowBlender

pytestmark = pytest.mark.usefixtures("gpu")

BALL = ("--reflector", "Mirror Ball")
SIZE = ("--resolution", "64x48")

type Command = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def blender(window_blender: WindowBlender, installed: dict[str, str]) -> Command:
    """Calls Blender without a window, with the extension."""

    def call(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*window_blender.headless, "--command", *map(str, arguments)],
            env=installed,
            capture_output=True,
            text=True,
            timeout=SECONDS,
        )

    return call


@pytest.fixture(scope="module")
def blend(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from small_scene import saved

    return saved(tmp_path_factory.mktemp("scene"))


def launcher(*arguments: str | Path) -> None:
    from blender_process import run_script
    from small_scene import RUN_VERB

    result = run_script(RUN_VERB, "--", *map(str, arguments))
    assert result.returncode == 0, result.stderr


def test_help_names_the_verbs(blender: Command) -> None:
    result = blender("curvrefl", "--help")
    assert result.returncode == 0
    for verb in ("demo", "test", "render", "compare", "bake", "build"):
        assert f"    {verb} " in result.stdout


def test_render_gives_the_same_picture(blender: Command, blend: Path, tmp_path: Path) -> None:
    from curvrefl.curvrefl_addon.report.images import load_exr

    verb = ("render", blend, *BALL, *SIZE, "--samples", "4", "--output")
    result = blender("curvrefl", *verb, tmp_path / "command" / "picture.exr")
    assert result.returncode == 0, result.stderr
    assert "Traceback" not in result.stdout + result.stderr
    launcher(*verb, tmp_path / "launcher" / "picture.exr")
    one, other = (load_exr(tmp_path / name / "picture.exr") for name in ("command", "launcher"))
    assert one.shape == other.shape == (48, 64, 4)
    assert one[..., :3].std() > 0.02, "there is something to see"
    # Another version of the driver may decide otherwise at an edge.
    difference = np.abs(one - other).max(axis=-1)
    assert np.percentile(difference, 98) < 0.005


def test_compare_gives_the_same_report(blender: Command, blend: Path, tmp_path: Path) -> None:
    methods = ("--method", "secant_star,environment_cube")
    verb = ("compare", blend, *BALL, *SIZE, *methods, "--samples", "4", "--peers", "none", "--output")
    result = blender("curvrefl", *verb, tmp_path / "command")
    assert result.returncode == 0, result.stderr
    launcher(*verb, tmp_path / "launcher")
    one, other = (report(tmp_path / name) for name in ("command", "launcher"))
    assert sorted(path.name for path in (tmp_path / "command").iterdir()) == sorted(
        path.name for path in (tmp_path / "launcher").iterdir()
    )
    for key in ("scene", "reflectors", "resolution"):
        assert one[key] == other[key]
    for key in ("engine", "samples", "light"):
        assert one["reference"][key] == other["reference"][key]
    assert one["mask_pixels"] == pytest.approx(other["mask_pixels"], rel=0.01)
    assert list(one["methods"]) == list(other["methods"]) == ["secant_star", "environment_cube"]
    for name, method in one["methods"].items():
        expected = other["methods"][name]
        assert method.keys() == expected.keys()
        assert method["image"]["psnr"] == pytest.approx(expected["image"]["psnr"], abs=0.5)
        assert method["geometry"]["wrong_object"] == pytest.approx(expected["geometry"]["wrong_object"], abs=0.01)
        median = expected["geometry"]["angle_deg"]["median"]
        assert method["geometry"]["angle_deg"]["median"] == pytest.approx(median, abs=0.01)
        assert (method["solve"] is None) == (expected["solve"] is None)
    solve, expected = (found["methods"]["secant_star"]["solve"] for found in (one, other))
    assert solve["vertices"] == expected["vertices"]
    assert solve["reflected"] == pytest.approx(expected["reflected"], rel=0.01)


def report(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((), "VERB"),
        (("polish",), "polish"),
        (("render", "/nowhere/scene.blend", *BALL, "--output", "{folder}/a.png"), "/nowhere/scene.blend"),
        (("render", "{blend}", "--reflector", "Spoon", "--output", "{folder}/a.png"), "Spoon"),
        (("render", "{blend}", *BALL, "--method", "guess", "--output", "{folder}/a.png"), "guess"),
    ],
)
def test_bad_input_is_code_2_and_one_sentence(
    blender: Command, blend: Path, tmp_path: Path, arguments: tuple[str, ...], sentence: str
) -> None:
    result = blender("curvrefl", *(part.format(blend=blend, folder=tmp_path) for part in arguments))
    assert result.returncode == 2
    (line,) = [line for line in result.stderr.splitlines() if line.startswith("curvrefl: ")]
    assert sentence in line
    assert "Traceback" not in result.stdout + result.stderr
    assert list(tmp_path.iterdir()) == []


def test_verbs_of_the_source_say_so(blender: Command) -> None:
    result = blender("curvrefl", "test")
    assert result.returncode == 2
    assert "source" in result.stderr
