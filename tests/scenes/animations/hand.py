# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand that comes to the demo's kettle, strokes it with its fingertips and goes: hand and reflection touch.

Heights are over the table that the kettle stands on; meters.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, looking
from curvrefl.curvrefl_addon.demo.kettle import BODY_CENTER, GAP, add_kettle, body_radius
from curvrefl.curvrefl_addon.demo.lights import add_lights
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.room import add_outside, add_room
from curvrefl.curvrefl_addon.demo.shapes import Shape, rotation, star_level, turned_profile
from curvrefl.curvrefl_addon.demo.table import add_table, smoothed
from curvrefl.curvrefl_addon.scene.arrays import Float64Array
from mathutils import Matrix

from .hand_shape import CHAINS, hand_shape, weights
from .stage import eased, fly, mark, moments, start, through

KETTLE_AT = np.array(BODY_CENTER)
TOUCHES = (0.4, 0.7)
"""Moments between which the fingers stay on the kettle"""
AWAY = 0.13
"""How far off it the hand is at the start and at the end"""


def build() -> None:
    """Replace the open file by the film."""
    start()
    add_room()
    add_outside()
    add_table()
    kettle = add_kettle()
    add_lights()
    _add_lamp()
    _animate(_add_hand())
    mark(kettle)
    eye = through((0.42, -0.56, 0.27), (0.38, -0.57, 0.25), (0.33, -0.56, 0.24))
    target = through((-0.01, -0.05, 0.1), (-0.015, -0.06, 0.1), (-0.01, -0.05, 0.1))
    fly(eye, target, lens=33.0)


def _add_lamp() -> None:
    """A wide one behind the camera: of the room's other lights little gets to the side of the kettle that it sees."""
    lamp: Any = bpy.data.lights.new("Softbox", "AREA")
    lamp.shape, lamp.size, lamp.size_y, lamp.energy, lamp.color = "RECTANGLE", 1.4, 1.0, 28.0, (1.0, 0.9, 0.78)
    thing: Any = bpy.data.objects.new("Softbox", lamp)
    thing.matrix_world = Matrix(looking((0.9, -1.6, 1.3), KETTLE_AT).tolist())
    scene: Any = bpy.context.scene
    scene.collection.objects.link(thing)


def _add_hand() -> bpy.types.Object:
    """The skeleton, which carries skin and sleeve. Its matrix is the hand's: see `hand_shape`."""
    bones: Any = bpy.data.armatures.new("Bones")
    skeleton = bpy.data.objects.new("Skeleton", bones)
    scene: Any = bpy.context.scene
    scene.collection.objects.link(skeleton)
    bpy.context.view_layer.objects.active = skeleton
    bpy.ops.object.mode_set(mode="EDIT")
    # The arm carries the palm, and the palm the fingers.
    for chain in sorted(CHAINS, key=lambda chain: chain.bones[0] != "arm"):
        for index, name in enumerate(chain.bones):
            if name in bones.edit_bones:
                continue
            bone = bones.edit_bones.new(name)
            bone.head, bone.tail = chain.joints[index].tolist(), chain.joints[index + 1].tolist()
            bone.align_roll((0.0, 0.0, 1.0))
            if index > 0:
                bone.parent = bones.edit_bones[chain.bones[index - 1]]
    bpy.ops.object.mode_set(mode="OBJECT")
    shape = hand_shape()
    skin = add_object("Hand", shape, matte("Skin", (0.64, 0.37, 0.27), roughness=0.6), smooth=True)
    _carry(skin, skeleton, weights(shape.positions))
    cuff = smoothed(
        [(0.034, -0.05), (0.037, -0.055), (0.039, -0.1), (0.045, -0.17), (0.05, -0.42), (0.0, -0.43)][::-1], 3
    )
    sleeve: Shape = turned_profile(cuff, 32).turned(0.5 * np.pi, 1)
    cloth = add_object("Sleeve", sleeve, matte("Sleeve", (0.05, 0.11, 0.22), roughness=0.95), smooth=True)
    _carry(cloth, skeleton, {"arm": np.ones(len(sleeve.positions))})
    return skeleton


