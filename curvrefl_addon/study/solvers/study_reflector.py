# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A reflector in closed form on the GPU, as every method wants it; world space is the map frame."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from ...optics.fermat import sample
from ...optics.surfaces.cube_map import texel_directions
from ...optics.surfaces.radial_surfaces import Float64Array, unit
from ...renderer.device.context import require_gpu
from ...renderer.device.cubes import cube_texture
from ...renderer.device.records import record_texture
from ...renderer.geometry.chunk import Batches, Chunk, Placed
from ...renderer.mirrors.mirror_plane import Plane, facing_plane, flat_parts
from ...renderer.mirrors.parametric_map import bake_parametric
from ...renderer.mirrors.screen_maps import ScreenMaps, map_to_texels, widened
from ...renderer.settings import Settings
from ...renderer.surfaces.materials import Materials
from ...renderer.vertices.grid_solve import ChunkGrid
from ...renderer.vertices.solution import VertexSolution
from ...renderer.vertices.solve import Reflector, solve_vertices
from ...scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from ...scene.camera.view import View
from .study_surfaces import Study

COLUMNS, ROWS = 512, 256
"""Quads of the mesh along longitude and latitude"""


def study_mesh(study: Study, columns: int = COLUMNS, rows: int = ROWS) -> MeshArrays:
    """Longitude and latitude as a UV-mapped grid with exact normals, up to the rim of an open one."""
    highest = np.arcsin(min(study.rim, 1.0))
    longitude = np.linspace(0.0, 2.0 * np.pi, columns + 1)
    latitude = np.linspace(-0.5 * np.pi, highest, rows + 1)
    ring = np.column_stack([np.cos(longitude), np.sin(longitude), np.zeros(columns + 1)])
    # The seam is twice there, in the same place.
    ring[-1] = ring[0]
    u = np.cos(latitude)[:, None, None] * ring + np.sin(latitude)[:, None, None] * np.array([0.0, 0.0, 1.0])
    at = sample(study.surface, unit(u.reshape(-1, 3)))
    uv = np.stack(np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1)), axis=-1)
    low = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.column_stack([low, low + 1, low + columns + 2, low + columns + 1])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    return MeshArrays(
        name="study",
        positions=at.position.astype(np.float32),
        corner_vertex=np.arange(len(at.position), dtype=np.int32),
        corner_normals=at.normal.astype(np.float32),
        corner_uv=uv.reshape(-1, 2).astype(np.float32),
        triangles=triangles,
        triangle_slot=np.zeros(len(triangles), np.int32),
    )


def _point_meshes(vertices: Float64Array, size: int) -> Chunk:
    """Runs of `size` vertices as meshes without faces."""
    placed = []
    for number, first in enumerate(range(0, len(vertices), size)):
        points = vertices[first : first + size].astype(np.float32)
        mesh = MeshArrays(
            name="points",
            positions=points,
            corner_vertex=np.arange(len(points), dtype=np.int32),
            corner_normals=np.zeros((len(points), 3), np.float32),
            corner_uv=None,
            triangles=np.zeros((1, 3), np.int32),
            triangle_slot=np.zeros(1, np.int32),
        )
        instance = InstanceArrays(f"points {number}", number, number, np.eye(4), (0,))
        placed.append(Placed(instance, mesh, mesh, np.zeros(1, np.int8)))
    return Chunk(placed)


