# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far straight edges are from the reflections that they stand for, and what splitting them takes.

    python tools/measure/measure_edges.py SCENES/sphere.blend .. [--method newton] [--tolerances 2,1,0.5,0.25]
        [--map 256] [--six-node]

Four views of each scene, 640 x 480: the camera's, turned by 90 and 200 degrees about the mirror, and by 300 degrees at
0.6 of the distance. Three ways to split: by the bound that knows no eye (`split.py`: all that is done while a view
moves), by it and then by solved midpoints (`curved_edges.py`: at rest), and by solved midpoints alone, from edges that
span half a radian.

*Edges*: both ends and the midpoint are reflected, one of them at a pixel of the mirror; pixels between where the solved
midpoint is seen and where it is drawn. *Pixels*: how far from its own reflection point is what a mirror pixel shows.
*Wrong*: mirror pixels that show another object than a followed ray finds. *Solves* are vertices and midpoints,
*ms* processor time of splitting and solving all of it afresh, least of three. Points are judged by `newton` on the same
map to 0.02 pixels, pixels from their own point on, so that the map's error is not in it.

`--six-node`: on the meshes of the first way, triangles with a side of four pixels or more whose corners and midpoints
are all reflected; errors where sides are quartered and inside, of the straight triangle, of the four straight ones and
of the quadratic patch through the same six points.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.optics import status  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.records import read_records, record_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.split import number_pairs  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.baked_shape import BakedShape  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.curved_edges import _Cutting  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, Float64Array, SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.blend_file import find_camera, find_reflectors, open_blend, view_of_camera  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.view import View  # noqa: E402

VIEWS = ((0.0, 1.0), (90.0, 1.0), (200.0, 1.0), (300.0, 0.6))
"""Degrees about the mirror's vertical axis, share of the camera's distance"""
WIDTH, HEIGHT = 640, 480
JUDGED_TO = 0.02
"""Pixels"""
NEAR = 0.1
"""Of the mirror's size: a point is seen at a pixel whose own point is nearer"""
COARSE = 1e6
"""Pixels: the bound splits to the largest angle that it allows"""
REPEATS = 3
LONG = 4.0
"""Pixels of a triangle's longest side, for --six-node"""
WAYS = {"bound": (1.0, False), "bound, midpoints": (1.0, True), "midpoints alone": (COARSE, True)}
"""Tolerance of the bound over that asked for; whether midpoints are solved"""


class Judge:
    """Reflection points in one view by `newton`, better than anything that is measured."""

    def __init__(self, mirror: Mirror, shape: BakedShape, view: View) -> None:
        self.view = view
        self._reflector = Reflector(shape.world_to_map, shape.bound, {"radial": shape.radial}, mirror.side(view, shape))

    def points(self, places: Float64Array, start: Float64Array | None = None) -> tuple[Float64Array, np.ndarray]:
        """P (n, 3) of world places (n, 3), searched for from `start`, and whether (n,) each is reflected."""
        before = None
        if start is not None:
            texture = _records(start)
            before = VertexSolution(texture, texture, len(start))
        solution = solve_vertices(
            "newton", self.view, self._reflector, _records(places), len(places), tolerance=JUDGED_TO, previous=before
        )
        points, code, _, _ = solution.read()
        return points.astype(np.float64), code == status.REFLECTED


def _records(places: np.ndarray) -> Any:
    records = np.zeros((len(places), 4), np.float32)
    records[:, :3] = places
    return record_texture(records)


