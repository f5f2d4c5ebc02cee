# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds: node trees of all kinds, skies, pictures that are odd or missing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import set_world_image, studio_light

from ..registry import awkward
from ..stage import bpy, node, output_of, picture, stage, world_tree


def _colored(kind: str, output: str = "Color", **inputs: Any) -> Any:
    """A world whose color is a node's; returns the node."""
    stage()
    tree, background = world_tree()
    made = node(tree, kind, **inputs)
    tree.links.new(made.outputs[output], background.inputs["Color"])
    return made


def _environment(image: Any) -> Any:
    """The scene's world becomes this picture; returns its node."""
    tree, background = world_tree()
    made = node(tree, "TexEnvironment")
    made.image = image
    tree.links.new(made.outputs["Color"], background.inputs["Color"])
    return made


def _panorama(width: int, height: int, is_float: bool = True) -> Any:
    """An equirectangular picture: blue above, brown below, a bright red quarter, so that turns show."""
    rng = np.linspace(0.0, 1.0, height)[:, None]
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = np.where(rng[..., None] > 0.5, (0.3, 0.5, 0.9), (0.25, 0.15, 0.1))
    pixels[height // 2 : height * 3 // 4 + 1, : width // 4, :3] = (1.2, 0.2, 0.1)
    return picture("Panorama", pixels, is_float=is_float)


@awkward("no world at all")
def world_none(folder: Path) -> None:
    stage(sky=None)


@awkward("a world without nodes in its tree")
def world_empty_tree(folder: Path) -> None:
    stage()
    world_tree()[0].nodes.clear()


@awkward("a world whose output has no surface")
def world_no_surface(folder: Path) -> None:
    stage()
    tree, _ = world_tree()
    tree.links.remove(output_of(tree).inputs["Surface"].links[0])


@awkward("a world of strength zero")
def world_zero(folder: Path) -> None:
    stage()
    world_tree()[1].inputs["Strength"].default_value = 0.0


@awkward("a world with negative color", words=("world", "negative"))
def world_negative(folder: Path) -> None:
    stage()
    world_tree()[1].inputs["Color"].default_value = (-0.5, 0.3, 0.6, 1.0)


@awkward("a picture as the world")
def world_image(folder: Path) -> None:
    stage()
    _environment(_panorama(64, 32))


@awkward("an 8-bit picture as the world")
def world_image_bytes(folder: Path) -> None:
    stage()
    _environment(_panorama(64, 32, is_float=False))


@awkward("a studio light of Blender's as the world")
def world_studio(folder: Path) -> None:
    stage(sky=None)
    set_world_image(studio_light("forest.exr"), turn=1.0, strength=0.8)


@awkward("a sunny studio light of Blender's as the world, alone")
def world_studio_sunset(folder: Path) -> None:
    stage(sky=None, sun=0.0)
    set_world_image(studio_light("sunset.exr"), turn=2.0, strength=1.0)


@awkward("a world picture of one pixel")
def world_one_pixel(folder: Path) -> None:
    stage()
    _environment(picture("One", np.full((1, 1, 4), (0.7, 0.5, 0.2, 1.0)), is_float=True))


@awkward("a world picture of two pixels")
def world_two_pixels(folder: Path) -> None:
    stage()
    _environment(picture("Two", np.array([[(0.8, 0.2, 0.1, 1.0), (0.1, 0.3, 0.8, 1.0)]]), is_float=True))


@awkward("a world picture whose file is missing", words=("missing", "gone.hdr", "no pixels", "cannot be read"))
def world_missing(folder: Path) -> None:
    stage()
    image = bpy.data.images.new("gone", 4, 4)
    image.source, image.filepath = "FILE", str(folder / "gone.hdr")
    _environment(image)


@awkward("an Environment Texture without an image")
def world_without_image(folder: Path) -> None:
    _colored("TexEnvironment")


@awkward("a world picture seen as a mirror ball")
def world_mirror_ball(folder: Path) -> None:
    stage()
    _environment(_panorama(64, 64)).projection = "MIRROR_BALL"


@awkward("a world picture without smoothing")
def world_closest(folder: Path) -> None:
    stage()
    _environment(_panorama(16, 8)).interpolation = "Closest"


@awkward("a world picture turned about all axes")
def world_turned(folder: Path) -> None:
    stage()
    made = _environment(_panorama(64, 32))
    tree = made.id_data
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.inputs["Rotation"].default_value = (0.5, -0.3, 2.0)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], made.inputs["Vector"])


@awkward("a world picture scaled by its mapping")
def world_scaled(folder: Path) -> None:
    stage()
    made = _environment(_panorama(64, 32))
    tree = made.id_data
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.inputs["Scale"].default_value = (1.0, 2.0, 0.5)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], made.inputs["Vector"])


