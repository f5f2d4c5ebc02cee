# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Footprints: solved points only bound where a triangle may be reflected, each pixel inside tests its own ray.

    python tools/measure/footprints.py [--triangles N] [--pixels N]

A candidate that is measured beside the methods (measure_methods.py) and is not part of the extension. The reflection
points of a triangle's corners and of the middles of its edges, found by `newton`, span a box on screen, grown by as
much as the edges bend; a fragment in it reflects its own ray at the mirror's point and normal there and meets it with
the triangle. Right, as `exact`, wherever the box holds the whole reflection. No proof says that it does, so this
command counts the mirror pixels where the picture is another than that of `exact`.

Needs a single closed convex mirror; base colors by images are not looked up.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.batches import bare_batch  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.records import empty_record_texture, record_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.shaders import Image, Piece, build_shader, dispatch, named  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, scissored, set_viewport  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.chunk import CHUNK, Chunk  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.materials import TABLE, Materials  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.primary import draw_primary  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SURFACE_OUTPUTS, SurfaceBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import VIEW, view_block  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.mirror_solver import Found, MirrorSolver  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.solution import SolvedChunk  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import Int32Array, MeshArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.view import View  # noqa: E402
from curvrefl.curvrefl_addon.study.benchmark.scenes import hall, view_of_mirror  # noqa: E402

SHADERS = Path(__file__).resolve().parent / "footprint_shaders"
GROUP = 64
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


@dataclass
class _Topology:
    """Triangles of a chunk and their edges on the GPU; vertices may move."""

    members: list[tuple[Int32Array, Int32Array]]
    """(triangles, corner_vertex) of its meshes: the same objects while the topology is the same"""
    triangles: Any
    edges: Any
    triangle_count: int
    edge_count: int


class _Middles:
    """Middles of a chunk's edges: positions to solve, as a chunk has them."""

    def __init__(self, chunk: Chunk, topology: _Topology) -> None:
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
        shader = _middles_shader()
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
        self._known: dict[int, tuple[Chunk, _Topology, _Middles]] = {}

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
        shader = _draw_shader()
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
        self, chunk: Chunk, before: dict[int, tuple[Chunk, _Topology, _Middles]]
    ) -> tuple[Chunk, _Topology, _Middles]:
        known = before.get(id(chunk))
        if known is not None:
            known[2].follow()
            return known
        members = [(item.drawn.triangles, item.drawn.corner_vertex) for item in chunk.placed]
        same = [topology for _, topology, _ in before.values() if _are_same(topology.members, members)]
        topology = same[0] if same else _read_topology(chunk, members)
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
        shader = _bounds_shader()
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


def _are_same(known: list[tuple[Int32Array, Int32Array]], members: list[tuple[Int32Array, Int32Array]]) -> bool:
    return len(known) == len(members) and all(a is c and b is d for (a, b), (c, d) in zip(known, members, strict=True))


def _read_topology(chunk: Chunk, members: list[tuple[Int32Array, Int32Array]]) -> _Topology:
    triangles, edges = [], []
    vertices = corners = 0
    edge_count = 0
    for item in chunk.placed:
        mesh = item.drawn
        ends = mesh.corner_vertex[mesh.triangles]
        pairs, numbers = _edges_of(ends)
        records = np.zeros((len(ends), 3, 4), np.float32)
        records[:, 0, :3] = ends + vertices
        records[:, 0, 3] = _materials_of(mesh, item.instance.materials)
        records[:, 1, :3] = numbers + edge_count
        records[:, 2, :3] = mesh.triangles + corners
        triangles.append(records.reshape(-1, 4))
        edges.append(np.pad((pairs + vertices).astype(np.float32), ((0, 0), (0, 2))))
        vertices += len(mesh.positions)
        corners += len(mesh.corner_vertex)
        edge_count += len(pairs)
    joined = np.concatenate(triangles)
    return _Topology(
        members, record_texture(joined), record_texture(np.concatenate(edges)), len(joined) // 3, edge_count
    )


def _edges_of(ends: Int32Array) -> tuple[np.ndarray, np.ndarray]:
    """Edges (n, 2) of triangles (m, 3), each once, and (m, 3) the numbers of those after each corner."""
    following = ends[:, [1, 2, 0]]
    low, high = np.minimum(ends, following).astype(np.int64), np.maximum(ends, following).astype(np.int64)
    keys, numbers = np.unique(low << 32 | high, return_inverse=True)
    return np.column_stack([keys >> 32, keys & 0xFFFFFFFF]), numbers.reshape(-1, 3)


def _materials_of(mesh: MeshArrays, materials: tuple[int, ...]) -> np.ndarray:
    return np.asarray(materials, np.int32)[np.minimum(mesh.triangle_slot, len(materials) - 1)]


_BATCH: list[tuple[int, Any]] = []


def _boxes_batch(count: int) -> Any:
    """A batch of at least so many times six vertices, without attributes."""
    if not _BATCH or _BATCH[0][0] < count:
        room = 1 << max(count - 1, 1).bit_length()
        _BATCH[:] = [(room, bare_batch(6 * room))]
    return _BATCH[0][1]


@cache
def _middles_shader() -> Any:
    return build_shader(
        "edge middles",
        Piece(
            constants={"edge_count": "INT"},
            samplers=named("FLOAT_2D", "edges", "positions"),
            images={"middles": Image()},
            group=GROUP,
            compute=SHADERS / "edge_middles.comp.glsl",
        ),
    )


