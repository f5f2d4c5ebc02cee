# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirror rays per second of the method `exact`: the walk alone, the surface buffer of the mirror made before."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import perf_counter
from typing import Any

import numpy as np

from ...errors import InputError
from ...renderer.device.textures import read_texture
from ...renderer.measured.hall import hall, view_of_mirror
from ...renderer.rays.paths import IN_THE_OPEN, PathBuffer
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...renderer.surfaces.materials import Materials
from ...renderer.surfaces.primary import draw_primary
from ...renderer.surfaces.surface_buffer import SurfaceBuffer
from ...renderer.surfaces.view_block import view_block
from .gpu_timing import empty_wait, time_on_gpu
from .solves import MIRROR_PIXELS, SIZE

REPEATS, SECONDS = 20, 2.0
NODE_BYTES, TRIANGLE_BYTES, INSTANCE_BYTES, RAY_BYTES = 64, 48, 80, 360
"""Records that the walk fetches for each, 16 bytes a record; of a ray: 3 texels of the mirror, 40 bytes written, 17
records of the surface that it hits"""
NODE_OPERATIONS, TRIANGLE_OPERATIONS, INSTANCE_OPERATIONS = 56, 53, 50
"""Counted in ray_walk.glsl: additions, products, comparisons, least and greatest; reciprocals as one"""


def measure_rays(counts: tuple[int, ...], say: Callable[[str], None]) -> Iterator[dict[str, Any]]:
    """A row per scene; `left_out` says why there are no times."""
    for count in counts:
        say(f"exact: a scene of {count:,} triangles")
        row: dict[str, Any] = {"triangles": count, "left_out": ""}
        try:
            row |= _measured(count)
        except (InputError, MemoryError) as error:
            row["left_out"] = str(error) or "there is not enough memory"
        yield row


def _measured(count: int) -> dict[str, Any]:
    scene = hall(count)
    view = view_of_mirror(*SIZE, MIRROR_PIXELS)
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    try:
        mirror, materials, uniforms = renderer.mirrors[0], Materials(scene), view_block(view)
        seen, path = SurfaceBuffer(*SIZE), PathBuffer(*SIZE)
        draw_primary(seen, renderer.geometry.seen(view), materials, uniforms)
        window = mirror.window(view)
        rays = renderer.rays()
        columns: dict[str, Any] = {
            "in_scene": sum(len(scene.meshes[instance.mesh].triangles) for instance in scene.instances[1:]),
            "first_build_ms": rays.build_ms,
        }

        def walk() -> None:
            path.follow(seen, rays, materials, uniforms, window, IN_THE_OPEN, goes_on=False)

        walk()
        columns["empty_wait_ms"] = empty_wait(path.wait)
        for state in ("quick", "best"):
            if state == "best":
                start = perf_counter()
                rays.finish()
                columns["improve_ms"] = 1e3 * (perf_counter() - start)
            measured = time_on_gpu(walk, path.wait, columns["empty_wait_ms"], REPEATS, SECONDS)
            path.follow(seen, rays, materials, uniforms, window, IN_THE_OPEN, with_counts=True)
            x, y, width, height = window
            counted = read_texture(path.direction)[y : y + height, x : x + width].reshape(-1, 4)
            counted = counted[counted[:, 3] == 1.0]
            nodes, triangles, instances = counted[:, :3].astype(np.float64).mean(axis=0).tolist()
            columns |= measured.columns(state)
            columns |= {
                "rays": len(counted),
                f"{state}_rays_per_second": 1e3 * len(counted) / measured.timing.median,
                f"{state}_nodes": nodes,
                f"{state}_tested": triangles,
                f"{state}_entered": instances,
                f"{state}_bytes": RAY_BYTES
                + nodes * NODE_BYTES
                + triangles * TRIANGLE_BYTES
                + instances * INSTANCE_BYTES,
                f"{state}_operations": nodes * NODE_OPERATIONS
                + triangles * TRIANGLE_OPERATIONS
                + instances * INSTANCE_OPERATIONS,
            }
        return columns
    finally:
        renderer.free()
