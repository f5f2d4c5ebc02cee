# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The object that is placed: what can be done to it, doing it, and undoing it."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ...errors import InputError
from ...scene.arrays import Float64Array
from .goals import Goal, aimed

AIMED = {"AREA", "SPOT"}
"""Lamps that are turned to what they are placed by; suns always are"""
SIZES = {"AREA": ("size", "size_y"), "POINT": ("shadow_soft_size",), "SPOT": ("shadow_soft_size",), "SUN": ("angle",)}
_CHANNELS = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale")
_PLACED = 1e-3
"""What is farther from where it was put than so much of its distance is held by something"""


@dataclass(frozen=True, slots=True)
class Change:
    """What placing does beside moving."""

    aims: bool = True
    size: float = 1.0
    """Times what it was"""
    power: float = 1.0
    """Times what it was"""


class Moved:
    """One object and how it was when it was taken up."""

    def __init__(self, item: bpy.types.Object) -> None:
        """Raises InputError for what cannot be moved."""
        if not item.is_editable:
            raise InputError(f'"{item.name}" is linked and cannot be moved: make a library override.')
        self.item = item
        self.name = item.name
        self._matrix = np.array(item.matrix_world, np.float64)
        self._channels: dict[str, tuple[float, ...]] = {name: tuple(getattr(item, name)) for name in _CHANNELS}
        light: Any = item.data
        names = (*SIZES[self.kind], "energy") if self.kind else ()
        self._of_light = {name: float(getattr(light, name)) for name in names}
        locked: Any = item.lock_rotation if self.is_sun else item.lock_location
        if any(locked):
            what = "rotation" if self.is_sun else "location"
            raise InputError(f'The {what} of "{item.name}" is locked: unlock it in the sidebar, tab Item.')

    @property
    def kind(self) -> str:
        """Of a lamp; nothing for other objects."""
        return str(self.item.data.type) if isinstance(self.item.data, bpy.types.Light) else ""

    @property
    def is_sun(self) -> bool:
        """It has a direction, and no place."""
        return self.kind == "SUN"

    @property
    def place(self) -> Float64Array:
        """(3,) where it was."""
        return self._matrix[:3, 3]

    @property
    def extent(self) -> float:
        """How far it reaches about its middle, meters, as it was."""
        if self.kind == "AREA":
            return 0.5 * float(np.hypot(*self._area_size()))
        if self.kind in ("POINT", "SPOT"):
            return self._of_light["shadow_soft_size"]
        return 0.0 if self.kind or self.item.type == "EMPTY" else 0.5 * self.item.dimensions.length

    def move(self, goal: Goal, change: Change) -> None:
        """From how it was to the goal."""
        rotation, lengths = _parts(self._matrix)
        if self.is_sun or (change.aims and self.kind in AIMED):
            rotation = aimed(rotation, goal.shines)
        matrix = np.eye(4)
        matrix[:3, :3] = rotation * lengths
        matrix[:3, 3] = self.place if self.is_sun else goal.place
        self.item.matrix_world = Matrix(matrix.tolist())
        # (Blender takes the matrix apart again.)
        scale = change.size if not self.kind else 1.0
        self.item.scale = [part * scale for part in self._channels["scale"]]
        self._change_light(change)

    def restore(self) -> None:
        """As it was."""
        for name, numbers in self._channels.items():
            setattr(self.item, name, numbers)
        for name, value in self._of_light.items():
            if getattr(self.item.data, name) != value:
                setattr(self.item.data, name, value)

    def insert_keys(self, aims: bool) -> None:
        """At the present frame, of what it was placed by."""
        if not self.is_sun:
            self.item.keyframe_insert("location")
        if self.is_sun or (aims and self.kind in AIMED):
            mode = self.item.rotation_mode
            names = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
            self.item.keyframe_insert(names.get(mode, "rotation_euler"))

    def held(self, goal: Goal, depsgraph: bpy.types.Depsgraph) -> str:
        """A sentence where constraints, drivers or the like keep it from the goal, in the updated scene."""
        matrix = np.array(self.item.evaluated_get(depsgraph).matrix_world, np.float64)
        if self.is_sun:
            is_there = np.linalg.norm(_parts(matrix)[0][:, 2] + goal.shines) <= _PLACED
        else:
            is_there = np.linalg.norm(matrix[:3, 3] - goal.place) <= _PLACED * goal.distance
        return "" if is_there else f'A constraint, a driver or physics keep "{self.item.name}" from going there.'

    def _area_size(self) -> tuple[float, float]:
        light: Any = self.item.data
        lengths = _parts(self._matrix)[1]
        height = self._of_light["size_y" if light.shape in ("RECTANGLE", "ELLIPSE") else "size"]
        return float(self._of_light["size"] * lengths[0]), float(height * lengths[1])

    def _change_light(self, change: Change) -> None:
        light: Any = self.item.data
        for name, value in self._of_light.items():
            factor = change.power if name == "energy" else change.size
            wanted = min(value * factor, pi) if name == "angle" else value * factor
            if getattr(light, name) == wanted:
                continue
            if not light.is_editable:
                raise InputError(f'"{light.name}" is linked: its size and power cannot be changed.')
            setattr(light, name, wanted)


def _parts(matrix: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Rotation (3, 3) and lengths (3,) of the columns of a matrix (4, 4), a mirrored one's third below 0."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    lengths = np.where(lengths > 0.0, lengths, 1.0)
    rotation = matrix[:3, :3] / lengths
    if np.linalg.det(rotation) < 0.0:
        lengths = lengths * (1.0, 1.0, -1.0)
        rotation = rotation * (1.0, 1.0, -1.0)
    return rotation, lengths
