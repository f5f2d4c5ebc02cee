# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A room with chairs about a table, and a ball of chrome that rolls between them: it shows the chairs' far sides.

Lengths in meters, the floor at height 0.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import Color, add_object, add_sun, looking, mirror, set_world_color
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import (
    Shape,
    block,
    cube_sphere_directions,
    joined,
    plane,
    projected,
    surface,
    tube,
    turned_profile,
)
from curvrefl.curvrefl_addon.demo.table import smoothed
from curvrefl.curvrefl_addon.scene.arrays import Float64Array
from mathutils import Matrix

from .stage import fly, mark, move, placed, start, through

BALL = "Ball"
RADIUS = 0.3
LEFT, RIGHT, FRONT, BACK, CEILING = -2.6, 2.6, -3.2, 2.4, 2.7
CHAIRS: tuple[tuple[float, float, float, Color], ...] = (
    (-0.75, 0.95, 0.0, (0.5, 0.07, 0.05)),
    (0.75, 0.95, 0.12, (0.62, 0.4, 0.06)),
    (-1.75, 0.3, 1.62, (0.08, 0.27, 0.3)),
    (1.75, 0.3, -1.55, (0.5, 0.07, 0.05)),
    (-1.35, -1.15, 2.5, (0.62, 0.4, 0.06)),
    (1.2, -1.25, 3.75, (0.08, 0.27, 0.3)),
)
"""Place, heading and color of the seat of each"""


def build() -> None:
    """Replace the open file by the film."""
    start()
    _add_room()
    _add_table()
    wood = matte("Chair wood", pixels=paint.planks(256, 256, 2, seed=14, colors=((0.55, 0.36, 0.2), (0.33, 0.2, 0.1))))
    for number, (x, y, heading, color) in enumerate(CHAIRS, 1):
        frame, cushion = chair()
        turn = (0.0, 0.0, heading)
        add_object(f"Chair {number}", frame, wood, location=(x, y, 0.0), rotation=turn)
        cloth = matte(f"Seat {number}", color, roughness=0.95)
        add_object(f"Seat {number}", cushion, cloth, smooth=True, location=(x, y, 0.0), rotation=turn)
    mark(_add_ball())
    _add_light()
    eye = through((0.5, -3.0, 1.25), (0.2, -2.75, 1.0), (-0.1, -2.5, 0.85), (-0.35, -2.1, 0.75))
    target = through((-0.5, -0.6, 0.4), (-0.2, -0.4, 0.38), (0.2, -0.4, 0.36), (0.5, -0.6, 0.36))
    fly(eye, target, lens=30.0)


def chair() -> tuple[Shape, Shape]:
    """(frame, cushion) of a chair with a ladder of a back, which is on its +Y side."""
    parts = []
    for x in (-0.2, 0.2):
        path = np.array([[x, 0.2, 0.0], [x, 0.19, 0.45], [x, 0.24, 0.75], [x * 0.97, 0.3, 1.02]])
        parts.append(tube(path, [0.017, 0.022, 0.02, 0.015], 10, side=(1.0, 0.0, 0.0)))
        parts.append(tube(np.array([[x, -0.2, 0.0], [x, -0.2, 0.44]]), [0.016, 0.021], 10, side=(1.0, 0.0, 0.0)))
        rail = np.array([[x, -0.2, 0.2], [x, 0.2, 0.2]])
        parts.append(tube(rail, [0.011, 0.011], 8, side=(1.0, 0.0, 0.0)))
    parts.append(tube(np.array([[-0.2, -0.2, 0.24], [0.2, -0.2, 0.24]]), [0.011, 0.011], 8, side=(0.0, 1.0, 0.0)))
    for height in (0.58, 0.73, 0.88):
        t = np.linspace(-1.0, 1.0, 13)
        y = np.interp(height, [0.45, 0.75, 1.02], [0.19, 0.24, 0.3]) + 0.03 * (1.0 - t * t)
        slat = np.stack([np.column_stack([0.19 * t, y + 0.25 * d, np.full(13, height + d)]) for d in (0.0, 0.07)])
        thick = np.stack([slat[0], slat[1], slat[1] + [0, 0.012, 0], slat[0] + [0, 0.012, 0], slat[0]])
        parts.append(Shape(surface(thick).positions, surface(thick).polygons))
    seat = block((-0.225, -0.225, 0.435), (0.225, 0.215, 0.46), bevel=0.006)
    frame = projected(joined(*parts, seat), 0.5)
    directions, quads = cube_sphere_directions(10)
    x, y, z = directions.T
    sizes = (np.abs(x) ** 5 + np.abs(y) ** 5 + np.abs(z) ** 5) ** (-0.2)
    return frame, Shape(directions * sizes[:, None] * [0.21, 0.2, 0.028] + [0.0, -0.005, 0.488], quads)


