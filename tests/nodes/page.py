# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of nodes (docs/nodes.md), as Cycles has judged them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from .judge import TOLERANCE
from .shaders import JudgedShader
from .table import Judged

PAGE = Path(__file__).resolve().parents[2] / "docs" / "nodes.md"
WHOLE = "as it is"
"""A node without modes"""
HEAD = """\
<!-- SPDX-FileCopyrightText: 2026 Curvrefl contributors -->
<!-- SPDX-License-Identifier: GPL-3.0-or-later -->
<!-- Written by tools/nodes/write_nodes.py by the judges of tests/nodes: call it after a change of nodes. -->

# Nodes

Node trees are compiled to programs ([how it is built](architecture.md)), and Blender itself is the judge of each node:
Cycles renders it, in each of its modes and with several inputs, as the emission of a plane, with one sample in the
middle of each pixel; the program is asked at the same places. A mode is *drawn* where no pixel is off by more than
1/255 (of what is larger than 1: by 1/255 of it), but at most 2 % of the pixels beside jumps, which rounding moves.

{count} nodes and modes are drawn, {approximated} are approximated, {left_out} are not drawn: these are said once per
material in the panel, where a scene has them.
"""
SHADERS = """\
## Shaders

Squares of each shader, before a backdrop that shines, seen in a flat mirror and lit by one sun: how far their mean
color is from that of Cycles. What is within 1/255 is drawn. (A Translucent BSDF takes in the backdrop's light in
Cycles; here lamps and the world alone give light, and the panel says so.)

| shader | error | said |
|---|---|---|"""
ADDING = """\
## How to add a node

One function in a file of `curvrefl_addon/scene/programs/nodes/`, from a node's output to GLSL, and one row in that
file's table `NODES`; its GLSL goes into `gpu_shaders/nodes/`. One row in a file of `tests/nodes/cases/` makes Cycles
judge it.
"""


def page(judged: Iterable[Judged], shaders: Iterable[JudgedShader]) -> str:
    """All of it."""
    by_node: dict[str, list[Judged]] = {}
    for item in judged:
        by_node.setdefault(item.row.node, []).append(item)
    everything = [item for items in by_node.values() for item in items]
    drawn = [item for item in everything if item.is_drawn]
    near = [item for item in everything if is_approximated(item)]
    head = HEAD.format(count=len(drawn), approximated=len(near), left_out=len(everything) - len(drawn) - len(near))
    lines = ["| node | drawn | approximated | not drawn |", "|---|---|---|---|"]
    lines += [_line(node, items) for node, items in sorted(by_node.items())]
    return "\n".join([head, *lines, "", SHADERS, *map(_shader_line, shaders), "", ADDING])


def is_approximated(item: Judged) -> bool:
    """Near enough to be worth showing."""
    return not item.is_drawn and TOLERANCE < item.error <= 0.1


def mode_of(item: Judged) -> str:
    return item.row.mode or WHOLE


def _line(node: str, items: list[Judged]) -> str:
    drawn = [mode_of(item) for item in items if item.is_drawn]
    near = [f"{mode_of(item)} (error {item.error:.3f}){_said(item)}" for item in items if is_approximated(item)]
    rest: dict[str, list[str]] = {}
    for item in items:
        if not item.is_drawn and not is_approximated(item):
            rest.setdefault(_said(item), []).append(mode_of(item))
    left_out = [f"{'; '.join(modes)}{said}" for said, modes in rest.items()]
    return f"| {node} | {'; '.join(drawn)} | {'; '.join(near)} | {'; '.join(left_out)} |"


def _shader_line(item: JudgedShader) -> str:
    return f"| {item.name} | {'drawn' if item.is_right else f'{item.error:.3f}'} | {' '.join(item.warnings)} |"


def _said(item: Judged) -> str:
    """What the panel says."""
    sentences = [note.replace(" {of}", "") for note in item.notes]
    return f": *{' '.join(sentences)}*" if sentences else ""
