# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds by programs, against Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.programs.world import baked_world
from curvrefl.curvrefl_addon.renderer.lighting.world import world_light
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import cycles_picture, extracted, link
from lighting.skies import all_directions, all_directions_by_cycles, new_world

pytestmark = pytest.mark.usefixtures("gpu")

SKIES = {
    "multiple": {"sky_type": "MULTIPLE_SCATTERING", "sun_elevation": 0.3, "sun_rotation": 2.0},
    "dusty": {"sky_type": "MULTIPLE_SCATTERING", "aerosol_density": 3.0, "ozone_density": 4.0, "altitude": 9000.0},
    "low": {"sky_type": "MULTIPLE_SCATTERING", "sun_elevation": -0.02, "air_density": 2.0, "sun_size": 0.3},
    "single": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": 0.3, "sun_rotation": -1.0},
    "evening": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": -0.03, "ozone_density": 3.0, "altitude": 2000.0},
    "behind": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": 2.5, "sun_size": 0.4, "sun_intensity": 0.01},
    "preetham": {"sky_type": "PREETHAM", "sun_direction": (0.3, -0.5, 0.81), "turbidity": 3.0},
    "hosek": {"sky_type": "HOSEK_WILKIE", "sun_direction": (0.6, 0.5, 0.62), "turbidity": 4.3, "ground_albedo": 0.6},
}


@pytest.mark.parametrize("name", SKIES)
def test_skies_are_those_of_cycles(name: str) -> None:
    settings: dict[str, Any] = SKIES[name]
    new_world("ShaderNodeTexSky", **settings)
    read = extracted()
    assert read.warnings == ()
    ours, cycles = all_directions(read.world), all_directions_by_cycles()
    scale = np.maximum(cycles, 0.02 * float(np.quantile(cycles, 0.99)))
    error = np.abs(ours - cycles) / scale
    assert np.quantile(error, 0.995) < 1.0 / 255.0, np.quantile(error, [0.5, 0.9, 0.99, 0.995, 1.0])
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), cycles.mean(axis=(0, 1)), rtol=0.002)


def gradient(tree: Any) -> None:
    node, place = tree.nodes.new("ShaderNodeTexGradient"), tree.nodes.new("ShaderNodeTexCoord")
    node.gradient_type = "SPHERICAL"
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0.3, 0.8, -0.4)
    mapping.inputs["Location"].default_value = (0.2, 0.5, 0.1)
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = (0.1, 0.2, 0.6, 1.0)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    tree.links.new(node.outputs["Fac"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def mixed(tree: Any) -> None:
    """An image and a sky, by how far up one looks."""
    sky, image = tree.nodes.new("ShaderNodeTexSky"), tree.nodes.new("ShaderNodeTexEnvironment")
    sky.sky_type, sky.sun_direction = "PREETHAM", (0.6, 0.0, 0.8)
    pixels = np.random.default_rng(1).random((32, 64, 4), np.float32)
    image.image = bpy.data.images.new("environment", 64, 32, float_buffer=True)
    image.image.pixels.foreach_set(pixels.ravel())
    image.image.update()
    second, mix = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeMixShader")
    place, parts = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(place.outputs["Object"], parts.inputs[0])
    tree.links.new(parts.outputs["Z"], mix.inputs[0])
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])
    tree.links.new(image.outputs["Color"], second.inputs["Color"])
    second.inputs["Strength"].default_value = 0.7
    tree.links.new(second.outputs[0], mix.inputs[1])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["World Output"].inputs["Surface"])


def normals(tree: Any) -> None:
    """Incoming and Normal of a world, and an added emission."""
    geometry, place = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeTexCoord")
    emission, add = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(geometry.outputs["Incoming"], tree.nodes["Background"].inputs["Color"])
    tree.links.new(place.outputs["Normal"], emission.inputs["Color"])
    tree.links.new(tree.nodes["Background"].outputs[0], add.inputs[0])
    tree.links.new(emission.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], tree.nodes["World Output"].inputs["Surface"])


