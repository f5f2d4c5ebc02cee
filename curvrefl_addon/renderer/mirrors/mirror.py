# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One reflector of a scene: its map, where it is, and the solve for a view."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from ...errors import InputError
from ...optics.catalogue import METHODS
from ...optics.surfaces.cube_map import CubeMapSurface
from ...optics.surfaces.curvature_regions import curvature_regions
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays, SceneArrays
from ...scene.view import View
from ..device.gpu_objects import cube_texture
from ..geometry.chunk import Batches, Chunk
from ..geometry.mesh_facts import MeshFacts
from ..geometry.mesh_inside import holds_point
from ..geometry.scene_geometry import CORNERS, Sight
from ..geometry.split import split_angle
from ..settings import Settings
from ..surfaces.materials import Materials
from ..vertices.curved_edges import SHORTEST, Solve, with_curved_edges
from ..vertices.grid_solve import ChunkGrid
from ..vertices.solve import Reflector, RegionTextures, SolvedChunk, VertexSolution, solve_region, solve_vertices
from .companion import closed_companion
from .mirror_plane import Plane, facing_plane, flat_parts
from .reflector_bake import Limits, bake_instance, polar
from .reflector_map import ReflectorMap
from .screen_maps import ScreenMaps, map_to_texels, widened

SAME_STRETCH = 1e-6
"""Relative: a matrix whose stretch differs less only moves and turns"""
SLIVER = 1e-6
"""A triangle with this share of the largest one's area"""
INSIDE = 0.98
"""Share of the distance to the nearest facet that is inside for sure, dents that count as none included"""
MOST_EYES = 8
"""Places of the eye of which it is remembered whether a mirror holds them"""
OPEN_LIMITS = Limits(holes=0.6)
"""Of the maps of open mirrors, for methods that take them"""
OPEN = 0.02
"""Share of directions without a surface from which on a mirror counts as open: it may show its inner side"""


