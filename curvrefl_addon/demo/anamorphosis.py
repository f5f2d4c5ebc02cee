# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A mirror on a sheet of paper, as large as one that stands on a table, and a picture for it to show."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import bpy
import numpy as np

from ..scene.arrays import Float32Array, Float64Array
from .data_blocks import add_camera, add_object, add_sun, mirror, principled, set_world_color, start_empty_scene
from .shapes import Shape, plane, star_normals, star_shape

MIRROR, PAPER = "Mirror", "Paper"
SEGMENTS, BANDS = 512, 64
"""Of mirrors about their axis, and along it where they are not straight"""
SHEET = 0.6
"""Meters along a side of the paper"""
WALL, WALL_HEIGHT, WALL_SEGMENTS = 0.5, 1.1, 96
"""Radius and height in meters of the paper around the ball"""
SKY = (0.4, 0.43, 0.46)
EYES = {
    "cylinder": ((0.0, -0.75, 0.5), (0.0, 0.0, 0.075), 150.0),
    "cone": ((0.0, -0.02, 0.75), (0.0, 0.0, 0.04), 150.0),
    "sphere": ((0.0, -0.4, 0.4), (0.0, 0.0, 0.3), 100.0),
    "free_form": ((0.0, -0.7, 0.65), (0.0, 0.0, 0.06), 170.0),
}
"""Where the camera is, what it looks at, and its focal length in millimeters"""


def build_anamorphosis(shape: str = "cylinder", width: int = 640, height: int = 480) -> bpy.types.Object:
    """Replace the open file by a scene that shows one of MIRRORS on white paper; returns the mirror."""
    start_empty_scene(width, height)
    reflector = MIRRORS[shape]()
    sheet = _wall() if shape == "sphere" else plane((SHEET, SHEET))
    add_object(PAPER, sheet, principled("White paper", roughness=1.0))
    set_world_color(SKY)
    add_sun((-0.4, -0.3, 0.9), 1.2)
    eye, target, lens = EYES[shape]
    add_camera(eye, target, lens=lens)
    return reflector


def _wall() -> Shape:
    """An upright cylinder about the mirror and the eye, with a seam of its UV map behind that."""
    turn = np.linspace(-0.5 * np.pi, 1.5 * np.pi, WALL_SEGMENTS + 1)
    across = np.column_stack([np.cos(turn), np.sin(turn)])[[*range(WALL_SEGMENTS), 0]]
    low, high = (np.column_stack([WALL * across, np.full(len(turn), z)]) for z in (0.0, WALL_HEIGHT))
    corners = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    unique, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    u = np.arange(WALL_SEGMENTS + 1) / WALL_SEGMENTS
    uv = [[(a, 0.0), (b, 0.0), (b, 1.0), (a, 1.0)] for a, b in pairwise(u.tolist())]
    return Shape(unique, tuple(map(tuple, index.reshape(-1, 4).tolist())), np.array(uv).reshape(-1, 2))


def _cylinder() -> bpy.types.Object:
    """Radius 40 mm, height 150 mm."""
    return _turned(lambda _z: 0.04, 0.15, 1)


def _cone() -> bpy.types.Object:
    """Radius 60 mm, height 80 mm."""
    return _turned(lambda z: 0.06 * (1.0 - z / 0.08), 0.08, BANDS)


def _sphere() -> bpy.types.Object:
    """Radius 60 mm, in the middle of the wall about it."""

    def radius(directions: Float64Array) -> Float64Array:
        return np.full(len(directions), 0.06)

    ball = star_shape(radius, 96)
    normals = star_normals(radius, ball.positions / 0.06)
    return add_object(MIRROR, ball, mirror("Mirror", (1.0, 1.0, 1.0)), True, (0.0, 0.0, 0.3), normals=normals)


def _free_form() -> bpy.types.Object:
    """An oval that turns and narrows upwards: no two places of it are curved alike."""
    return _turned(lambda z: 0.05 - 0.08 * z, 0.14, BANDS, flatness=0.3, twist=np.radians(50.0))