class StudyReflector:
    """GPU side of a study; freed with it."""

    def __init__(self, study: Study, map_resolution: int = 128) -> None:
        require_gpu()
        self.study = study
        self._map_resolution = map_resolution
        self._instance = InstanceArrays("study", 1, 0, np.eye(4), (0,))
        self._screens: dict[tuple[int, int], tuple[bytes, ScreenMaps, dict[str, Any]]] = {}
        """By size: the view that was drawn last, and its targets"""

    def solve(
        self,
        method: str,
        view: View,
        settings: Settings,
        vertices: Float64Array,
        previous: VertexSolution | None = None,
    ) -> VertexSolution:
        """Reflection points of vertices (n, 3), of one mesh for methods that work on meshes.

        Raises InputError where the method cannot work on this shape.
        """
        return self.solver(method, settings, vertices)(view, previous)

    def solver(
        self, method: str, settings: Settings, vertices: Float64Array, mesh_size: int = 0
    ) -> Callable[[View, VertexSolution | None], VertexSolution]:
        """`solve` of vertices (n, 3) that are on the GPU already: takes the view and the last frame's solution.

        Every `mesh_size` of the vertices are a mesh of their own; 0: all of them are one.
        """
        grid_search = settings.entry.grid_search

        def search(view: View, positions: Any, count: int, previous: VertexSolution | None) -> VertexSolution:
            return solve_vertices(
                grid_search or method,
                view,
                self._reflector(method, view, settings),
                positions,
                count,
                steps=settings.steps,
                tolerance=0.1 * settings.pixel_tolerance,
                previous=previous,
            )

        if not grid_search:
            records = np.zeros((len(vertices), 4), np.float32)
            records[:, :3] = vertices
            positions = record_texture(records)
            return lambda view, previous: search(view, positions, len(vertices), previous)
        chunk = _point_meshes(vertices, mesh_size or len(vertices))
        grid = ChunkGrid(chunk, settings.grid_share)
        return lambda view, _: grid.solve(chunk, lambda corners, count: search(view, corners, count, None))

    def _reflector(self, method: str, view: View, settings: Settings) -> Reflector:
        maps = settings.entry.maps
        textures: dict[str, Any] = {}
        to_search, start = np.eye(4), (0.0, 0.0)
        if "radial" in maps:
            textures |= {"radial": self._radial}
        if "parametric" in maps:
            textures |= self._parametric.samplers()
        plane = (0.0, 0.0, 1.0, 0.0)
        if "plane" in maps:
            plane = facing_plane(self._planes, view.eye)
        if "screen" in maps:
            wide = widened(view, settings.frustum, settings.search_resolution)
            textures |= self._screen(wide)
            to_search, start = map_to_texels(wide, np.eye(4)), (0.5 * wide.width, 0.5 * wide.height)
        return Reflector(
            np.eye(4),
            self.study.surface.bound,
            textures,
            self.study.side,
            plane,
            to_search,
            start,
            self.study.is_convex,
            self.study.index or 1.0,
        )

    def _screen(self, view: View) -> dict[str, Any]:
        """The targets of a widened view, drawn anew for another one only: the shape does not change."""
        size, drawn = (view.width, view.height), view.world_to_clip.tobytes()
        before, maps, textures = self._screens.get(size, (b"", ScreenMaps(), {}))
        if before != drawn:
            textures = maps.draw(self._surface, self._materials, view)
            self._screens[size] = (drawn, maps, textures)
        return textures

    @cached_property
    def _radial(self) -> Any:
        at = sample(self.study.surface, texel_directions(self._map_resolution).reshape(-1, 3))
        faces = np.column_stack([at.radius, at.gradient]).astype(np.float32)
        return cube_texture(faces.reshape(6, self._map_resolution, self._map_resolution, 4))

    @cached_property
    def _mesh(self) -> MeshArrays:
        return study_mesh(self.study)

    @cached_property
    def _planes(self) -> list[Plane]:
        return flat_parts(self._mesh, self._instance, np.eye(4))

    @cached_property
    def _parametric(self) -> Any:
        return bake_parametric(self._mesh, self._instance, np.eye(4))

    @cached_property
    def _surface(self) -> tuple[Chunk, Batches]:
        placed = Placed(self._instance, self._mesh, self._mesh, np.zeros(len(self._mesh.triangles), np.int8), mirror=1)
        chunk = Chunk([placed])
        return chunk, chunk.batches(np.ones(1, bool))

    @cached_property
    def _materials(self) -> Materials:
        return Materials(
            SceneArrays((self._mesh,), (self._instance,), (MaterialArrays("study"),), (), (), WorldArrays(), (1,))
        )