@dataclass(frozen=True)
class Seen:
    """What mirror pixels show."""

    view: View
    surfaces: dict[str, Float32Array]
    near: float

    @property
    def mirror(self) -> np.ndarray:
        """(h, w)"""
        return self.surfaces["seen_color"][..., 3] > 0.5

    @property
    def objects(self) -> np.ndarray:
        """(h, w) shown by mirror pixels, 0 elsewhere and for the background."""
        return np.where(self.mirror, np.rint(self.surfaces["reflected_position"][..., 3]), 0).astype(int)

    def shows(self, points: Float64Array) -> np.ndarray:
        """(n,) whether points of the mirror (n, 3) are at a pixel of it."""
        pixels = np.floor(self.view.project(points))
        inside = ((pixels >= 0.0) & (pixels < (self.view.width, self.view.height))).all(axis=1)
        column, row = np.where(inside[:, None], pixels, 0.0).astype(int).T
        off = np.linalg.norm(self.surfaces["seen_position"][row, column, :3] - points, axis=1)
        return inside & self.mirror[row, column] & (off < self.near)

    def errors(self, judge: Judge) -> Float64Array:
        """(n,) pixels, of those that show an object."""
        shown = self.objects > 0
        points, is_reflected = judge.points(
            self.surfaces["reflected_position"][shown][:, :3].astype(np.float64),
            self.surfaces["seen_position"][shown][:, :3].astype(np.float64),
        )
        row, column = np.nonzero(shown)
        off = self.view.project(points) - np.column_stack([column + 0.5, row + 0.5])
        return np.linalg.norm(off, axis=1)[is_reflected]


def turned(view: View, center: Float64Array, degrees: float, closer: float) -> View:
    """The eye turned about the vertical axis through `center`, then brought closer to it."""
    angle = np.radians(degrees)
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    turn[:3, 3] = center - turn[:3, :3] @ center
    world_to_view = view.world_to_view @ np.linalg.inv(turn)
    world_to_view[:3, 3] -= (1.0 - closer) * (world_to_view @ np.append(center, 1.0))[:3]
    return replace(view, world_to_view=world_to_view)


@contextmanager
def counted() -> Iterator[list[int]]:
    """Midpoints that are solved."""
    counts: list[int] = []
    act = _Cutting._middles

    def count(cutting: _Cutting, pairs: np.ndarray) -> Any:
        counts.append(len(pairs))
        return act(cutting, pairs)

    with patch.object(_Cutting, "_middles", count):
        yield counts


def coarser(factor: float) -> Any:
    """The bound asked for another tolerance than what is drawn."""
    act = Mirror.sight
    return patch.object(
        Mirror, "sight", lambda mirror, view, tolerance, shape: act(mirror, view, factor * tolerance, shape)
    )


def edge_errors(reflection: Reflection, judge: Judge, seen: Seen) -> tuple[Float64Array, int]:
    """(n,) pixels from solved to drawn midpoints of seen edges of all first images, and the number of triangles."""
    found, count = [], 0
    for part in (part for part in reflection.parts[0] if part.image == 0):
        points, code, _, virtual = part.solution.read()
        places = part.places
        count += len(places)
        _, pairs = number_pairs(places.ravel(), places[:, [1, 2, 0]].ravel(), 0)
        pairs = pairs[(code[pairs] == status.REFLECTED).all(axis=1)]
        world = read_records(part.chunk.positions, part.solution.count)[:, :3].astype(np.float64)
        middles, is_reflected = judge.points(world[pairs].mean(axis=1), points[pairs].mean(axis=1))
        shown = seen.shows(points.astype(np.float64))
        chosen = is_reflected & (shown[pairs].any(axis=1) | seen.shows(middles))
        drawn = virtual[pairs[chosen], :3].astype(np.float64).mean(axis=1)
        off = judge.view.project(middles[chosen]) - judge.view.project(drawn)
        found.append(np.linalg.norm(off, axis=1))
    return np.concatenate(found), count


def numbers(values: Float64Array, percents: tuple[float, ...]) -> str:
    return " ".join(f"{value:7.3f}" for value in np.percentile(values, percents))


