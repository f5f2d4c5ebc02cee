# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One sentence for each cause."""

from __future__ import annotations

import bpy
import numpy as np
from curvrefl.curvrefl_addon.scene.remarks import Remark, sentences
from extraction import add_square, empty_scene, extracted
from scene.color_nodes import node


def test_a_sentence_names_three_and_counts_the_others() -> None:
    found = [Remark("Bumps {of} are left out.", "object", name) for name in "ABCDE"]
    assert sentences(found[:1]) == ('Bumps of object "A" are left out.',)
    assert sentences(found[:2]) == ('Bumps of 2 objects ("A" and "B") are left out.',)
    assert sentences(found[:3]) == ('Bumps of 3 objects ("A", "B" and "C") are left out.',)
    assert sentences(found) == ('Bumps of 5 objects ("A", "B", "C" and 2 more) are left out.',)


def test_equal_causes_are_joined_where_the_first_stands() -> None:
    one, other = Remark("X {of}.", "material", "A"), Remark("X {of}.", "object", "A")
    assert sentences([one, "Plain.", other, Remark("X {of}.", "material", "{of}"), one, "Plain."]) == (
        'X of 2 materials ("A" and "{of}").',
        "Plain.",
        'X of object "A".',
    )


def test_a_scene_as_from_gltf_says_nothing() -> None:
    """Twelve materials, each with textures of roughness, metallic, emission and alpha, and a normal map."""
    empty_scene()
    for index in range(12):
        square = add_square(f"part {index}")
        square.data.materials.append(bpy.data.materials.new(f"paint {index}"))
        tree = square.data.materials[0].node_tree
        shader = tree.nodes["Principled BSDF"]
        image = bpy.data.images.new(f"image {index}", 4, 4)
        image.pixels.foreach_set(np.linspace(0.1, 0.9, 64, dtype=np.float32))
        textures = [node(tree, "ShaderNodeTexImage", image=image) for _ in range(4)]
        channels = node(tree, "ShaderNodeSeparateColor", {0: textures[1].outputs["Color"]})
        bend = node(tree, "ShaderNodeNormalMap", {"Color": textures[2].outputs["Color"]})
        for source, target in (
            (textures[0].outputs["Color"], "Base Color"),
            (textures[0].outputs["Alpha"], "Alpha"),
            (channels.outputs[1], "Roughness"),
            (channels.outputs[2], "Metallic"),
            (bend.outputs[0], "Normal"),
            (textures[3].outputs["Color"], "Emission Color"),
        ):
            tree.links.new(source, shader.inputs[target])
        shader.inputs["Emission Strength"].default_value = 1.0
        shader.inputs["Transmission Weight"].default_value = 0.5
    assert not extracted().warnings
