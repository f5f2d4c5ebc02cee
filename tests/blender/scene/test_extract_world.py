# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as read, against what Cycles shows of it."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import WorldArrays
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import cycles_picture, empty_scene, extracted, link

SIZE = 24


@pytest.fixture
def world() -> bpy.types.World:
    return empty_scene().world


def environment(world: bpy.types.World) -> Any:
    """An environment texture of 64 x 32 smooth pixels, plugged in at strength 1.5; its node."""
    height, width = 32, 64
    y, x = np.mgrid[0:height, 0:width]
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., 0] = 0.5 + 0.5 * np.sin(2.0 * np.pi * x / width)
    pixels[..., 1] = (y + 0.5) / height
    pixels[..., 2] = 0.5 + 0.5 * np.cos(2.0 * np.pi * x / width)
    image = bpy.data.images.new("environment", width, height, float_buffer=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    tree = world.node_tree
    node: Any = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 1.5
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    return node


def radiance(world: WorldArrays, directions: np.ndarray) -> np.ndarray:
    """(h, w, 3) of unit world directions, by the definition of `WorldArrays`."""
    assert world.image is not None
    x, y, z = np.moveaxis(directions @ world.rotation.T, -1, 0)
    height, width = world.image.shape[:2]
    u, v = 0.5 - np.arctan2(y, x) / (2.0 * np.pi), np.arcsin(np.clip(z, -1.0, 1.0)) / np.pi + 0.5
    column, row = u * width - 0.5, np.clip(v * height - 0.5, 0.0, height - 1.001)
    left, low = np.floor(column).astype(int), np.floor(row).astype(int)
    s, t = (column - left)[..., None], (row - low)[..., None]
    rows = [
        world.image[low + k, left % width] * (1.0 - s) + world.image[low + k, (left + 1) % width] * s for k in (0, 1)
    ]
    return (rows[0] * (1.0 - t) + rows[1] * t) * np.array(world.color)


def add_mapping(world: bpy.types.World, texture: Any, kind: str, **values: Any) -> None:
    tree = world.node_tree
    mapping: Any = tree.nodes.new("ShaderNodeMapping")
    mapping.vector_type = kind
    mapping.inputs["Rotation"].default_value = (0.3, -0.5, 1.2)
    for name, value in values.items():
        mapping.inputs[name].default_value = value
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])


@pytest.mark.parametrize("case", ["plain", "POINT", "TEXTURE", "mirrored", "moved", "NORMAL", "ball", "gamma"])
def test_directions_are_those_of_cycles(world: bpy.types.World, case: str) -> None:
    texture = environment(world)
    if case in ("POINT", "TEXTURE"):
        add_mapping(world, texture, case)
    elif case == "mirrored":
        add_mapping(world, texture, "POINT", Scale=(1.0, 1.0, -1.0))
    elif case == "moved":
        add_mapping(world, texture, "TEXTURE", Scale=(1.0, 1.5, 0.7), Location=(0.2, 0.1, -0.3))
    elif case == "NORMAL":
        add_mapping(world, texture, case, Scale=(1.0, 1.5, 0.7))
    elif case == "ball":
        texture.projection = "MIRROR_BALL"
    elif case == "gamma":
        tree = world.node_tree
        gamma = tree.nodes.new("ShaderNodeGamma")
        gamma.inputs["Gamma"].default_value = 2.0
        tree.links.new(texture.outputs["Color"], gamma.inputs["Color"])
        tree.links.new(gamma.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    # The sky is only looked at: no need to find out where it is bright.
    world.cycles.sampling_method = "NONE"
    camera = bpy.data.cameras.new("camera")
    camera.angle = 2.0
    obj = link(bpy.data.objects.new("camera", camera))
    obj.rotation_euler = (1.0, 0.3, 0.6)
    scene = bpy.context.scene
    scene.camera = obj

    read = extracted()
    assert read.warnings == ()
    view = view_of_camera(scene, obj, SIZE, SIZE)
    steps = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(steps, steps)
    far = np.stack([x, y, np.ones_like(x), np.ones_like(x)], axis=-1) @ np.linalg.inv(view.world_to_clip).T
    directions = far[..., :3] / far[..., 3:] - view.eye[:3]
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    error = np.abs(radiance(read.world, directions) - cycles_picture(SIZE, SIZE, 64)).max(axis=-1)
    # At the poles of the image a pixel holds all columns.
    assert np.quantile(error, 0.9) < 0.03, np.quantile(error, [0.5, 0.9, 1.0])
    assert np.median(error) < 0.012


def test_one_rotation_by_hand(world: bpy.types.World) -> None:
    texture = environment(world)
    add_mapping(world, texture, "POINT", Rotation=(0.0, 0.0, math.pi / 2.0))
    rotation = extracted().world.rotation
    np.testing.assert_allclose(rotation @ np.array([1.0, 0.0, 0.0]), (0.0, 1.0, 0.0), atol=1e-6)


def test_colors(world: bpy.types.World) -> None:
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.25, 0.5, 1.0, 1.0)
    background.inputs["Strength"].default_value = 2.0
    read = extracted()
    assert read.world.color == (0.5, 1.0, 2.0) and read.world.image is None and not read.warnings
    world.node_tree.nodes.remove(background)
    assert extracted().world.color == (0.0, 0.0, 0.0)
    world.node_tree.nodes.clear()
    world.color = (0.25, 0.5, 0.75)
    assert extracted().world.color == (0.0, 0.0, 0.0)
    bpy.context.scene.camera = link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    assert not cycles_picture(4, 4, 1).any()
    bpy.context.scene.world = None
    assert extracted().world.color == (0.0, 0.0, 0.0)