def _add_table() -> None:
    oak = paint.planks(512, 512, 6, seed=6, colors=((0.72, 0.54, 0.36), (0.5, 0.33, 0.2)))
    wood = matte("Table", pixels=oak, roughness=0.7)
    rim = smoothed([(0.0, 0.7), (0.6, 0.7), (0.66, 0.715), (0.66, 0.735), (0.64, 0.74), (0.0, 0.74)], 2)
    add_object("Table", projected(turned_profile(rim, 64), 0.9), wood, location=(0.0, 0.6, 0.0))
    foot = [(0.0, 0.0), (0.3, 0.0), (0.3, 0.03), (0.09, 0.08), (0.06, 0.2), (0.1, 0.38), (0.05, 0.5), (0.14, 0.69)]
    add_object("Table's foot", turned_profile(smoothed(foot, 3), 32), wood, smooth=True, location=(0.0, 0.6, 0.0))
    vase = smoothed([(0.0, 0.0), (0.05, 0.0), (0.09, 0.08), (0.07, 0.16), (0.035, 0.21), (0.05, 0.25), (0.04, 0.25)], 3)
    blue = matte("Vase", (0.06, 0.16, 0.36), roughness=0.5)
    add_object("Vase", turned_profile(vase, 36), blue, smooth=True, location=(0.1, 0.65, 0.741))
    rng = np.random.default_rng(8)
    stems, heads = [], []
    for index in range(7):
        angle = 2.4 * index
        tip = np.array([0.1 * np.cos(angle), 0.1 * np.sin(angle), rng.uniform(0.4, 0.52)])
        path = np.array([[0.0, 0.0, 0.1], 0.35 * tip + [0.0, 0.0, 0.17], tip])
        stems.append(tube(path, [0.004, 0.004, 0.003], 6, side=(np.sin(angle), -np.cos(angle), 0.1)))
        bloom = turned_profile(smoothed([(0.0, 0.0), (0.03, 0.02), (0.045, 0.045), (0.02, 0.05), (0.0, 0.04)], 2), 16)
        heads.append(bloom.moved(tip - [0.0, 0.0, 0.01]))
    where = (0.1, 0.65, 0.741)
    add_object("Stems", joined(*stems), matte("Stem", (0.08, 0.22, 0.05)), smooth=True, location=where)
    add_object("Flowers", joined(*heads), matte("Flower", (0.75, 0.2, 0.06)), smooth=True, location=where)


def _add_ball() -> bpy.types.Object:
    """The mirror, on its way in a bow between the chairs."""
    directions, quads = cube_sphere_directions(40)
    chrome = mirror("Chrome")
    thing = add_object(BALL, Shape(RADIUS * directions, quads), chrome, smooth=True, normals=directions)
    way = through((-0.85, -0.75, RADIUS), (-0.35, -0.4, RADIUS), (0.3, -0.35, RADIUS), (0.72, -0.75, RADIUS))

    def pose(t: float) -> Float64Array:
        place = way(t)
        # (It rolls: so far as it has come, about the axis across its way.)
        turned = placed(place, 0.0)
        angle = (place[0] - way(0.0)[0]) / RADIUS
        turned[:3, :3] = np.array(Matrix.Rotation(angle, 3, "Y"))
        return turned

    move(thing, pose)
    return thing


