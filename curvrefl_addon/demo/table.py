# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table and what stands on it in the camera's view: books and a ball that touch the kettle, Suzanne looking into
it, a lacquered jar, a glass carafe, a bowl of fruit, a picture on the wall."""

from __future__ import annotations

from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..scene.arrays import Float64Array
from . import paint
from .data_blocks import add_object, principled
from .kettle import BODY_CENTER, GAP, body_radius
from .materials import glass, lacquer, matte
from .room import BACK, FLOOR
from .shapes import (
    Shape,
    ball,
    block,
    box,
    joined,
    plane,
    projected,
    slide_to_contact,
    star_normals,
    star_shape,
    turned_profile,
)

JAR = "Lacquer jar"
"""Name of the second reflector"""
JAR_HEIGHT = 0.062
"""Meters, of its middle"""
TABLE = (-0.78, 0.95, -0.42, 0.585)
"""From x, to x, from y, to y; its top is at height 0"""


def add_table() -> bpy.types.Object:
    """A top of planks on four legs, the kettle amid it."""
    x0, x1, y0, y1 = TABLE
    wood = paint.planks(1024, 1024, 6, colors=((0.76, 0.57, 0.38), (0.5, 0.32, 0.19)))
    oak = matte("Oak planks", pixels=wood, roughness=0.7)
    middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1))
    top = projected(block((x0, y0, -0.035), (x1, y1, 0.0), bevel=0.003), 0.72)
    legs = [
        block((x - 0.03, y - 0.03, FLOOR), (x + 0.03, y + 0.03, -0.0355))
        for x in (x0 + 0.06, x1 - 0.06)
        for y in (y0 + 0.06, y1 - 0.06)
    ]
    add_object("Table legs", projected(joined(*legs), 0.72), oak)
    return add_object("Table", top.moved((-middle[0], -middle[1], 0.0)), oak, location=(*middle, 0.0))


def add_things() -> None:
    """All that the camera sees on the table and the wall behind it."""
    _add_touching_things()
    add_suzanne((-0.055, -0.205, 0.0345), size=0.035, toward=np.array(BODY_CENTER))
    add_jar((-0.235, -0.065))
    add_carafe((0.185, 0.25))
    _add_fruit((0.232, 0.03))
    _add_picture()


def _add_touching_things() -> None:
    """A ball and a pile of books, pushed to the kettle."""
    center = np.array(BODY_CENTER)
    stripes = [(0.78, 0.36, 0.22), (0.9, 0.86, 0.77), (0.16, 0.33, 0.38), (0.9, 0.86, 0.77), (0.86, 0.63, 0.25)]
    stripes += [(0.9, 0.86, 0.77)]
    rubber = matte("Striped rubber", pixels=paint.segments(384, 64, stripes), roughness=0.6)
    sphere = ball(0.03, 32).turned(0.5, 0).turned(0.9, 1).moved((0.15, -0.3, 0.03))
    sphere = slide_to_contact(sphere, (-0.35, 1.0, 0.0), body_radius, center, GAP)
    _add_world_shape("Ball", sphere, rubber, smooth=True)

    paper = matte("Paper", (0.76, 0.7, 0.58))
    cover, pages = book((0.13, 0.19, 0.03))
    cover, pages = (part.turned(np.radians(-63.0)).moved((0.1, 0.42, 0.015)) for part in (cover, pages))
    pushed = slide_to_contact(cover, (-0.25, -1.0, 0.0), body_radius, center, GAP)
    offset = pushed.positions[0] - cover.positions[0]
    _add_world_shape("Book cover", pushed, matte("Green cloth", (0.05, 0.16, 0.11)))
    _add_world_shape("Book pages", pages.moved(offset), paper)
    under = pages.moved(offset).positions.mean(0)
    top = np.array([under[0] + 0.008, under[1] + 0.004, 0.0412])
    cover, pages = (part.turned(np.radians(-52.0)).moved(top) for part in book((0.115, 0.17, 0.022)))
    _add_world_shape("Upper book cover", cover, matte("Ocher cloth", (0.5, 0.24, 0.05)))
    _add_world_shape("Upper book pages", pages, paper)


def jar_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of the jar's surface from its middle along unit directions (n, 3), meters."""
    x, y, z = directions.T
    outline = (((x * x + y * y) / 0.05**2) ** 1.3 + (z * z / JAR_HEIGHT**2) ** 1.3) ** (-1.0 / 2.6)
    polar = np.arctan2(np.hypot(x, y), z)
    lid = np.exp(-(((polar - np.radians(38.0)) / np.radians(5.0)) ** 2))
    return outline * (1.0 - 0.1 * z + 0.1 * z**3 - 0.05 * lid)


