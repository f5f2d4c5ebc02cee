# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Placing what is active by the line of sight under a cursor, again and again as that moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array
from ...scene.camera.film import rendered_size
from ...scene.camera.view import View
from ...scene.opened.blend_file import find_camera, view_of_camera
from .goals import Goal, background, illumination, outward, reflection, rim
from .moved import Change, Moved
from .paths import limited
from .sight import MirrorRules, Sight, SurfaceHit
from .worlds import MovedWorld

NEAREST = 1e-3
"""A distance below so much of the size of what is under the cursor is none: the size is taken"""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of sight. World space."""

    origin: Float64Array
    """(3,)"""
    direction: Float64Array
    """(3,) unit"""
    is_parallel: bool = False
    """To all others, as in an orthographic view"""

    @staticmethod
    def through(view: View, x: float, y: float) -> Line:
        """In pixels from the bottom left of the view's picture."""
        return Line(*view.line_of_sight(x, y), is_parallel=view.is_orthographic)

    @staticmethod
    def along(origin: Float64Array, direction: Float64Array, is_parallel: bool = False) -> Line:
        """From a place (3,) along a direction (3,) of any length. Raises InputError for one without direction."""
        length = float(np.linalg.norm(direction))
        if not (np.isfinite(origin).all() and np.isfinite(length) and length > 0.0):
            raise InputError("The line of sight has no direction: give three finite numbers that are not all zero.")
        return Line(np.asarray(origin, np.float64), direction / length, is_parallel)

    def beside(self, across: Float64Array, meters: float, ahead: float) -> tuple[Float64Array, Float64Array]:
        """Origin and direction of the line that is `meters` along the unit vector `across` (3,) from this one, `ahead`
        meters from its origin."""
        if self.is_parallel:
            return self.origin + meters * across, self.direction
        return self.origin, unit(ahead * self.direction + meters * across)


@dataclass(frozen=True, slots=True)
class Ask:
    """What placing keeps and what not."""

    mode: str = "REFLECTION"
    """REFLECTION, ILLUMINATION or RIM"""
    distance: float | None = None
    """Meters from the point that it is placed by, along the path; None keeps the first"""
    keeps_size: bool = True
    """In meters; else as large as it looks from there"""
    keeps_power: bool = True
    """In watts; else as bright as it is there"""
    size: float = 1.0
    power: float = 1.0
    aims: bool = True
    rim_width: float = 0.26
    """Radians"""


@dataclass(frozen=True, slots=True)
class Placed:
    """What came of it."""

    goal: Goal
    on: str
    """Name of what is under the cursor, nothing beside all"""
    behind: str
    """Name of what it was kept in front of, or nothing"""
    hides: str
    """Name of what hides a sun there, or nothing"""


