# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Only `renderer/device` knows Blender's `gpu` module, and a define of GLSL has one value, in Python or in GLSL."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.gpu_shaders.loader import Snippet, load

ROOT = Path(__file__).resolve().parents[3]
DEVICE = ROOT / "curvrefl_addon" / "renderer" / "device"


def imported(source: str) -> Iterator[str]:
    """Names of modules that a file imports anywhere in it."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module is not None:
            yield node.module


def knows_gpu(source: str) -> bool:
    return any(name.split(".")[0] in ("gpu", "gpu_extras") for name in imported(source))


@pytest.mark.parametrize(
    "source", ["import gpu", "def f():\n    from gpu_extras.batch import batch_for_shader", "import numpy, gpu.types"]
)
def test_the_check_finds_imports(source: str) -> None:
    assert knows_gpu(source)


def test_gpu_is_imported_under_device_alone() -> None:
    files = [*ROOT.glob("curvrefl_addon/**/*.py"), *ROOT.glob("operators/**/*.py"), *ROOT.glob("gpu_shaders/*.py")]
    knowing = [file for file in files if knows_gpu(file.read_text(encoding="utf-8"))]
    assert knowing, "the device itself imports it"
    assert [file.relative_to(ROOT) for file in knowing if DEVICE not in file.parents] == []


def test_no_glsl_literal_of_what_python_injects() -> None:
    """A `#define` in a file would quietly win over the value that Python gives."""
    injected = set()
    for file in ROOT.glob("curvrefl_addon/renderer/**/*.py"):
        text = file.read_text(encoding="utf-8")
        injected |= set(re.findall(r'"([A-Z][A-Z0-9_]+)": [A-Za-z0-9_.\[\](]', text))
    assert {"MATERIAL_RECORDS", "STACK", "WORLD_MAP_SIZE", "LARGEST_COORDINATE"} <= injected
    twice = [
        f"{file.relative_to(ROOT)}: {name}"
        for file in ROOT.glob("gpu_shaders/**/*.glsl")
        for name in re.findall(r"^#define (\w+) ", file.read_text(encoding="utf-8"), re.MULTILINE)
        if name in injected
    ]
    assert twice == []


def test_glsl_takes_numbers_from_python(tmp_path: Path) -> None:
    """With the line that asks for them, where errors are told."""
    file = tmp_path / "asking.glsl"
    file.write_text("// One\n#from optics.status import REFLECTED, HIDDEN as BEHIND\nvoid main() {}\n")
    source = load(file)
    lines = ["// One", f"#define REFLECTED {status.REFLECTED}", f"#define BEHIND {status.HIDDEN}", "void main() {}"]
    assert source.text.splitlines() == lines
    assert [line for _, line in source.places] == [1, 2, 2, 3]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("#from optics.nowhere import REFLECTED", ImportError),
        ("#from optics.status import NOTHING", AttributeError),
        ("#from optics.status import SENTENCES", TypeError),
    ],
)
def test_what_is_no_number_is_refused(line: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        load(Snippet(f"asks for {error.__name__}", line))