def test_what_is_no_image_is_a_program(world: bpy.types.World) -> None:
    tree = world.node_tree
    sky: Any = tree.nodes.new("ShaderNodeTexSky")
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    read = extracted()
    assert not read.warnings and read.world.image is None and read.world.program is not None
    (disc,) = read.world.discs
    up = float(sky.sun_elevation)
    np.testing.assert_allclose(disc.direction, (0.0, math.cos(up), math.sin(up)), atol=1e-9)
    sky.sun_disc = False
    assert extracted().world.discs == ()


def test_mixed_constants_are_a_constant(world: bpy.types.World) -> None:
    tree = world.node_tree
    mix, other = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBackground")
    other.inputs["Color"].default_value = (1.0, 0.0, 0.5, 1.0)
    mix.inputs["Fac"].default_value = 0.75
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    read = extracted()
    assert read.world.color == (0.75, 0.0, 0.375) and not read.warnings


def of_pixels(world: bpy.types.World, *pixels: tuple[float, float, float]) -> Any:
    """An environment texture with these in a row; its node."""
    node = environment(world)
    node.image = bpy.data.images.new("row", len(pixels), 1, float_buffer=True)
    node.image.pixels.foreach_set([value for pixel in pixels for value in (*pixel, 1.0)])
    node.image.update()
    return node


def test_an_image_of_one_pixel_is_a_color(world: bpy.types.World) -> None:
    of_pixels(world, (0.1, 0.2, 0.4))
    read = extracted()
    assert read.world.image is None and not read.warnings
    np.testing.assert_allclose(read.world.color, (0.15, 0.3, 0.6), rtol=1e-6)


def test_an_environment_node_without_an_image_is_magenta(world: bpy.types.World) -> None:
    environment(world).image = None
    camera = link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    bpy.context.scene.camera = camera
    color = extracted().world.color
    assert color == (1.5, 0.0, 1.5)
    np.testing.assert_allclose(cycles_picture(4, 4, 1)[2, 2], color, rtol=1e-5)


@pytest.mark.usefixtures("gpu")
@pytest.mark.parametrize("pixels", [[(0.2, 0.5, 0.8)], [(1.0, 0.2, 0.1), (0.0, 0.1, 0.5)]])
def test_a_ball_under_few_pixels_is_lit_as_in_cycles(world: bpy.types.World, pixels: Any) -> None:
    """From all sides of the sky, not from the middle of each pixel."""
    of_pixels(world, *pixels)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    paint = bpy.data.materials.new("paint")
    paint.node_tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.0
    ball.data.materials.append(paint)
    camera = link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    camera.location = (0.0, 0.0, 6.0)
    scene = bpy.context.scene
    scene.camera = camera
    ours = Renderer(extracted(), Settings(method="exact", samples=8)).render(view_of_camera(scene, camera, SIZE, SIZE))
    error = np.abs(ours.color()[..., :3] - cycles_picture(SIZE, SIZE, 256)).max(axis=-1)
    assert np.quantile(error, 0.95) < 0.03
    assert error.mean() < 0.012


def test_a_color_without_a_shader_is_a_background(world: bpy.types.World) -> None:
    tree = world.node_tree
    color: Any = tree.nodes.new("ShaderNodeRGB")
    color.outputs[0].default_value = (0.1, 0.4, 0.2, 1.0)
    tree.links.new(color.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    bpy.context.scene.camera = link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    read = extracted()
    np.testing.assert_allclose(read.world.color, cycles_picture(4, 4, 1)[2, 2], rtol=1e-5)
    assert not read.warnings
