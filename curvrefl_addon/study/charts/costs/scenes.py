# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that differ in one amount alone: the hall of the benchmark with more of something, or with less.

All are lit directly, and all but those with images are made of arrays, without Blender.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ....demo.data_blocks import (
    add_camera,
    add_object,
    add_sun,
    mirror,
    principled,
    set_world_color,
    start_empty_scene,
)
from ....demo.shapes import ball, plane
from ....optics.surfaces.radial_surfaces import Ellipsoid
from ....renderer.measured.hall import CHROME, hall, radial_mesh, view_of_mirror
from ....report.direct_light import in_direct_light
from ....scene.arrays import Float64Array, InstanceArrays, LightArrays, SceneArrays
from ....scene.camera.view import View
from ....scene.meshes.made import quad_mesh
from ....scene.opened.render_depsgraph import read_render_scene

TRIANGLES = 50_000
"""Where their number is not what is varied"""
SHARE, LARGE_SHARE = 0.5, 0.9
"""Of the picture's width that the mirror takes, and where its pixels are varied"""
LAMPS_POWER, LAMP_RADIUS = 800.0, 0.05
"""Watts of all lamps together, and meters"""
LAMPS_AWAY, LAMPS_UP = 5.0, 4.0
GRID = 1.6
"""Width and height of what many mirrors fill, meters"""
MIRROR_BANDS = 24
ROOM_SIDES, ROOM_FRONT, ROOM_BACK, ROOM_HEIGHT = 2.2, -7.0, 3.0, 3.5
"""Of a room of mirrors about the mirror and the eye, meters: places of its walls across and along the line of sight"""
BALLS, RINGS = 64, 4
IMAGES, IMAGE_SIDE = 8, 256
"""Where their number or size is not what is varied"""

type Size = tuple[int, int]
"""Of a picture: width, height"""


def triangles_of(scene: SceneArrays) -> int:
    """In all that is no mirror."""
    shown = [instance for instance in scene.instances if instance.object_id not in scene.reflectors]
    return sum(len(scene.meshes[instance.mesh].triangles) for instance in shown)


def of_triangles(count: int, size: Size) -> tuple[SceneArrays, View]:
    """About so many around the mirror."""
    return hall(count), view_of_mirror(*size, SHARE * size[0])


def of_pixels(scale: float, size: Size) -> tuple[SceneArrays, View]:
    """A mirror that fills most of a picture of another size."""
    return hall(TRIANGLES), resized(view_of_mirror(*size, LARGE_SHARE * size[0]), scale)


def resized(view: View, scale: float) -> View:
    """The same picture with other pixels."""
    return replace(view, width=max(round(scale * view.width), 1), height=max(round(scale * view.height), 1))


def of_lights(count: int, size: Size) -> tuple[SceneArrays, View]:
    """Point lamps with shadows in a ring; all together are as bright as one."""
    angles = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    lamps = tuple(_lamp(number, float(angle), LAMPS_POWER / count) for number, angle in enumerate(angles))
    return replace(hall(TRIANGLES), lights=lamps), view_of_mirror(*size, SHARE * size[0])


def _lamp(number: int, angle: float, power: float) -> LightArrays:
    matrix = np.eye(4)
    matrix[:3, 3] = LAMPS_AWAY * np.cos(angle), LAMPS_AWAY * np.sin(angle), LAMPS_UP
    return LightArrays(f"lamp {number}", "POINT", (power,) * 3, matrix, radius=LAMP_RADIUS)


def of_mirrors(count: int, size: Size) -> tuple[SceneArrays, View]:
    """Ellipsoids in a grid that takes the same part of the picture, however many they are."""
    scene = hall(TRIANGLES)
    columns = int(np.ceil(np.sqrt(count)))
    cell = GRID / columns
    mesh = len(scene.meshes)
    first = max(instance.object_id for instance in scene.instances) + 1
    mirrors = []
    for number in range(count):
        row, column = divmod(number, columns)
        matrix: Float64Array = np.diag([0.48 * cell, 0.48 * cell, 0.48 * cell, 1.0])
        matrix[:3, 3] = (column - 0.5 * (columns - 1)) * cell, 0.0, (row - 0.5 * (columns - 1)) * cell
        mirrors.append(InstanceArrays(f"mirror {number}", first + number, mesh, matrix, (CHROME,)))
    meshes = (*scene.meshes, radial_mesh(Ellipsoid(1.0, 0.8, 0.7), MIRROR_BANDS, 2 * MIRROR_BANDS))
    numbers = tuple(one.object_id for one in mirrors)
    # (The hall's own mirror is gone.)
    scene = replace(scene, meshes=meshes, instances=(*scene.instances[1:], *mirrors), reflectors=numbers)
    return scene, view_of_mirror(*size, SHARE * size[0])


