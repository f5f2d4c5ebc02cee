# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules that every shader file keeps, and what Python and shaders share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.solvers import newton
from curvrefl.curvrefl_addon.renderer.device.uniform_struct import glsl_struct
from curvrefl.gpu_shaders import loader

ROOT = Path(__file__).resolve().parents[3]
SOLVERS = ROOT / "gpu_shaders" / "solvers"
SHADERS = sorted([*(ROOT / "gpu_shaders").rglob("*.glsl"), *(ROOT / "tools").rglob("*.glsl")])
MOST_COLUMNS = 119
MOST_FILES = 14


@pytest.mark.parametrize("path", SHADERS, ids=lambda path: path.name)
def test_lines_are_under_120_characters(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").splitlines()
    long = [number for number, line in enumerate(lines, 1) if len(line) > MOST_COLUMNS]
    assert long == [], f"lines of {path.relative_to(ROOT)} that need wrapping"


def test_folders_are_small() -> None:
    folders = {path.parent for path in SHADERS}
    crowded = [folder.name for folder in folders if len(list(folder.glob("*.glsl"))) > MOST_FILES]
    assert crowded == []


@pytest.mark.parametrize("path", sorted(SOLVERS.iterdir()), ids=lambda path: path.name)
def test_a_vertex_method_is_one_function(path: Path) -> None:
    """What all methods do alike is not in any method's file."""
    text = path.read_text(encoding="utf-8")
    assert text.count("\nSolved solve(int index, vec3 vertex)\n") == 1
    for word in ("void main", "imageStore", "imageLoad", "invocation()", "solver.count"):
        assert word not in text


def test_numbers_come_from_python() -> None:
    lines = loader.load("solvers/newton_stragglers.comp.glsl").text.splitlines()
    assert f"#define HIDDEN {status.HIDDEN}" in lines
    assert f"#define RUNG_COUNT {len(newton.RUNGS)}" in lines
    assert f"#define BISECTIONS_OF_ARC {newton.BISECTIONS}" in lines
    assert f"#define STRAIGHT {newton.STRAIGHT}" in lines
    assert not any(line.startswith("#from") for line in lines)


def test_block_is_declared_as_numpy_has_it() -> None:
    block = np.dtype([("place", "f4", (4, 4)), ("size", "f4", 2), ("count", "i4"), ("share", "f4")])
    assert glsl_struct("Block", block) == "struct Block { mat4 place; vec2 size; int count; float share; };"


@pytest.mark.parametrize(
    "fields",
    [
        [("share", "f4"), ("size", "f4", 2), ("count", "i4")],
        [("count", "i4"), ("eye", "f4", 4)],
        [("size", "f4", 2)],
        [("size", "f8", 2)],
        [("small", "f4", (2, 2))],
    ],
)
def test_block_that_std140_lays_out_otherwise_is_refused(fields: list[tuple[str, str]]) -> None:
    with pytest.raises(ValueError, match="Block"):
        glsl_struct("Block", np.dtype(fields))
