# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The packed extension: what is in it, and its life in a Blender without any user's settings."""

from __future__ import annotations

import importlib
import json
import os
import zipfile
from pathlib import Path

import pytest
from blender_process import run_script
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.registration import OPERATORS

ROOT = Path(__file__).resolve().parents[3]
SHIPPED = {"blender_manifest.toml", "LICENSE", "README.md", "__init__.py", "curvrefl_addon", "gpu_shaders", "operators"}


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist") / "new"
    assert cli.main(["build", "--output", str(folder)]) == 0
    (package,) = folder.iterdir()
    return package


def test_only_the_extension_is_packed(package: Path) -> None:
    names = zipfile.ZipFile(package).namelist()
    assert {name.split("/")[0] for name in names} == SHIPPED
    assert {Path(name).suffix for name in names} <= {"", ".toml", ".md", ".py", ".glsl", ".npy", ".dat", ".yaml", ".js"}
    assert not [name for name in names if "__pycache__" in name]


def test_all_of_the_extension_is_packed(package: Path) -> None:
    names = set(zipfile.ZipFile(package).namelist())
    for folder in ("curvrefl_addon", "gpu_shaders", "operators"):
        sources = {
            path.relative_to(ROOT).as_posix() for path in (ROOT / folder).rglob("*") if path.suffix in (".py", ".glsl")
        }
        assert sources
        assert sources <= names


def test_enabled_and_disabled_twice_it_leaves_nothing(package: Path, tmp_path: Path) -> None:
    result = run_script(
        ROOT / "tests" / "blender" / "extension_life.py", str(package), BLENDER_USER_RESOURCES=str(tmp_path)
    )
    lines = [line for line in result.stdout.splitlines() if line.startswith("SEEN ")]
    assert len(lines) == 1, result.stdout + result.stderr
    seen = json.loads(lines[0].removeprefix("SEEN "))
    assert seen["installed"]
    for time in ("first", "second"):
        assert seen[f"{time} enabled"] == [True, True], result.stderr
        assert len(seen[f"{time} state"]["operators"]) == sum(
            len(importlib.import_module(f"curvrefl.operators.{name}").CLASSES) for name in OPERATORS
        )
        assert seen[f"{time} disabled"] == [False, False]
        assert seen[f"{time} after"] == seen["before"]
    assert seen["first state"] == seen["second state"]
    assert seen["warnings"] == {}
    assert seen["outside"] == []
    assert not seen["gpu imported"], "enabling the extension must stay quick: the renderer is imported when used"
    assert "Traceback" not in result.stderr
    assert os.listdir(tmp_path / "extensions" / "user_default" / "curvrefl")
