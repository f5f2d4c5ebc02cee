# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What light between surfaces costs a viewport: until there is some, until it has settled, the longest step; and frames
of an orbit with it and without, taking turns.

    .venv/bin/python tools/measure/light/measure_light.py FILE.blend --reflector A[,B..] [--size 640x480]

A viewport's steps, one after the other without the pictures between them. *Off*: how far light at patches is from its
end, the mean over those that are lit.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401 (before its module `gpu`)
import numpy as np  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.renderer.appearance import LIGHT_SECONDS  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from light.given_file import GivenFile, file_parser  # noqa: E402

REPEATS = 9


def main() -> None:
    arguments = file_parser(__doc__).parse_args()
    given = GivenFile(arguments)
    still = given.read()
    triangles = sum(len(still.scene.meshes[item.mesh].triangles) for item in still.scene.instances)
    print(f"{arguments.file.name}: {triangles:,} triangles")
    renderer = Renderer(still.scene, Settings(method="exact", samples=16), is_gradual=True)
    canvas = Canvas.of_size(given.width, given.height)
    frame(renderer, still.view, canvas)
    while renderer.is_loading:
        # (To its end, so that all shaders are compiled: they are counted elsewhere, as materials are.)
        renderer.load_some(1.0)
    measure_steps(still.scene, still.view, canvas)
    measure_frames(renderer, still.scene, still.view, canvas)


def measure_steps(scene: SceneArrays, view: View, canvas: Canvas) -> None:
    """Of another renderer, as shaders are compiled by now."""
    renderer = Renderer(scene, Settings(method="exact", samples=16), is_gradual=True)
    frame(renderer, view, canvas)
    while renderer._appearance.materials.is_loading:
        renderer.load_some(10.0)
    renderer.rays()
    steps: list[float] = []
    known: list[tuple[float, Any]] = []
    while renderer.is_loading:
        start = perf_counter()
        renderer.load_some(0.0)
        irradiance = renderer._appearance.indirect.irradiance
        if irradiance is not None:
            irradiance.wait()
        steps.append(perf_counter() - start)
        if irradiance is not None:
            known.append((sum(steps), irradiance.arriving()))
    if not known:
        print(f"Bounced light: {renderer.bounced_light}, found in {sum(steps):.2f} s")
        return
    end = known[-1][1]
    scale = np.abs(end).mean()
    off = [(seconds, float(np.abs(light - end).mean() / scale)) for seconds, light in known if light.shape == end.shape]
    settled = next(seconds for seconds, share in off if share < 0.02)
    print(f"First light after {known[0][0]:.2f} s ({100 * off[0][1]:.0f} % off), within 2 % of its end after ", end="")
    print(f"{settled:.2f} s, at its end after {sum(steps):.2f} s: {renderer.bounced_light}")
    print(f"{len(steps)} steps, the longest {1e3 * max(steps):.0f} ms, half below {1e3 * median(steps):.0f} ms")
    print(f"(A redraw takes steps for {1e3 * LIGHT_SECONDS:.0f} ms)")


def measure_frames(renderer: Renderer, scene: SceneArrays, view: View, canvas: Canvas) -> None:
    """A moving view, with bounced light and without."""
    plain = Renderer(replace(scene, diffuse_bounces=0), Settings(method="exact", samples=16))
    times: dict[str, list[float]] = {"with": [], "without": []}
    for _ in range(REPEATS):
        for name, one in (("with", renderer), ("without", plain)):
            start = perf_counter()
            frame(one, view, canvas)
            times[name].append(1e3 * (perf_counter() - start))
    ratio = median(a / b for a, b in zip(times["with"], times["without"], strict=True))
    print(f"A frame of an orbit: {median(times['with']):.1f} ms, without {median(times['without']):.1f}: {ratio:.2f}")


def frame(renderer: Renderer, view: View, canvas: Canvas) -> None:
    canvas.clear()
    renderer.add_sub_frame(canvas, renderer.reflect(view), 0, 1.0, mirrors_only=True)
    canvas.wait()


if __name__ == "__main__":
    main()
