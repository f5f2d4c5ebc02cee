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
from dataclasses import replace
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
from curvrefl.curvrefl_addon.renderer.device.records import read_records  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.split import number_pairs  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.curved_edges import _Cutting  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import Float64Array, SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, find_reflectors, open_blend, view_of_camera  # noqa: E402
from edges.judge import NEAR, VIEWS, Judge, Seen, numbers, turned  # noqa: E402
from edges.six_node import measure_six_node  # noqa: E402

WIDTH, HEIGHT = 640, 480
COARSE = 1e6
"""Pixels: the bound splits to the largest angle that it allows"""
REPEATS = 3
WAYS = {"bound": (1.0, False), "bound, midpoints": (1.0, True), "midpoints alone": (COARSE, True)}
"""Tolerance of the bound over that asked for; whether midpoints are solved"""


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
