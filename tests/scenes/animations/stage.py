# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all animations are made with: a file to start from, mirrors that are marked, and paths given frame by frame."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))
import bootstrap

bootstrap.load_package()

from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, looking, start_empty_scene  # noqa: E402
from curvrefl.curvrefl_addon.demo.shapes import Numbers, rotation  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import Float64Array  # noqa: E402

FRAMES = 120
RATE = 24

type Path3 = Callable[[float], Float64Array]
"""A place (3,) at a moment from 0, the first frame, to 1, the last"""


@dataclass(frozen=True)
class Animation:
    """One film, as a file."""

    build: Callable[[], None]
    """Replaces the open file"""
    mirrors: tuple[str, ...]
    vertices: int
    """Of all that the mirrors show, as its meshes are evaluated, themselves left out"""
    paper: str
    """Which one shows such a film, and where"""


def start() -> Any:
    """An empty scene of 120 frames that Cycles renders without much noise, and what Blender is to know of mirrors."""
    scene: Any = start_empty_scene()
    scene.frame_start, scene.frame_end = 1, FRAMES
    scene.render.fps = RATE
    # (What mirrors focus is bright dots in Cycles.)
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces = 4, 2
    return scene


def moments() -> Sequence[tuple[int, float]]:
    """Each frame with its moment."""
    return [(frame, (frame - 1) / (FRAMES - 1)) for frame in range(1, FRAMES + 1)]


def eased(t: float) -> float:
    """From 0 to 1, slow at both ends."""
    return t * t * (3.0 - 2.0 * t)


def through(*places: Numbers) -> Path3:
    """A smooth path through places at equal distances in time (Catmull and Rom's curve), with its ends at rest."""
    points = np.array(places, float)
    ends = np.vstack([2.0 * points[0] - points[1], points, 2.0 * points[-1] - points[-2]])

    def at(moment: float) -> Float64Array:
        along = eased(moment) * (len(points) - 1)
        part = min(int(along), len(points) - 2)
        t = along - part
        a, b, c, d = ends[part : part + 4]
        return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))

    return at


def move(thing: bpy.types.Object, pose: Callable[[float], Float64Array]) -> None:
    """Give an object a key in each frame; `pose`: the world matrix (4, 4), without scale, at a moment."""
    thing.rotation_mode = "QUATERNION"
    last = None
    for frame, moment in moments():
        place, turn, _ = Matrix(pose(moment).tolist()).decompose()
        if last is not None:
            # (Of the two that are the same turn, that which blends with the one before.)
            turn.make_compatible(last)
        thing.location, thing.rotation_quaternion = place, turn
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_quaternion", frame=frame)
        last = turn.copy()


def placed(place: Numbers, heading: float) -> Float64Array:
    """(4, 4) world matrix of what stands at a place (3,), turned about Z by `heading` radians."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation(heading), place
    return matrix


def copied(thing: bpy.types.Object) -> bpy.types.Object:
    """The same mesh once more, as an object of its own."""
    copy: Any = thing.copy()
    scene: Any = bpy.context.scene
    scene.collection.objects.link(copy)
    return copy


def fly(eye: Path3, target: Path3, lens: float, clip: tuple[float, float] = (0.01, 100.0)) -> None:
    """The scene's camera, along a path, looking at what moves along another."""
    camera = add_camera(eye(0.0), target(0.0), lens=lens, clip=clip)
    move(camera, lambda moment: looking(eye(moment), target(moment)))


def mark(*mirrors: bpy.types.Object) -> None:
    """Have the extension take these for mirrors, as its panel does. What is marked stays so in the file, whether the
    extension is there or not."""
    from curvrefl.curvrefl_addon import registration

    is_there = hasattr(bpy.types.Object, "curvrefl")
    if not is_there:
        registration.register()
    try:
        for thing in mirrors:
            settings: Any = thing
            settings.curvrefl.is_mirror = True
    finally:
        if not is_there:
            registration.unregister()


def reflected_vertices(mirrors: Sequence[str]) -> int:
    """How many vertices evaluated meshes have, but those of the mirrors; instances count each."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    total = 0
    for item in depsgraph.object_instances:
        thing: Any = item.object
        if thing.type == "MESH" and thing.name not in mirrors:
            total += len(thing.data.vertices)
    return total
