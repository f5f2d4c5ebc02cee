# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of sight in an evaluated scene: what they meet first, over which mirrors they go, where an edge is.

Blender casts the rays; what they have met is computed again in double precision on the triangle that was hit, with the
normals that the renderer draws by. A ray costs some ten microseconds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...errors import InputError
from ...optics.meshes.barycentric import barycentric
from ...optics.ray import ReflectedRay, reflect_ray
from ...optics.shading_normal import reflecting_outward
from ...optics.surfaces.radial_surfaces import unit
from ...options import marked_mirrors
from ...scene.arrays import Float64Array
from ...scene.reads import bounces_of
from .paths import MirrorPath

SELF_HIT = 1e-4
"""A ray starts so far off the surface that it leaves, over the size of the object: it must not meet where it comes
from"""
MOST_SKIPPED = 64
"""Surfaces that a ray goes through as it does not see them"""
EDGE_STEPS = 48
"""Rays in which an edge is looked for, over the size of the object"""
EDGE_HALVINGS = 24
DEEPEST_STEP = 0.25
"""Over the size of the object: what is farther behind its last place is not the same surface going on"""


@dataclass(frozen=True, slots=True)
class SurfaceHit:
    """What a line of sight meets. World space."""

    obj: bpy.types.Object
    """The original, not an evaluated copy"""
    matrix: Matrix
    """To the world: tells instances of one object apart"""
    point: Float64Array
    """(3,)"""
    normal: Float64Array
    """(3,) unit shading normal, on the side of the ray"""
    size: float
    """Of the object, meters"""

    @property
    def off(self) -> float:
        """How far off the surface another ray starts."""
        return _off(self.point.tolist(), self.size)


@dataclass(frozen=True, slots=True)
class MirrorRules:
    """What reflects, and how often. Looks through all objects once: kept while something is dragged."""

    has_marked: bool
    """Objects are marked as mirrors: only these reflect"""
    bounces: int

    @staticmethod
    def of(scene: bpy.types.Scene) -> MirrorRules:
        """As the scene's mirrors are drawn."""
        settings: Any = scene
        bounces = min(int(settings.curvrefl.bounces), bounces_of(scene).mirror)
        return MirrorRules(bool(marked_mirrors(scene)), max(bounces, 1))

    def reflects(self, hit: SurfaceHit) -> bool:
        """Where nothing is marked anything does."""
        obj: Any = hit.obj
        return not self.has_marked or bool(obj.curvrefl.is_mirror)


class Sight:
    """Of one state of the scene."""

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        scene: bpy.types.Scene,
        rules: MirrorRules,
        moved: bpy.types.Object | None = None,
    ) -> None:
        """`moved`: what is placed, which no ray meets."""
        self._depsgraph, self._scene, self._moved = depsgraph, scene, moved
        self._rules = rules

    def first(self, origin: Float64Array, direction: Float64Array, is_reflected: bool = False) -> SurfaceHit | None:
        """What is met first by the ray from `origin` (3,) along the unit `direction` (3,), of what sees such rays:
        the eye's own, or those that mirrors reflect."""
        met = self._cast(origin, direction, is_reflected)
        return None if met is None else self._surface(met, origin, direction)

    def glimpse(self, origin: Float64Array, direction: Float64Array, is_reflected: bool = False) -> tuple[str, float]:
        """Name of what is met first, nothing for the background, and how far away, in single precision."""
        met = self._cast(origin, direction, is_reflected)
        if met is None:
            return "", np.inf
        return met.obj.original.name, float((np.array(met.place, np.float64) - origin) @ direction)

    def path(self, origin: Float64Array, direction: Float64Array) -> MirrorPath:
        """Over the mirrors that the line of sight meets one after the other, as many as are drawn.

        Raises InputError where the first thing that it meets is none.
        """
        hit = self.first(origin, direction)
        if hit is None:
            raise InputError("Nothing is there: click on a mirror.")
        if not self._rules.reflects(hit):
            raise InputError(f'"{hit.obj.name}" is not a mirror: click on one, or mark it in the sidebar.')
        mirror, size = hit.obj.name, hit.size
        rays: list[ReflectedRay] = []
        while hit is not None and len(rays) < self._rules.bounces:
            # (Where nothing is marked no mirror is seen in another.)
            if rays and not (self._rules.has_marked and self._rules.reflects(hit)):
                break
            rays.append(reflect_ray(direction, hit.point, hit.normal))
            direction = rays[-1].direction
            hit = self.first(hit.point + hit.off * rays[-1].normal, direction, is_reflected=True)
        if hit is None:
            return MirrorPath(tuple(rays), np.inf, "", mirror, size)
        way = float(np.linalg.norm(hit.point - rays[-1].point))
        return MirrorPath(tuple(rays), way, hit.obj.name, mirror, size)

    def edge(
        self,
        hit: SurfaceHit,
        line: Callable[[float], tuple[Float64Array, Float64Array]],
    ) -> tuple[SurfaceHit, Float64Array]:
        """The last place of the hit object on a bundle of lines of sight, and the unit line (3,) to it; other objects
        are looked through.

        `line`: origin and direction of the line that passes the hit at so many meters; 0 is the one that met it.
        """
        step = hit.size / EDGE_STEPS
        low = high = 0.0
        last = Vector(hit.point.tolist())
        while high < 2.0 * hit.size:
            high += step
            if (place := self._place_on(hit, last, *line(high))) is None:
                break
            low, last = high, place
        for _ in range(EDGE_HALVINGS):
            middle = 0.5 * (low + high)
            if (place := self._place_on(hit, last, *line(middle))) is None:
                high = middle
            else:
                low, last = middle, place
        origin, direction = line(low)
        met = self._cast_at(hit, origin, direction)
        return hit if met is None else self._surface(met, origin, direction), direction

    def _place_on(self, hit: SurfaceHit, last: Vector, origin: Float64Array, direction: Float64Array) -> Vector | None:
        """Where a line of sight meets the object that was hit, unless that is far behind the last place on it: an edge
        may have more of its own object behind it."""
        met = self._cast_at(hit, origin, direction)
        if met is None or (met.place - last).length > DEEPEST_STEP * hit.size:
            return None
        return met.place

    def _cast_at(self, hit: SurfaceHit, origin: Float64Array, direction: Float64Array) -> _Met | None:
        """Where a ray meets the object that was hit, whatever is before it."""
        evaluated: Any = hit.obj.evaluated_get(self._depsgraph)
        to_object = hit.matrix.inverted_safe()
        start, way = to_object @ Vector(origin.tolist()), to_object.to_3x3() @ Vector(direction.tolist())
        if not isinstance(evaluated.data, bpy.types.Mesh):
            # (Only meshes can be asked alone.)
            met = self._cast(origin, direction, is_reflected=False)
            return met if met is not None and met.obj.original == hit.obj and met.matrix == hit.matrix else None
        is_met, place, facing, face = evaluated.ray_cast(start, way)
        return _Met(is_met, hit.matrix @ place, facing, face, hit.obj, hit.matrix) if is_met else None

    def _cast(self, origin: Float64Array, direction: Float64Array, is_reflected: bool) -> _Met | None:
        start, way = Vector(origin.tolist()), Vector(direction.tolist())
        for _ in range(MOST_SKIPPED):
            met = _Met(*self._scene.ray_cast(self._depsgraph, start, way))
            if not met.is_met:
                return None
            evaluated = met.obj.evaluated_get(self._depsgraph)
            is_seen = evaluated.visible_glossy if is_reflected else evaluated.visible_camera
            if is_seen and (self._moved is None or met.obj.original != self._moved):
                return met
            start = met.place + _off(met.place, evaluated.dimensions.length) * way
        return None

    def _surface(self, met: _Met, origin: Float64Array, direction: Float64Array) -> SurfaceHit:
        evaluated: Any = met.obj.evaluated_get(self._depsgraph)
        to_world = np.array(met.matrix, np.float64)
        place = np.array(met.place, np.float64)
        point, facet, bent = _on_triangle(evaluated, met.face, to_world, place, origin, direction)
        if facet is None or bent is None:
            facet = bent = np.array(met.facing, np.float64)
        side = 1.0 if facet @ direction < 0.0 else -1.0
        normal = reflecting_outward(side * facet[None], -direction[None], side * bent[None])[0]
        return SurfaceHit(met.obj.original, met.matrix.copy(), point, normal, _size(evaluated))


