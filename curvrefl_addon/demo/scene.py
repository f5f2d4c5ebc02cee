# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The demo: a chrome kettle on a wooden table, Suzanne looking into it, and things that only the mirror sees.

The body of the kettle is star-shaped by construction: it is given as a distance in every direction from
`BODY_CENTER`. It is convex too, so that no point has two reflections in it. Book, ball, block, table and the
kettle's own enamelled parts touch it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..scene.arrays import Float64Array
from ..written_files import error_in
from . import paint
from .data_blocks import (
    add_camera,
    add_object,
    add_sun,
    mirror,
    packed_image,
    principled,
    set_world_image,
    start_empty_scene,
    studio_light,
)
from .shapes import (
    Shape,
    ball,
    box,
    joined,
    plane,
    slide_to_contact,
    star_level,
    star_normals,
    star_shape,
    tube,
    turned_profile,
)

KETTLE = "Kettle"
"""Name of the reflector"""

BODY_WIDTH = 0.22
"""Meters, before the flutes"""
BODY_CENTER = (0.0, 0.0, 0.092)
"""Meters, in the world: the center that the body is star-shaped about"""
GAP = 2e-4
"""Meters between the kettle and what touches it: 0.002 of its radius, so that nothing pokes into the mirror"""


def body_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of the kettle's body from `BODY_CENTER` along unit directions (n, 3).

    A squarish ellipsoid (u^4 + v^4 + u^2 v^2 = 1), a little wider below than above, with eight flutes so soft that
    it stays convex (the real part of (x + iy)^8, which is smooth at the poles). Its lowest point is on the table.
    """
    x, y, z = directions.T
    u2 = (x * x + y * y) / (0.5 * BODY_WIDTH) ** 2
    v2 = (z / 0.092) ** 2
    outline = (u2 * u2 + v2 * v2 + u2 * v2) ** -0.25
    flutes = ((x + 1j * y) ** 8).real
    return outline * (1.0 - 0.09 * z + 0.09 * z**3 + 0.0055 * flutes)


def build_demo(path: Path) -> None:
    """Replace the open file by the demo scene and save it as the .blend `path`, whose folder must exist.

    Raises OSError when the file cannot be written.
    """
    start_empty_scene()
    body = add_kettle()
    add_table()
    add_toys(body)
    add_unseen_things()
    set_world_image(studio_light("forest.exr"), turn=np.radians(8.0), strength=0.55)
    add_sun(toward=(-0.55, -0.55, 0.8), strength=2.7, color=(1.0, 0.95, 0.87), angle=np.radians(2.0))
    add_camera(eye=(0.03, -0.72, 0.30), target=(0.004, 0.0, 0.0905), lens=67.5)
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    except RuntimeError as error:
        raise error_in(str(error), path) from error


def add_kettle() -> bpy.types.Object:
    """The mirror body and its spout, lid knob and handle, which are not mirrors."""
    shape = star_shape(body_radius, cells=40)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    body = add_object(
        KETTLE,
        shape,
        mirror("Chrome"),
        smooth=True,
        location=BODY_CENTER,
        normals=star_normals(body_radius, directions),
    )
    enamel = principled("Cherry enamel", (0.55, 0.018, 0.03), roughness=0.22)
    black = principled("Black handle", (0.018, 0.018, 0.022), roughness=0.35)
    add_object("Spout", _spout(), enamel, smooth=True, location=BODY_CENTER)
    add_object("Lid knob", _knob(), enamel, smooth=True, location=BODY_CENTER)
    add_object("Handle", _handle(), black, smooth=True, location=BODY_CENTER)
    return body


def _landed(points: Float64Array, way: Float64Array) -> Float64Array:
    """Points (n, 3), relative to the center, moved along `way` until `GAP` short of the body (they may start in it)."""
    near, far = points - 0.2 * way, points.copy()
    far -= way * ((far @ way)[:, None])
    for _ in range(50):
        middle = 0.5 * (near + far)
        inside = (star_level(body_radius, middle) < GAP)[:, None]
        near, far = np.where(inside, near, middle), np.where(inside, middle, far)
    return near


def _spout() -> Shape:
    """A curved spout whose first ring lies on the body; its mouth is hollow."""
    t = np.linspace(0.0, 1.0, 7)[:, None]
    start, bend, end = np.array([[0.098, 0, 0.018], [0.137, 0, 0.028], [0.143, 0, 0.075]])
    path = (1 - t) ** 2 * start + 2 * t * (1 - t) * bend + t**2 * end
    radii = np.interp(t[:, 0], [0.0, 0.5, 1.0], [0.0215, 0.016, 0.0125])
    segments = 16
    outside = tube(path, radii, segments, side=(0.0, 1.0, 0.0), capped=False)
    positions = outside.positions.copy()
    positions[:segments] = _landed(positions[:segments], (start - bend) / np.linalg.norm(start - bend))
    rim = positions[-segments:]
    inner = path[-1] + 0.78 * (rim - path[-1])
    deep = inner + 0.9 * (path[-2] - path[-1])
    count = len(positions)
    polygons = list(outside.polygons)
    for ring in range(2):
        for i in range(segments):
            a = count - segments + ring * segments + i
            b = count - segments + ring * segments + (i + 1) % segments
            polygons.append((a, b, b + segments, a + segments))
    polygons.append(tuple(range(count + segments, count + 2 * segments)))
    return Shape(np.concatenate([positions, inner, deep]), tuple(polygons))


def _knob() -> Shape:
    """A turned knob standing on the top of the body."""
    profile = [(0.0135, 0.0), (0.011, 0.003), (0.0085, 0.007), (0.0105, 0.0105), (0.0145, 0.0155)]
    profile += [(0.0145, 0.021), (0.011, 0.0255), (0.006, 0.028), (0.0, 0.0285)]
    top = float(body_radius(np.array([[0.0, 0.0, 1.0]]))[0])
    knob = turned_profile(profile, 20).moved((0.0, 0.0, top))
    positions = knob.positions.copy()
    positions[:20] = _landed(positions[:20], np.array([0.0, 0.0, -1.0]))
    return Shape(positions, knob.polygons)


def _handle() -> Shape:
    """An arch over the lid from shoulder to shoulder, thicker in the middle."""
    count, segments = 17, 10
    angle = np.linspace(np.pi, 0.0, count)
    across, up = np.cos(angle), np.sin(angle)
    path = np.column_stack([0.076 * np.sign(across) * np.abs(across) ** 0.7, np.zeros(count), 0.07 + 0.064 * up**0.75])
    radii = np.interp(np.abs(across), [0.0, 0.62, 0.8, 1.0], [0.0085, 0.008, 0.005, 0.005])
    arch = tube(path, radii, segments, side=(0.0, 1.0, 0.0), capped=False)
    positions = arch.positions.copy()
    for ring in (slice(0, segments), slice(len(positions) - segments, None)):
        positions[ring] = _landed(positions[ring], np.array([0.0, 0.0, -1.0]))
    return Shape(positions, arch.polygons)


def add_table() -> bpy.types.Object:
    """A plank table top, ten times the kettle's radius to each side, at height 0."""
    planks = packed_image("Planks", paint.planks(1024, 1024, 9))
    wood = principled("Oak planks", (0.5, 0.33, 0.19), roughness=0.55, image=planks)
    return add_object("Table", plane((2.4, 2.4), (8, 8), tile=0.75), wood)