def measure(arrays: SceneArrays, camera: View, settings: Settings, way: str) -> str:
    """One line: a way to split, all views together."""
    factor, at_rest = WAYS[way]
    renderer = Renderer(arrays, settings)
    rays = Renderer(arrays, replace(settings, method="exact"))
    mirror = renderer.mirrors[0]
    shape = mirror.shape(settings.map_resolution)
    edges, pixels, wrong = [], [], []
    triangles = vertices = middles = 0
    milliseconds = 0.0
    with coarser(factor):
        for degrees, closer in VIEWS:
            view = turned(camera, shape.center, degrees, closer)
            # Split, and shaders compiled.
            renderer.reflect(view, at_rest=at_rest)
            times = []
            for _ in range(REPEATS):
                start = process_time()
                with counted() as counts:
                    reflection = renderer.reflect(view, at_rest=at_rest)
                    for solution in reflection.solutions:
                        solution.wait()
                times.append(process_time() - start)
            milliseconds += 1e3 * min(times) / len(VIEWS)
            vertices += sum(chunk.position_count for chunk, _ in renderer.geometry.scenery(mirror.index))
            middles += sum(counts)
            judge = Judge(mirror, shape, view)
            seen = Seen(view, renderer.surfaces_of(reflection), NEAR * shape.bound)
            truth = Seen(view, rays.surfaces_of(rays.reflect(view)), NEAR * shape.bound)
            off, count = edge_errors(reflection, judge, seen)
            triangles += count
            edges.append(off)
            pixels.append(seen.errors(judge))
            wrong.append((seen.objects != truth.objects)[seen.mirror])
    renderer.free()
    rays.free()
    edge, pixel = np.concatenate(edges), np.concatenate(pixels)
    tolerance = settings.pixel_tolerance
    share = len(VIEWS)
    return (
        f"{tolerance:5g} {way:17} {triangles // share:9} {(vertices + middles) // share:7} {milliseconds:6.0f}   "
        f"{numbers(edge, (50, 99, 100))} {(edge > tolerance).mean():6.2%}   {numbers(pixel, (50, 95, 99, 99.9))} "
        f"{(pixel > tolerance).mean():6.2%} {np.concatenate(wrong).mean():6.3%}"
    )


def measure_six_node(arrays: SceneArrays, camera: View, settings: Settings) -> str:
    """One line: straight triangles and quadratic patches through the same points."""
    renderer = Renderer(arrays, settings)
    mirror = renderer.mirrors[0]
    shape = mirror.shape(settings.map_resolution)
    found: dict[str, list[Float64Array]] = {"straight": [], "four straight": [], "six-node": []}
    solves = count = 0
    for degrees, closer in VIEWS:
        view = turned(camera, shape.center, degrees, closer)
        reflection = renderer.reflect(view)
        judge = Judge(mirror, shape, view)
        seen = Seen(view, renderer.surfaces_of(reflection), NEAR * shape.bound)
        for part in (part for part in reflection.parts[0] if part.image == 0):
            points, code, _, _ = part.solution.read()
            world = read_records(part.chunk.positions, part.solution.count)[:, :3].astype(np.float64)
            places = part.places
            pixels = view.project(points.astype(np.float64))
            sides = np.linalg.norm(pixels[places] - pixels[places[:, [1, 2, 0]]], axis=2)
            chosen = (code[places] == status.REFLECTED).all(axis=1) & (sides.max(axis=1) >= LONG)
            chosen &= seen.shows(points.astype(np.float64))[places].any(axis=1)
            corners = world[places[chosen]]
            nodes = np.concatenate([corners, 0.5 * (corners + corners[:, [1, 2, 0]])], axis=1)
            solves += len(np.unique(nodes.reshape(-1, 3).round(5), axis=0))
            at_nodes = _virtual(judge, nodes)
            at_samples = _virtual(judge, np.einsum("sk,nkc->nsc", SAMPLES, corners))
            usable = np.isfinite(at_nodes).all(axis=(1, 2)) & np.isfinite(at_samples).all(axis=(1, 2))
            count += int(usable.sum())
            truth = view.project(at_samples[usable].reshape(-1, 3))
            for name, weights in (("straight", CORNERS), ("four straight", HALVES), ("six-node", QUADRATIC)):
                drawn = np.einsum("sk,nkc->nsc", weights, at_nodes[usable]).reshape(-1, 3)
                found[name].append(np.linalg.norm(view.project(drawn) - truth, axis=1))
    renderer.free()
    errors = "   ".join(numbers(np.concatenate(parts), (50, 99, 99.9)) for parts in found.values())
    return f"{settings.pixel_tolerance:5g} {count // len(VIEWS):9} {solves // len(VIEWS):7}   {errors}"