@awkward("a world picture of 20,000 x 8 pixels", words=("fewer pixels",))
def world_wide(folder: Path) -> None:
    stage()
    _environment(_panorama(20000, 8, is_float=False))


@awkward("the sky texture", words=("sky",))
def world_sky(folder: Path) -> None:
    _colored("TexSky")
    world_tree()[1].inputs["Strength"].default_value = 0.1


@awkward("the sky texture with its sun", words=("sky",))
def world_sky_sun(folder: Path) -> None:
    stage(sun=0.0)
    tree, background = world_tree()
    sky = node(tree, "TexSky")
    sky.sun_elevation, sky.sun_rotation, sky.sun_size = 0.5, 2.5, 0.05
    tree.links.new(sky.outputs[0], background.inputs["Color"])
    background.inputs["Strength"].default_value = 0.1


@awkward("a gradient of the direction as the world", words=("world", "gradient", "ramp"))
def world_gradient(folder: Path) -> None:
    stage()
    tree, background = world_tree()
    coordinate, separate, ramp = node(tree, "TexCoord"), node(tree, "SeparateXYZ"), node(tree, "ValToRGB")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.6, 0.1, 0.1, 1.0), (0.1, 0.2, 0.9, 1.0)
    tree.links.new(coordinate.outputs["Generated"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], ramp.inputs[0])
    tree.links.new(ramp.outputs["Color"], background.inputs["Color"])


@awkward("noise as the world", words=("world", "noise"))
def world_noise(folder: Path) -> None:
    _colored("TexNoise", Scale=3.0)


@awkward("two backgrounds: one for the camera, another for all else", words=("world", "light path"))
def world_light_path(folder: Path) -> None:
    stage()
    tree, background = world_tree()
    other = node(tree, "Background", Color=(0.9, 0.2, 0.1, 1.0))
    mix, path = node(tree, "MixShader"), node(tree, "LightPath")
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output_of(tree).inputs["Surface"])


@awkward("two backgrounds added", words=("world",))
def world_added(folder: Path) -> None:
    stage()
    tree, background = world_tree()
    other, add = node(tree, "Background", Color=(0.3, 0.1, 0.0, 1.0)), node(tree, "AddShader")
    tree.links.new(background.outputs[0], add.inputs[0])
    tree.links.new(other.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], output_of(tree).inputs["Surface"])


@awkward("Emission in place of Background", words=("world",))
def world_emission(folder: Path) -> None:
    stage()
    tree, _ = world_tree()
    emission = node(tree, "Emission", Color=(0.3, 0.6, 0.2, 1.0))
    tree.links.new(emission.outputs[0], output_of(tree).inputs["Surface"])


@awkward("blackbody as the world", words=("blackbody",))
def world_blackbody(folder: Path) -> None:
    _colored("Blackbody", Temperature=3000.0)


@awkward("mist in the world", words=("volume",))
def world_volume(folder: Path) -> None:
    stage(sun=1.0)
    tree, _ = world_tree()
    mist = node(tree, "VolumeScatter", Density=0.15)
    tree.links.new(mist.outputs[0], output_of(tree).inputs["Volume"])


@awkward("a world that is not a number", words=("world", "not a number", "not finite"))
def world_nan(folder: Path) -> None:
    stage()
    tree, background = world_tree()
    divide = node(tree, "Math")
    divide.operation = "POWER"
    divide.inputs[0].default_value, divide.inputs[1].default_value = -1.0, 0.5
    tree.links.new(divide.outputs[0], background.inputs["Strength"])


@awkward("a world picture with a pixel that is not a number", words=("not a number", "finite", "Panorama"))
def world_nan_pixel(folder: Path) -> None:
    stage()
    image = _panorama(64, 32)
    pixels = np.array(image.pixels[:], np.float32).reshape(32, 64, 4)
    pixels[20:22, 30:34, :3] = np.nan
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    _environment(image)


@awkward("a world picture with an endless pixel", words=("not a number", "finite", "Panorama"))
def world_inf_pixel(folder: Path) -> None:
    stage()
    image = _panorama(64, 32)
    pixels = np.array(image.pixels[:], np.float32).reshape(32, 64, 4)
    pixels[20, 30, :3] = np.inf
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    _environment(image)


@awkward("a world of a million")
def world_bright(folder: Path) -> None:
    stage()
    world_tree()[1].inputs["Strength"].default_value = 1e6


@awkward("a world that only its own sampling setting hides from lamps")
def world_unsampled(folder: Path) -> None:
    stage()
    _environment(_panorama(64, 32))
    bpy.context.scene.world.cycles.sampling_method = "NONE"


@awkward("a sun hidden in the world by the Sun settings of EEVEE, which Cycles ignores")
def world_eevee_sun(folder: Path) -> None:
    stage()
    _environment(_panorama(64, 32))
    bpy.context.scene.world.sun_threshold = 0.1
