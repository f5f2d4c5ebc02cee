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
from mathutils import Vector

from ..errors import InputError
from ..optics.ray import ReflectedRay, reflect_ray
from ..options import marked_mirrors
from ..scene.arrays import Float64Array

SELF_HIT = 1e-4
"""A reflected ray starts so far off the mirror, over the mirror's size: it must not meet where it comes from"""
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
    hit, point, _normal, face, placed, matrix = scene.ray_cast(
        depsgraph, Vector(origin.tolist()), Vector(direction.tolist())
    )
    if not hit:
        raise InputError("Nothing is there: click on a mirror.")
    if marked_mirrors(scene) and not placed.original.curvrefl.is_mirror:
        raise InputError(f'"{placed.name}" is not a mirror: click on one, or mark it in the sidebar.')
    evaluated = placed.evaluated_get(depsgraph)
    normal = _shading_normal(evaluated, face, np.array(matrix.inverted() @ point, np.float64))
    world_normal = normal @ np.linalg.inv(np.array(matrix)[:3, :3])
    ray = reflect_ray(np.asarray(direction, np.float64), np.array(point, np.float64), world_normal)
    size = max(evaluated.dimensions.length, float(np.finfo(np.float32).tiny))
    # (Blender casts rays in single precision, from places that are rounded.)
    off = max(SELF_HIT * size, 4.0 * float(np.spacing(np.float32(np.abs(ray.point).max()))))
    start = Vector((ray.point + off * ray.normal).tolist())
    again, seen_at, _, _, seen, _ = scene.ray_cast(depsgraph, start, Vector(ray.direction.tolist()))
    return Trace(
        eye=np.array(origin, np.float64),
        mirror=placed.original.name,
        ray=ray,
        hit=np.array(seen_at, np.float64) if again else None,
        seen=seen.original.name if again else "",
        reach=10.0 * size,
    )


def place_on(found: Trace, item: bpy.types.Object) -> float:
    """Move an object onto the reflected ray, so that its origin is seen where the ray was clicked; returns its distance
    from the mirror in meters.

    It keeps its distance from the reflection point, but stays in front of what the ray shows. Raises InputError for
    the mirror itself, and for what cannot be moved.
    """
    if item.name == found.mirror:
        raise InputError("The mirror cannot be placed in its own reflection: make another object active.")
    if not item.is_editable:
        raise InputError(f'"{item.name}" is linked and cannot be moved: make a library override.')
    distance = float(np.linalg.norm(np.array(item.matrix_world.translation) - found.ray.point))
    if found.seen != item.name:
        distance = min(distance, 0.95 * found.distance)
    if distance <= 0.0:
        distance = 0.1 * found.reach
    matrix = item.matrix_world.copy()
    matrix.translation = Vector(found.ray.at(distance).tolist())
    item.matrix_world = matrix
    return distance


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


def _shading_normal(obj: bpy.types.Object, face: int, point: Float64Array) -> Float64Array:
    """(3,) the interpolated corner normal of an evaluated mesh at a point of one of its faces, object space."""
    mesh: Any = obj.to_mesh()
    try:
        mesh.calc_loop_triangles()
        faces = np.empty(len(mesh.loop_triangles), np.int32)
        mesh.loop_triangle_polygons.foreach_get("value", faces)
        best: Float64Array = np.array(mesh.polygons[face].normal, np.float64)
        weight = -np.inf
        for index in np.flatnonzero(faces == face).tolist():
            triangle = mesh.loop_triangles[index]
            weights = _barycentric(point, np.array([mesh.vertices[i].co for i in triangle.vertices], np.float64))
            if weights.min() > weight:
                weight = float(weights.min())
                best = weights @ np.array([mesh.corner_normals[loop].vector for loop in triangle.loops], np.float64)
        return best
    finally:
        obj.to_mesh_clear()


def _barycentric(point: Float64Array, corners: Float64Array) -> Float64Array:
    """(3,) weights of a triangle's corners (3, 3) at a point in its plane."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    squared = max(float(normal @ normal), 1e-300)
    first = np.cross(corners[2] - corners[1], point - corners[1]) @ normal / squared
    second = np.cross(corners[0] - corners[2], point - corners[2]) @ normal / squared
    return np.array([first, second, 1.0 - first - second])


def _place(point: Any) -> str:
    x, y, z = point
    return f"({x:.4g}, {y:.4g}, {z:.4g})"
