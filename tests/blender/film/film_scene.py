# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror ball before a plain world: what its film must show is known without rendering anything."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.report.images import load_exr

SIZE = 32
WORLD = (0.2, 0.5, 0.8)
FALSE = (0.0, 1.0, 0.0)
"""What the ball looks like in EEVEE: a color that its film must show nowhere"""
BALL = "Ball"


def build() -> Any:
    """The ball reflects the world as it is, by its override; in EEVEE it shines green. Returns the scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    render = scene.render
    render.engine = "BLENDER_EEVEE"
    render.resolution_x = render.resolution_y = SIZE
    scene.eevee.taa_render_samples = 2
    scene.curvrefl.render_samples = 8
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*WORLD, 1.0)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=1.0)
    ball: Any = bpy.context.object
    ball.name = BALL
    bpy.ops.object.shade_smooth()
    ball.data.materials.append(shining("false", FALSE))
    ball.curvrefl.is_mirror = ball.curvrefl.override = True
    ball.curvrefl.fresnel = "CONSTANT"
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0.0, -20.0, 0.0), rotation=(np.pi / 2.0, 0.0, 0.0))
    # (So that there is something to reflect; it looks like the world.)
    bpy.context.object.data.materials.append(shining("plain", WORLD))
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    camera.location = (0.0, -6.0, 0.0)
    camera.rotation_euler = (np.pi / 2.0, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


def shining(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """A material that shines as `color` and does nothing else."""
    material = bpy.data.materials.new(name)
    tree: Any = material.node_tree
    tree.nodes.clear()
    output, emission = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def blur(scene: Any, kind: str) -> None:
    """Depth of field after the picture or by the camera, motion of the ball, or none of them."""
    lens = scene.camera.data.dof
    lens.use_dof = kind in ("depth of field", "jittered depth of field")
    lens.focus_distance, lens.aperture_fstop = 3.0, 0.15
    if kind == "depth of field":
        # (What EEVEE blurs after the picture has an alpha that its colors do not quite follow, with few samples.)
        scene.eevee.taa_render_samples = 16
    scene.eevee.use_bokeh_jittered = kind == "jittered depth of field"
    if kind == "motion":
        scene.render.use_motion_blur = True
        scene.render.motion_blur_shutter = 1.0
        ball = bpy.data.objects[BALL]
        for frame, place in ((0, -0.5), (2, 0.5)):
            ball.location.x = place
            ball.keyframe_insert("location", frame=frame)
        scene.frame_set(1)


def picture(scene: Any, path: Path) -> np.ndarray:
    """(SIZE, SIZE, 4) of a render of the scene as it is, by way of `path`."""
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    settings.color_mode = "RGBA"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return load_exr(path)