def add_toys(body: bpy.types.Object) -> None:
    """What the camera sees: Suzanne facing the mirror, and a book, a block and a ball that touch it."""
    center = np.array(BODY_CENTER)
    add_suzanne((-0.0965, -0.146, 0.0345), size=0.035, toward=np.array(body.location))

    red = principled("Red block", (0.62, 0.045, 0.03), roughness=0.4)
    yellow = principled("Yellow block", (0.8, 0.5, 0.03), roughness=0.4)
    blue = principled("Blue block", (0.03, 0.13, 0.5), roughness=0.4)
    block = box((0.045, 0.045, 0.045), bevel=0.0027)

    lower = block.turned(np.radians(28.0)).moved((0.26, -0.155, 0.0225))
    lower = slide_to_contact(lower, (-1.0, 0.49, 0.0), body_radius, center, GAP)
    middle = lower.positions.mean(0)
    _add_world_shape("Block 1", lower, yellow)
    add_object("Block 2", block, blue, location=(middle[0] + 0.050, middle[1] + 0.012, 0.0225), rotation=(0, 0, 0.15))
    add_object("Block 3", block, red, location=(middle[0] + 0.028, middle[1] + 0.006, 0.0677), rotation=(0, 0, 0.7))

    stripes = [(0.82, 0.12, 0.10), (0.95, 0.93, 0.88), (0.12, 0.33, 0.72), (0.95, 0.93, 0.88), (0.96, 0.75, 0.12)]
    stripes += [(0.95, 0.93, 0.88)]
    rubber = principled(
        "Striped rubber", roughness=0.35, image=packed_image("Stripes", paint.segments(384, 64, stripes))
    )
    sphere = ball(0.034, 24).turned(0.5, 0).turned(0.9, 1).moved((0.09, -0.3, 0.034))
    sphere = slide_to_contact(sphere, (-0.33, 1.0, 0.0), body_radius, center, GAP)
    _add_world_shape("Ball", sphere, rubber, smooth=True)

    cover, pages = _book((0.15, 0.21, 0.034))
    cover, pages = (part.turned(np.radians(24.0)).moved((-0.34, 0.12, 0.017)) for part in (cover, pages))
    pushed = slide_to_contact(cover, (1.0, -0.25, 0.0), body_radius, center, GAP)
    offset = pushed.positions[0] - cover.positions[0]
    _add_world_shape("Book cover", pushed, principled("Green cloth", (0.03, 0.2, 0.11), roughness=0.6))
    _add_world_shape("Book pages", pages.moved(offset), principled("Paper", (0.82, 0.77, 0.65), roughness=0.8))


