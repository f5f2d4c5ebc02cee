# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A wall of squares, a meter apart, seen in a flat mirror: what each shows of one sun, here and in Cycles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add, extracted, link, new_material

TILE = 16
"""Pixels of a square's meter"""
SUB_FRAMES, SAMPLES = 64, 256


@dataclass(frozen=True, slots=True)
class Wall:
    """Pictures of it, by squares: (rows, columns, TILE, TILE, 3), from below and, seen in the mirror, from the left."""

    ours: np.ndarray
    cycles: np.ndarray
    warnings: tuple[str, ...]


def pictures_of_wall(columns: int, rows: int) -> Wall:
    """Of the open scene, whose squares lie in the plane y = 0 about (0..columns - 1, 0..rows - 1) and face -Y."""
    mirror = _add_surroundings(columns, rows)
    scene = bpy.context.scene
    width, height = columns * TILE, rows * TILE
    view = view_of_camera(scene, scene.camera, width, height)
    frame = Renderer(extracted(mirror), Settings(method="exact", samples=SUB_FRAMES)).render(view)
    cycles: Any = scene.cycles
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 12, 0, 1, 12
    cycles.caustics_reflective = cycles.caustics_refractive = False
    still = render_reference(scene, bpy.context.view_layer, width, height, SAMPLES, "full")

    def squares(picture: Any) -> np.ndarray:
        pixels = np.asarray(picture)[..., :3].astype(np.float64)
        # (In the mirror left is right.)
        return pixels.reshape(rows, TILE, columns, TILE, 3).transpose(0, 2, 1, 3, 4)[:, ::-1]

    return Wall(squares(frame.color()), squares(still.pixels), tuple(frame.warnings))


def _add_surroundings(columns: int, rows: int) -> Any:
    """The mirror; an orthographic camera between it and the wall, a backdrop that shines, a sun, a black world."""
    scene = bpy.context.scene
    low, right, top, far = -2.0, columns + 2.0, rows + 2.0, -6.0
    corners = ((low, low), (right, low), (right, top), (low, top))
    backdrop = add("backdrop", [(x, 0.6, z) for x, z in corners], [(0, 1, 2, 3)])
    new_material(backdrop, "ShaderNodeEmission")[1][0].inputs["Color"].default_value = (0.3, 0.35, 0.4, 1.0)
    mirror = add("mirror", [(x, far, z) for x, z in corners], [(0, 3, 2, 1)])
    mirror.visible_shadow = False
    _, (metal,) = new_material(mirror, "ShaderNodeBsdfAnisotropic")
    metal.inputs["Roughness"].default_value = 0.0
    metal.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", float(max(columns, rows))
    eye = link(bpy.data.objects.new("camera", camera))
    eye.location, eye.rotation_euler = ((columns - 1) / 2.0, -3.0, (rows - 1) / 2.0), (math.pi / 2.0, 0.0, math.pi)
    scene.camera = eye
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 2.0, 0.1
    lamp = link(bpy.data.objects.new("sun", sun))
    lamp.rotation_euler = (0.9, 0.2, 0.3)
    # What shines lights nothing else, as in direct light.
    for material in bpy.data.materials:
        material.cycles.emission_sampling = "NONE"
    return mirror