def add_jar(place: tuple[float, float]) -> bpy.types.Object:
    """A red jar under a clear coat, closed and star-shaped: the second mirror. Its knob is matte."""
    shape = star_shape(jar_radius, 32)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    at = (*place, JAR_HEIGHT)
    red = lacquer("Red lacquer", (0.36, 0.014, 0.012))
    jar = add_object(JAR, shape, red, smooth=True, location=at, normals=star_normals(jar_radius, directions))
    knob = turned_profile([(0.006, 0.0), (0.005, 0.005), (0.0105, 0.011), (0.0105, 0.016), (0.0, 0.02)], 20)
    top = float(jar_radius(np.array([[0.0, 0.0, 1.0]]))[0]) - 0.0002
    ocher = matte("Ocher paint", (0.5, 0.27, 0.06))
    add_object("Jar knob", knob, ocher, smooth=True, location=(at[0], at[1], at[2] + top))
    return jar


def add_carafe(place: tuple[float, float]) -> None:
    """A carafe of solid glass."""
    clear = glass("Glass")
    outside = [(0.03, 0.0), (0.049, 0.004), (0.055, 0.03), (0.05, 0.075), (0.032, 0.125), (0.022, 0.16)]
    outside += [(0.021, 0.185), (0.03, 0.222)]
    inside = [(0.0275, 0.222), (0.0185, 0.185), (0.0195, 0.16), (0.029, 0.125), (0.047, 0.075), (0.052, 0.03)]
    carafe = [(0.0, 0.0), *outside, *inside, (0.044, 0.009), (0.0, 0.008)]
    shape = turned_profile(smoothed(carafe, 4), 48)
    thing: Any = add_object("Carafe", shape, clear, smooth=True, location=(*place, 0.0005))
    # No render without caustics knows that light comes through it: rather no shadow than one as of a black carafe.
    thing.visible_shadow = thing.visible_diffuse = False


def smoothed(profile: list[tuple[float, float]], times: int) -> list[tuple[float, float]]:
    """A profile with `times` points for each of its stretches, on a curve through its points (Catmull and Rom's)."""
    points = np.array(profile, float)
    ends = np.vstack([2.0 * points[0] - points[1], points, 2.0 * points[-1] - points[-2]])
    found = [points[:1]]
    for index in range(len(points) - 1):
        a, b, c, d = ends[index : index + 4]
        t = np.linspace(0.0, 1.0, times + 1)[1:, None]
        found.append(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))))
    curve = np.concatenate(found)
    # (Curves go a little past their points: not through the axis, and not below what they stand on.)
    curve = np.maximum(curve, [0.0, points[:, 1].min()])
    return [(float(radius), float(height)) for radius, height in curve]


