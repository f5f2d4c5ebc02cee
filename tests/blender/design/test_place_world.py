# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds turned by the operator: their suns are read where the mirror was to show them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.lighting.suns import split_suns
from curvrefl.curvrefl_addon.scene.materials.images import ImageReader
from curvrefl.curvrefl_addon.scene.world import equirectangular_directions, read_world

EYE, CLICKED = np.array((0.0, -4.0, 0.0)), unit(np.array((0.5, -0.8, 0.3)))
SEEN = unit(CLICKED - EYE) - 2.0 * (unit(CLICKED - EYE) @ CLICKED) * CLICKED
"""What the unit sphere shows there"""


@pytest.fixture(autouse=True)
def world() -> Iterator[Any]:
    """A mirror ball in a world of a Background alone."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
    bpy.ops.object.shade_smooth()
    bpy.context.object.curvrefl.is_mirror = True
    bpy.context.scene.world = bpy.data.worlds.new("Outside")
    bpy.context.view_layer.update()
    yield bpy.context.scene.world
    registration.unregister()


def run(**properties: Any) -> set[str]:
    given = {"target": "WORLD", "eye": EYE.tolist(), "point": CLICKED.tolist(), **properties}
    return bpy.ops.curvrefl.place_light(**given)


def plug(world: Any, kind: str) -> Any:
    """A texture node as the color of the world's background."""
    node = world.node_tree.nodes.new(kind)
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    world.node_tree.links.new(node.outputs["Color"], background.inputs["Color"])
    return node


def add_image(world: Any, toward: np.ndarray) -> Any:
    """An environment with a sun in this direction, behind a Mapping node, which is returned."""
    texture = plug(world, "ShaderNodeTexEnvironment")
    size = (256, 128)
    texture.image = bpy.data.images.new("Sky", *size, float_buffer=True)
    pixels = np.full((size[1], size[0], 4), 0.2, np.float32)
    pixels[equirectangular_directions(*size) @ toward > np.cos(0.04)] = 500.0
    texture.image.pixels.foreach_set(pixels.ravel())
    mapping = world.node_tree.nodes.new("ShaderNodeMapping")
    coordinates = world.node_tree.nodes.new("ShaderNodeTexCoord")
    world.node_tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    world.node_tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return mapping


def sun_read(world: Any) -> np.ndarray:
    """As the renderer reads it."""
    (sun,) = split_suns(read_world(world, ImageReader(), [])).suns
    return np.array(sun.matrix[:3, 2])


@pytest.mark.parametrize("kind", ["MULTIPLE_SCATTERING", "SINGLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE"])
def test_the_sun_of_a_sky_goes_there(world: Any, kind: Any) -> None:
    node = plug(world, "ShaderNodeTexSky")
    node.sky_type = kind
    assert run() == {"FINISHED"}
    if kind in ("PREETHAM", "HOSEK_WILKIE"):
        np.testing.assert_allclose(node.sun_direction, SEEN, atol=2e-3)
        return
    (disc,) = read_world(world, ImageReader(), []).emitter.discs
    np.testing.assert_allclose(disc.direction, SEEN, atol=2e-3)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "NORMAL"])
def test_the_sun_of_an_image_goes_there_and_its_horizon_leans_no_further_than_that(world: Any, kind: Any) -> None:
    mapping = add_image(world, unit(np.array((-0.6, 0.5, 0.55))))
    mapping.vector_type = kind
    mapping.inputs["Rotation"].default_value = (0.1, -0.2, 0.8)
    run()
    np.testing.assert_allclose(sun_read(world), SEEN, atol=4e-3)
    run(mode="ILLUMINATION")
    np.testing.assert_allclose(sun_read(world), CLICKED, atol=4e-3)


def test_two_mappings_are_both_counted(world: Any) -> None:
    first = add_image(world, unit(np.array((-0.6, 0.5, 0.55))))
    second = world.node_tree.nodes.new("ShaderNodeMapping")
    second.inputs["Rotation"].default_value = (0.4, 0.3, -1.2)
    texture = next(node for node in world.node_tree.nodes if node.type == "TEX_ENVIRONMENT")
    world.node_tree.links.new(first.outputs["Vector"], second.inputs["Vector"])
    world.node_tree.links.new(second.outputs["Vector"], texture.inputs["Vector"])
    run()
    np.testing.assert_allclose(sun_read(world), SEEN, atol=4e-3)
    np.testing.assert_allclose(second.inputs["Rotation"].default_value, (0.4, 0.3, -1.2), atol=1e-6)


def test_a_level_world_is_turned_about_the_vertical_alone(world: Any, capfd: pytest.CaptureFixture[str]) -> None:
    sun = unit(np.array((-0.6, 0.5, 0.55)))
    mapping = add_image(world, sun)
    run(level=True)
    found = sun_read(world)
    assert found[2] == pytest.approx(sun[2], abs=4e-3)
    assert np.arctan2(found[1], found[0]) == pytest.approx(np.arctan2(SEEN[1], SEEN[0]), abs=4e-3)
    np.testing.assert_allclose(mapping.inputs["Rotation"].default_value[:2], 0.0, atol=1e-6)
    apart = np.degrees(np.arccos(found @ SEEN))
    assert f"{apart:.0f}" in capfd.readouterr().out


def test_power_is_the_strength_of_the_background(world: Any) -> None:
    plug(world, "ShaderNodeTexSky")
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Strength"].default_value = 0.5
    run(power=3.0)
    assert background.inputs["Strength"].default_value == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda world: setattr(bpy.context.scene, "world", None), "has no world"),
        (lambda world: None, "has no Sky Texture or Environment Texture"),
        (lambda world: plug(world, "ShaderNodeTexEnvironment"), "has no Mapping node"),
        (
            lambda world: setattr(add_image(world, CLICKED).inputs["Scale"], "default_value", (1.0, 2.0, 1.0)),
            "does more than turn",
        ),
    ],
)
def test_what_cannot_be_turned_is_told(world: Any, change: Any, message: str) -> None:
    change(world)
    with pytest.raises(RuntimeError, match=message):
        run()


def test_its_sun_is_shown_in_the_mirror_where_it_was_placed_by(world: Any) -> None:
    from curvrefl.curvrefl_addon.design.lights.shown import LightsInMirrors
    from scenes.views import look_at

    add_image(world, unit(np.array((-0.6, 0.5, 0.55))))
    lights, looking = LightsInMirrors(), look_at(EYE, np.zeros(3), 200, 150, 0.7)
    for _ in range(2):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        (*_others, found) = lights.of(depsgraph, bpy.context.scene, looking, None, has_world=True)
        assert found.is_world
        run()
    (*_others, found) = lights.of(bpy.context.evaluated_depsgraph_get(), bpy.context.scene, looking, None, True)
    np.testing.assert_allclose(found.centers, looking.project(CLICKED[None]), atol=0.2)