@cache
def _bounds_shader() -> Any:
    return build_shader(
        "footprint bounds",
        VIEW,
        Piece(
            constants={
                **named("INT", "triangle_count", "chunk"),
                "screen": "VEC2",
                **named("VEC4", "window", "margins"),
            },
            samplers=named("FLOAT_2D", "triangles", "positions", "corner_points", "middle_points"),
            images={"boxes": Image(), "counters": Image("R32UI", "UINT_2D_ATOMIC", is_read=True)},
            group=GROUP,
            compute=SHADERS / "footprint_bounds.comp.glsl",
        ),
    )


@cache
def _draw_shader() -> Any:
    return build_shader(
        "footprint",
        VIEW,
        CHUNK,
        TABLE,
        SURFACE_OUTPUTS,
        Piece(
            constants={"screen": "VEC2", **named("FLOAT", "mirror", "depth_scale")},
            samplers=named("FLOAT_2D", "boxes", "triangles", "mirror_position", "mirror_normal", "mirror_color"),
            flat={**named("VEC3", "corner_a", "edge_b", "edge_c", "corner_numbers"), "about": "VEC2"},
            defines={"OVERLAP": 2e-6},
            writes_depth=True,
            vertex=SHADERS / "footprint.vert.glsl",
            fragment=SHADERS / "footprint.frag.glsl",
        ),
    )


@dataclass
class Comparison:
    """Of mirror pixels of one view with `exact`."""

    pixels: int
    hits: int
    """Of `exact`"""
    missing: int
    """`exact` hits something, footprints nothing"""
    farther: int
    """Both do, footprints behind it"""
    nearer: int
    """Or before it, or where `exact` hits nothing"""


class Compared:
    """One scene, drawn both ways."""

    def __init__(self, triangles: int, pixels: float, size: tuple[int, int]) -> None:
        scene = hall(triangles)
        self.size, self.pixels = size, pixels
        self.materials = Materials(scene)
        self.renderer = Renderer(scene, Settings(method="newton", samples=1))
        self.seen, self.shown, self.path = SurfaceBuffer(*size), SurfaceBuffer(*size), PathBuffer(*size)

    @property
    def mirror(self) -> Mirror:
        return self.renderer.mirrors[0]

    def compare(self, turn: float, footprints: Footprints) -> Comparison:
        """The eye goes round the mirror by `turn`, radians."""
        view = view_of_mirror(*self.size, self.pixels, turn)
        uniforms = view_block(view)
        draw_primary(self.seen, self.renderer.geometry.seen(view), self.materials, uniforms)
        footprints.draw(self.shown, self.seen, view, uniforms)
        window = self.mirror.window(view)
        self.path.follow(self.seen, self.renderer.rays(), self.materials, uniforms, window, False)
        x, y, width, height = window

        def part(texture: Any) -> np.ndarray:
            return read_texture(texture)[y : y + height, x : x + width]

        is_mirror = part(self.seen.color)[..., 3] > 0.5
        origin = part(self.seen.position)[is_mirror][:, :3]
        truth, found = (part(buffer.position)[is_mirror] for buffer in (self.path, self.shown))
        far, near = (np.linalg.norm(hits[:, :3] - origin, axis=1) for hits in (found, truth))
        is_hit, is_found = truth[:, 3] > 0.5, found[:, 3] > 0.5
        both = is_hit & is_found
        return Comparison(
            int(is_mirror.sum()),
            int(is_hit.sum()),
            int((is_hit & ~is_found).sum()),
            int((both & (far > near * (1.0 + 1e-4))).sum()),
            int((both & (far < near * (1.0 - 1e-4))).sum() + (is_found & ~is_hit).sum()),
        )


def main() -> None:
    """Compare with `exact` and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--triangles", type=int, default=125_000, help="of the largest scene (%(default)s)")
    parser.add_argument("--pixels", type=float, default=300.0, help="width of the mirror (%(default)s)")
    parser.add_argument("--views", type=int, default=8, help="around the mirror (%(default)s)")
    parser.add_argument("--margins", type=float, nargs=4, help="see Margins")
    options = parser.parse_args()
    require_gpu()
    margins = Margins(*options.margins) if options.margins else Margins()
    for count in (n for n in (1_000, 10_000, 125_000, 500_000, 2_000_000) if n <= options.triangles):
        compared = Compared(count, options.pixels, (640, 480))
        footprints = Footprints(compared.renderer, compared.materials, margins)
        total = Comparison(0, 0, 0, 0, 0)
        for number in range(options.views):
            one = compared.compare(number * 2.0 * np.pi / options.views, footprints)
            total = Comparison(*(getattr(total, name) + getattr(one, name) for name in Comparison.__dataclass_fields__))
        counts = ", ".join(f"{number:,} {name}" for name, number in footprints.counts.items())
        print(f"{footprints.triangles:,} triangles, {footprints.points:,} points solved; {counts}")
        print(
            f"   {total.pixels:,} mirror pixels, {total.hits:,} hits: {total.missing:,} missing, "
            f"{total.farther:,} too far, {total.nearer:,} too near",
            flush=True,
        )
        compared.renderer.free()


if __name__ == "__main__":
    main()
