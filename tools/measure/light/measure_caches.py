# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two caches of the light between surfaces, by rays: the renderer's patches and a grid of probes (`probes.py`).

    .venv/bin/python tools/measure/light/measure_caches.py FILE.blend .. --reflector A[,B..] --output DIR

Judged where the mirrors show something: irradiance that comes from other surfaces at random places of what they show,
against the mean of paths from there. Caches and paths follow rays by one walk, and materials and lamps at their ends
are the same passes. Then two rooms with 5 cm of wall between them: how much of the lit one's light is in the dark one.
Prints a table and writes caches.csv and caches.png. Of the names of mirrors each file takes those that it has.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.renderer.cells.lookup import WALLS  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.indirect import points  # noqa: E402
from curvrefl.curvrefl_addon.renderer.indirect.indirect import BATCHES  # noqa: E402
from curvrefl.curvrefl_addon.renderer.indirect.irradiance import RAYS_AT_ONCE, Irradiance  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import open_blend  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_moments  # noqa: E402
from light.draw_caches import draw  # noqa: E402
from light.probes import TETRAHEDRON, ProbeGrid  # noqa: E402
from light.scene_rays import RAYS_OF_PLACE, SceneRays  # noqa: E402
from light.two_rooms import MIRROR, build_rooms, places_in  # noqa: E402
from mathutils.bvhtree import BVHTree  # noqa: E402

SIZE = (320, 240)
LIFT = 1e-4
"""How far off surfaces places are, in parts of how far the judged ones reach"""
JUDGED, COPIES = 400, 128
"""Places; how often each is among those that send rays at once"""
TRUE_BATCHES = 8
PATCHES = (3_000, 12_000, 48_000)
PATCH_BATCHES = (1, BATCHES, 16)
MOST_PATCH_BATCHES = 200_000
"""Patches times batches: more takes too long"""
PROBES = (6, 10, 16, 24)
"""Along the longest side"""
PROBE_BATCHES = (4, 16)
MOST_PROBE_RAYS = 1_500_000


class Row(NamedTuple):
    """One cache of one scene."""

    scene: str
    cache: str
    number: int
    """Patches or probes"""
    rays: int
    """Of all of them together"""
    off: float
    """Root mean square of the error, over the mean"""
    median: float
    """Of the errors in parts of what is right"""
    is_ours: bool = False
    """As the extension has it"""


class Judge(NamedTuple):
    """What is right at some places."""

    positions: np.ndarray
    normals: np.ndarray
    truth: np.ndarray
    noise: float
    """Of the truth itself, as `Row.off`"""

    def off(self, found: np.ndarray) -> tuple[float, float]:
        error = found.mean(axis=1) - self.truth.mean(axis=1)
        right = self.truth.mean(axis=1)
        median = float(np.median(np.abs(error) / np.maximum(right, 1e-3 * right.mean())))
        return float(np.sqrt((error**2).mean()) / right.mean()), median


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--reflector", required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    require_gpu()
    rows: list[Row] = []
    noises: dict[str, float] = {}
    for file in arguments.files:
        open_blend(file)
        names = [name for name in arguments.reflector.split(",") if name in bpy.data.objects]
        renderer, frame = drawn(names)
        judged = shown_places(renderer.scene, frame)
        reach = float(np.ptp(judged[0], axis=0).max())
        rays = SceneRays(renderer, LIFT * reach)
        judge = judged_places(rays, *judged, reach)
        noises[file.stem] = judge.noise
        print(f"{file.stem}: {JUDGED} places, noise of the truth {100 * judge.noise:.1f} %", flush=True)
        for row in (*of_patches(rays, judge, file.stem), *of_probes(rays, judge, file.stem)):
            rows.append(row)
            ours = " (ours)" if row.is_ours else ""
            print(
                f"| {row.cache}{ours} | {row.number:,} | {row.rays:,} | {row.off:.3f} | {row.median:.3f} |", flush=True
            )
        print(f"A ray of either takes {1e9 * rays.seconds / rays.rays_followed:.0f} ns", flush=True)
        renderer.free()
    measure_leaks()
    arguments.output.mkdir(parents=True, exist_ok=True)
    with (arguments.output / "caches.csv").open("w", newline="", encoding="utf-8") as held:
        writer = csv.writer(held)
        writer.writerow(Row._fields)
        writer.writerows(rows)
    draw(rows, noises, arguments.output / "caches.png")


