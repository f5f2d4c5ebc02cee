# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the lights of a scene show in its mirrors, in a view: kept as long as nothing of that changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ...optics.surfaces.radial_surfaces import unit
from ...renderer.geometry.solid import solid_side
from ...scene.arrays import Float64Array, LightArrays, MeshArrays
from ...scene.camera.view import View
from ...scene.lights import read_light
from ...scene.meshes.meshes import MeshNeeds, mirrored, read_mesh
from ...scene.visibility import rays_of
from .goals import upright
from .images import images, is_met, outline, place_of
from .paths import MirrorPath
from .placing import Line
from .reflecting import PlacedMirror, Reflecting, reflecting
from .sight import MirrorRules, Sight
from .worlds import KnownSuns, MovedWorld

MOST_TESTED = 160
"""Places of outlines that are asked whether the eye sees them; those between follow their neighbors"""
SAME_DEPTH = 1e-3
"""Of the distance"""
WORLD = "\0world"
"""In place of an object's name"""
CLOSE = 12.0
"""Pixels from a light's image that a click picks it in"""


@dataclass(frozen=True, slots=True)
class ShownLight:
    """One light, or the active object, in all mirrors. Pixels from the bottom left."""

    name: str
    light: LightArrays | None
    """None for another object"""
    centers: Float64Array
    """(k, 2) of its images that the eye sees"""
    is_lit: tuple[bool, ...]
    """For each of them, whether nothing is between the mirror and the light"""
    segments: Float64Array
    """(s, 2, 2) of its outline"""
    is_world: bool = False
    """It is the sun of the world, or what is brightest there"""


@dataclass(slots=True)
class _Kept:
    mesh: MeshArrays
    is_solid: bool


@dataclass(frozen=True, slots=True)
class _Standing:
    """A mirror, by its kept mesh."""

    name: str
    key: tuple[int, bool]
    matrix: Float64Array


@dataclass(slots=True)
class LightsInMirrors:
    """Of one view of a view layer."""

    counters: dict[str, int] = field(default_factory=lambda: {"meshes": 0, "mirrors": 0, "lights": 0})
    """How often meshes were read, mirrors seen from another eye, lights looked for"""
    _meshes: dict[tuple[int, bool], _Kept] = field(default_factory=dict)
    """By the address of the evaluated mesh, and whether wound the other way round"""
    _mirrors: list[tuple[str, Reflecting]] = field(default_factory=list)
    _mirrors_key: Any = None
    _suns: KnownSuns = field(default_factory=dict)
    _lights: dict[str, tuple[Any, ShownLight]] = field(default_factory=dict)

    def forget_meshes(self) -> None:
        """Geometry has changed."""
        self._meshes.clear()
        self._mirrors_key = None

    def of(
        self,
        depsgraph: bpy.types.Depsgraph,
        scene: bpy.types.Scene,
        view: View,
        active: bpy.types.Object | None,
        has_world: bool = False,
    ) -> tuple[ShownLight, ...]:
        """All lamps that the view layer shows, the active object if it is none; last the world's sun if `has_world`."""
        placed, lights = self._read(depsgraph, active)
        if has_world and (sun := self._sun_of(scene.world)) is not None:
            lights.append((WORLD, sun, place_of(sun)))
        mirrors = tuple((mirror.key, mirror.matrix.tobytes()) for mirror in placed)
        key = (view.world_to_clip.tobytes(), view.width, view.height, mirrors)
        if key != self._mirrors_key:
            self._mirrors_key = key
            self._lights.clear()
            self._mirrors = [(mirror.name, reflecting(self._placed(mirror), view)) for mirror in placed]
            self.counters["mirrors"] += len(placed)
        sight: Sight | None = None
        shown = []
        for name, light, place in lights:
            known = (None if light is None else _identity(light), place.tobytes())
            if name not in self._lights or self._lights[name][0] != known:
                sight = sight or Sight(depsgraph, scene, MirrorRules.of(scene))
                self._lights[name] = (known, self._shown(sight, view, name, light, place))
                self.counters["lights"] += 1
            shown.append(self._lights[name][1])
        return tuple(shown)

    def _sun_of(self, world: bpy.types.World | None) -> LightArrays | None:
        """As a lamp without a disk; None for a world that cannot be turned. Its image is looked through once."""
        try:
            direction = MovedWorld(world, False, self._suns).direction
        except InputError:
            # (The operator says why.)
            return None
        matrix = np.eye(4)
        matrix[:3, :3] = upright(direction)
        return LightArrays(WORLD, "SUN", (1.0, 1.0, 1.0), matrix)

    def _read(
        self, depsgraph: bpy.types.Depsgraph, active: bpy.types.Object | None
    ) -> tuple[list[_Standing], list[tuple[str, LightArrays | None, Float64Array]]]:
        placed: list[_Standing] = []
        lights: list[tuple[str, LightArrays | None, Float64Array]] = []
        view_layer = depsgraph.view_layer
        assert view_layer is not None
        for instance in depsgraph.object_instances:
            obj: Any = instance.object
            if not instance.show_self:
                continue
            matrix = np.array(instance.matrix_world, np.float64)
            if obj.type == "LIGHT":
                light = read_light(obj, matrix, rays_of(instance, view_layer), [])
                if light is not None:
                    lights.append((obj.original.name, light, place_of(light)))
            elif obj.original.curvrefl.is_mirror and isinstance(obj.data, bpy.types.Mesh):
                placed.append(self._standing(obj, matrix))
        if active is not None and not isinstance(active.data, bpy.types.Light):
            place = np.array(active.evaluated_get(depsgraph).matrix_world, np.float64)[:, 3]
            lights.append((active.name, None, place))
        return placed, lights

    def _standing(self, obj: Any, matrix: Float64Array) -> _Standing:
        is_mirrored = bool(np.linalg.det(matrix[:3, :3]) < 0.0)
        key = (obj.data.as_pointer(), is_mirrored)
        if key not in self._meshes:
            mesh = read_mesh(obj.data, MeshNeeds()).mesh
            mesh = mirrored(mesh) if is_mirrored else mesh
            self._meshes[key] = _Kept(mesh, solid_side(mesh) == (-1 if is_mirrored else 1))
            self.counters["meshes"] += 1
        return _Standing(obj.original.name, key, matrix)

    def _placed(self, mirror: _Standing) -> PlacedMirror:
        kept, matrix = self._meshes[mirror.key], mirror.matrix
        return PlacedMirror(
            mirror.name,
            (kept.mesh.positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3])[kept.mesh.corner_vertex],
            unit(kept.mesh.corner_normals.astype(np.float64) @ np.linalg.inv(matrix[:3, :3])),
            kept.mesh.triangles,
            kept.is_solid,
        )

    def _shown(self, sight: Sight, view: View, name: str, light: LightArrays | None, place: Float64Array) -> ShownLight:
        centers: list[Float64Array] = []
        lit: list[bool] = []
        segments = [np.zeros((0, 2, 2))]
        for mirror, seen in self._mirrors:
            if mirror == name:
                continue
            found = images(seen, place)
            for point, pixel in zip(found.points, found.pixels, strict=True):
                if _is_seen(sight, view, mirror, point, pixel):
                    centers.append(pixel)
                    lit.append(_is_free(sight, view, pixel, place, name, 0.0 if light is None else light.radius))
            if light is not None:
                ends, middles = outline(seen, light)
                segments.append(ends[_seen_of(sight, view, mirror, ends, middles)])
        return ShownLight(
            name,
            light,
            np.array(centers).reshape(-1, 2),
            tuple(lit),
            np.concatenate(segments),
            name == WORLD,
        )