def of_bounces(_count: int, size: Size) -> tuple[SceneArrays, View]:
    """The mirror between four walls, mirrors that show it and each other again and again, open above. The same scene
    for any number: how often light is followed from mirror to mirror is a setting."""
    scene = hall(TRIANGLES)
    inside = [one for one in scene.instances[2:] if abs(one.matrix[0, 3]) < ROOM_SIDES - 0.5]
    inside = [one for one in inside if one.matrix[1, 3] < ROOM_BACK - 0.5]
    corners = [(-ROOM_SIDES, ROOM_FRONT), (ROOM_SIDES, ROOM_FRONT), (ROOM_SIDES, ROOM_BACK), (-ROOM_SIDES, ROOM_BACK)]
    meshes, walls = list(scene.meshes), []
    first = max(instance.object_id for instance in scene.instances) + 1
    for number, (end, start) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True)):
        along = np.subtract(end, start) / np.linalg.norm(np.subtract(end, start))
        ring = [(*start, -1.0), (*end, -1.0), (*end, ROOM_HEIGHT), (*start, ROOM_HEIGHT)]
        walls.append(InstanceArrays(f"wall {number}", first + number, len(meshes), np.eye(4), (CHROME,)))
        meshes.append(quad_mesh("wall", np.array(ring), (along[1], -along[0], 0.0)))
    scene = replace(
        scene,
        meshes=tuple(meshes),
        instances=(*scene.instances[:2], *inside, *walls),
        reflectors=(*scene.reflectors, *(wall.object_id for wall in walls)),
    )
    return scene, view_of_mirror(*size, SHARE * size[0])


def of_images(count: int, size: Size) -> tuple[SceneArrays, View]:
    """BALLS balls around a mirror, which share so many images."""
    return _with_images(count, IMAGE_SIDE, size)


def of_image_sides(side: int, size: Size) -> tuple[SceneArrays, View]:
    """The same balls with IMAGES square images of so many pixels a side."""
    return _with_images(IMAGES, side, size)


def _with_images(count: int, side: int, size: Size) -> tuple[SceneArrays, View]:
    """Built in Blender, whose nodes materials' programs are made from: the open file is replaced."""
    start_empty_scene(*size)
    rng = np.random.default_rng(0)
    paints = [principled(f"paint {number}", image=_image(rng, f"image {number}", side)) for number in range(count)]
    add_object("Mirror", ball(1.0, 96), mirror("chrome"), smooth=True)
    add_object("floor", plane((20.0, 20.0), (1, 1)), principled("gray"), location=(0.0, 0.0, -1.0))
    for number in range(BALLS):
        ring, place = divmod(number, BALLS // RINGS)
        angle = 2.0 * np.pi * (place + 0.5 * (ring % 2)) / (BALLS // RINGS)
        away = 1.7 + 0.8 * ring
        where = (away * np.cos(angle), away * np.sin(angle), -0.7 + 0.25 * ring)
        add_object(f"ball {number}", ball(0.25, 16), paints[number % count], smooth=True, location=where)
    set_world_color((0.5, 0.5, 0.5))
    add_sun((-0.5, -0.6, 0.9), 2.0)
    add_camera((0.0, -6.0, 2.0), (0.0, 0.0, 0.0), lens=58.0)
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and view_layer is not None, "an empty file has both"
    arrays, view = read_render_scene(scene, view_layer, ["Mirror"], *size)
    return in_direct_light(arrays), view


def _image(rng: np.random.Generator, name: str, side: int) -> bpy.types.Image:
    """Noise of a tint of its own."""
    image = bpy.data.images.new(name, side, side, alpha=False)
    pixels = np.ones((side, side, 4), np.float32)
    pixels[..., :3] = rng.uniform(0.2, 0.9, 3) * rng.uniform(0.6, 1.0, (side, side, 1))
    flat: Any = pixels.ravel()
    image.pixels.foreach_set(flat)
    image.update()
    return image