class Mirror:
    """A placed reflector."""

    def __init__(self, scene: SceneArrays, index: int, number: int, facts: MeshFacts, map_resolution: int) -> None:
        """Bakes the radial map of the instance `index`, unless `map_resolution` is 0.

        `number` is 1, 2, ... in the order of the scene's instances.

        A shape that no radial map can hold has none: methods that need one raise its `refusal`. An open mirror has
        both, for methods that take open ones and for those that do not.
        """
        start = perf_counter()
        instance = scene.instances[index]
        self.map: ReflectorMap | None = None
        self.refusal: InputError | None = None
        self.radial: Any = None
        self.is_baked = map_resolution > 0
        self.world_to_map, self.bound = _bounding_frame(facts, instance)
        if self.is_baked:
            try:
                self.map = bake_instance(scene, index, map_resolution)
            except InputError as error:
                self.refusal = error
                self.map = _open_map(scene, index, map_resolution, 2.0 * self.bound)
        if self.map is not None:
            self.radial = cube_texture(self.map.radial)
            self.world_to_map, self.bound = self.map.world_to_map, self.map.r_max
        self.bake_ms = 1e3 * (perf_counter() - start)
        self._instance = instance
        self.may_hide_itself = not facts.is_convex
        self.facts = facts
        self.index, self.number = index, number
        self._inner_radius: float | None = None
        self._parametric: Any = None
        self._planes: Sequence[Plane] | None = None
        self._companion: tuple[Chunk, Batches] | None = None
        self._screen_maps = ScreenMaps()
        self._regions: RegionTextures | None = None
        self._grids: dict[int, tuple[Chunk, float, ChunkGrid]] = {}
        self._before: dict[int, tuple[Chunk, int, VertexSolution]] = {}
        self._held: dict[bytes, bool] = {}
        """By the eye in object space: whether the mesh holds it"""

    def follow(self, scene: SceneArrays, index: int, number: int) -> bool:
        """Be the instance `index` of another state of the scene; False where the map has to be baked anew for that."""
        instance = scene.instances[index]
        if scene.meshes[instance.mesh] is not self.facts.mesh:
            return False
        if instance is not self._instance:
            placed = _moved_map(self.world_to_map, self._instance, instance)
            if placed is None:
                return False
            self.world_to_map = placed
            self._companion = None
            if self.map is not None:
                self.map = replace(self.map, world_to_map=placed, object_name=instance.object_name)
        self._instance, self.index, self.number = instance, index, number
        return True

    def require(self, method: str) -> None:
        """Raise InputError where a method cannot work on this shape."""
        takes = METHODS[method].takes_open and self.map is not None
        if "radial" in METHODS[method].maps and self.refusal is not None and not takes:
            raise self.refusal
        if "parametric" in METHODS[method].maps:
            self._parametric_map()

    @property
    def object_name(self) -> str:
        return self._instance.object_name

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return () if self.map is None else self.map.warnings

    @property
    def center(self) -> Float64Array:
        """(3,) star centre in world space; the middle of a shape without radial map."""
        return -self.world_to_map[:3, :3].T @ self.world_to_map[:3, 3]

    @property
    def nearest_surface(self) -> float:
        """Metres from the centre to the surface, or less."""
        return self.map.r_min if self.map is not None else 1e-3 * self.bound

    @property
    def mesh(self) -> MeshArrays:
        """What was baked."""
        return self.facts.mesh

    @property
    def object_id(self) -> int:
        return self._instance.object_id

    @property
    def is_open(self) -> bool:
        """Whether it may show its inner side."""
        return self.map is not None and self.map.holes > OPEN

    def radius_pixels(self, view: View) -> float:
        """Size of the reflector's bounding ball in the picture."""
        distance = 1.0
        if not view.is_orthographic:
            distance = max(float(np.linalg.norm(view.eye[:3] - self.center)), self.bound)
        return view.focal_pixels * self.bound / distance

    def most_pixels_per_metre(self, view: View) -> float:
        """No length that it reflects covers more pixels: what is seen in a mirror that bends outwards everywhere is no
        larger than it would be at the mirror itself."""
        if not self.facts.never_sees_itself:
            return np.inf
        clip = view.view_to_clip
        scale = max(view.focal_pixels, 0.5 * view.width * float(clip[0, 0]))
        if view.is_orthographic:
            return scale
        nearest = float(np.linalg.norm(view.eye[:3] - self.center)) - self.bound
        if nearest <= 0.0:
            return np.inf
        # In the picture's corners, the farthest one of a shifted lens, a radian covers more pixels than straight ahead.
        x, y = ((1.0 + abs(float(clip[axis, 2]))) / float(clip[axis, axis]) for axis in range(2))
        return (1.0 + x**2 + y**2) * scale / nearest

    @property
    def inner_ball(self) -> tuple[Float64Array, float]:
        """Center (3,), world space, and radius, metres, of a ball inside of a closed convex mirror."""
        low, high = (end.astype(np.float64) for end in self.facts.box)
        middle = 0.5 * (low + high)
        matrix = self._instance.matrix
        if self._inner_radius is None:
            # The same wherever it moves: a mirror that is stretched is another one.
            corners = (self.facts.mesh.positions - middle) @ matrix[:3, :3].T
            a, b, c = (corners[self.facts.mesh.corner_vertex[self.facts.mesh.triangles[:, k]]] for k in range(3))
            normals = np.cross(b - a, c - a)
            lengths = np.linalg.norm(normals, axis=1)
            # Slivers have no plane.
            some = lengths > SLIVER * lengths.max(initial=0.0)
            heights = np.einsum("ij,ij->i", normals[some], a[some]) / lengths[some]
            self._inner_radius = INSIDE * float(np.abs(heights).min(initial=np.inf)) if some.any() else 0.0
        return matrix[:3, :3] @ middle + matrix[:3, 3], self._inner_radius

    def holds_eye(self, view: View) -> bool:
        """Whether the eye is inside the reflector."""
        if view.is_orthographic or self.is_open:
            return False
        eye = (self.world_to_map @ view.eye)[:3]
        distance = float(np.linalg.norm(eye))
        if distance >= self.bound:
            return False
        if self.map is None:
            return self.facts.is_closed and self._mesh_holds(np.linalg.solve(self._instance.matrix, view.eye)[:3])
        if distance == 0.0:
            return True
        radius, _ = CubeMapSurface(self.map.radial).radius(eye[None] / distance)
        return distance < float(radius[0])

    def _mesh_holds(self, eye: Float64Array) -> bool:
        """Whether the closed mesh holds a point (3,), object space.

        All triangles are looked at for that: once for all sub-frames of a view, also where a few viewports take turns.
        """
        key = eye.tobytes()
        if key not in self._held:
            while len(self._held) >= MOST_EYES:
                del self._held[next(iter(self._held))]
            self._held[key] = holds_point(self.facts.mesh, eye)
        return self._held[key]

    def window(self, view: View) -> tuple[int, int, int, int]:
        """x, y, width and height of pixels that hold all of the reflector's; the whole picture where it is near."""
        low, high = self.facts.box
        corners = np.ones((8, 4))
        corners[:, :3] = np.where(CORNERS, high, low)
        clip = corners @ (view.world_to_clip @ self._instance.matrix).T
        if (clip[:, 3] <= 1e-6).any():
            return (0, 0, view.width, view.height)
        pixels = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        size = (view.width, view.height)
        first = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, size).astype(int)
        last = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int)
        return (int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1]))

    def sight(self, view: View, tolerance: float) -> Sight:
        """How finely `tolerance` pixels want the scenery split at the mirror's size in this view."""
        x, y, z = self.center.tolist()
        return Sight((x, y, z), split_angle(self.radius_pixels(view), tolerance), self.index)

    def solve(
        self,
        view: View,
        settings: Settings,
        scenery: Sequence[tuple[Chunk, Batches]],
        own: tuple[Chunk, Batches],
        materials: Materials,
        follow: bool = True,
    ) -> tuple[SolvedChunk, ...]:
        """Reflection points of all vertices of the scenery; `own` is the mirror's own surface.

        Methods that can start from the last solve do so, and where nothing has changed its solution stands; without
        `follow` a method on the radial map starts afresh, as a picture of its own should. Raises InputError where the
        method cannot work on this shape.
        """
        self.require(settings.method)
        method = METHODS[settings.method]
        reflector = self.reflector(view, settings, own, materials)
        before, self._before = self._before, {}
        parts = []
        for chunk, batches in scenery:

            def search(
                positions: Any, count: int, last: VertexSolution | None = None, at_rest: bool = False
            ) -> VertexSolution:
                return solve_vertices(
                    method.grid_search or settings.method,
                    view,
                    reflector,
                    positions,
                    count,
                    steps=settings.steps,
                    tolerance=0.1 * settings.pixel_tolerance,
                    previous=last,
                    at_rest=at_rest,
                )

            if method.grid_search:
                solution = self._grid(chunk, settings.grid_share).solve(chunk, search)
            else:
                known = before.get(id(chunk)) if follow or "screen" in method.maps else None
                last, at_rest = None, False
                if known is not None:
                    last = known[2]
                    # The maps of a view are drawn anew for each solve.
                    at_rest = known[1] == chunk.revision and "screen" not in method.maps
                solution = search(chunk.positions, chunk.position_count, last, at_rest)
            if "previous" in method.maps:
                # The chunk is kept with it, so that no other chunk can get its id.
                self._before[id(chunk)] = (chunk, chunk.revision, solution)
            parts.append(SolvedChunk(chunk, batches, solution))
        if method.several_images and reflector.side > 0.0:
            parts += self._more_images(view, reflector, scenery, 0.1 * settings.pixel_tolerance)
        used = {id(chunk) for chunk, _ in scenery}
        self._grids = {key: grid for key, grid in self._grids.items() if key in used}
        return tuple(parts)

    def _more_images(
        self, view: View, reflector: Reflector, scenery: Sequence[tuple[Chunk, Batches]], tolerance: float
    ) -> list[SolvedChunk]:
        """One per region and chunk; none on a mirror that bends one way."""
        if not self.may_hide_itself or self.is_open or self.map is None:
            return []
        if self._regions is None:
            self._regions = RegionTextures(curvature_regions(CubeMapSurface(self.map.radial)))
        if self._regions.count < 2:
            return []
        return [
            SolvedChunk(
                chunk,
                batches,
                solve_region(view, reflector, self._regions, region, chunk.positions, chunk.position_count, tolerance),
                image=region + 1,
            )
            for region in range(self._regions.count)
            for chunk, batches in scenery
        ]

    def with_curved_edges(
        self,
        view: View,
        settings: Settings,
        parts: Sequence[SolvedChunk],
        own: tuple[Chunk, Batches],
        materials: Materials,
        longest_edge: Callable[[Chunk], float],
    ) -> tuple[SolvedChunk, ...]:
        """What `solve` has found, with edges split where their solved midpoint leaves the chord (`curved_edges`).

        For methods with `curves_edges`; reads the solutions back from the GPU, but not of chunks whose edges are all
        too short: `longest_edge` is theirs, metres.
        """
        scale = self.most_pixels_per_metre(view)
        reflector = self.reflector(view, settings, own, materials)
        tolerance = 0.1 * settings.pixel_tolerance

        def found(image: int) -> Solve:
            def search(positions: Any, count: int, start: VertexSolution) -> VertexSolution:
                if image == 0:
                    return solve_vertices(
                        settings.method,
                        view,
                        reflector,
                        positions,
                        count,
                        steps=settings.steps,
                        tolerance=tolerance,
                        previous=start,
                    )
                assert self._regions is not None
                return solve_region(view, reflector, self._regions, image - 1, positions, count, tolerance)

            return search

        return tuple(
            piece
            for part in parts
            for piece in (
                with_curved_edges(part, view, settings.pixel_tolerance, found(part.image))
                if isinstance(part.chunk, Chunk)
                and scale * longest_edge(part.chunk) > SHORTEST * settings.pixel_tolerance
                else (part,)
            )
        )

    def reflector(self, view: View, settings: Settings, own: tuple[Chunk, Batches], materials: Materials) -> Reflector:
        """What a solve in this view knows of it; `own` is its own surface. Draws the maps of methods that search in the
        view's own."""
        maps = METHODS[settings.method].maps
        reflector = Reflector(
            self.world_to_map, self.bound, side=self.side(view), is_convex=self.facts.never_sees_itself
        )
        if "radial" in maps:
            reflector = replace(reflector, textures={"radial": self.radial})
        if "parametric" in maps:
            reflector = replace(reflector, textures=self._parametric_map().samplers())
        if "plane" in maps:
            if self._planes is None:
                self._planes = flat_parts(self.facts.mesh, self._instance, self.world_to_map)
            reflector = replace(reflector, plane=facing_plane(self._planes, self.world_to_map @ view.eye))
        if "screen" in maps:
            wide = widened(view, settings.frustum, settings.search_resolution)
            surface = own
            if self.is_open and reflector.side > 0.0:
                # What lies past the rim is searched for on the closed shape.
                if self._companion is None and self.map is not None:
                    self._companion = closed_companion(self.map, self._instance, self.world_to_map)
                surface = self._companion or own
            x, y, width, height = self.window(wide)
            reflector = replace(
                reflector,
                textures=self._screen_maps.draw(surface, materials, wide),
                map_to_search=map_to_texels(wide, self.world_to_map),
                start=(x + 0.5 * width, y + 0.5 * height),
            )
        return reflector

    def side(self, view: View) -> float:
        """1 where the eye sees more of the outer side of the mirror, -1 where it sees more of the inner one."""
        if not self.is_open:
            return 1.0
        eye = self.world_to_map @ view.eye
        to_map = self.world_to_map @ self._instance.matrix
        positions = self.facts.mesh.positions @ to_map[:3, :3].T + to_map[:3, 3]
        corners = positions[self.facts.mesh.corner_vertex[self.facts.mesh.triangles]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        middle = corners.mean(axis=1)
        normals *= np.sign(np.einsum("ij,ij->i", normals, middle))[:, None]
        to_eye = eye[:3] - middle * eye[3]
        seen = np.einsum("ij,ij->i", normals, to_eye) / np.maximum(np.linalg.norm(to_eye, axis=1), 1e-30) ** 3
        return 1.0 if np.maximum(seen, 0.0).sum() >= np.maximum(-seen, 0.0).sum() else -1.0

    def _grid(self, chunk: Chunk, share: float) -> ChunkGrid:
        known = self._grids.get(id(chunk))
        if known is None or known[1] != share:
            known = self._grids[id(chunk)] = (chunk, share, ChunkGrid(chunk, share))
        return known[2]

    def _parametric_map(self) -> Any:
        """Baked when first asked for. Raises InputError where the mesh has no UV map that serves."""
        from .parametric_map import bake_parametric

        if self._parametric is None:
            self._parametric = bake_parametric(self.facts.mesh, self._instance, self.world_to_map)
        return self._parametric


def _open_map(scene: SceneArrays, index: int, map_resolution: int, largest: float) -> ReflectorMap | None:
    """The map of an open mirror; None where there is none that reaches no farther than `largest` metres."""
    try:
        found = bake_instance(scene, index, map_resolution, limits=OPEN_LIMITS)
    except InputError:
        # The caller has the sentence that says why not.
        return None
    return found if found.r_max <= largest else None


def _bounding_frame(facts: MeshFacts, instance: InstanceArrays) -> tuple[Float64Array, float]:
    """World to a frame about the middle of an instance's box, and the box's half diagonal, metres."""
    rotation, _ = polar(instance.matrix[:3, :3])
    low, high = (np.asarray(end, np.float64) for end in facts.box)
    center = instance.matrix[:3, :3] @ (0.5 * (low + high)) + instance.matrix[:3, 3]
    world_to_map = np.eye(4)
    world_to_map[:3, :3] = rotation.T
    world_to_map[:3, 3] = -rotation.T @ center
    corners = (np.where(CORNERS, high, low) - 0.5 * (low + high)) @ instance.matrix[:3, :3].T
    return world_to_map, float(np.linalg.norm(corners, axis=1).max())


def _moved_map(world_to_map: Float64Array, before: InstanceArrays, after: InstanceArrays) -> Float64Array | None:
    """The map's frame after its instance has moved or turned; None where it has been stretched."""
    old_rotation, old_stretch = polar(before.matrix[:3, :3])
    rotation, stretch = polar(after.matrix[:3, :3])
    if np.abs(stretch - old_stretch).max() > SAME_STRETCH * np.abs(old_stretch).max():
        return None
    map_to_world = np.linalg.inv(world_to_map)
    offset = old_rotation.T @ (map_to_world[:3, 3] - before.matrix[:3, 3])
    moved = np.eye(4)
    moved[:3, :3] = rotation.T
    moved[:3, 3] = -rotation.T @ (after.matrix[:3, 3] + rotation @ offset)
    return moved


def faces_views(center: np.ndarray, near: float, far: float, resolution: int) -> list[View]:
    """The six views (GL face order) of a cube map about `center`."""
    axes: list[tuple[Any, Any]] = [
        ((1, 0, 0), (0, -1, 0)),
        ((-1, 0, 0), (0, -1, 0)),
        ((0, 1, 0), (0, 0, 1)),
        ((0, -1, 0), (0, 0, -1)),
        ((0, 0, 1), (0, -1, 0)),
        ((0, 0, -1), (0, -1, 0)),
    ]
    projection = np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )
    views = []
    for forward, up in axes:
        world_to_view = np.eye(4)
        world_to_view[:3, :3] = np.array([np.cross(forward, up), up, np.negative(forward)])
        world_to_view[:3, 3] = -world_to_view[:3, :3] @ center
        views.append(View(world_to_view, projection, resolution, resolution))
    return views