class Placing:
    """Of one thing, from when it is taken up until it is let go or restored."""

    def __init__(self, moved: Moved | MovedWorld, scene: bpy.types.Scene) -> None:
        self.moved = moved
        self._rules = MirrorRules.of(scene)
        self._kept: float | None = None

    def place(self, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, line: Line, ask: Ask) -> Placed:
        """Move it. Raises InputError, and moves nothing, where the line meets nothing that serves."""
        item = self.moved.item
        sight = Sight(depsgraph, scene, self._rules, item)
        if ask.mode == "REFLECTION":
            self._require_another(depsgraph, scene, line)
            placed = self._reflected(sight, line, ask)
        else:
            hit = sight.first(line.origin, line.direction)
            if hit is None and ask.mode == "ILLUMINATION":
                raise InputError("Nothing is there: click on what is to be lit.")
            if hit is None:
                placed = Placed(self._beside_all(line, ask), "", "", "")
            elif ask.mode == "ILLUMINATION":
                placed = self._lit(sight, hit, ask)
            else:
                placed = self._grazed(sight, hit, line, ask)
        self.moved.move(placed.goal, self._change(placed.goal, ask))
        return placed

    def _require_another(self, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, line: Line) -> None:
        """At first: what is dragged later may come before the mirror."""
        item: Any = self.moved.item
        if self._kept is None and item is not None and item.curvrefl.is_mirror:
            hit = Sight(depsgraph, scene, self._rules).first(line.origin, line.direction)
            if hit is not None and hit.obj == item:
                raise InputError("The mirror cannot be placed in its own reflection: make another object active.")

    def _reflected(self, sight: Sight, line: Line, ask: Ask) -> Placed:
        path = sight.path(line.origin, line.direction)
        on = path.mirror
        if self.moved.is_sun:
            return Placed(background(path), on, "", path.seen)
        asked = self._distance(path.rays[0].point, path.size, ask)
        distance = limited(asked, path.reach, self.moved.extent * ask.size)
        return Placed(reflection(path, distance), on, path.seen if distance < asked else "", "")

    def _lit(self, sight: Sight, hit: SurfaceHit, ask: Ask) -> Placed:
        asked = self._distance(hit.point, hit.size, ask)
        distance, behind = self._in_front(sight, hit, hit.normal, asked, ask)
        goal = illumination(hit.point, hit.normal, distance)
        return self._unless_sun(goal, hit, behind)

    def _grazed(self, sight: Sight, hit: SurfaceHit, line: Line, ask: Ask) -> Placed:
        try:
            across = outward(line.direction, hit.normal)
        except ValueError as error:
            raise InputError(f'"{hit.obj.name}" faces the eye here: click nearer to its edge.') from error
        ahead = float((hit.point - line.origin) @ line.direction)
        edge, direction = sight.edge(hit, lambda meters: line.beside(across, meters, ahead))
        if edge.normal @ across < 0.0:
            # (A facet that is seen from its rim may be taken for one that is seen from behind.)
            edge = replace(edge, normal=-edge.normal)
        asked = self._distance(edge.point, hit.size, ask)
        goal = rim(edge.point, direction, edge.normal, ask.rim_width, asked)
        distance, behind = self._in_front(sight, edge, -goal.shines, asked, ask)
        return self._unless_sun(rim(edge.point, direction, edge.normal, ask.rim_width, distance), hit, behind)

    def _beside_all(self, line: Line, ask: Ask) -> Goal:
        """Where the cursor points, and as far from the eye as it was."""
        distance = self._distance(line.origin, 1.0, ask)
        return Goal(line.origin + distance * line.direction, -line.direction, distance)

    def _in_front(
        self, sight: Sight, hit: SurfaceHit, direction: Float64Array, asked: float, ask: Ask
    ) -> tuple[float, str]:
        """How far it can go from there before something is in its way, and what that is."""
        other = sight.first(hit.point + hit.off * hit.normal, direction, is_reflected=True)
        if other is None:
            return asked, ""
        way = float(np.linalg.norm(other.point - hit.point))
        if self.moved.is_sun:
            return asked, other.obj.name
        distance = limited(asked, way, self.moved.extent * ask.size)
        return distance, other.obj.name if distance < asked else ""

    def _unless_sun(self, goal: Goal, hit: SurfaceHit, behind: str) -> Placed:
        if self.moved.is_sun:
            return Placed(goal, hit.obj.name, "", behind)
        return Placed(goal, hit.obj.name, behind, "")

    def _distance(self, point: Float64Array, size: float, ask: Ask) -> float:
        if self._kept is None:
            self._kept = float(np.linalg.norm(self.moved.place - point))
            if not self._kept > NEAREST * size:
                self._kept = size
        return self._kept if ask.distance is None else ask.distance

    def _change(self, goal: Goal, ask: Ask) -> Change:
        """(A sun is as large and as bright from everywhere.)"""
        farther = 1.0 if self.moved.is_sun or not self._kept else goal.distance / self._kept
        size = ask.size * (1.0 if ask.keeps_size else farther)
        power = ask.power * (1.0 if ask.keeps_power else farther**2)
        return Change(ask.aims, size, power)


def line_given(
    scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, given: Mapping[str, Float64Array], is_parallel: bool
) -> Line:
    """The line of sight by what a script names of `eye` (3,), `direction` (3,), `point` (3,) on it, and `pixel` (2,) of
    the active camera's picture from the bottom left. Raises InputError where that says none."""
    if "direction" in given and "eye" in given:
        return Line.along(given["eye"], given["direction"], is_parallel)
    if "point" in given and "eye" in given:
        return Line.along(given["eye"], given["point"] - given["eye"])
    if not given.keys() & {"pixel", "point"}:
        raise InputError("No place is given: set pixel, or point, or eye and direction.")
    view = view_of_camera(scene, find_camera(scene), *rendered_size(scene.render), depsgraph)
    pixel = given["pixel"] if "pixel" in given else view.project(given["point"][None])[0]
    return Line.through(view, *pixel.tolist())