def drawn(names: list[str]) -> tuple[Renderer, Any]:
    """The open file in full light, and its picture."""
    context: Any = bpy.context
    still, _, _ = read_render_moments(context.scene, context.view_layer, names, *SIZE, 16, None)
    renderer = Renderer(still.scene, Settings(method="exact", samples=16))
    frame = renderer.render(still.view)
    if renderer._appearance.indirect.irradiance is None:
        raise SystemExit(f"No light goes between the surfaces of this scene: {renderer.bounced_light}.")
    return renderer, frame


def shown_places(scene: SceneArrays, frame: Any) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) random places that mirrors show, and normals of their triangles towards there."""
    shown, ids = frame.reflected_position(), frame.reflected_object()
    chosen = np.flatnonzero((ids > 0) & ~np.isin(ids, list(scene.reflectors)))
    chosen = np.random.default_rng(3).choice(chosen, JUDGED, replace=len(chosen) < JUDGED)
    places = shown.reshape(-1, 4)[chosen, :3].astype(np.float64)
    mirrors = frame.reflector_position().reshape(-1, 3)[chosen]
    tree = tree_of(scene)
    normals = np.array([tuple(tree.find_nearest(place.tolist())[1]) for place in places])
    normals *= np.where(((mirrors - places) * normals).sum(axis=1) < 0.0, -1.0, 1.0)[:, None]
    return places, normals


def tree_of(scene: SceneArrays) -> Any:
    """Of all triangles."""
    corners = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        world = mesh.positions.astype(np.float64) @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        corners.append(world[mesh.corner_vertex[mesh.triangles]].reshape(-1, 3))
    vertices = np.concatenate(corners)
    return BVHTree.FromPolygons(vertices.tolist(), np.arange(len(vertices)).reshape(-1, 3).tolist())


def judged_places(rays: SceneRays, positions: np.ndarray, normals: np.ndarray, reach: float) -> Judge:
    """With the mean of paths; where these begin inside of something they say nothing, and such places are left out."""
    lifted = positions + LIFT * reach * normals
    places, facing = np.tile(lifted, (COPIES, 1)), np.tile(normals, (COPIES, 1))
    chance = np.random.default_rng(4)
    found = [gathered(rays, places, facing, batch, rays.bounces, chance) for batch in range(TRUE_BATCHES)]
    each = np.stack(found).reshape(TRUE_BATCHES * COPIES, JUDGED, 3)
    truth = each.mean(axis=0)
    error = each.mean(axis=2).std(axis=0) / np.sqrt(len(each))
    return Judge(lifted, normals, truth, float(np.sqrt((error**2).mean()) / truth.mean()))


def gathered(
    rays: SceneRays, places: np.ndarray, normals: np.ndarray, batch: int, bounces: int, chance: np.random.Generator
) -> np.ndarray:
    """(n, 3) irradiance from other surfaces, off so many of them: by RAYS_OF_PLACE rays, of which one goes on."""
    hits = rays.follow(places, normals, batch, with_emitters=True)
    found = hits.shone.mean(axis=1)
    if bounces == 0:
        return found
    positions, facing = hits.positions.reshape(-1, 3), hits.normals.reshape(-1, 3)
    lights = range(2 * batch, 2 * batch + 2) if 2 * TRUE_BATCHES % rays.lights == 0 else range(rays.lights)
    arriving = rays.lit(positions, facing, lights)
    # (As many rays again; those that go on stand for all.)
    chosen = chance.permutation(len(positions))[: len(places)]
    arriving[chosen] += RAYS_OF_PLACE * gathered(rays, positions[chosen], facing[chosen], batch, bounces - 1, chance)
    sent = hits.albedo * arriving.reshape(hits.albedo.shape)
    return found + sent.mean(axis=1)


def of_patches(rays: SceneRays, judge: Judge, scene: str) -> Iterator[Row]:
    """At several sizes and numbers of rays."""
    for wanted in PATCHES:
        batches = [batch for batch in PATCH_BATCHES if batch * wanted <= MOST_PATCH_BATCHES]
        for done, irradiance in patches(rays, wanted, batches):
            found = rays.read_patches(irradiance, judge.positions, judge.normals)
            kinds = 1 if rays.indirect.emitters is None else 2
            count = irradiance.patches.count
            followed = count * (WALLS + kinds * RAYS_AT_ONCE * done)
            yield Row(scene, "patches", count, followed, *judge.off(found), done == BATCHES and wanted == PATCHES[1])


def patches(rays: SceneRays, wanted: int, batches: list[int]) -> Iterator[tuple[int, Irradiance]]:
    """The renderer's own, about so many, after each of these numbers of batches."""
    before = (points.LEAST_PATCHES, points.WANTED_PATCHES, points.MOST_PATCHES)
    points.LEAST_PATCHES, points.WANTED_PATCHES, points.MOST_PATCHES = wanted // 2, wanted, 2 * wanted
    try:
        found = None
        for step in rays.indirect._place():
            found = step
    finally:
        points.LEAST_PATCHES, points.WANTED_PATCHES, points.MOST_PATCHES = before
    assert found is not None
    irradiance = Irradiance(*found)
    irradiance.find_walls(rays.rays)
    irradiance.light(rays.lighting, rays.lights)
    means = (rays.rays, rays.materials, rays.lighting, rays.view_uniforms, rays.indirect.emitters, rays.has_caustics)
    for batch in range(1, max(batches) + 1):
        for _ in irradiance.follow_rays(*means):
            pass
        if batch in batches:
            irradiance.sweep(rays.bounces)
            yield batch, irradiance


