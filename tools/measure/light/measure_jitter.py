# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether light between surfaces is calm while the view moves: how it changes at the same places in a slow orbit.

    .venv/bin/python tools/measure/light/measure_jitter.py FILE.blend --reflector A[,B..] [--step 0.1] [--frames 12]

The camera goes round the vertical axis through the mirrors' middle, `--step` degrees a frame; pictures are what a
viewport shows while it moves, one sub-frame, always the first. All but mirrors and what shines is made plain gray, so
that textures, whose texels jump, are not taken for light; *light* is the picture less that of the same view without
bounces. A pixel is compared with the one of the next frame that shows the same place best, seen itself or in a mirror,
where the two places are less than a tenth of a pixel apart, and a row each of so many meters. The change is what the
light's change makes of the displayed picture, by the sRGB curve. Places are never quite the same: beside it stands what
the change from each pixel to the next in one frame explains of it, and what that leaves. Then patches are read at fixed
places after each frame: what changes there is the cache's own.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.demo.data_blocks import principled  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from light.given_file import GivenFile, file_parser  # noqa: E402
from light.scene_rays import SceneRays  # noqa: E402
from mathutils import Matrix  # noqa: E402
from mathutils.kdtree import KDTree  # noqa: E402

NEAR_PIXELS, NEAR = 0.1, (0.01, 0.001)
"""Shares of a pixel; meters, of which there is a row each"""
MOST_WAY = 12
"""Pixels between two frames"""
FIXED = 20_000
"""Places whose patches are read"""


class Shown(NamedTuple):
    """One frame, a row for each pixel that shows something."""

    bare: np.ndarray
    """Color without bounces, scene-linear"""
    light: np.ndarray
    """What bounces add"""
    places: np.ndarray
    """Of what is shown, world space"""
    normals: np.ndarray
    """Of what is seen itself; 0 in mirrors"""
    spacing: np.ndarray
    """How far the nearest neighbor's place is"""
    gradient: np.ndarray
    """How much the neighbor's light would change the display, 1/255"""
    is_mirror: np.ndarray
    pixels: np.ndarray
    """(n, 2)"""


def main() -> None:
    parser = file_parser(__doc__)
    parser.add_argument("--step", type=float, default=0.1, help="degrees")
    parser.add_argument("--frames", type=int, default=12)
    arguments = parser.parse_args()
    given = GivenFile(arguments)
    make_plain(given.names)
    still = given.read()
    settings = Settings(method="exact", samples=16)
    lit = Renderer(still.scene, settings)
    bare = Renderer(replace(still.scene, diffuse_bounces=0), settings)
    placed = [item.matrix[:3, 3] for item in still.scene.instances if item.object_id in still.scene.reflectors]
    middle = np.mean(placed, axis=0)
    views = [turned(still.view, middle, arguments.step * frame) for frame in range(arguments.frames)]
    pairs: dict[str, list[np.ndarray]] = {"seen itself": [], "in mirrors": []}
    read: list[np.ndarray] = []
    places: tuple[np.ndarray, np.ndarray] | None = None
    last: Shown | None = None
    held: list[Reflection | None] = [None, None]
    for view in views:
        shown, held = drawn(lit, bare, view, held)
        if places is None:
            chosen = np.random.default_rng(2).permutation(np.flatnonzero(~shown.is_mirror))[:FIXED]
            places = shown.places[chosen], shown.normals[chosen]
        irradiance = lit._appearance.indirect.irradiance
        if irradiance is None:
            raise SystemExit(f"No light goes between the surfaces of this scene: {lit.bounced_light}.")
        read.append(SceneRays(lit, 0.0).read_patches(irradiance, *places))
        if last is not None:
            for name, wanted in (("seen itself", False), ("in mirrors", True)):
                pairs[name].append(compared(last, shown, wanted))
        last = shown
    print(f"{arguments.file.name}, {arguments.frames} frames, {arguments.step} degrees each; by 1/255 of the display:")
    print("| | closer than, m | pixels | median | p99 | over 1 | explained, p99 | left, p99 |")
    for name, parts in pairs.items():
        whole = np.concatenate(parts)
        for near in NEAR:
            change, away, slope, _ = whole[whole[:, 3] < near].T
            if len(change):
                half, most = np.quantile(change, (0.5, 0.99))
                over, explained = 100.0 * (change > 1.0).mean(), away * slope
                row = f"{len(change):,} | {half:.3f} | {most:.3f} | {over:.2f} %"
                left = np.quantile(np.maximum(change - explained, 0.0), 0.99)
                print(f"| {name} | {near} | {row} | {np.quantile(explained, 0.99):.3f} | {left:.3f} |", flush=True)
    off = max(float(np.abs(one - read[0]).max()) for one in read)
    print(f"Patches read at {len(read[0]):,} fixed places: largest change {off:g} of a mean of {read[0].mean():.3g}")


