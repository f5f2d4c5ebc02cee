# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A candidate that is measured beside the methods (measure_methods.py) and is not part of the extension.

The reflection points of a triangle's corners and of the middles of its edges, found by `newton`, span a box on screen,
grown by as much as the edges bend; a fragment in it reflects its own ray at the mirror's point and normal there and
meets it with the triangle. Right, as `exact`, wherever the box holds the whole reflection; no proof says that it does.

Needs a single closed convex mirror; materials have their constants, no programs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import bare_batch
from curvrefl.curvrefl_addon.renderer.device.records import empty_record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import dispatch
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, scissored, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture
from curvrefl.curvrefl_addon.renderer.geometry.chunk import Chunk
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.surfaces.materials import Materials
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer
from curvrefl.curvrefl_addon.renderer.vertices.mirror_solver import Found, MirrorSolver
from curvrefl.curvrefl_addon.renderer.vertices.solution import SolvedChunk
from curvrefl.curvrefl_addon.scene.camera.view import View
from footprints.programs import GROUP, bounds_shader, draw_shader, middles_shader
from footprints.topology import Topology, are_same, read_topology

SPLIT = 4.0
"""Pixels: edges are split where their reflection bends by more"""
COUNTED = ("drawn", "crossing the horizon", "drawn over the whole window", "hidden")
"""Triangles, as the slots of `counters` in footprint_bounds.comp.glsl"""


@dataclass(frozen=True, slots=True)
class Margins:
    """What boxes are grown by."""

    bend: float = 1.0
    """Share of what an edge's reflection bends"""
    pixels: float = 0.1
    """More, of triangles that are reflected whole"""
    horizon_pixels: float = 1.0
    """More, of triangles that cross the horizon"""
    horizon_share: float = 0.1
    """Of their size, more"""


class _Middles:
    """Middles of a chunk's edges: positions to solve, as a chunk has them."""

    def __init__(self, chunk: Chunk, topology: Topology) -> None:
        self.positions = empty_record_texture(topology.edge_count)
        self.position_count = topology.edge_count
        self.revision = -1
        self._chunk, self._edges = chunk, topology.edges
        self.follow()

    def follow(self) -> None:
        """Be where the chunk's vertices are now."""
        if self.revision == self._chunk.revision:
            return
        self.revision = self._chunk.revision
        shader = middles_shader()
        shader.bind()
        shader.uniform_sampler("edges", self._edges)
        shader.uniform_sampler("positions", self._chunk.positions)
        shader.uniform_int("edge_count", self.position_count)
        shader.image("middles", self.positions)
        dispatch(shader, self.position_count, GROUP)