def _virtual(judge: Judge, places: Float64Array) -> Float64Array:
    """(n, k, 3) where places (n, k, 3) seem to be, NaN where they are not reflected."""
    flat = places.reshape(-1, 3)
    points, is_reflected = judge.points(flat)
    eye = judge.view.eye
    to_eye = eye[:3] - points * eye[3]
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    virtual = points - np.linalg.norm(flat - points, axis=1, keepdims=True) * to_eye
    return np.where(is_reflected[:, None], virtual, np.nan).reshape(places.shape)


def _samples() -> Float64Array:
    """(9, 3) barycentric: the quarters of the sides, and half way from each corner's to the opposite midpoint."""
    lattice = [(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]
    return np.array([weights for weights in lattice if any(weight % 2 for weight in weights)]) / 4.0


def _quadratic(samples: Float64Array) -> Float64Array:
    """(s, 6) shape functions of corners and of the midpoints of the sides 01, 12, 20."""
    a, b, c = samples.T
    return np.column_stack([*(x * (2.0 * x - 1.0) for x in (a, b, c)), 4.0 * a * b, 4.0 * b * c, 4.0 * c * a])


def _halves(samples: Float64Array) -> Float64Array:
    """(s, 6) weights in the four triangles of corners and midpoints: barycentric in the one that holds the sample."""
    corner = samples.argmax(axis=1)
    at_corner = samples.max(axis=1) >= 0.5
    weights = np.zeros((len(samples), 6))
    for row, (sample, k, near) in enumerate(zip(samples, corner, at_corner, strict=True)):
        if near:
            rest = [(k + 1) % 3, (k + 2) % 3]
            weights[row, k] = 2.0 * sample[k] - 1.0
            weights[row, 3 + k], weights[row, 3 + (k + 2) % 3] = 2.0 * sample[rest[0]], 2.0 * sample[rest[1]]
        else:
            weights[row, [4, 5, 3]] = 1.0 - 2.0 * sample
    return weights


SAMPLES = _samples()
CORNERS = np.column_stack([SAMPLES, np.zeros((len(SAMPLES), 3))])
HALVES, QUADRATIC = _halves(SAMPLES), _quadratic(SAMPLES)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--reflector", default="Mirror")
    parser.add_argument("--method", default="newton", choices=("newton", "secant_star"))
    parser.add_argument("--tolerances", default="2,1,0.5,0.25")
    parser.add_argument("--map", type=int, default=256, help="texels along an edge of the radial map")
    parser.add_argument("--six-node", action="store_true")
    options = parser.parse_args()
    require_gpu()
    for path in options.files:
        open_blend(path)
        scene = bpy.context.scene
        assert scene is not None
        reflectors = find_reflectors(scene, [options.reflector])
        arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, reflectors)
        camera = view_of_camera(scene, find_camera(scene), WIDTH, HEIGHT)
        print(f"{path.stem}, {options.method}")
        if options.six_node:
            print(f"{'px':>5} triangles  solves   p50, p99, p99.9: straight, four straight, six-node")
        else:
            print(
                f"{'px':>5} {'split by':17} triangles  solves     ms   edges: p50     p99     max   over   "
                "pixels: p50     p95     p99   p99.9   over  wrong"
            )
        for tolerance in (float(number) for number in options.tolerances.split(",")):
            settings = Settings(method=options.method, samples=1, pixel_tolerance=tolerance, map_resolution=options.map)
            if options.six_node:
                print(measure_six_node(arrays, camera, settings), flush=True)
                continue
            for way in WAYS:
                print(measure(arrays, camera, settings, way), flush=True)


if __name__ == "__main__":
    main()
