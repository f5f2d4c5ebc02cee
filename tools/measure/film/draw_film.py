# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE alone, the film, and Cycles side by side, with depth of field, and how far the mirrors of each are from Cycles.

    .venv/bin/python tools/measure/film/draw_film.py FILE.blend A[,B] OUT.jpg [--size 320x240] [--samples 160]
        [--sub-frames 96] [--eevee-samples 16] [--focus OBJECT] [--fstop 0.8]

Prints FLIP over the pixels that the film changes, but for those at their edges, which show what is behind the mirrors
as well: of EEVEE, of the film, and of the picture of the engine Curvrefl.
Needs Pillow and flip-evaluator.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import open_scene, registered, start_gpu  # noqa: E402
from curvrefl.curvrefl_addon.film.film import EEVEE, set_up  # noqa: E402
from curvrefl.curvrefl_addon.options import marked_mirrors  # noqa: E402
from curvrefl.curvrefl_addon.report.as_shown import save_as_shown  # noqa: E402
from curvrefl.curvrefl_addon.report.images import load_exr  # noqa: E402
from curvrefl.curvrefl_addon.report.measured_frame import image_error  # noqa: E402
from curvrefl.curvrefl_addon.streams import STDOUT, dropped  # noqa: E402
from PIL import Image  # noqa: E402

QUALITY = 88
EDGE = 6
"""Pixels; what blurs edges in the pictures of the documents reaches less far"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("reflectors")
    parser.add_argument("output", type=Path)
    parser.add_argument("--size", default="320x240", help="of each picture")
    parser.add_argument("--samples", type=int, default=160, help="of Cycles")
    parser.add_argument("--sub-frames", type=int, default=96, help="of the mirrors")
    parser.add_argument("--eevee-samples", type=int, default=16)
    parser.add_argument("--focus", help="name of the object in focus; without depth of field if not given")
    parser.add_argument("--fstop", type=float, default=0.8)
    parser.add_argument("--keep", type=Path, help="folder for the pictures, scene-linear")
    arguments = parser.parse_args()
    start_gpu()
    scene: Any = open_scene(arguments.file)
    with registered(), tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or Path(temporary)
        _prepare(scene, arguments)
        pictures = {"EEVEE": _picture(scene, EEVEE, folder / "eevee.exr")}
        set_up(scene)
        pictures["film"] = _picture(scene, EEVEE, folder / "film.exr")
        scene.render.use_compositing = False
        pictures["render"] = _picture(scene, "CURVREFL", folder / "render.exr")
        pictures["Cycles"] = _picture(scene, "CYCLES", folder / "cycles.exr")
        changed = _inside((pictures["film"] != pictures["EEVEE"]).any(axis=2))
        for name in ("EEVEE", "film", "render"):
            print(f"{name}: FLIP {image_error(pictures[name], pictures['Cycles'], changed)['flip']:.4f}")
        columns = []
        for name in ("EEVEE", "film", "Cycles"):
            path = Path(temporary, f"{name}.png")
            save_as_shown(path, pictures[name], scene)
            with Image.open(path) as opened:
                columns.append(np.asarray(opened.convert("RGB")))
        Image.fromarray(np.concatenate(columns, axis=1)).save(arguments.output, quality=QUALITY)


def _inside(mask: np.ndarray) -> np.ndarray:
    """(h, w) without the pixels that are within `EDGE` of one that is not in the mask."""
    height, width = mask.shape
    around = np.pad(mask, EDGE, constant_values=True)
    beside = range(2 * EDGE + 1)
    return np.logical_and.reduce([around[y : y + height, x : x + width] for y in beside for x in beside])


def _prepare(scene: Any, arguments: argparse.Namespace) -> None:
    names = arguments.reflectors.split(",")
    for obj in (*marked_mirrors(scene), *(bpy.data.objects[name] for name in names)):
        obj.curvrefl.is_mirror = obj.name in names
    render = scene.render
    render.resolution_x, render.resolution_y = (int(side) for side in arguments.size.split("x"))
    render.resolution_percentage = 100
    settings = render.image_settings
    settings.media_type, settings.file_format = "IMAGE", "OPEN_EXR"
    settings.color_depth, settings.color_mode = "32", "RGBA"
    scene.curvrefl.render_samples = arguments.sub_frames
    scene.eevee.use_raytracing = True
    scene.eevee.taa_render_samples = arguments.eevee_samples
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = arguments.samples, False
    scene.cycles.use_denoising = False
    if arguments.focus:
        lens = scene.camera.data.dof
        lens.use_dof, lens.focus_object = True, bpy.data.objects[arguments.focus]
        lens.aperture_fstop = arguments.fstop


def _picture(scene: Any, engine: str, path: Path) -> np.ndarray:
    """(h, w, 4) scene-linear, as the engine renders the scene; says how long that took."""
    scene.render.engine, scene.render.filepath = engine, str(path)
    start = time.perf_counter()
    with dropped(STDOUT):
        bpy.ops.render.render(write_still=True, scene=scene.name)
    print(f"{engine}: {time.perf_counter() - start:.1f} s", flush=True)
    return load_exr(path)


if __name__ == "__main__":
    main()
