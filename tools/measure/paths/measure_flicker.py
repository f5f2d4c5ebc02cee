# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether rough mirrors are calm while the view moves: how pixels change from frame to frame of a slow orbit.

    .venv/bin/python tools/measure/paths/measure_flicker.py [NAME ..] [--frames 12] [--step 0.25] [--samples 1024]
        [--keep DIR] [--sharp]

The camera goes round the vertical axis, `--step` degrees a frame. Ours is what a viewport shows while it moves: one
sub-frame, always the first. Cycles has `--samples` with the same seed in all frames. Of the pixels whose center shows
the mirror in both frames, a row tells by 1/255 of the display's range the largest of ours' change (and its 99.9th
percentile) where Cycles changes by less than 4, how many pixels change by more than 8 there, the same over all pixels
against Cycles' own change, and the mean error of the moving picture. `--sharp` draws one path in place of the blur.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from curvrefl.curvrefl_addon.report.images import save_png  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from mathutils import Matrix  # noqa: E402
from scenes.paths import SCENES  # noqa: E402
from scenes.paths.judged import cycles_picture, judged_pixels, read_open  # noqa: E402
from scenes.paths.registry import PathScene  # noqa: E402

STILL, FLICKER = 4.0, 8.0
SEED = 5


def moving_pictures(arrays: Any, views: list[View], sharp: bool) -> list[np.ndarray]:
    """(h, w, 4) scene-linear, what a viewport shows of one view after the other."""
    renderer = Renderer(arrays, Settings(method="exact", samples=1))
    pictures = []
    reflection = None
    for view in views:
        reflection = renderer.reflect(view, last=reflection)
        canvas = Canvas.of_size(view.width, view.height)
        renderer.add_sub_frame(canvas, replace(reflection, calm=None) if sharp else reflection, 0, 1.0)
        pictures.append(canvas.pixels())
    renderer.free()
    return pictures


def measure(scene: PathScene, options: argparse.Namespace) -> str:
    """Renders an orbit both ways and returns the row."""
    with dropped(STDOUT):
        scene.build()
        camera: Any = bpy.context.scene.camera
        start = camera.matrix_world.copy()
        views, cycles, masks = [], [], []
        for frame in range(options.frames):
            camera.matrix_world = Matrix.Rotation(np.radians(options.step * frame), 4, "Z") @ start
            opened = read_open(scene.mirrors)
            views.append(opened.view)
            cycles.append(cycles_picture(options.samples, SEED))
            masks.append(judged_pixels(scene.judged))
        ours = moving_pictures(opened.arrays, views, options.sharp)
    shown = [255.0 * display_transform(np.stack(pictures)[..., :3]) for pictures in (ours, cycles)]
    if options.keep is not None:
        options.keep.mkdir(parents=True, exist_ok=True)
        for frame in range(options.frames):
            save_png(options.keep / f"{scene.name}_{frame:02d}.png", np.hstack([ours[frame], cycles[frame]]))
    mask = np.stack(masks)
    both = mask[1:] & mask[:-1]
    change, right = (np.abs(np.diff(pictures, axis=0)).max(axis=-1)[both] for pictures in shown)
    still = change[right < STILL]
    error = np.abs(shown[0] - shown[1]).mean(axis=-1)[mask]
    return (
        f"| {scene.name} | {len(still)} of {len(change)} | {still.max():.1f} | {np.quantile(still, 0.999):.1f} | "
        f"{(still > FLICKER).sum()} | {change.mean():.2f} / {right.mean():.2f} | {error.mean():.1f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=["metal_02"])
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--step", type=float, default=0.25, help="degrees")
    parser.add_argument("--samples", type=int, default=1024, help="of Cycles")
    parser.add_argument("--keep", type=Path, help="folder for the frames, ours and Cycles side by side")
    parser.add_argument("--sharp", action="store_true", help="one path in place of the blur")
    options = parser.parse_args()
    require_gpu()
    print("| scene | pixels still in Cycles | largest change | 99.9 % | above 8 | mean change, ours / Cycles | error |")
    print("|---|---|---|---|---|---|---|")
    for name in options.names:
        print(measure(SCENES[name], options), flush=True)


if __name__ == "__main__":
    main()
