# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the demo with a lamp placed by a pixel in each of the three ways: a cross where it was asked for, and
the outlines of lamps in the mirrors.

    .venv/bin/python tools/measure/light/draw_lights.py FOLDER [--samples 32]

`./curvrefl images lights.jpg` calls it.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import bootstrap
import bpy
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon import registration  # noqa: E402
from curvrefl.curvrefl_addon.demo.scene import MIRRORS, build_demo  # noqa: E402
from curvrefl.curvrefl_addon.design.lights.shown import LightsInMirrors  # noqa: E402
from curvrefl.curvrefl_addon.engine.job import Job  # noqa: E402
from curvrefl.curvrefl_addon.engine.still import render_still  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera  # noqa: E402
from curvrefl.curvrefl_addon.settings_table import Settings  # noqa: E402

SIZE = (420, 315)
ASKED: dict[str, tuple[tuple[float, float], dict[str, Any], float]] = {
    "REFLECTION": ((152.5, 118.5), {"keep_distance": False, "distance": 0.4, "size": 2.5}, 5.0),
    "ILLUMINATION": ((118.5, 30.5), {"keep_distance": False, "distance": 0.09}, 0.9),
    "RIM": ((97.5, 166.5), {"keep_distance": False, "distance": 0.18, "rim_width": 0.8}, 3.0),
}
"""For each mode the pixel from the bottom left, how, and the lamp's power in watts"""
BOX = (0.16, 0.07)
"""Meters"""
CROSS = 7
"""Pixels from its middle to its ends"""


def add_lamp() -> bpy.types.Object:
    """An upright soft box."""
    light: Any = bpy.data.lights.new("Soft box", "AREA")
    light.shape = "RECTANGLE"
    lamp = bpy.data.objects.new("Soft box", light)
    lamp.visible_camera = False
    scene: Any = bpy.context.scene
    scene.collection.objects.link(lamp)
    bpy.context.view_layer.objects.active = lamp
    return lamp


def dim(scene: Any) -> None:
    """The evening, so that the lamp tells."""
    bpy.data.objects["Sun"].hide_render = bpy.data.objects["Sun"].hide_viewport = True
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Strength"].default_value *= 0.15


def outlines(scene: Any) -> Any:
    """(s, 2, 2) what the tool draws over the mirrors, in pixels from the bottom left."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view = view_of_camera(scene, scene.camera, *SIZE, depsgraph)
    return np.concatenate([light.segments for light in LightsInMirrors().of(depsgraph, scene, view, None)])


def mark(path: Path, pixel: tuple[float, float], segments: Any) -> None:
    """A cross at a place in pixels from the bottom left, and lines."""
    from PIL import Image, ImageDraw

    with Image.open(path) as opened:
        picture = opened.convert("RGB")
    draw = ImageDraw.Draw(picture)
    x, y = pixel[0], picture.height - pixel[1]
    for width, color in ((4, (0, 0, 0)), (2, (255, 170, 30))):
        for turned in (False, True):
            ends = [(x - CROSS, y), (x + CROSS, y)] if turned else [(x, y - CROSS), (x, y + CROSS)]
            draw.line(ends, fill=color, width=width)
        for one, other in segments.tolist():
            draw.line([(one[0], picture.height - one[1]), (other[0], picture.height - other[1])], color, width)
    picture.save(path)


def main() -> None:
    parser = argparse.ArgumentParser(description="Draws the demo with a lamp placed in three ways.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--modes", nargs="*", default=list(ASKED), choices=list(ASKED))
    arguments = parser.parse_args()
    registration.register()
    build_demo(arguments.folder.resolve() / "demo.blend")
    scene: Any = bpy.context.scene
    operators: Any = bpy.ops
    for name in MIRRORS:
        mirror: Any = bpy.data.objects[name]
        mirror.curvrefl.is_mirror = True
    dim(scene)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    lamp: Any = add_lamp()
    for mode in arguments.modes:
        pixel, properties, lamp.data.energy = ASKED[mode]
        lamp.data.size, lamp.data.size_y = BOX
        operators.curvrefl.place_light(mode=mode, pixel=pixel, **properties)
        path = arguments.folder.resolve() / f"{mode.lower()}.png"
        render_still(scene, Job(MIRRORS, Settings(samples=arguments.samples)), *SIZE, path, None)
        mark(path, pixel, outlines(scene))
    registration.unregister()


if __name__ == "__main__":
    main()