class _Met(NamedTuple):
    """What Blender says of a ray, in single precision, world space."""

    is_met: bool
    place: Vector
    facing: Vector
    face: int
    obj: Any
    matrix: Any


def _size(evaluated: bpy.types.Object) -> float:
    return max(evaluated.dimensions.length, float(np.finfo(np.float32).tiny))


def _off(place: Any, size: float) -> float:
    """How far off a surface another ray starts."""
    # (Blender casts rays from places that are rounded.)
    return max(SELF_HIT * size, 4.0 * float(np.spacing(np.float32(max(map(abs, place))))))


def has_bumps(item: bpy.types.Object) -> bool:
    """Whether materials of an object bend its normals, which lines of sight do not know."""
    trees = [slot.material.node_tree for slot in item.material_slots if slot.material is not None]
    return any(node.type in ("BUMP", "NORMAL_MAP") for tree in trees if tree is not None for node in tree.nodes)


def _on_triangle(
    evaluated: Any,
    face: int,
    to_world: Float64Array,
    place: Float64Array,
    origin: Float64Array,
    direction: Float64Array,
) -> tuple[Float64Array, Float64Array | None, Float64Array | None]:
    """Where the ray meets the face of an evaluated object, and the unit normals there, outward: the facet's and the
    shading's. Without both where Blender's mesh does not have that face."""
    is_mesh = isinstance(evaluated.data, bpy.types.Mesh) and not evaluated.data.is_editmode
    mesh: Any = evaluated.data if is_mesh else evaluated.to_mesh()
    try:
        if mesh is None or not 0 <= face < len(mesh.polygons):
            return place, None, None
        mesh.calc_loop_triangles()
        polygon = mesh.polygons[face]
        # Triangles lie in the order of faces, two fewer than the corners of each.
        begin = polygon.loop_start - 2 * face
        best = -np.inf
        found: tuple[Float64Array, Float64Array | None, Float64Array | None] = (place, None, None)
        normals_to_world = np.linalg.inv(to_world[:3, :3])
        winding = np.sign(np.linalg.det(normals_to_world))
        for triangle in mesh.loop_triangles[begin : begin + polygon.loop_total - 2]:
            corners = np.array([mesh.vertices[vertex].co for vertex in triangle.vertices], np.float64)
            corners = corners @ to_world[:3, :3].T + to_world[:3, 3]
            cross = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            slope = float(cross @ direction)
            if slope == 0.0:
                continue
            point = origin + float(cross @ (corners[0] - origin)) / slope * direction
            weights = barycentric(point[None], corners[None])[0]
            if weights.min() > best:
                best = float(weights.min())
                normals = np.array([mesh.corner_normals[loop].vector for loop in triangle.loops], np.float64)
                # (Each corner's is a unit vector once it is in the world, as in the renderer.)
                bent = unit(np.maximum(weights, 0.0) @ unit(normals @ normals_to_world))
                found = (point, winding * unit(cross), bent)
        return found
    finally:
        if not is_mesh:
            evaluated.to_mesh_clear()
