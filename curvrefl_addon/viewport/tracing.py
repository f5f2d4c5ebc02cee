# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a line of sight goes at a mirror of the open scene, and the drawing of it in the viewports."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..design.lights.sight import MirrorRules, Sight
from ..errors import InputError
from ..optics.ray import ReflectedRay, reflect_ray
from ..scene.arrays import Float64Array

COLOR = (1.0, 0.62, 0.1, 1.0)
LINE_PIXELS = 2.0


@dataclass(frozen=True, slots=True)
class Trace:
    """A line of sight that met a mirror. World space."""

    eye: Float64Array
    """(3,) where it starts"""
    mirror: str
    ray: ReflectedRay
    hit: Float64Array | None
    """(3,) where the reflected ray ends, None in the background"""
    seen: str
    """Name of the object there, or nothing"""
    reach: float
    """Length of the line that is drawn into the background, meters"""

    @property
    def distance(self) -> float:
        """From the mirror to what is seen; endless in the background."""
        return float("inf") if self.hit is None else float(np.linalg.norm(self.hit - self.ray.point))

    def rows(self) -> list[tuple[str, str]]:
        """Label and value."""
        rows = [
            ("Mirror", self.mirror),
            ("Reflected At", _place(self.ray.point)),
            ("Incidence", f"{degrees(self.ray.incidence):.2f}\u00b0"),
            ("Shows", self.seen or "Background"),
        ]
        if self.hit is not None:
            rows += [("Seen At", _place(self.hit)), ("Distance", f"{self.distance:.4g} m")]
        return rows

    def sentence(self) -> str:
        """The same in one line."""
        shown = f'"{self.seen}" at {_place(self.hit)}, {self.distance:.4g} m away' if self.seen else "the background"
        angle = f"{degrees(self.ray.incidence):.2f}\u00b0"
        return f'"{self.mirror}" at {_place(self.ray.point)} shows {shown}; incidence {angle}'


def trace(
    depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, origin: Float64Array, direction: Float64Array
) -> Trace:
    """Follow the line of sight from `origin` (3,) along `direction` (3,) to what it shows in the mirror it meets.

    Where objects are marked as mirrors, only these reflect. Raises InputError where it meets no mirror.
    """
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(origin).all() and np.isfinite(length) and length > 0.0):
        raise InputError("The line of sight has no direction: give three finite numbers that are not all zero.")
    rules = MirrorRules.of(scene)
    sight = Sight(depsgraph, scene, rules)
    met = sight.first(np.asarray(origin, np.float64), np.asarray(direction, np.float64) / length)
    if met is None:
        raise InputError("Nothing is there: click on a mirror.")
    if not rules.reflects(met):
        raise InputError(f'"{met.obj.name}" is not a mirror: click on one, or mark it in the sidebar.')
    ray = reflect_ray(np.asarray(direction, np.float64), met.point, met.normal)
    seen = sight.first(met.point + met.off * met.normal, ray.direction, is_reflected=True)
    return Trace(
        eye=np.array(origin, np.float64),
        mirror=met.obj.name,
        ray=ray,
        hit=None if seen is None else seen.point,
        seen="" if seen is None else seen.obj.name,
        reach=10.0 * met.size,
    )


_shown: list[Trace] = []
_handlers: list[Any] = []


def show(found: Trace) -> None:
    """Draw the trace in all 3D viewports, in place of the last one."""
    clear()
    _shown.append(found)
    _handlers.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))
    bpy.app.handlers.load_pre.append(_forget)


def shown() -> Trace | None:
    """What is drawn now."""
    return _shown[0] if _shown else None


def clear() -> None:
    """Draw nothing any more."""
    _shown.clear()
    while _handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_handlers.pop(), "WINDOW")
    if _forget in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(_forget)


@persistent
def _forget(*_arguments: Any) -> None:
    clear()


def _draw() -> None:
    # (Not with this module, which is there as soon as the extension is enabled.)
    from ..renderer.device.overlays import draw_line

    for found in _shown:
        end = found.ray.at(found.reach) if found.hit is None else found.hit
        places = [tuple(place) for place in (found.eye, found.ray.point, end)]
        draw_line(places, LINE_PIXELS, COLOR)


def _place(point: Any) -> str:
    x, y, z = point
    return f"({x:.4g}, {y:.4g}, {z:.4g})"