def make_plain(mirrors: list[str]) -> None:
    """The open scene, but for the mirrors and what shines."""
    gray = principled("plain", (0.5, 0.5, 0.5), roughness=1.0, sockets={"Specular IOR Level": 0.0})
    for thing in bpy.data.objects:
        for slot in thing.material_slots if thing.name not in mirrors else ():
            if slot.material is None or not shines(slot.material):
                slot.material = gray


def shines(material: Any) -> bool:
    nodes = [] if material.node_tree is None else material.node_tree.nodes
    strengths = [node.inputs["Emission Strength"] for node in nodes if "Emission Strength" in node.inputs]
    return any(node.type == "EMISSION" for node in nodes) or any(
        strength.is_linked or strength.default_value > 0.0 for strength in strengths
    )


def turned(view: View, middle: np.ndarray, degrees: float) -> View:
    """Seen from farther round."""
    turn = np.array(Matrix.Rotation(-np.radians(degrees), 4, "Z"))
    turn[:3, 3] = middle - turn[:3, :3] @ middle
    return replace(view, world_to_view=view.world_to_view @ turn)


def drawn(
    lit: Renderer, bare: Renderer, view: View, held: list[Reflection | None]
) -> tuple[Shown, list[Reflection | None]]:
    """With bounces and without; `held`: the last reflections of the two."""
    pictures: list[np.ndarray] = []
    reflections = []
    for renderer, before in zip((lit, bare), held, strict=True):
        reflection = renderer.reflect(view, last=before)
        canvas = Canvas.of_size(view.width, view.height)
        renderer.add_sub_frame(canvas, reflection, 0, 1.0)
        pictures.append(canvas.pixels()[..., :3])
        reflections.append(reflection)
    # (The first sub-frame looks through another place in the pixels than their middles.)
    dx, dy = lit._jitter[0]
    surfaces = lit.surfaces_of(replace(reflections[0], view=reflections[0].view.jittered(-dx, -dy)))
    seen, reflected = surfaces["seen_position"], surfaces["reflected_position"]
    mirror = surfaces["seen_color"][..., 3] > 0.5
    places = np.where(mirror[..., None], reflected[..., :3], seen[..., :3]).astype(np.float64)
    thing = np.where(mirror, np.rint(reflected[..., 3]), np.rint(seen[..., 3]))
    light = pictures[0] - pictures[1]
    steps = [np.roll(places, step, axis=axis) - places for axis in (0, 1) for step in (1, -1)]
    # (The nearest one's: where something ends the others are far away.)
    spacing = np.min([np.linalg.norm(step, axis=-1) for step in steps], axis=0)
    gradient = np.maximum(*(display_change(pictures[1], light, np.roll(light, -1, axis=axis)) for axis in (0, 1)))
    # (Of neighbors that show the same thing alone it is known how far apart places are. What mirrors show of mirrors is
    # light from elsewhere.)
    kept = (thing > 0.0) & ~(mirror & np.isin(thing, list(lit.scene.reflectors)))
    for axis in (0, 1):
        for step in (1, -1):
            kept &= (np.roll(thing, step, axis=axis) == thing) & (np.roll(mirror, step, axis=axis) == mirror)
    normals = np.where(mirror[..., None], 0.0, surfaces["seen_normal"][..., :3])
    pixels = np.moveaxis(np.indices(mirror.shape), 0, -1)
    fields = (pictures[1], light, places, normals, spacing, gradient, mirror, pixels)
    return Shown(*(field[kept] for field in fields)), list(reflections)


def display_change(bare: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The largest of the channels, by 1/255, where the same picture has one light and another."""
    shown = [display_transform((bare + light).astype(np.float32)) for light in (before, after)]
    return 255.0 * np.abs(shown[1] - shown[0]).max(axis=-1)


def compared(last: Shown, shown: Shown, in_mirrors: bool) -> np.ndarray:
    """(n, 4) of places that both frames show: the change of their light, how far apart they are in pixels, how much
    light changes from there to the next pixel, and how far apart they are in meters."""
    old, new = np.flatnonzero(last.is_mirror == in_mirrors), np.flatnonzero(shown.is_mirror == in_mirrors)
    tree = KDTree(len(new))
    for number, place in enumerate(shown.places[new].tolist()):
        tree.insert(place, number)
    tree.balance()
    found = [tree.find(place)[1:] for place in last.places[old].tolist()] if len(new) else []
    if not found:
        return np.empty((0, 4))
    numbers, away = (np.array(part) for part in zip(*found, strict=True))
    share = away / np.maximum(last.spacing[old], 1e-12)
    # (What is far off in the picture is another image of the same place.)
    way = np.abs(shown.pixels[new[numbers.astype(np.int64)]] - last.pixels[old]).max(axis=1)
    near = (share < NEAR_PIXELS) & (away < max(NEAR)) & (way < MOST_WAY)
    pair, other = old[near], new[numbers[near].astype(np.int64)]
    change = display_change(last.bare[pair], last.light[pair], shown.light[other])
    return np.stack([change, share[near], last.gradient[pair], away[near]], axis=1)


if __name__ == "__main__":
    main()