def of_probes(rays: SceneRays, judge: Judge, scene: str) -> Iterator[Row]:
    """Grids about all that is judged and nine tenths of what lights it."""
    hits = rays.follow(judge.positions, judge.normals, 0, with_emitters=False)
    met = hits.positions[np.isfinite(hits.ranges)]
    low, high = np.quantile(met, (0.05, 0.95), axis=0)
    low, high = np.minimum(low, judge.positions.min(axis=0)), np.maximum(high, judge.positions.max(axis=0))
    for along in PROBES:
        for batches in PROBE_BATCHES:
            grid = ProbeGrid(low, high, along)
            if grid.count * batches * len(TETRAHEDRON) * RAYS_OF_PLACE > MOST_PROBE_RAYS:
                continue
            followed = grid.fill(rays, batches)
            yield Row(scene, "probes", grid.count, followed, *judge.off(grid.at(judge.positions, judge.normals)))


def measure_leaks() -> None:
    """Light in the dark one of two rooms, in parts of that in the lit one; on the mean and where it is most."""
    build_rooms()
    renderer, _ = drawn([MIRROR])
    rays = SceneRays(renderer, LIFT)
    dark, lit = (places_in(is_dark, 10 * JUDGED, 1e-3) for is_dark in (True, False))
    print("Two rooms:", flush=True)

    def say(cache: str, count: int, in_dark: np.ndarray, in_lit: np.ndarray) -> None:
        parts = in_dark.mean(axis=1) / in_lit.mean()
        print(f"| {cache} | {count:,} | mean {parts.mean():.5f} | most {parts.max():.4f} |", flush=True)

    for wanted in PATCHES:
        for _, irradiance in patches(rays, wanted, [BATCHES]):
            found = [rays.read_patches(irradiance, *places) for places in (dark, lit)]
            say("patches", irradiance.patches.count, *found)
    everywhere = np.concatenate([dark[0], lit[0]])
    for along in PROBES:
        grid = ProbeGrid(everywhere.min(axis=0), everywhere.max(axis=0), along)
        grid.fill(rays, PROBE_BATCHES[0])
        say("probes", grid.count, grid.at(*dark), grid.at(*lit))
    renderer.free()


if __name__ == "__main__":
    main()
