# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb that puts mirrors into EEVEE's pictures; see `verbs`."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from ..output import checked_file, checked_folder
from ..streams import STDOUT, dropped
from .inputs import open_scene, read_names, registered, resolution_of, settings_of_file, start_gpu, warn_of

SUFFIXES = (".png", ".exr", ".mp4", ".mov", ".mkv", ".webm")


def film(options: argparse.Namespace) -> int:
    """Set the film of the opened file up, in memory, and render stills or a range of it."""
    output = _checked(options.output)
    reflectors = None if options.reflector is None else read_names(options.reflector, "reflector")
    start_gpu()
    scene: Any = open_scene(options.file, options.frame)

    from ..scene.opened.blend_file import find_reflectors

    found = None if reflectors is None else find_reflectors(scene, reflectors)
    with registered():
        from ..engine.job import Job
        from ..film.film import EEVEE, remove, set_up
        from ..film.frames import render_frames
        from ..film.wiring import add_layers_file
        from ..options import marked_mirrors

        if found is not None:
            chosen: Any
            for chosen in (*marked_mirrors(scene), *found):
                chosen.curvrefl.is_mirror = chosen in found
        settings = settings_of_file(options, scene)
        scene.render.engine, scene.render.use_single_layer = EEVEE, False
        width, height = resolution_of(options, scene)
        scene.render.resolution_x, scene.render.resolution_y = width, height
        scene.render.resolution_percentage = 100
        remove(scene)
        warn_of(set_up(scene))
        if options.layers:
            add_layers_file(scene, "//", "layers")
        names = tuple(obj.name for obj in marked_mirrors(scene))
        job = Job(names, settings, may_be_hidden=options.frames is not None)
        frames = options.frames or range(scene.frame_current, scene.frame_current + 1)
        start = time.perf_counter()
        with dropped(STDOUT) as stdout:

            def say(line: str) -> None:
                print(line, file=stdout, flush=True)

            count = render_frames(scene, frames, output, job, options.camera, options.resume, say)
        warn_of(job.warnings)
    print(f"Rendered {count} frames in {time.perf_counter() - start:.1f} s")
    return 0


def _checked(text: str) -> Path:
    """A folder where the name has no suffix or is one already."""
    if Path(text).is_dir() or not Path(text).suffix:
        return checked_folder(text)
    return checked_file(text, SUFFIXES)