def _carry(thing: bpy.types.Object, skeleton: bpy.types.Object, shares: dict[str, Float64Array]) -> None:
    """Have bones carry a mesh, by their share (n,) of each vertex."""
    for bone, share in shares.items():
        group = thing.vertex_groups.new(name=bone)
        for vertex in np.flatnonzero(share > 0.0).tolist():
            group.add([vertex], float(share[vertex]), "REPLACE")
    modifier: Any = thing.modifiers.new("Skeleton", "ARMATURE")
    modifier.object = skeleton
    thing.parent = skeleton


def _animate(skeleton: bpy.types.Object) -> None:
    """Keys for bones and hand in each frame. Where it touches, it is so near that no part of it is in the kettle."""
    skin = bpy.data.objects["Hand"]
    skeleton.rotation_mode = "QUATERNION"
    for frame, moment in moments():
        for name, curl in _curls(moment).items():
            bone = skeleton.pose.bones[name]
            bone.rotation_mode = "XYZ"
            bone.rotation_euler = (-curl, 0.0, 0.0)
            bone.keyframe_insert("rotation_euler", index=0, frame=frame)
        turn, place, way = _held(moment)
        skeleton.matrix_world = Matrix.Identity(4)
        bpy.context.view_layer.update()
        evaluated = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
        points = np.array([vertex.co for vertex in evaluated.data.vertices]) @ turn.T
        off = _way_to_kettle(points + place - KETTLE_AT, way) - GAP - AWAY * _lifted(moment)
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = turn, place + off * way
        skeleton.location, skeleton.rotation_quaternion, _ = Matrix(matrix.tolist()).decompose()
        skeleton.keyframe_insert("location", frame=frame)
        skeleton.keyframe_insert("rotation_quaternion", frame=frame)


def _lifted(moment: float) -> float:
    """From 1, as far off as it gets, to 0, on the kettle."""
    first, last = TOUCHES
    if moment < first:
        return 1.0 - eased(moment / first)
    return 0.0 if moment <= last else eased((moment - last) / (1.0 - last))


def _curls(moment: float) -> dict[str, float]:
    """Angles of the fingers' joints, radians: more bent when it is off the kettle."""
    bent = 0.35 + 0.5 * _lifted(moment)
    curls = {}
    for number, finger in enumerate(("index", "middle", "ring", "little")):
        own = bent + 0.06 * number + 0.05 * np.sin(2.0 * np.pi * moment + number)
        curls |= {f"{finger} 1": 0.5 * own, f"{finger} 2": 0.9 * own, f"{finger} 3": 0.55 * own}
    return curls | {"thumb 2": 0.25 * bent, "thumb 3": 0.3 * bent}


def _held(moment: float) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Rotation (3, 3) of the hand, a place (3,) of its wrist clear of the kettle, and the way (3,) from there to it."""
    stroke = eased(float(np.clip((moment - TOUCHES[0]) / (TOUCHES[1] - TOUCHES[0]), 0.0, 1.0)))
    heading = np.radians(70.0) + 0.35 * (stroke - 0.5)
    turn = rotation(heading) @ rotation(np.radians(24.0), 1) @ rotation(np.radians(-12.0), 0)
    way = np.array([np.cos(heading), np.sin(heading), 0.0])
    side = np.array([-way[1], way[0], 0.0])
    place = KETTLE_AT - 0.42 * way + (0.02 - 0.05 * stroke) * side + np.array([0.0, 0.0, 0.085 - 0.03 * stroke])
    return turn, place, way


def _way_to_kettle(points: Float64Array, way: Float64Array) -> float:
    """How far points (n, 3) about the kettle's center can go along `way` (3,) until one meets it."""
    free, blocked = 0.0, 0.4
    for _ in range(30):
        middle = 0.5 * (free + blocked)
        moved = points + middle * way
        near = moved[np.linalg.norm(moved, axis=1) < 0.25]
        if len(near) and (star_level(body_radius, near) <= 0.0).any():
            blocked = middle
        else:
            free = middle
    return free
