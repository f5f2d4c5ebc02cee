# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of baking a reflector, with the Python that has bpy: python tools/measure/measure_bake.py [repeats]"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from time import perf_counter

import bpy  # noqa: F401  (before gpu)

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests")]

import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_bake import bake_reflector  # noqa: E402
from scenes.star_meshes import scene_of, star_mesh  # noqa: E402


def main(repeats: int) -> None:
    """Print a line for each size of mesh and of map; the first line's first time includes compiling the shader."""
    require_gpu()
    print(f"{'triangles':>9} {'texels':>10} {'first ms':>9} {'median ms':>9}  errors of radius and normal, 95 of 100")
    for bands in (32, 160):
        scene = scene_of(star_mesh(Bumpy(0.15), bands))
        for resolution in (64, 128, 256):
            times = []
            for _ in range(repeats + 1):
                start = perf_counter()
                baked = bake_reflector(scene, 1, resolution)
                times.append(1e3 * (perf_counter() - start))
            size = f"{resolution}^2 x 6"
            errors = f"{baked.radius_error.p95:.1e} {baked.normal_error_degrees.p95:.3f} degrees"
            print(
                f"{len(scene.meshes[0].triangles):>9} {size:>10} {times[0]:>9.0f} {median(times[1:]):>9.0f}  {errors}"
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 7)