class Footprints:
    """The method, on one scene's renderer, whose method is `newton`."""

    def __init__(self, renderer: Renderer, materials: Materials, margins: Margins | None = None) -> None:
        self.margins = margins or Margins()
        self.counts = dict.fromkeys(COUNTED, 0)
        """Of the last picture"""
        self.points = 0
        """Solved for it"""
        self.triangles = 0
        """It had, after splitting"""
        self._renderer, self._materials = renderer, materials
        self._solver = MirrorSolver(renderer.mirrors[0])
        self._found: Found | None = None
        """In the picture before, where solving starts"""
        self._known: dict[int, tuple[Chunk, Topology, _Middles]] = {}

    def draw(self, target: SurfaceBuffer, seen: SurfaceBuffer, view: View, uniforms: Any) -> None:
        """Fill `target` with what the mirror shows at the pixels where `seen` has it."""
        renderer, mirror = self._renderer, self._renderer.mirrors[0]
        shape = mirror.shape(renderer.settings.map_resolution)
        renderer.geometry.refine([mirror.sight(view, SPLIT, shape)])
        scenery = renderer.geometry.scenery(mirror.index)
        before, self._known = self._known, {}
        for chunk, _ in scenery:
            self._known[id(chunk)] = self._follow(chunk, before)
        middles: list[Any] = [(self._known[id(chunk)][2], ()) for chunk, _ in scenery]
        own = renderer.geometry.of_instance(mirror.index)
        solved, self._found = self._solver.solve(
            view, renderer.settings, [*scenery, *middles], own, self._materials, self._found
        )
        corner_parts, middle_parts = solved[: len(scenery)], solved[len(scenery) :]
        window = mirror.window(view)
        boxes = [
            self._bound(number, corners, middle, view, uniforms, window)
            for number, (corners, middle) in enumerate(zip(corner_parts, middle_parts, strict=True))
        ]
        counted = self._read_counts()
        self.counts = dict(zip(COUNTED, counted.sum(axis=0).tolist(), strict=True))
        self.points = sum(part.solution.count for part in solved)
        self.triangles = sum(topology.triangle_count for _, topology, _ in self._known.values())
        target.clear()
        if window[2] <= 0 or window[3] <= 0:
            return
        shader = draw_shader()
        with drawing_state("LESS_EQUAL", depth_write=True), target.frame_buffer.bind(), scissored(window):
            set_viewport(0, 0, target.width, target.height)
            shader.bind()
            shader.uniform_block("view", uniforms)
            shader.uniform_float("screen", (target.width, target.height))
            shader.uniform_float("mirror", float(mirror.number))
            shader.uniform_float("depth_scale", shape.bound)
            shader.uniform_sampler("materials", self._materials.table)
            shader.uniform_sampler("mirror_position", seen.position)
            shader.uniform_sampler("mirror_normal", seen.normal)
            shader.uniform_sampler("mirror_color", seen.color)
            for part, found, drawn in zip(corner_parts, boxes, counted[:, 0].tolist(), strict=True):
                if drawn == 0:
                    continue
                shader.uniform_sampler("boxes", found)
                shader.uniform_sampler("triangles", self._known[id(part.chunk)][1].triangles)
                shader.uniform_sampler("positions", part.chunk.positions)
                shader.uniform_sampler("corners", part.chunk.corners)
                _boxes_batch(drawn).draw_range(shader, elem_start=0, elem_count=6 * drawn)

    def _follow(
        self, chunk: Chunk, before: dict[int, tuple[Chunk, Topology, _Middles]]
    ) -> tuple[Chunk, Topology, _Middles]:
        known = before.get(id(chunk))
        if known is not None:
            known[2].follow()
            return known
        members = [(item.drawn.triangles, item.drawn.corner_vertex) for item in chunk.placed]
        same = [topology for _, topology, _ in before.values() if are_same(topology.members, members)]
        topology = same[0] if same else read_topology(chunk, members)
        return chunk, topology, _Middles(chunk, topology)

    def _bound(
        self, number: int, corners: SolvedChunk, middles: SolvedChunk, view: View, uniforms: Any, window: Any
    ) -> Any:
        """Boxes of a chunk's triangles; their number is in row `number` of the counters."""
        if number == 0:
            self._counters = empty_texture(len(COUNTED), max(len(self._known), 1), "R32UI")
            self._counters.clear(format="UINT", value=(0,))
        chunk, topology, _ = self._known[id(corners.chunk)]
        boxes = empty_record_texture(2 * topology.triangle_count)
        shader = bounds_shader()
        shader.bind()
        shader.uniform_block("view", uniforms)
        shader.uniform_int("triangle_count", topology.triangle_count)
        shader.uniform_int("chunk", number)
        shader.uniform_float("screen", (view.width, view.height))
        x, y, width, height = window
        shader.uniform_float("window", (x, y, x + width, y + height))
        margins = self.margins
        shader.uniform_float("margins", (margins.bend, margins.pixels, margins.horizon_pixels, margins.horizon_share))
        shader.uniform_sampler("triangles", topology.triangles)
        shader.uniform_sampler("positions", chunk.positions)
        shader.uniform_sampler("corner_points", corners.solution.reflection_points)
        shader.uniform_sampler("middle_points", middles.solution.reflection_points)
        shader.image("boxes", boxes)
        shader.image("counters", self._counters)
        dispatch(shader, topology.triangle_count, GROUP)
        return boxes

    def _read_counts(self) -> np.ndarray:
        """(chunks, 4); waits for the GPU, as there are no indirect draws."""
        if not self._known:
            return np.zeros((0, len(COUNTED)), np.int64)
        buffer = self._counters.read()
        buffer.dimensions = self._counters.width * self._counters.height
        return np.array(buffer, np.int64).reshape(-1, len(COUNTED))


_BATCH: list[tuple[int, Any]] = []


def _boxes_batch(count: int) -> Any:
    """A batch of at least so many times six vertices, without attributes."""
    if not _BATCH or _BATCH[0][0] < count:
        room = 1 << max(count - 1, 1).bit_length()
        _BATCH[:] = [(room, bare_batch(6 * room))]
    return _BATCH[0][1]
