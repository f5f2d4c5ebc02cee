# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lights a 3D viewport: the scene, the studio light of Material Preview, or an image."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..errors import InputError
from ..scene.arrays import Float32Array, Float64Array, SceneArrays, WorldArrays
from ..scene.materials.color_spaces import rec709_to_scene
from ..scene.materials.images import ImageReader


@dataclass(frozen=True, slots=True)
class ViewportLight:
    """Where a viewport's light comes from; equal ones light alike."""

    scene_lights: bool = True
    path: str = ""
    """File of an equirectangular image in place of the scene's world"""
    image: int = 0
    """session_uid of one among the file's images, in place of the scene's world"""
    strength: float = 1.0
    rotation: float = 0.0
    """About Z, radians"""


def light_of(space: bpy.types.SpaceView3D, settings: Any) -> ViewportLight:
    """The light that `Scene.curvrefl` chooses for a viewport."""
    if settings.environment == "IMAGE":
        image = settings.environment_image
        if image is None:
            return ViewportLight()
        return ViewportLight(
            image=image.session_uid,
            strength=settings.environment_strength,
            rotation=settings.environment_rotation,
        )
    shading = space.shading
    if settings.environment == "SCENE" or shading.type == "SOLID":
        return ViewportLight()
    is_rendered = shading.type == "RENDERED"
    scene_lights = shading.use_scene_lights_render if is_rendered else shading.use_scene_lights
    scene_world = shading.use_scene_world_render if is_rendered else shading.use_scene_world
    light = shading.selected_studio_light
    if scene_world or light is None or light.type != "WORLD":
        return ViewportLight(scene_lights)
    return ViewportLight(
        scene_lights, light.path, strength=shading.studiolight_intensity, rotation=shading.studiolight_rotate_z
    )


class LightReader:
    """Puts the light of a viewport in place of a scene's own; keeps the pictures it has read."""

    def __init__(self) -> None:
        self._files: dict[str, Float32Array] = {}
        self._images = ImageReader()
        self._worlds: dict[ViewportLight, WorldArrays] = {}

    def lit(self, scene: SceneArrays, light: ViewportLight) -> SceneArrays:
        """The scene in this light. Raises InputError where its picture cannot be read."""
        lamps = scene.lights if light.scene_lights else ()
        if not light.path and not light.image:
            return scene if lamps is scene.lights else replace(scene, lights=lamps)
        if light not in self._worlds:
            pixels = self._pixels(light)
            strength = light.strength
            self._worlds[light] = WorldArrays((strength,) * 3, pixels, _about_z(light.rotation))
        return replace(scene, lights=lamps, world=self._worlds[light])

    def forget_images(self, images: set[int]) -> None:
        """These images (session_uid) changed."""
        self._images.forget(images)
        for light in [key for key in self._worlds if key.image in images]:
            del self._worlds[light]

    def keep(self, lights: set[ViewportLight]) -> None:
        """Let go of all others."""
        self._worlds = {key: world for key, world in self._worlds.items() if key in lights}
        paths = {light.path for light in lights}
        self._files = {path: pixels for path, pixels in self._files.items() if path in paths}

    def _pixels(self, light: ViewportLight) -> Float32Array:
        """(height, width, 3) scene-linear, row 0 at the bottom."""
        if light.image:
            for image in bpy.data.images:
                if image.session_uid == light.image:
                    return np.ascontiguousarray(self._images.read(image)[..., :3])
            raise InputError("The environment's image is gone: choose another under Environment.")
        if light.path not in self._files:
            self._files[light.path] = _read_file(light.path)
        return self._files[light.path]


def _read_file(path: str) -> Float32Array:
    """(height, width, 3) of a studio light, which is no image of the open file, and must not become one."""
    try:
        import OpenImageIO
    except ImportError:
        # Builds of Blender by others may lack the module.
        return _read_as_image(path)
    pixels = OpenImageIO.ImageBuf(path).get_pixels(OpenImageIO.FLOAT)
    if pixels is None or pixels.ndim != 3 or pixels.shape[2] < 3:
        raise _unreadable(path)
    return rec709_to_scene(np.ascontiguousarray(pixels[::-1, :, :3], np.float32))


def _read_as_image(path: str) -> Float32Array:
    try:
        image = bpy.data.images.load(path, check_existing=False)
    except RuntimeError as error:
        raise _unreadable(path) from error
    try:
        return np.ascontiguousarray(ImageReader().read(image)[..., :3])
    finally:
        bpy.data.images.remove(image)


def _unreadable(path: str) -> InputError:
    return InputError(f"The studio light {Path(path).name} cannot be read: choose another one.")


def _about_z(angle: float) -> Float64Array:
    """(3, 3) from world to image directions of an light turned by `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