def _add_fruit(place: tuple[float, float]) -> None:
    """A bowl of earthenware with oranges and a lemon."""
    x, y = place
    profile = [(0.0, 0.0), (0.04, 0.0), (0.042, 0.006), (0.07, 0.022), (0.092, 0.05), (0.098, 0.066), (0.095, 0.067)]
    profile += [(0.088, 0.052), (0.066, 0.028), (0.035, 0.014), (0.0, 0.012)]
    profile = [(0.86 * radius, 0.86 * height) for radius, height in profile]
    clay = matte("Earthenware", (0.55, 0.5, 0.41), roughness=0.7)
    add_object("Bowl", turned_profile(smoothed(profile, 3), 40), clay, smooth=True, location=(x, y, 0.0))
    orange = matte("Orange", (0.75, 0.24, 0.02), roughness=0.6)
    yellow = matte("Lemon peel", (0.8, 0.56, 0.05), roughness=0.6)
    places = ((-0.029, -0.019, 0.048), (0.031, -0.017, 0.048), (0.003, 0.036, 0.048), (0.002, -0.001, 0.085))
    for number, (dx, dy, z) in enumerate(places, 1):
        add_object(f"Orange {number}", ball(0.029, 24), orange, smooth=True, location=(x + dx, y + dy, z))
    lemon = Shape(ball(0.025, 20).positions * [1.0, 1.0, 1.35], ball(0.025, 20).polygons)
    add_object(
        "Yellow fruit", lemon, yellow, smooth=True, location=(x + 0.047, y + 0.031, 0.058), rotation=(1.2, 0, 0.6)
    )


def _add_picture() -> None:
    """A landscape in a frame on the wall."""
    x, z, width, height = -0.27, 0.38, 0.228, 0.171
    y, edge = BACK - 0.001, 0.014
    outer, inner = (0.5 * width + edge, 0.5 * height + edge), (0.5 * width, 0.5 * height)
    frame = joined(
        block((x - outer[0], y - 0.02, z - outer[1]), (x + outer[0], y, z - inner[1])),
        block((x - outer[0], y - 0.02, z + inner[1]), (x + outer[0], y, z + outer[1])),
        block((x - outer[0], y - 0.02, z - inner[1]), (x - inner[0], y, z + inner[1])),
        block((x + inner[0], y - 0.02, z - inner[1]), (x + outer[0], y, z + inner[1])),
    )
    add_object("Picture frame", frame, matte("Dark frame", (0.05, 0.03, 0.02)))
    print_ = matte("Print", pixels=paint.landscape(512, 384))
    sheet = plane((width, height)).turned(np.pi / 2, 0)
    add_object("Picture", sheet, print_, location=(x, y - 0.008, z))


def add_suzanne(location: tuple[float, float, float], size: float, toward: Float64Array) -> bpy.types.Object:
    """Blender's monkey, subdivided once, her nose turned to the point `toward` about the upright axis."""
    mesh = bpy.data.meshes.new("Suzanne")
    sculpt = bmesh.new()
    bmesh.ops.create_monkey(sculpt, matrix=Matrix.Scale(size, 4), calc_uvs=False)
    for face in sculpt.faces:
        face.smooth = True
    sculpt.to_mesh(mesh)
    sculpt.free()
    mesh.materials.append(principled("Suzanne", (0.05, 0.32, 0.52), roughness=0.38))
    suzanne = bpy.data.objects.new("Suzanne", mesh)
    subdivision: Any = suzanne.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = 1
    suzanne.location = location
    way = Vector(toward.tolist()) - Vector(location)
    way.z = 0.0
    suzanne.rotation_euler = (0.0, 0.0, way.to_2d().angle_signed(Vector((0.0, -1.0))))
    scene = bpy.context.scene
    assert scene is not None
    scene.collection.objects.link(suzanne)
    return suzanne


def _add_world_shape(name: str, shape: Shape, material: bpy.types.Material, smooth: bool = False) -> None:
    """A shape placed in world space, its origin put at the middle of its vertices."""
    middle = shape.positions.mean(0)
    add_object(name, shape.moved(-middle), material, smooth, location=middle.tolist())


def book(size: tuple[float, float, float]) -> tuple[Shape, Shape]:
    """(cover, pages) of a closed book lying flat, centered at the origin, its back on the +X side."""
    width, depth, height = size
    board = 0.0028
    cover = joined(
        box((width, depth, board)).moved((0.0, 0.0, 0.5 * (height - board))),
        box((width, depth, board)).moved((0.0, 0.0, -0.5 * (height - board))),
        box((board, depth, height - 2.0 * board)).moved((0.5 * (width - board), 0.0, 0.0)),
    )
    pages = box((width - board - 0.008, depth - 0.01, height - 2.0 * board)).moved((0.004 - 0.5 * board, 0.0, 0.0))
    return cover, pages
