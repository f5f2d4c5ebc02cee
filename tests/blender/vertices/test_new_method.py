# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A new method is its shader file and its entry in the catalog: tried out in a copy of the repository."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from blender_process import run_script

pytestmark = pytest.mark.usefixtures("gpu")

ROOT = Path(__file__).resolve().parents[3]
COPIED = ("curvrefl_addon", "gpu_shaders", "operators", "tools", "tests")
CATALOG = "curvrefl_addon/optics/catalog.py"
HEADER = "// SPDX-FileCopyrightText: 2026 Curvrefl contributors\n// SPDX-License-Identifier: GPL-3.0-or-later\n"

DESCENT = """#include "solver_pieces/star_ending.glsl"

// Nothing but the safeguarded descent, from between eye and vertex.
Solved solve(int index, vec3 vertex)
{
  int iterations = 0;
  vec3 u = guess_between(solver.eye, vertex);
  bool converged = minimize(
      solver.eye, solver.focal_pixels, vertex, solver.steps, solver.tolerance, false, u, iterations);
  return finish(vertex, u, converged, iterations);
}
"""
DESCENT_ENTRY = """    "descent": Method(
        "Descent",
        "Newton on Fermat's principle, from a guess",
        "every ray from the star center leaves the reflector once",
        ("pixel_tolerance", (1.0, 0.5)),
        maps=("radial",),
        steps=30,
        curves_edges=True,
    ),
"""
PLAIN = """// By direction alone; what is found is dimmed, so that it can be told from its twin.
vec3 environment_direction(vec3 point, vec3 ray)
{
  return ray;
}

vec4 environment_at(vec3 point, vec3 ray)
{
  vec4 found = textureLod(environment, ray, 0.0);
  return vec4(0.5 * found.rgb, found.a);
}
"""
PLAIN_ENTRY = """    "environment_plain": Method(
        "Plain Environment",
        "Blinn & Newell 1976, dimmed",
        "everything is infinitely far away",
        ("environment_resolution", (64, 128)),
    ),
"""


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """The repository, as far as pictures need it."""
    for name in COPIED:
        shutil.copytree(ROOT / name, tmp_path / "copy" / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "__init__.py", tmp_path / "copy")
    return tmp_path / "copy"


def add_method(copy: Path, shader: str, source: str, entry: str) -> None:
    """The two files: a shader of this name and an entry at the catalog's end."""
    assert not (copy / shader).exists()
    (copy / shader).write_text(HEADER + source, encoding="utf-8")
    catalog = copy / CATALOG
    text = catalog.read_text(encoding="utf-8").rstrip()
    assert text.endswith("}")
    catalog.write_text(f"{text[:-1]}{entry}}}\n", encoding="utf-8")


def drawn(copy: Path, twin: str, method: str, folder: Path) -> tuple[dict, dict, list[dict]]:
    """Pictures of the twin and of the new method, and what each says of its solve."""
    run = run_script(copy / "tests" / "blender" / "new_method_session.py", twin, method, str(folder))
    assert run.returncode == 0, run.stdout + run.stderr
    said = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
    assert [item["method"] for item in said] == [twin, method]
    pictures = [dict(np.load(folder / f"{name}.npz")) for name in (twin, method)]
    return pictures[0], pictures[1], said


def test_new_vertex_method_is_two_files(copy: Path, tmp_path: Path) -> None:
    add_method(copy, "gpu_shaders/solvers/descent.comp.glsl", DESCENT, DESCENT_ENTRY)
    old, new, said = drawn(copy, "secant_star", "descent", tmp_path)
    solved = [item["solve"] for item in said]
    assert solved[1]["vertices"] == solved[0]["vertices"] > 100
    assert abs(solved[1]["reflected"] - solved[0]["reflected"]) < 0.01 * solved[0]["reflected"]
    assert solved[1]["unconverged"] < 0.01 * solved[1]["vertices"]
    # It is not the twin that has run.
    assert abs(solved[1]["iterations"]["mean"] - solved[0]["iterations"]["mean"]) > 0.5
    ball = old["mask"] > 0
    assert ball.sum() > 1000
    np.testing.assert_array_equal(new["mask"], old["mask"])
    assert (new["shown"] == old["shown"])[ball].mean() > 0.995
    assert len(np.unique(new["shown"][ball])) >= 3
    assert np.percentile(np.abs(new["color"] - old["color"])[ball], 99) < 0.01


def test_new_lookup_is_two_files(copy: Path, tmp_path: Path) -> None:
    add_method(copy, "gpu_shaders/environments/environment_plain.glsl", PLAIN, PLAIN_ENTRY)
    old, new, _ = drawn(copy, "environment_cube", "environment_plain", tmp_path)
    # Within the ball's outline: on it pixels are in part of what is behind.
    ball = np.zeros(old["mask"].shape, bool)
    ball[2:-2, 2:-2] = np.min(
        [np.roll(old["mask"] > 0, (row, column), (0, 1))[2:-2, 2:-2] for row in (-2, 2) for column in (-2, 2)], axis=0
    )
    assert ball.sum() > 1000
    assert old["color"][ball][:, :3].max() > 0.01
    np.testing.assert_allclose(new["color"][ball][:, :3], 0.5 * old["color"][ball][:, :3], rtol=1e-3, atol=1e-5)
    assert (new["shown"] == old["shown"])[ball].mean() > 0.995
