# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps by nodes, by what they light: a matt floor, against Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add_square, cycles_picture, empty_scene, extracted, link, look_down, new_material

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = 32


def lamp(kind: str, **settings: Any) -> tuple[Any, Any]:
    """A lamp 2 m above a floor, turned a little, and seen from above; its tree and its Emission node."""
    empty_scene()
    floor = add_square(size=6.0)
    _, (paint,) = new_material(floor, "ShaderNodeBsdfDiffuse")
    paint.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1.0)
    look_down(4.0)
    data: Any = bpy.data.lights.new("lamp", kind)
    data.energy = 100.0
    for name, value in settings.items():
        setattr(data, name, value)
    placed = link(bpy.data.objects.new("lamp", data))
    placed.location, placed.rotation_euler = (0.3, 0.2, 2.0), (0.2, -0.1, 0.7)
    return data.node_tree, data.node_tree.nodes["Emission"]


def textured(tree: Any, emission: Any, place: str, output: str, scale: float) -> None:
    """A smooth texture at the coordinates of a node."""
    coordinates, noise = tree.nodes.new(place), tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = scale, 0.0
    tree.links.new(coordinates.outputs[output], noise.inputs["Vector"])
    tree.links.new(noise.outputs["Color"], emission.inputs["Color"])


def spot_uv() -> None:
    textured(*lamp("SPOT", spot_size=1.3, shadow_soft_size=0.0), "ShaderNodeTexCoord", "UV", 4.0)


def point_normal() -> None:
    textured(*lamp("POINT", shadow_soft_size=0.0), "ShaderNodeTexCoord", "Normal", 3.0)


def point_uv() -> None:
    textured(*lamp("POINT", shadow_soft_size=0.0), "ShaderNodeTexCoord", "UV", 5.0)


def point_incoming() -> None:
    textured(*lamp("POINT", shadow_soft_size=0.0), "ShaderNodeNewGeometry", "Incoming", 3.0)


def area_uv() -> None:
    textured(*lamp("AREA", size=1.5), "ShaderNodeTexCoord", "UV", 3.0)


def sun_normal() -> None:
    textured(*lamp("SUN", energy=2.0), "ShaderNodeTexCoord", "Normal", 3.0)


def falling_off(output: str, smooth: float) -> None:
    tree, emission = lamp("POINT", shadow_soft_size=0.0)
    falloff = tree.nodes.new("ShaderNodeLightFalloff")
    falloff.inputs["Strength"].default_value, falloff.inputs["Smooth"].default_value = 0.4, smooth
    tree.links.new(falloff.outputs[output], emission.inputs["Strength"])


def linear() -> None:
    falling_off("Linear", 0.0)


def constant() -> None:
    falling_off("Constant", 3.0)


def smooth() -> None:
    falling_off("Quadratic", 5.0)


def blackbody() -> None:
    tree, emission = lamp("POINT", shadow_soft_size=0.0)
    node = tree.nodes.new("ShaderNodeBlackbody")
    node.inputs[0].default_value = 3000.0
    tree.links.new(node.outputs[0], emission.inputs["Color"])


def by_ray() -> None:
    """(Cycles tells lamps nothing of rays.)"""
    tree, emission = lamp("POINT", shadow_soft_size=0.0)
    path = tree.nodes.new("ShaderNodeLightPath")
    invert = tree.nodes.new("ShaderNodeInvert")
    tree.links.new(path.outputs["Is Diffuse Ray"], invert.inputs["Color"])
    tree.links.new(invert.outputs["Color"], emission.inputs["Color"])


def ies(kind: str) -> None:
    """A made-up luminaire."""
    tree, emission = lamp("POINT", energy=1.0, shadow_soft_size=0.0)
    node = tree.nodes.new("ShaderNodeTexIES")
    down = {"A": np.linspace(-90, 90, 13), "B": np.linspace(0, 90, 7), "C": np.linspace(0, 90, 10)}[kind]
    about = {"A": np.linspace(0, 90, 5), "B": np.linspace(-90, 90, 9), "C": np.linspace(0, 90, 4)}[kind]
    values = 1000.0 * np.random.default_rng(3).random((len(about), len(down)))
    lines = ["IESNA:LM-63-1995", "[TEST] made up", "TILT=NONE"]
    lines += [f"1 1000 1 {len(down)} {len(about)} {'CBA'.index(kind) + 1} 2 0 0 0", "1 1 100"]
    lines += [" ".join(f"{value:.3f}" for value in row) for row in (down, about, *values)]
    node.mode, node.ies = "INTERNAL", bpy.data.texts.new("luminaire.ies")
    node.ies.write("\n".join(lines) + "\n")
    tree.links.new(node.outputs[0], emission.inputs["Strength"])


def ies_a() -> None:
    ies("A")


def ies_b() -> None:
    ies("B")


def ies_c() -> None:
    ies("C")


CASES = (
    *(ies_a, ies_b, ies_c),
    *(spot_uv, point_normal, point_uv, point_incoming, area_uv, sun_normal),
    *(linear, constant, smooth, blackbody, by_ray),
)


@pytest.mark.parametrize("build", CASES)
def test_floors_are_lit_as_in_cycles(build: Any) -> None:
    build()
    scene = bpy.context.scene
    read = extracted()
    assert read.warnings == ()
    view = view_of_camera(scene, scene.camera, SIZE, SIZE)
    ours = Renderer(read, Settings(method="exact", samples=16)).render(view).color()[..., :3]
    cycles = cycles_picture(SIZE, SIZE, 64 if build is not area_uv else 512)
    error = np.abs(ours - cycles).max(axis=-1) / float(cycles.max())
    # (Off the edges of cones and maps. An area lamp shines from one place in each sub-frame.)
    limit = 0.035 if build is area_uv else 0.01
    assert np.quantile(error, 0.9) < limit, np.quantile(error, [0.5, 0.9, 0.95, 1.0])
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), cycles.mean(axis=(0, 1)), rtol=0.01)


def test_a_lamp_without_more_than_colors_has_no_program() -> None:
    _, emission = lamp("POINT")
    emission.inputs["Color"].default_value = (0.5, 0.25, 1.0, 1.0)
    emission.inputs["Strength"].default_value = 2.0
    (light,) = extracted().lights
    assert light.emitter is None and light.color == (100.0, 50.0, 200.0)
