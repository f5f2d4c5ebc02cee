# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds by nodes, and all their directions at once: by Cycles, and by their programs."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.lighting.programs.bake import CAMERA, Baker, sky_directions
from curvrefl.curvrefl_addon.scene.arrays import WorldArrays
from extraction import empty_scene, link

WIDTH = 128


def new_world(node_type: str, **settings: Any) -> tuple[bpy.types.NodeTree, Any]:
    """A new file whose world is a node's color; its tree and that node."""
    world = empty_scene().world
    world.cycles.sampling_method = "NONE"
    tree = world.node_tree
    node: Any = tree.nodes.new(node_type)
    for name, value in settings.items():
        setattr(node, name, value)
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    return tree, node


def all_directions_by_cycles(width: int = WIDTH) -> np.ndarray:
    """(width / 2, width, 3) equirectangular, at the middles of pixels."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.panorama_type = "PANO", "EQUIRECTANGULAR"
    scene.camera = link(bpy.data.objects.new("camera", camera))
    scene.camera.rotation_euler = (0.5 * math.pi, 0.0, -0.5 * math.pi)
    render = scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, width // 2, 100
    scene.cycles.samples, scene.cycles.filter_width, scene.cycles.pixel_filter_type = 1, 0.01, "BOX"
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    path = f"{bpy.app.tempdir}sky.exr"
    render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path, check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.empty(4 * width * (width // 2), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(width // 2, width, 4)[..., :3]


def all_directions(world: WorldArrays, width: int = WIDTH, rays: int = CAMERA) -> np.ndarray:
    """The same by the world's program."""
    assert world.program is not None
    return Baker(world.program, world.program_images).bake(sky_directions(width), rays)
