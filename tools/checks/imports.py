# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports of what ships run one way: from higher rooms to lower ones, never back and never between neighbors.

The house is TIERS, lowest first. An import inside a function counts as one at the top of a file.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

TIERS: tuple[tuple[str, ...], ...] = (
    ("errors", "held_folders", "pacing", "streams", "supervised", "written_files", "gpu_shaders"),
    ("memory", "output", "optics", "setting"),
    ("settings_choices",),
    ("diagnostics",),
    ("settings_table",),
    ("scene", "renderer.settings"),
    ("diagnostics.colors",),
    ("options",),
    ("renderer.device",),
    ("renderer.cells",),
    ("renderer.geometry",),
    ("renderer.programs",),
    ("renderer.surfaces",),
    ("renderer.mirrors",),
    ("renderer.costs",),
    ("renderer.paths",),
    ("renderer.vertices", "renderer.rays", "renderer.lighting"),
    ("renderer.indirect",),
    ("renderer.shading",),
    ("renderer.tracing",),
    ("renderer.caustics",),
    ("renderer.environments",),
    ("renderer.shown",),
    ("renderer.truth",),
    ("renderer.reuse",),
    ("renderer",),
    ("renderer.proofs",),
    ("renderer.measured",),
    ("report", "demo", "design", "farm"),
    ("study",),
    ("inspection",),
    ("viewport",),
    ("engine",),
    ("frames",),
    ("film",),
    ("ui",),
    ("operators",),
    ("gpu_caches",),
    ("command",),
    ("registration",),
    ("",),
)
"""Rooms that may import from those above them in this table. A room is a package or a module of curvrefl_addon, or a
folder beside it; "renderer" is what lies at its root, "" the extension itself"""

ALLOWED = (("command", "registration"),)
"""The command line makes Blender know the Mirror switch of a file where the extension is not installed"""

SHIPPED = ("__init__.py", "curvrefl_addon", "gpu_shaders", "operators")


def violations(root: Path) -> list[str]:
    """A sentence for each import that goes up or sideways, and for each module that is in no room of the table."""
    height = {room: number for number, tier in enumerate(TIERS) for room in tier}
    found: list[str] = []
    for path in _sources(root):
        source = path.relative_to(root)
        room = _room(_module(source), height)
        if room is None:
            found.append(f"{source}: is in no room of tools/checks/imports.py.")
            continue
        for line, target in _imports(path, root):
            other = _room(target, height)
            if other is None:
                found.append(f"{source}:{line}: {'.'.join(target)} is in no room of tools/checks/imports.py.")
            elif other != room and height[other] >= height[room] and (room, other) not in ALLOWED:
                found.append(f"{source}:{line}: {room or 'the extension'} may not import from {other}.")
    return found


def _sources(root: Path) -> list[Path]:
    paths = [root / name for name in SHIPPED]
    return [file for path in paths for file in (sorted(path.rglob("*.py")) if path.is_dir() else [path])]


def _module(source: Path) -> tuple[str, ...]:
    """The names that lead to a file's module from the package's root."""
    parts = source.with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


def _room(module: tuple[str, ...], height: dict[str, int]) -> str | None:
    """The longest name in the table that the module's begins with; those of packages hold for all in them."""
    names = module[1:] if module[:1] == ("curvrefl_addon",) else module
    if module and not names:
        return ""
    for length in range(len(names), -1, -1):
        room = ".".join(names[:length])
        if room in height and (room or not names):
            return room
    return None


def _imports(path: Path, root: Path) -> Iterator[tuple[int, tuple[str, ...]]]:
    """(line, names from the package's root) of each relative import: all that ships imports itself so."""
    package = path.relative_to(root).parts[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = package[: len(package) - node.level + 1]
        target = (*base, *(node.module.split(".") if node.module else ()))
        if (root.joinpath(*target)).is_dir():
            # What is imported from a package may be a module in it.
            yield from ((node.lineno, _inside(root, target, name.name)) for name in node.names)
        else:
            yield node.lineno, target


def _inside(root: Path, package: tuple[str, ...], name: str) -> tuple[str, ...]:
    folder = root.joinpath(*package)
    return (*package, name) if (folder / f"{name}.py").is_file() or (folder / name).is_dir() else package
