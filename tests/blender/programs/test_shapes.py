# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees of one shape are one program, whatever their constants and images are."""

from __future__ import annotations

from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from extraction import empty_scene, extracted
from scenes.awkward.stage import principled_node

MATERIALS, SHAPES = 300, 20


def textured(number: int) -> bpy.types.Material:
    """An image or noise through so many nodes as its number's shape says."""
    material = bpy.data.materials.new(f"material {number}")
    tree: Any = material.node_tree
    if number % 2:
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new(f"image {number}", 2, 2)
    else:
        node = tree.nodes.new("ShaderNodeTexNoise")
        node.inputs["Scale"].default_value = 1.0 + number
    color = node.outputs["Color"]
    for _ in range(number % SHAPES // 2):
        gamma = tree.nodes.new("ShaderNodeGamma")
        gamma.inputs["Gamma"].default_value = 1.0 + 0.001 * number
        tree.links.new(color, gamma.inputs["Color"])
        color = gamma.outputs["Color"]
    tree.links.new(color, principled_node(material).inputs["Base Color"])
    return material


def cubes() -> None:
    empty_scene()
    bpy.ops.mesh.primitive_cube_add()
    data: Any = bpy.context.object.data
    for number in range(MATERIALS):
        data.materials.append(textured(number))


def test_many_materials_of_few_shapes() -> None:
    cubes()
    programs = [item.program for item in extracted().materials if item.program is not None]
    assert len(programs) == MATERIALS
    assert len({program.shape for program in programs}) == SHAPES


@pytest.mark.usefixtures("gpu")
def test_programs_are_let_in_one_by_one() -> None:
    cubes()
    renderer = Renderer(extracted(), Settings(method="exact", samples=1), is_gradual=True)
    materials = renderer._appearance.materials
    assert materials.has_programs and not materials.programs.admitted
    for count in range(1, SHAPES + 1):
        before = renderer.revision
        renderer.load_some(0.0)
        assert len(materials.programs.admitted) == count and renderer.revision > before
    while renderer.is_loading:
        renderer.load_some(0.01)
    assert materials.programs.number_of(MATERIALS) >= 0