def picked(
    shown: tuple[ShownLight, ...], path: MirrorPath | None, pixel: Float64Array
) -> tuple[str, Float64Array] | None:
    """Name of the light that a click at a pixel (2,) is meant for, and its image (2,) nearest to that; or None.

    That whose image is nearest, if one is close; else a lamp that is met on the `path` of the line of sight there.
    """
    nearest = [
        (float(np.linalg.norm(center - pixel)), number, center)
        for number, light in enumerate(shown)
        for center in light.centers
    ]
    nearest.sort(key=lambda item: item[0])
    if nearest and nearest[0][0] <= CLOSE:
        return shown[nearest[0][1]].name, nearest[0][2]
    for ray, length in () if path is None else zip(path.rays, path.lengths, strict=True):
        for _, number, center in nearest:
            light = shown[number].light
            if light is not None and is_met(light, ray.point, ray.direction, length):
                return shown[number].name, center
    return None


def path_at(
    depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, view: View, pixel: Float64Array
) -> MirrorPath | None:
    """Over the mirrors under a pixel (2,); None where there is none."""
    line = Line.through(view, *pixel.tolist())
    try:
        return Sight(depsgraph, scene, MirrorRules.of(scene)).path(line.origin, line.direction)
    except InputError:
        return None


def _is_seen(sight: Sight, view: View, mirror: str, point: Float64Array, pixel: Float64Array) -> bool:
    """Whether the point (3,) of a mirror is what the eye sees at its pixel (2,)."""
    origin, direction = view.line_of_sight(*pixel.tolist())
    name, distance = sight.glimpse(origin, direction)
    return name == mirror and distance >= (1.0 - SAME_DEPTH) * float((point - origin) @ direction)


def _is_free(sight: Sight, view: View, pixel: Float64Array, place: Float64Array, name: str, extent: float) -> bool:
    """Whether the homogeneous place (4,) of a ball of the radius `extent` is seen from the mirror there."""
    hit = sight.first(*view.line_of_sight(*pixel.tolist()))
    if hit is None:
        return False
    start = hit.point + hit.off * hit.normal
    way = place[:3] - start * place[3]
    length = float(np.linalg.norm(way)) if place[3] else np.inf
    met, distance = sight.glimpse(start, unit(way), is_reflected=True)
    return met == name or distance >= (1.0 - SAME_DEPTH) * length - extent


def _seen_of(sight: Sight, view: View, mirror: str, ends: Float64Array, middles: Float64Array) -> np.ndarray:
    """(s,) which segments of an outline the eye sees."""
    step = -(-len(ends) // MOST_TESTED) or 1
    tested = [
        _is_seen(sight, view, mirror, middle, pixel)
        for middle, pixel in zip(middles[::step], ends[::step].mean(axis=1), strict=True)
    ]
    return np.repeat(np.array(tested, bool), step)[: len(ends)]


def _identity(light: LightArrays) -> tuple[Any, ...]:
    return light.kind, light.matrix.tobytes(), light.radius, light.angle, light.size, light.ellipse
