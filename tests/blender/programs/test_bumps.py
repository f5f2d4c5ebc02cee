# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement as bumps: normals against Cycles, alone and under the nodes that tilt them further."""

from __future__ import annotations

from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.scene.materials.node_links import output_source, source_of
from curvrefl.curvrefl_addon.scene.programs.builder import Builder
from curvrefl.curvrefl_addon.scene.programs.nodes.values.bumps import displacement_as_bump
from curvrefl.curvrefl_addon.scene.programs.program import Program
from curvrefl.curvrefl_addon.scene.programs.registry import HANDLERS
from nodes.evaluation import Board
from nodes.judge import judge_all
from nodes.stage import judged_input
from nodes.trees import ACROSS, DAMP, PAINT, UV, MakeTree, shader_node, split

pytestmark = pytest.mark.usefixtures("gpu")

HEIGHT = shader_node("Math", {0: split(UV, "Y")}, operation="SINE")
NORMAL = shader_node("NewGeometry", output="Normal")


def _displaced(displacement: MakeTree, shown: MakeTree) -> MakeTree:
    def make(tree: Any) -> Any:
        output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(displacement(tree), output.inputs["Displacement"])
        return shown(tree)

    return make


def _compiled(board: Board, material: bpy.types.Material) -> tuple[Program, list[str]]:
    notes: list[str] = []
    b = Builder(HANDLERS, board.images, notes)
    source = output_source(material.node_tree, "Displacement")
    assert source is not None
    displacement_as_bump(b, source)
    return b.finished({"emission": b.value(source_of(judged_input(material)), "color")}), notes


def test_displacement_tilts_as_in_cycles(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Board, "compiled", _compiled)
    raised = shader_node("Displacement", {"Height": HEIGHT, "Scale": 0.5}, space="OBJECT")
    vector = shader_node("CombineXYZ", {0: HEIGHT, 1: DAMP, 2: 0.3})
    trees = {
        "object": _displaced(raised, NORMAL),
        "world": _displaced(shader_node("Displacement", {"Height": HEIGHT, "Scale": 0.5}, space="WORLD"), NORMAL),
        "facing": _displaced(raised, shader_node("LayerWeight", output="Facing")),
        "bumps": _displaced(raised, shader_node("Bump", {"Height": ACROSS, "Distance": 0.5})),
        "normal map": _displaced(raised, shader_node("NormalMap", {"Color": PAINT}, space="TANGENT")),
        **{
            space: _displaced(shader_node("VectorDisplacement", {"Vector": vector, "Scale": 0.5}, space=space), NORMAL)
            for space in ("TANGENT", "OBJECT", "WORLD")
        },
    }
    for name, verdict in judge_all(trees).items():
        assert verdict.is_right and not verdict.notes, (name, str(verdict))


def test_bumps_of_noise_are_those_of_cycles() -> None:
    noise = shader_node("TexNoise", {"Scale": 3.0})
    trees = {
        f"{width}": shader_node("Bump", {"Height": noise, "Distance": 0.5, "Filter Width": width})
        for width in (0.1, 1.0)
    }
    for name, verdict in judge_all(trees).items():
        assert verdict.is_right and not verdict.notes, (name, str(verdict))
