# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where procedural textures are looked up, and what they give to nodes that count the last bit, against Cycles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from nodes.judge import judge_all
from nodes.stage import MakeTree
from nodes.trees import shader_node

pytestmark = pytest.mark.usefixtures("gpu")

TEXTURES = ("Noise", "Voronoi", "Wave", "Magic", "Brick", "Checker", "Gradient", "WhiteNoise", "Gabor")


def test_nothing_is_plugged_in() -> None:
    _all_right({kind: shader_node(f"Tex{kind}") for kind in TEXTURES})


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR", "NORMAL"])
def test_the_nodes_own_mapping(kind: str) -> None:
    def mapped(axes: tuple[str, str, str]) -> Callable[[Any], None]:
        def adjust(node: Any) -> None:
            mapping = node.texture_mapping
            mapping.vector_type = kind
            mapping.translation, mapping.rotation, mapping.scale = (0.13, 0.37, 0.71), (0.3, 0.5, 0.7), (1.1, 0.9, -1.2)
            mapping.mapping_x, mapping.mapping_y, mapping.mapping_z = axes
            mapping.use_min = mapping.use_max = True

        return adjust

    axes = [("X", "Y", "Z"), ("Y", "X", "Z"), ("X", "NONE", "Z"), ("X", "Y", "X")]
    _all_right({" ".join(names): shader_node("TexNoise", adjust=mapped(names)) for names in axes})


def test_positions_of_cells_are_hashed_alike() -> None:
    """To the last bit, or each cell would have another random color."""
    trees = {}
    for dimensions in ("2D", "3D", "4D"):
        for randomness in (1.0, 0.7):
            cells = {"Scale": 3.3, "Randomness": randomness}
            position = shader_node("TexVoronoi", cells, "Position", voronoi_dimensions=dimensions)
            for name, socket in (("3D", "Vector"), ("1D", "W")):
                colors = shader_node("TexWhiteNoise", {socket: position}, "Color", noise_dimensions=name)
                trees[f"{dimensions} {randomness} to {name}"] = colors
    _all_right(trees)


def test_ways_that_lead_nowhere_count_as_nothing() -> None:
    def through(first: str, second: str) -> MakeTree:
        def make(tree: Any) -> Any:
            noise = tree.nodes.new("ShaderNodeTexNoise")
            start, end = tree.nodes.new(first), tree.nodes.new(second)
            for node in (start, end):
                node.mute = node.type != "REROUTE"
                if node.mute:
                    node.inputs["Vector"].default_value = (0.2, 0.3, 0.4)
            tree.links.new(start.outputs[0], end.inputs[0])
            tree.links.new(end.outputs[0], noise.inputs["Vector"])
            return noise.outputs["Color"]

        return make

    kinds = ("NodeReroute", "ShaderNodeMapping")
    _all_right({f"{first} {second}": through(first, second) for first in kinds for second in kinds})


def _all_right(trees: Mapping[str, MakeTree]) -> None:
    wrong = {name: str(found) for name, found in judge_all(trees).items() if not found.is_right or found.notes}
    assert not wrong
