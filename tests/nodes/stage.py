# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many node trees in one picture of Cycles: a board of square tiles that shine with what their trees give.

All tiles are one mesh, a parallelogram in its own space, with UV maps, colors and other attributes. Its normals differ
from that of its plane, and the board is turned, so that no space is like another.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

type MakeTree = Callable[[Any], Any]
"""Adds nodes to a node tree; returns the output socket that is judged"""

SIDE = 24
"""Pixels along a tile"""
SIZE = 2.0
"""Meters along a tile"""
MOST = 64
"""Tiles in one picture"""
CORNERS = ((-1.03, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
"""Of a tile, in halves of its size; the line between its triangles goes through no pixel's middle"""
CAMERA_DISTANCE, CLIP_START = 10.0, 0.1
"""(Rays of the camera begin where it begins to see.)"""
PASS_INDEX, MATERIAL_INDEX = 3, 5
OBJECT_COLOR = (0.9, 0.35, 0.15, 0.7)
PROPERTIES: dict[str, Any] = {"warmth": 0.625, "shade": (0.2, 0.5, 0.8)}
"""Custom properties of each object"""

FRAME = Euler((0.5, -0.4, 0.8)).to_matrix()
"""From the board's axes to the world's; the camera looks along its -Z"""
ORIGIN = Vector((0.3, -0.2, 0.5))
_OWN = Euler((0.3, 0.2, -0.5)).to_matrix() @ Matrix.Diagonal((1.25, 0.8, 1.1))
_SHIFT = Vector((0.1, 0.2, -0.15))


def columns_for(count: int) -> int:
    """Tiles along each side of a board of so many."""
    return math.ceil(math.sqrt(count))


def tile_center(number: int, columns: int) -> Vector:
    """In world space; tiles are counted from the bottom left."""
    row, column = divmod(number, columns)
    middle = (columns - 1) / 2.0
    return ORIGIN + FRAME @ Vector(((column - middle) * SIZE, (row - middle) * SIZE, 0.0))


def place_on_tile(tile: bpy.types.Object, places: np.ndarray) -> np.ndarray:
    """(n, 2) from -1 to 1, of places (n, 3) in world space."""
    center = tile.matrix_world.translation - FRAME @ _SHIFT
    return ((places - np.array(center)) @ np.array(FRAME))[:, :2] / (SIZE / 2.0)


def make_board(trees: Sequence[MakeTree], is_back: bool = False) -> list[bpy.types.Object]:
    """A scene of nothing else; the tiles, of which the back may be seen. What is judged is plugged into `Emission`."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    columns = columns_for(len(trees))
    _set_up_cycles(scene, columns * SIDE)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale, camera.clip_start = "ORTHO", columns * SIZE, CLIP_START
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)
    scene.camera.matrix_world = Matrix.LocRotScale(ORIGIN + FRAME @ Vector((0.0, 0.0, CAMERA_DISTANCE)), FRAME, None)
    mesh = tile_mesh(is_back)
    tiles = []
    for number, make_tree in enumerate(trees):
        tile = bpy.data.objects.new(f"tile {number}", mesh)
        scene.collection.objects.link(tile)
        matrix = (FRAME @ _OWN).to_4x4()
        matrix.translation = tile_center(number, columns) + FRAME @ _SHIFT
        tile.matrix_world = matrix
        tile.pass_index, tile.color = PASS_INDEX, OBJECT_COLOR
        for name, value in PROPERTIES.items():
            tile[name] = value
        tile.material_slots[0].link = "OBJECT"
        tile.material_slots[0].material = shining(make_tree)
        tiles.append(tile)
    bpy.context.view_layer.update()
    return tiles


def shining(make_tree: MakeTree) -> bpy.types.Material:
    """A material that sends out what a tree gives."""
    material = bpy.data.materials.new("judged")
    material.pass_index = MATERIAL_INDEX
    material.cycles.emission_sampling = "NONE"
    tree = material.node_tree
    tree.nodes.clear()
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
    emission.name = "Judged"
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    tree.links.new(make_tree(tree), emission.inputs["Color"])
    return material


def judged_input(material: bpy.types.Material) -> Any:
    """The socket that the judged value is plugged into."""
    return material.node_tree.nodes["Judged"].inputs["Color"]


def tile_mesh(is_back: bool) -> bpy.types.Mesh:
    """With the UV maps "UVMap" (which renders use) and "Other", the colors "Paint", "Glow" (floats) and "Bytes", and
    the attributes "damp", "across", "up" (numbers), "wind", "place" (vectors) and "tier" (whole numbers of faces)."""
    to_own = _OWN.inverted()
    order = (0, 3, 2, 1) if is_back else (0, 1, 2, 3)
    mesh = bpy.data.meshes.new("tile")
    mesh.from_pydata([to_own @ (Vector((*corner, 0.0)) - _SHIFT) for corner in CORNERS], [], [order])
    places = np.array(CORNERS)
    for name, axes, offset in (
        ("UVMap", ((0.6, -0.3), (0.2, 0.7)), (0.45, 0.55)),
        ("Other", ((1.1, 0.4), (-0.5, 0.9)), (-0.2, 0.3)),
    ):
        uv = places @ np.array(axes) + offset
        mesh.uv_layers.new(name=name).data.foreach_set("uv", uv[list(order)].astype(np.float32).ravel())
    shades = np.column_stack([0.5 + 0.3 * places[:, 0], 0.4 - 0.3 * places[:, 1], 0.2 + 0.1 * places.sum(1)])
    rows = np.column_stack([shades, 0.6 + 0.3 * places[:, 0]])[list(order)].astype(np.float32).ravel()
    mesh.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER").data.foreach_set("color", rows)
    mesh.color_attributes.new("Bytes", "BYTE_COLOR", "CORNER").data.foreach_set("color", rows)
    glow = np.column_stack([0.5 - 0.6 * places[:, 1], 0.8 + 0.7 * places[:, 0], 0.4 - 0.2 * places.sum(1), np.ones(4)])
    mesh.color_attributes.new("Glow", "FLOAT_COLOR", "POINT").data.foreach_set("color", glow.ravel().tolist())
    where = np.column_stack([places, np.zeros(4)]).ravel()
    mesh.attributes.new("place", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", where.tolist())
    mesh.attributes.new("across", "FLOAT", "POINT").data.foreach_set("value", (2.0 * places[:, 0]).tolist())
    mesh.attributes.new("up", "FLOAT", "POINT").data.foreach_set(
        "value", (1.9 * places[:, 1] + 0.13 * places[:, 0]).tolist()
    )
    mesh.attributes.new("damp", "FLOAT", "POINT").data.foreach_set("value", (0.3 + 0.5 * places[:, 1]).tolist())
    wind = np.column_stack([places, 0.5 * places[:, 0] - places[:, 1]]).ravel()
    mesh.attributes.new("wind", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", wind.tolist())
    mesh.attributes.new("tier", "INT", "FACE").data.foreach_set("value", [2])
    mesh.materials.append(None)
    mesh.update()
    mesh.polygons[0].use_smooth = True
    # (Normals of a mesh go with the inverse transposed.)
    leaning = [_OWN.transposed() @ Vector((0.5 * x + 0.2, 0.3 * y - 0.2 * x, 1.0)) for x, y in CORNERS]
    side = -1.0 if is_back else 1.0
    mesh.normals_split_custom_set([side * leaning[corner].normalized() for corner in order])
    return mesh


@cache
def sampled_places(columns: int) -> np.ndarray:
    """(columns**2, SIDE, SIDE, 2): where on its tile, from -1 to 1, Cycles looks at each pixel. (Samples are a little
    off the pixels' middles, alike in all pictures of one size.)"""

    def place(tree: Any) -> Any:
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_name = "place"
        return node.outputs["Vector"]

    make_board([place] * columns**2)
    return render_board(columns**2)[..., :2]


def render_board(count: int) -> np.ndarray:
    """(count, SIDE, SIDE, 3) of the scene's board by Cycles, rows from below, in the working space."""
    scene = bpy.context.scene
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder, "board.exr"))
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    columns = columns_for(count)
    board = pixels.reshape(columns, SIDE, columns, SIDE, -1)[..., :3]
    return board.transpose(0, 2, 1, 3, 4).reshape(-1, SIDE, SIDE, 3)[:count]


def _set_up_cycles(scene: bpy.types.Scene, pixels: int) -> None:
    """One sample in the middle of each pixel."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", 1, False, False
    cycles.max_bounces, cycles.use_light_tree, cycles.sample_clamp_direct = 0, False, 0.0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
    render = scene.render
    render.resolution_x = render.resolution_y = pixels
    render.resolution_percentage, render.dither_intensity = 100, 0.0
    render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