def _add_room() -> None:
    boards = paint.planks(1024, 1024, 8, seed=4, colors=((0.6, 0.44, 0.28), (0.4, 0.26, 0.15)))
    middle = (0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), 0.0)
    floor = plane((RIGHT - LEFT, BACK - FRONT), (10, 10), tile=1.4)
    add_object("Floor", floor, matte("Boards", pixels=boards), location=middle)
    green = matte("Green plaster", pixels=paint.plaster(512, (0.47, 0.57, 0.48)), roughness=0.9)
    white = matte("White plaster", pixels=paint.plaster(512, (0.87, 0.84, 0.78), seed=3), roughness=0.9)
    thick = 0.15
    back = projected(block((LEFT, BACK, 0.0), (RIGHT, BACK + thick, CEILING)), 1.5)
    add_object("Back wall", back, green)
    right = projected(block((RIGHT, FRONT, 0.0), (RIGHT + thick, BACK, CEILING)), 1.5)
    add_object("Right wall", right, white)
    front = projected(block((LEFT, FRONT - thick, 0.0), (RIGHT, FRONT, CEILING)), 1.5)
    add_object("Front wall", front, green)
    add_object("Ceiling", block((LEFT, FRONT, CEILING), (RIGHT, BACK, CEILING + thick)), white)
    paint_white = matte("White paint", (0.8, 0.78, 0.73), roughness=0.7)
    parts, bars, start_y = [], [], FRONT
    for y0, y1 in ((-2.4, -1.0), (-0.1, 1.3)):
        z0, z1 = 0.6, 2.25
        parts.append(block((LEFT - thick, start_y, 0.0), (LEFT, y0, CEILING)))
        parts.append(block((LEFT - thick, y0, 0.0), (LEFT, y1, z0)))
        parts.append(block((LEFT - thick, y0, z1), (LEFT, y1, CEILING)))
        start_y = y1
        far, near = LEFT - 0.1, LEFT - 0.05
        bars += [block((far, y, z0), (near, y + 0.05, z1)) for y in np.linspace(y0, y1 - 0.05, 3)]
        bars += [block((far, y0, z), (near, y1, z + 0.05)) for z in np.linspace(z0, z1 - 0.05, 4)]
    parts.append(block((LEFT - thick, start_y, 0.0), (LEFT, BACK, CEILING)))
    add_object("Window wall", projected(joined(*parts), 1.5), white)
    add_object("Window frames", joined(*bars), paint_white)
    rug = matte("Rug", pixels=paint.rug(384, 576), roughness=0.95)
    add_object("Rug", plane((2.0, 2.9), (6, 8)), rug, location=(0.0, -0.2, 0.008), rotation=(0.0, 0.0, 1.5708))
    skirting = [
        block((LEFT, BACK - 0.02, 0.0), (RIGHT, BACK, 0.1)),
        block((RIGHT - 0.02, FRONT, 0.0), (RIGHT, BACK, 0.1)),
        block((LEFT, FRONT, 0.0), (RIGHT, FRONT + 0.02, 0.1)),
        block((LEFT, FRONT, 0.0), (LEFT + 0.02, BACK, 0.1)),
    ]
    add_object("Skirting", joined(*skirting), paint_white)
    dark = matte("Frame", (0.07, 0.045, 0.03))
    for number, (x, wide) in enumerate(((-1.3, 1.0), (1.1, 1.3)), 1):
        picture = plane((wide, 0.66 * wide)).turned(np.pi / 2, 0)
        shown = matte(f"Print {number}", pixels=paint.landscape(384, 256))
        add_object(f"Print {number}", picture, shown, location=(x, BACK - 0.026, 1.65))
        half, tall = 0.5 * wide + 0.03, 0.33 * wide + 0.03
        board = block((x - half, BACK - 0.025, 1.65 - tall), (x + half, BACK, 1.65 + tall))
        add_object(f"Frame {number}", board, dark)
    # Behind the camera, where only the ball shows them
    add_object("Door", block((0.7, FRONT, 0.0), (1.6, FRONT + 0.04, 2.1), bevel=0.01), paint_white)
    red = matte("Cupboard", (0.45, 0.08, 0.05), roughness=0.6)
    cupboard = [block((-1.7, FRONT, 0.1), (-0.3, FRONT + 0.42, 0.9), bevel=0.01)]
    cupboard += [block((x, FRONT + 0.42, 0.14), (x + 0.64, FRONT + 0.44, 0.86), bevel=0.008) for x in (-1.67, -0.97)]
    add_object("Cupboard", joined(*cupboard), red)


def _add_light() -> None:
    """The sky in the windows, a sun, and a wide lamp under the ceiling."""
    set_world_color((0.8, 0.95, 1.2))
    add_sun((-0.8, -0.25, 0.5), 3.0, (1.0, 0.88, 0.7), angle=np.radians(1.5))
    lamp: Any = bpy.data.lights.new("Ceiling lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y, lamp.energy, lamp.color = "RECTANGLE", 2.6, 2.6, 170.0, (1.0, 0.91, 0.79)
    thing: Any = bpy.data.objects.new("Ceiling lamp", lamp)
    thing.matrix_world = Matrix(looking((0.0, -0.3, CEILING - 0.01), (0.0, -0.3, 0.0)).tolist())
    bpy.context.scene.collection.objects.link(thing)