def _turned(
    radius: Callable[[float], float], height: float, bands: int, flatness: float = 0.0, twist: float = 0.0
) -> bpy.types.Object:
    """A mantle of this radius, narrower by `flatness` across a direction that turns by `twist` upwards; its normals are
    those of the true surface."""

    def place(turn: Float64Array, z: Float64Array) -> Float64Array:
        size = np.vectorize(radius)(z)
        around = twist * z / height
        x, y = size * np.cos(turn), (1.0 - flatness) * size * np.sin(turn)
        return np.stack([np.cos(around) * x - np.sin(around) * y, np.sin(around) * x + np.cos(around) * y, z], axis=-1)

    turn, z = np.meshgrid(2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS, np.linspace(0.0, height, bands + 1))
    step = 1e-6
    along = place(turn + step, z) - place(turn - step, z)
    up = place(turn, z + step * height) - place(turn, z - step * height)
    # (At a tip the circle is none: there the normals are those just below.)
    low = np.minimum(z, height * (1.0 - 1e-3))
    along = np.where(
        np.linalg.norm(along, axis=-1, keepdims=True) > 1e-12, along, place(turn + step, low) - place(turn - step, low)
    )
    normals = np.cross(along, up)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    index = np.arange(turn.size).reshape(turn.shape)
    after = np.roll(index, -1, axis=1)
    quads = np.stack([index[:-1], after[:-1], after[1:], index[1:]], axis=-1).reshape(-1, 4)
    shape = Shape(place(turn, z).reshape(-1, 3), tuple(map(tuple, quads.tolist())))
    chrome = mirror("Mirror", (1.0, 1.0, 1.0))
    return add_object(MIRROR, shape, chrome, smooth=True, normals=normals.reshape(-1, 3))


MIRRORS: dict[str, Callable[[], bpy.types.Object]] = {
    "cylinder": _cylinder,
    "cone": _cone,
    "sphere": _sphere,
    "free_form": _free_form,
}


def picture(size: int = 512, fineness: int = 3) -> Float32Array:
    """(size, size, 4) on the curve of sRGB, row 0 at the bottom: a house by the sea, in a frame. Edges are smoothed by
    `fineness` places along a side of each pixel."""
    steps = (np.arange(size * fineness) + 0.5) / (size * fineness)
    x, y = np.meshgrid(steps, steps)
    colors = np.empty((*x.shape, 3))
    colors[:] = np.array([0.95, 0.85, 0.65]) + (y[..., None] - 0.35) * [-0.7, -0.35, 0.45]

    def put(where: np.ndarray, color: tuple[float, float, float]) -> None:
        colors[where] = color

    turn = np.arctan2(y - 0.74, x - 0.74)
    far = np.hypot(x - 0.74, y - 0.74)
    put((far < 0.17) & (np.cos(12.0 * turn) > 0.2), (0.98, 0.75, 0.2))
    put(far < 0.1, (0.95, 0.45, 0.12))
    put(y < 0.36, (0.1, 0.38, 0.6))
    put((y < 0.36) & (np.sin(70.0 * y + 0.6 * np.sin(25.0 * x)) > 0.75), (0.75, 0.88, 0.93))
    put(y < 0.3 - 0.5 * (x - 0.25) ** 2 - 0.1 * np.maximum(x - 0.55, 0.0), (0.2, 0.5, 0.22))
    put((np.abs(x - 0.36) < 0.17) & (y > 0.2) & (y < 0.5), (0.93, 0.9, 0.82))
    put((y >= 0.5) & (y < 0.7 - np.abs(x - 0.36)), (0.72, 0.16, 0.13))
    put((np.abs(x - 0.45) < 0.03) & (y > 0.55) & (y < 0.72), (0.45, 0.2, 0.16))
    put((np.abs(x - 0.29) < 0.045) & (y > 0.2) & (y < 0.38), (0.35, 0.2, 0.12))
    put((np.abs(x - 0.44) < 0.05) & (np.abs(y - 0.36) < 0.05), (0.15, 0.25, 0.4))
    bars = np.minimum(np.abs(x - 0.44), np.abs(y - 0.36)) < 0.006
    put(bars & (np.maximum(np.abs(x - 0.44), np.abs(y - 0.36)) < 0.05), (0.93, 0.9, 0.82))
    edge = np.minimum(np.minimum(x, 1.0 - x), np.minimum(y, 1.0 - y))
    put(edge < 0.035, (0.12, 0.1, 0.1))
    put((edge > 0.014) & (edge < 0.02), (0.85, 0.7, 0.3))
    smooth = colors.reshape(size, fineness, size, fineness, 3).mean(axis=(1, 3))
    result: Float32Array = np.ones((size, size, 4), np.float32)
    result[..., :3] = np.clip(smooth, 0.0, 1.0)
    return result
