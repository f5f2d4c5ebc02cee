# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps as read: their power follows all settings as it does in Cycles."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import LightArrays
from curvrefl.curvrefl_addon.scene.programs.emitting import LINEAR
from extraction import add_square, cycles_picture, empty_scene, extracted, link, look_down, new_material

SMALL: dict[str, dict[str, Any]] = {
    "POINT": {"shadow_soft_size": 0.1},
    "SPOT": {"shadow_soft_size": 0.1},
    "AREA": {"size": 0.2},
    "SUN": {"angle": 0.05},
}
VARIANTS: list[tuple[dict[str, Any], float]] = [
    ({"exposure": 1.5, "color": (1.0, 0.5, 0.25)}, 1.0),
    ({"use_temperature": True, "temperature": 3000.0}, 1.0),
    ({"normalize": False}, 2.0),
]
"""Settings and scale of the object"""


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def lamp(kind: str, scale: float = 1.0, **values: Any) -> bpy.types.Object:
    """5 m above the origin, shining down."""
    light = bpy.data.lights.new("lamp", kind)
    light.energy = 10.0
    for name, value in values.items():
        setattr(light, name, value)
    obj = link(bpy.data.objects.new("lamp", light))
    obj.location = (0.0, 0.0, 5.0)
    obj.scale = (scale, scale, scale)
    return obj


def read(obj: bpy.types.Object) -> LightArrays:
    (light,) = extracted().lights
    assert light.name == obj.name
    return light


@pytest.mark.parametrize("kind", list(SMALL))
def test_power_per_light_on_the_floor_is_the_same_for_all_settings(kind: str) -> None:
    """In Cycles; the lamps are small enough for their shape not to matter."""
    square = add_square("floor", 4.0)
    _, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    look_down(0.02)
    ratios = []
    for values, scale in [({}, 1.0), *VARIANTS]:
        obj = lamp(kind, scale, **SMALL[kind], **values)
        light = read(obj)
        ratios.append(cycles_picture(4, 4, 64).mean(axis=(0, 1)) / light.color)
        bpy.data.objects.remove(obj)
    np.testing.assert_allclose(ratios, np.full((len(ratios), 3), ratios[0][0]), rtol=5e-3)


def test_kinds_and_sizes() -> None:
    point = read(lamp("POINT", 3.0, shadow_soft_size=0.25))
    assert (point.kind, point.radius, point.color) == ("POINT", 0.25, (10.0, 10.0, 10.0))
    assert point.casts_shadow and point.visible_glossy
    np.testing.assert_allclose(point.matrix[:3, :3], np.eye(3))
    np.testing.assert_allclose(point.matrix[:3, 3], (0.0, 0.0, 5.0))


def test_a_spot() -> None:
    spot = read(lamp("SPOT", spot_size=0.5, spot_blend=0.75, use_shadow=False))
    assert (spot.kind, spot.spot_angle, spot.spot_blend, spot.casts_shadow) == ("SPOT", 0.5, 0.75, False)


def test_a_sun() -> None:
    obj = lamp("SUN", angle=0.125)
    obj.rotation_euler = (math.pi / 2.0, 0.0, 0.0)
    obj.visible_glossy = False
    sun = read(obj)
    assert (sun.kind, sun.angle, sun.visible_glossy) == ("SUN", 0.125, False)
    np.testing.assert_allclose(-sun.matrix[:3, 2], (0.0, 1.0, 0.0), atol=1e-6)


@pytest.mark.parametrize(
    ("shape", "size", "ellipse"),
    [
        ("SQUARE", (2.0, 1.5), False),
        ("RECTANGLE", (2.0, 6.0), False),
        ("DISK", (2.0, 1.5), True),
        ("ELLIPSE", (2.0, 6.0), True),
    ],
)
def test_area_lamps_are_scaled(shape: str, size: tuple[float, float], ellipse: bool) -> None:
    obj = lamp("AREA", shape=shape, size=1.0, size_y=4.0)
    obj.scale = (2.0, 1.5, 1.0)
    area = read(obj)
    np.testing.assert_allclose(area.size, size)
    assert area.ellipse is ellipse


@pytest.mark.parametrize("spread, said", [(0.3, 1), (1.0, 0)])
def test_a_narrow_spread_is_said(spread: float, said: int) -> None:
    lamp("AREA", spread=spread)
    sentence = 'The narrow spread of lamp "lamp" is drawn roughly.'
    assert [sentence] * said == [text for text in extracted().warnings if "spread" in text]


def test_lamps_that_give_no_light() -> None:
    lamp("POINT", energy=0.0)
    lamp("AREA", size=0.0)
    lamp("SUN").hide_render = True
    assert extracted().lights == ()
    lamp("SPOT", 0.0)
    scene = extracted()
    assert scene.lights == () and len(scene.warnings) == 1


def test_nodes_of_a_lamp() -> None:
    obj = lamp("POINT")
    tree = obj.data.node_tree
    emission = tree.nodes["Emission"]
    emission.inputs["Color"].default_value = (1.0, 0.5, 0.0, 1.0)
    emission.inputs["Strength"].default_value = 2.0
    np.testing.assert_allclose(read(obj).color, (20.0, 10.0, 0.0))
    falloff = tree.nodes.new("ShaderNodeLightFalloff")
    tree.links.new(falloff.outputs["Linear"], emission.inputs["Strength"])
    scene = extracted()
    (light,) = scene.lights
    assert scene.warnings == () and light.emitter is not None
    assert light.emitter.program is None and light.emitter.falloff == LINEAR
    np.testing.assert_allclose(light.color, (1000.0, 500.0, 0.0))
