# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex solve of one mirror: its scenery, chunk by chunk, by any method that finds reflection points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ...optics.catalog import Method
from ...optics.surfaces.cube_map import CubeMapSurface
from ...optics.surfaces.curvature_regions import curvature_regions
from ...scene.camera.view import View
from ..geometry.chunk import Batches, Chunk
from ..mirrors.baked_shape import BakedShape
from ..mirrors.mirror import Mirror
from ..mirrors.mirror_plane import facing_plane
from ..mirrors.screen_maps import ScreenMaps, map_to_texels, widened
from ..settings import Settings
from ..surfaces.materials import Materials
from .curved_edges import SHORTEST, Solve, with_curved_edges
from .grid_solve import ChunkGrid
from .solution import SolvedChunk, VertexSolution
from .solve import Reflector, RegionTextures, solve_region, solve_vertices

SOLVER_SHARE = 0.1
"""Of the pixels that a reflected chord may be off, what the search may be off"""


@dataclass(frozen=True, slots=True)
class Found:
    """What one solve leaves for the next: per chunk's id, the chunk itself (so that no other gets its id), its revision
    and its solution."""

    method: str = ""
    shape: BakedShape | None = None
    by_chunk: dict[int, tuple[Chunk, int, VertexSolution]] = field(default_factory=dict)


def require(method: Method, shape: BakedShape) -> None:
    """Raise InputError where a method cannot work on a shape."""
    takes = method.takes_open and shape.map is not None
    if "radial" in method.maps and shape.refusal is not None and not takes:
        raise shape.refusal
    if "parametric" in method.maps:
        shape.parametric()


class MirrorSolver:
    """What solves for one mirror share, whatever the view."""

    def __init__(self, mirror: Mirror) -> None:
        self.mirror = mirror
        self._screen_maps = ScreenMaps()
        self._regions: tuple[Any, RegionTextures] | None = None
        """With the map that they are of"""
        self._grids: dict[int, tuple[Chunk, tuple[float, int], ChunkGrid]] = {}

    def solve(
        self,
        view: View,
        settings: Settings,
        scenery: Sequence[tuple[Chunk, Batches]],
        own: tuple[Chunk, Batches],
        materials: Materials,
        last: Found | None = None,
    ) -> tuple[tuple[SolvedChunk, ...], Found]:
        """Reflection points of all vertices of the scenery, and what the next solve may start from; `own` is the
        mirror's own surface.

        Methods that can start from the solve before start from `last`, and where nothing has changed its solution
        stands. Raises InputError where the method cannot work on this shape.
        """
        shape = self.mirror.shape(settings.map_resolution)
        require(settings.entry, shape)
        method = settings.entry
        reflector = self.reflector(view, settings, own, materials)
        known_chunks = (
            last.by_chunk if last is not None and last.shape is shape and last.method == settings.method else {}
        )
        found = Found(settings.method, shape)
        parts = []
        for chunk, batches in scenery:

            def search(
                positions: Any, count: int, start: VertexSolution | None = None, at_rest: bool = False
            ) -> VertexSolution:
                return solve_vertices(
                    method.grid_search or settings.method,
                    view,
                    reflector,
                    positions,
                    count,
                    steps=settings.steps,
                    tolerance=SOLVER_SHARE * settings.pixel_tolerance,
                    previous=start,
                    at_rest=at_rest,
                )

            if method.grid_search:
                solution = self._grid(chunk, settings.grid_share).solve(chunk, search)
            else:
                known = known_chunks.get(id(chunk))
                start, at_rest = None, False
                if known is not None:
                    start = known[2]
                    # The maps of a view are drawn anew for each solve.
                    at_rest = known[1] == chunk.revision and "screen" not in method.maps
                solution = search(chunk.positions, chunk.position_count, start, at_rest)
            if "previous" in method.maps:
                found.by_chunk[id(chunk)] = (chunk, chunk.revision, solution)
            parts.append(SolvedChunk(chunk, batches, solution))
        if method.several_images and reflector.side > 0.0:
            parts += self._more_images(view, shape, reflector, scenery, SOLVER_SHARE * settings.pixel_tolerance)
        used = {id(chunk) for chunk, _ in scenery}
        self._grids = {key: grid for key, grid in self._grids.items() if key in used}
        return tuple(parts), found

    def _more_images(
        self,
        view: View,
        shape: BakedShape,
        reflector: Reflector,
        scenery: Sequence[tuple[Chunk, Batches]],
        tolerance: float,
    ) -> list[SolvedChunk]:
        """One per region and chunk; none on a mirror that bends one way."""
        if not self.mirror.may_hide_itself or shape.is_open or shape.map is None:
            return []
        regions = self._regions_of(shape)
        if regions.count < 2:
            return []
        return [
            SolvedChunk(
                chunk,
                batches,
                solve_region(view, reflector, regions, region, chunk.positions, chunk.position_count, tolerance),
                image=region + 1,
            )
            for region in range(regions.count)
            for chunk, batches in scenery
        ]

    def _regions_of(self, shape: BakedShape) -> RegionTextures:
        """Found when first asked for, and again for another map."""
        assert shape.map is not None
        if self._regions is None or self._regions[0] is not shape.radial:
            self._regions = shape.radial, RegionTextures(curvature_regions(CubeMapSurface(shape.map.radial)))
        return self._regions[1]

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
        too short: `longest_edge` is theirs, meters.
        """
        shape = self.mirror.shape(settings.map_resolution)
        scale = self.mirror.most_pixels_per_meter(view, shape)
        reflector = self.reflector(view, settings, own, materials)
        tolerance = SOLVER_SHARE * settings.pixel_tolerance

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
                return solve_region(view, reflector, self._regions_of(shape), image - 1, positions, count, tolerance)

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
        """What a solve in this view knows of the mirror; `own` is its own surface. Draws the maps of methods that
        search in the view's own."""
        mirror, shape = self.mirror, self.mirror.shape(settings.map_resolution)
        maps = settings.entry.maps
        reflector = Reflector(
            shape.world_to_map,
            shape.bound,
            side=mirror.side(view, shape),
            is_convex=mirror.facts.never_sees_itself,
        )
        if "radial" in maps:
            reflector = replace(reflector, textures={"radial": shape.radial})
        if "parametric" in maps:
            reflector = replace(reflector, textures=shape.parametric().samplers())
        if "plane" in maps:
            reflector = replace(reflector, plane=facing_plane(shape.planes(), shape.world_to_map @ view.eye))
        if "screen" in maps:
            wide = widened(view, settings.frustum, settings.search_resolution)
            surface = own
            if shape.is_open and reflector.side > 0.0:
                # What lies past the rim is searched for on the closed shape.
                surface = shape.companion() or own
            x, y, width, height = mirror.window(wide)
            reflector = replace(
                reflector,
                textures=self._screen_maps.draw(surface, materials, wide),
                map_to_search=map_to_texels(wide, shape.world_to_map),
                start=(x + 0.5 * width, y + 0.5 * height),
            )
        return reflector

    def _grid(self, chunk: Chunk, share: float) -> ChunkGrid:
        known = self._grids.get(id(chunk))
        key = (share, chunk.shape_revision)
        if known is None or known[1] != key:
            known = self._grids[id(chunk)] = (chunk, key, ChunkGrid(chunk, share))
        return known[2]
