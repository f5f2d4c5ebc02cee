# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that ask where they are know the world's own places, however far out a scene is drawn about its own."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from scenes import placed_room

pytestmark = pytest.mark.usefixtures("gpu")
PLACE = (131072.0, -65536.0, 65536.0)
"""Where single precision has steps of 1/128 m"""


def painted_by_place(output: str, place: tuple[float, float, float]) -> None:
    """The floor shines by where it is, less `place`."""
    tree: Any = bpy.data.materials["Gray"].node_tree
    node = tree.nodes.new("ShaderNodeNewGeometry" if output == "Position" else "ShaderNodeObjectInfo")
    less = tree.nodes.new("ShaderNodeVectorMath")
    less.operation = "SUBTRACT"
    less.inputs[1].default_value = place
    scaled = tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value, scaled.inputs[2].default_value = (0.03,) * 3, (0.4,) * 3
    tree.links.new(node.outputs[output], less.inputs[0])
    tree.links.new(less.outputs[0], scaled.inputs[0])
    shader = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(scaled.outputs[0], shader.inputs["Color"])
    tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])


@pytest.mark.parametrize("method", ["exact", "newton"])
@pytest.mark.parametrize("output", ["Position", "Location"])
def test_places_are_the_worlds(output: str, method: str) -> None:
    pictures = []
    for place in ((0.0, 0.0, 0.0), PLACE):
        ball = placed_room.build(place)
        painted_by_place(output, place)
        scene, view = placed_room.read(ball)
        renderer = Renderer(scene, Settings(method=method, samples=2))
        pictures.append(renderer.render(view).color()[..., :3])
        assert bool(renderer.scene.origin != (0.0, 0.0, 0.0)) == (place == PLACE)
    assert (np.abs(pictures[0] - pictures[1]).max(axis=-1) > 0.02).mean() <= 0.002