def add_unseen_things() -> None:
    """What only the mirror shows: a pencil, a mug, a lemon and a tower of blocks, out of the picture all round."""
    mug = principled("Turquoise mug", (0.02, 0.36, 0.38), roughness=0.25)
    add_object("Mug", _mug(), mug, smooth=True, location=(0.33, -0.42, 0.0), rotation=(0.0, 0.0, 0.6))
    colors = [(0.6, 0.05, 0.04), (0.82, 0.55, 0.04), (0.05, 0.32, 0.1), (0.04, 0.12, 0.5)]
    for level, color in enumerate(colors):
        add_object(
            f"Tower {level + 1}",
            box((0.06, 0.06, 0.06)),
            principled(f"Tower {level + 1}", color, roughness=0.4),
            location=(-0.36, -0.42, 0.03 + 0.0601 * level),
            rotation=(0.0, 0.0, 0.35 * level),
        )
    lemon = principled("Lemon", (0.85, 0.66, 0.03), roughness=0.4)
    add_object("Lemon", ball(0.035, 16), lemon, smooth=True, location=(0.10, -0.52, 0.035))
    wood = principled("Pencil", (0.85, 0.33, 0.02), roughness=0.35)
    tip = principled("Pencil tip", (0.76, 0.55, 0.34), roughness=0.6)
    shaft, point = _pencil()
    for name, part, material in (("Pencil", shaft, wood), ("Pencil tip", point, tip)):
        add_object(name, part, material, location=(-0.028, -0.195, 0.003465), rotation=(0.0, 0.0, np.radians(-14.0)))


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


def _book(size: tuple[float, float, float]) -> tuple[Shape, Shape]:
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


def _pencil() -> tuple[Shape, Shape]:
    """(shaft, sharpened end) of a six-sided pencil along X, its axis through the origin."""
    shaft = turned_profile([(0.0, -0.07), (0.004, -0.07), (0.004, 0.052)], 6)
    point = turned_profile([(0.004, 0.052), (0.0, 0.07)], 6)
    shaft, point = (part.turned(np.pi / 2, 1).turned(np.pi / 6, 0) for part in (shaft, point))  # a flat side down
    return shaft, point


def _mug() -> Shape:
    """A mug with a handle, standing on height 0."""
    profile = [(0.0, 0.0), (0.036, 0.0), (0.04, 0.004), (0.042, 0.095), (0.0395, 0.0965), (0.037, 0.094)]
    cup = turned_profile([*profile, (0.035, 0.012), (0.0, 0.010)], 20)
    angle = np.radians(np.linspace(-78.0, 78.0, 9))
    path = np.column_stack([0.039 + 0.028 * np.cos(angle), np.zeros(9), 0.05 + 0.03 * np.sin(angle)])
    return joined(cup, tube(path, np.full(9, 0.005), 6, side=(0.0, 1.0, 0.0)))
