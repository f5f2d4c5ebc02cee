# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror ball between a cube and a glossy ball on a floor, as a Blender scene, and how far our picture of it is from
the one that F12 shows with Cycles."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, principled, set_world_color
from curvrefl.curvrefl_addon.demo.shapes import ball, box, plane
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.images import load_exr
from curvrefl.curvrefl_addon.scene.extract import extract_scene
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from mathutils import Vector

WIDTH, HEIGHT = 96, 72
OFF = 0.08
"""Of a block's mean as the screen shows it"""


def build_room(with_lamp: bool = True) -> bpy.types.Scene:
    """Replaces the open file. Objects: floor, mirror, cube, gloss; a lamp "area"; a gray world; no indirect light."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    matte = principled("floor", (0.5, 0.5, 0.5), roughness=0.6)
    # Its gloss would show the lamps that the mirror shows, as noise.
    matte.node_tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.0
    add_object("floor", plane((12.0, 12.0)), matte)
    add_object("mirror", ball(1.0, 64), principled("chrome", (0.9, 0.9, 0.9), 1.0, 0.0), True, (0.0, 0.0, 1.0))
    add_object("cube", box((1.0, 1.0, 1.0)), principled("red", (0.8, 0.1, 0.05)), location=(-1.7, -0.6, 0.5))
    add_object("gloss", ball(0.5, 48), principled("gloss", (0.1, 0.3, 0.7), roughness=0.3), True, (1.6, -0.8, 0.5))
    set_world_color((0.3, 0.35, 0.4))
    if with_lamp:
        add_lamp("AREA", (1.5, -2.0, 3.5), 150.0, size=1.0)
    add_camera((0.0, -7.0, 2.6), (0.0, 0.0, 0.9), 45.0)
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.cycles.diffuse_bounces = 0
    return scene


def add_lamp(kind: str, place: tuple[float, float, float], energy: float, **values: Any) -> Any:
    """A lamp that shines on the origin, called as its kind in small letters; its object."""
    light: Any = bpy.data.lights.new(kind.lower(), kind)
    light.energy = energy
    for name, value in values.items():
        setattr(light, name, value)
    placed: Any = bpy.data.objects.new(light.name, light)
    placed.location = place
    placed.rotation_euler = Vector(place).to_track_quat("Z", "Y").to_euler()
    scene: Any = bpy.context.scene
    scene.collection.objects.link(placed)
    return placed


@dataclass(frozen=True)
class Judged:
    """Two pictures (HEIGHT, WIDTH, 3), scene-linear, and what ours warns of."""

    ours: np.ndarray
    cycles: np.ndarray
    warnings: tuple[str, ...]

    @property
    def share_off(self) -> float:
        """Share of blocks of 4 by 4 pixels that the screen shows otherwise."""
        return float((np.abs(blocks(self.ours) - blocks(self.cycles)).max(axis=-1) > OFF).mean())


def judge_room(
    samples: int = 48, mirrors: tuple[str, ...] = ("mirror",), method: str = "exact", shadow_rays: bool = False
) -> Judged:
    """The open scene by both."""
    ours, warnings = our_room(mirrors, method, shadow_rays)
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples = samples
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_light_tree = False
    # Light that gets from a lamp over the mirror to the floor is the next issue's.
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "cycles.exr")
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        return Judged(ours, load_exr(path)[..., :3], warnings)


def our_room(
    mirrors: tuple[str, ...] = ("mirror",), method: str = "exact", shadow_rays: bool = False, samples: int = 16
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Picture and warnings of the open scene as a render shows it."""
    scene: Any = bpy.context.scene
    depsgraph = bpy.context.evaluated_depsgraph_get()
    arrays = extract_scene(depsgraph, scene, [scene.objects[name] for name in mirrors])
    renderer = Renderer(arrays, Settings(method=method, samples=samples, shadow_rays=shadow_rays))
    size = (scene.render.resolution_x, scene.render.resolution_y)
    frame = renderer.render(view_of_camera(scene, scene.camera, *size, depsgraph))
    picture = frame.color()[..., :3]
    renderer.free()
    return picture, frame.warnings


def blocks(picture: np.ndarray) -> np.ndarray:
    """Means of 4 by 4 pixels, sRGB, up to 1."""
    linear = np.clip(picture, 0.0, None)
    shown = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055).clip(0.0, 1.0)
    height, width = picture.shape[:2]
    return shown.reshape(height // 4, 4, width // 4, 4, 3).mean(axis=(1, 3))
