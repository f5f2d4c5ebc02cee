# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images with alpha, of sequences and beyond their borders, against what Cycles shows of them."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import node

RGBA = (0.8, 0.4, 0.2, 0.5)
SPACES = {"PNG": "sRGB", "OPEN_EXR": "Linear Rec.709"}


pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def even(fmt: str, rgba: tuple[float, ...] = RGBA) -> bpy.types.Image:
    made = bpy.data.images.new("even", 4, 4, alpha=True, float_buffer=fmt == "OPEN_EXR")
    made.pixels.foreach_set(np.tile(np.array(rgba, np.float32), 16))
    return made


def from_file(folder: Path, fmt: str, mode: str, packed: bool, space: str) -> bpy.types.Image:
    """The image `even`, saved and loaded."""
    made = even(fmt)
    made.filepath_raw = str(folder / f"even.{'png' if fmt == 'PNG' else 'exr'}")
    made.file_format = fmt
    made.save()
    loaded = bpy.data.images.load(made.filepath_raw)
    loaded.alpha_mode = mode
    loaded.colorspace_settings.name = space
    if packed:
        loaded.pack()
    return loaded


def show(name: str, column: int, image: bpy.types.Image, uses_alpha: bool) -> Any:
    """As a base color, that where its alpha is used is multiplied with 1 - 0.1 of it."""
    square = add_square(name, 1.0)
    square.location.x = column
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    texture = node(tree, "ShaderNodeTexImage", image=image)
    color = texture.outputs["Color"]
    if uses_alpha:
        rest = node(tree, "ShaderNodeMath", {0: -0.1, 1: texture.outputs["Alpha"], 2: 1.0}, operation="MULTIPLY_ADD")
        inputs = {"Factor_Float": 1.0, "A_Color": color, "B_Color": rest.outputs[0]}
        color = node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]
    tree.links.new(color, shader.inputs["Color"])
    return texture


def shown_by_cycles(count: int) -> np.ndarray:
    """(count, 3)"""
    for obj in bpy.context.scene.objects:
        tree = obj.data.materials[0].node_tree
        emission = node(
            tree, "ShaderNodeEmission", {"Color": tree.nodes["Diffuse BSDF"].inputs[0].links[0].from_socket}
        )
        tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    look_down(count).location.x = 0.5 * (count - 1)
    return cycles_picture(5 * count, 5, 1)[2, 2::5]


def color_of(scene: SceneArrays, name: str) -> np.ndarray:
    """(3,) of an image of one color."""
    return channel_on(scene, name, "base_color", [(0.1, 0.2)])[0]


def test_alpha_does_to_colors_what_it_does_in_cycles(tmp_path: Path) -> None:
    """Whatever its mode, in files and packed, where a node uses alpha and where none does."""
    cases: dict[str, tuple[bpy.types.Image, bool]] = {}
    modes = ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE")
    for fmt, mode, packed in itertools.product(SPACES, modes, (False, True)):
        if (fmt, mode, packed) == ("PNG", "PREMUL", False):
            # (Colors brighter than their alpha: Blender's bytes do not hold them.)
            continue
        for uses_alpha in (False, True):
            # (One name for all: each has a file of its own.)
            folder = tmp_path / str(len(cases))
            folder.mkdir()
            name = f"{fmt} {mode} {packed} {uses_alpha}"
            cases[name] = from_file(folder, fmt, mode, packed, SPACES[fmt]), uses_alpha
    for fmt, uses_alpha in itertools.product(SPACES, (False, True)):
        cases[f"generated {fmt} {uses_alpha}"] = even(fmt), uses_alpha
        folder = tmp_path / f"data {fmt} {uses_alpha}"
        folder.mkdir()
        cases[f"data {fmt} {uses_alpha}"] = from_file(folder, fmt, "STRAIGHT", False, "Non-Color"), uses_alpha
    for mode, uses_alpha in itertools.product(("STRAIGHT", "PREMUL"), (False, True)):
        folder = tmp_path / f"encoded {mode} {uses_alpha}"
        folder.mkdir()
        cases[folder.name] = from_file(folder, "OPEN_EXR", mode, False, "sRGB"), uses_alpha
    cases["clear"] = even("PNG", (0.8, 0.4, 0.2, 0.0)), False
    for column, (name, (image, uses_alpha)) in enumerate(cases.items()):
        show(name, column, image, uses_alpha)
    scene = extracted()
    assert not scene.warnings
    cycles = shown_by_cycles(len(cases))
    for name, color in zip(cases, cycles, strict=True):
        np.testing.assert_allclose(color_of(scene, name), color, atol=0.012, err_msg=name)


def test_a_sequence_shows_its_frame(tmp_path: Path) -> None:
    for frame in (1, 2, 3, 4):
        one = even("PNG", (0.1 * frame, 0.2, 0.3, 1.0))
        one.filepath_raw, one.file_format = str(tmp_path / f"wave_{frame:03}.png"), "PNG"
        one.save()
    image = bpy.data.images.load(str(tmp_path / "wave_001.png"))
    image.source = "SEQUENCE"
    user = show("square", 0, image, False).image_user
    user.frame_duration, user.frame_start, user.frame_offset, user.use_auto_refresh = 4, 1, 0, True
    scene = bpy.context.scene
    seen = []
    for frame in (2, 3):
        scene.frame_set(frame)
        read = extracted()
        assert not read.warnings
        seen.append(color_of(read, "square"))
        np.testing.assert_allclose(seen[-1][0], ((0.1 * frame + 0.055) / 1.055) ** 2.4, atol=4e-3)
    scene.frame_set(3)
    np.testing.assert_allclose(seen[-1], shown_by_cycles(1)[0], atol=2e-3)


def test_a_sequence_without_its_file_is_magenta(tmp_path: Path) -> None:
    image = even("PNG")
    image.source = "SEQUENCE"
    image.filepath = str(tmp_path / "gone_001.png")
    show("square", 0, image, False)
    scene = extracted()
    assert scene.warnings == ('The pixels of image "even" are missing: drawn magenta, as in Cycles.',)
    np.testing.assert_allclose(color_of(scene, "square"), shown_by_cycles(1)[0])


def test_an_image_node_without_an_image_is_magenta() -> None:
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    tree.links.new(node(tree, "ShaderNodeTexImage").outputs["Color"], shader.inputs["Color"])
    scene = extracted()
    assert material_of(scene, "square").base_color == (1.0, 0.0, 1.0)
    assert scene.warnings == ('Image nodes of material "square" without an image are drawn magenta, as in Cycles.',)
    np.testing.assert_allclose(shown_by_cycles(1)[0], (1.0, 0.0, 1.0))


def test_a_mapping_without_coordinates_is_one_place() -> None:
    """Not the UV map: the pixel at the mapping's own vector."""
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    image = bpy.data.images.new("ramp", 8, 1, float_buffer=True)
    ramp = np.repeat(np.linspace(0.0, 0.7, 8, dtype=np.float32), 4)
    ramp[3::4] = 1.0
    image.pixels.foreach_set(ramp)
    mapping = node(tree, "ShaderNodeMapping", {"Vector": (0.25, 0.0, 0.0), "Location": (0.3125, 0.0, 0.0)})
    texture = node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=image)
    tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    np.testing.assert_allclose(color_of(extracted(), "square"), 0.4, atol=1e-3)
    np.testing.assert_allclose(shown_by_cycles(1)[0], 0.4, atol=1e-3)
