# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A room with a leaf cut out by an image and two clear panes, seen directly, in a mirror and in shadows, by Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import plane
from lighting.room import build_room, judge_room

pytestmark = pytest.mark.usefixtures("gpu")


def green(name: str, alpha: float = 1.0) -> Any:
    material: Any = principled(name, (0.2, 0.7, 0.2), roughness=0.6)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Specular IOR Level"].default_value = 0.0
    shader.inputs["Alpha"].default_value = alpha
    return material


def add_leaf(place: tuple[float, float, float], size: float) -> None:
    """A sheet of which an ellipse is there, without an image of its color."""
    y, x = np.mgrid[0:64, 0:64] / 63.0 - 0.5
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[..., 3] = np.hypot(x, 1.5 * y) < 0.42
    image: Any = bpy.data.images.new("ellipse", 64, 64, alpha=True, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    material = green("leaf")
    texture = material.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    alpha = material.node_tree.nodes["Principled BSDF"].inputs["Alpha"]
    material.node_tree.links.new(texture.outputs["Alpha"], alpha)
    mesh: Any = add_object("leaf", plane((size, size)), material, location=place).data
    layer = mesh.uv_layers[0] if mesh.uv_layers else mesh.uv_layers.new()
    corners = [mesh.vertices[loop.vertex_index].co for loop in mesh.loops]
    layer.data.foreach_set("uv", np.array([(c.x / size + 0.5, c.y / size + 0.5) for c in corners], np.float32).ravel())


def test_a_leaf_and_panes_are_those_of_cycles() -> None:
    build_room()
    add_leaf((-0.9, -2.2, 1.2), 1.6)
    for name, size, height in (("pane", 1.6, 1.4), ("higher pane", 1.0, 1.7)):
        add_object(name, plane((size, size)), green(name, 0.5), location=(1.2, -2.4, height))
    judged = judge_room(64)
    assert not judged.warnings
    assert judged.share_off < 0.01
    assert judged.ours.mean() == pytest.approx(judged.cycles.mean(), rel=0.005)