@pytest.mark.parametrize("build", [gradient, mixed, normals])
def test_backgrounds_are_those_of_cycles(build: Any) -> None:
    tree, _ = new_world("ShaderNodeTexSky")
    build(tree)
    read = extracted()
    assert read.warnings == ()
    ours, cycles = all_directions(read.world), all_directions_by_cycles()
    error = np.abs(np.maximum(ours, 0.0) - np.maximum(cycles, 0.0)).max(axis=-1)
    assert np.quantile(error, 0.99) < 1.0 / 255.0, np.quantile(error, [0.5, 0.9, 0.99, 1.0])


def by_camera(tree: Any) -> None:
    """Red for the camera, else green."""
    path, mix = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("ShaderNodeMix")
    mix.data_type = "RGBA"
    colors = {socket.identifier: socket for socket in mix.inputs}
    colors["A_Color"].default_value, colors["B_Color"].default_value = (0.0, 0.5, 0.0, 1.0), (1.0, 0.0, 0.0, 1.0)
    tree.links.new(path.outputs["Is Camera Ray"], colors["Factor_Float"])
    tree.links.new(mix.outputs[2], tree.nodes["Background"].inputs["Color"])


def test_what_the_camera_sees_may_differ() -> None:
    tree, _ = new_world("ShaderNodeTexSky")
    by_camera(tree)
    baked = baked_world(extracted().world)
    assert baked.seen.color == (1.0, 0.0, 0.0) and baked.glossy.color == (0.0, 0.5, 0.0)
    assert baked.diffuse is baked.glossy and baked.glossy.image is None and baked.warnings == ()


def test_the_sun_is_a_disc_where_it_is_seen() -> None:
    """Its limb is darker than its middle, and the earth hides a part of it."""
    new_world(
        "ShaderNodeTexSky",
        sun_elevation=0.02,
        sun_rotation=0.15,
        sun_size=0.3,
        sun_intensity=0.005,
        aerosol_density=0.5,
    )
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.angle = 0.5
    scene.camera = link(bpy.data.objects.new("camera", camera))
    scene.camera.rotation_euler = (0.5 * np.pi, 0.0, -0.15)
    ours = Renderer(extracted(), Settings(samples=16)).render(view_of_camera(scene, scene.camera, 48, 48)).color()
    cycles = cycles_picture(48, 48, 64)
    error = np.abs(ours[..., :3] - cycles).max(axis=-1) / float(cycles.max())
    assert np.quantile(error, 0.9) < 0.01, np.quantile(error, [0.5, 0.8, 0.9, 0.95, 1.0])


def test_what_mirrors_show_may_differ_from_what_lights() -> None:
    """An even light, and a sky in mirrors."""
    tree, sky = new_world("ShaderNodeTexSky", sky_type="PREETHAM")
    path, mix = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("ShaderNodeMix")
    mix.data_type = "RGBA"
    sockets = {socket.identifier: socket for socket in mix.inputs}
    sockets["A_Color"].default_value = (0.3, 0.3, 0.3, 1.0)
    tree.links.new(sky.outputs[0], sockets["B_Color"])
    tree.links.new(path.outputs["Is Glossy Ray"], sockets["Factor_Float"])
    tree.links.new(mix.outputs[2], tree.nodes["Background"].inputs["Color"])
    baked = baked_world(extracted().world)
    assert baked.glossy.image is not None and np.ptp(baked.glossy.image) > 0.1
    assert baked.diffuse.image is not None and np.allclose(baked.diffuse.image, 0.3)
    assert baked.seen.color == pytest.approx((0.3, 0.3, 0.3)) and baked.seen.image is None
    light = world_light(baked.glossy, 16, baked.diffuse)
    np.testing.assert_allclose(light.maps[0, ..., :3], 0.3 * np.pi, rtol=0.01)
