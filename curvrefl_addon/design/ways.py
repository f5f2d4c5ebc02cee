# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of sight by the mirrors of a scene to what they show, as the exact method follows them, on the GPU."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..renderer.device.batches import full_screen_triangle
from ..renderer.device.context import gpu_cache
from ..renderer.device.frame_buffers import frame_buffer
from ..renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from ..renderer.device.state import drawing_state, set_viewport
from ..renderer.device.textures import empty_texture, read_texture, texture_2d
from ..renderer.geometry.mesh_facts import MeshFactsCache
from ..renderer.geometry.vertex_uploads import VertexUploads
from ..renderer.placement import Placement
from ..renderer.rays.mesh_rays import triangles_with_a_place
from ..renderer.rays.ray_scene import RAYS, RayScene
from ..scene.arrays import Float64Array, SceneArrays
from ..scene.camera.view import View

SIDE = 512
"""Rays go in squares of so many"""
FARTHEST = 3e38
OUTPUTS = ("first_mirror", "last_place", "last_way", "last_corners", "last_weights")


@dataclass(frozen=True, slots=True)
class Ways:
    """What n lines of sight meet. World space, meters."""

    mirror: NDArray[np.int64]
    """(n,) object_id of the mirror that they meet first; 0 where they meet something else first, or nothing"""
    point: Float64Array
    """(n, 3) where they meet it"""
    end: Float64Array
    """(n, 3) what they meet last, where `object` is not 0"""
    direction: Float64Array
    """(n, 3) unit, from the last mirror on"""
    bounces: NDArray[np.int64]
    """(n,) mirrors on the way"""
    object: NDArray[np.int64]
    """(n,) object_id of what is met last, 0: the background"""
    instance: NDArray[np.int64]
    """(n,) its index in `SceneArrays.instances`, -1: the background"""
    corners: NDArray[np.int64]
    """(n, 3) corners of its mesh"""
    weights: Float64Array
    """(n, 3) of these, barycentric"""

    def some(self, chosen: NDArray[np.bool_]) -> Ways:
        """Those that are chosen (n,)."""
        return Ways(*(getattr(self, item.name)[chosen] for item in fields(self)))


class WaysByMirrors:
    """The scene as these lines of sight need it. Its `reflectors` are the mirrors."""

    def __init__(self, scene: SceneArrays, middle: Float64Array) -> None:
        """`middle` (3,): what is looked at; coordinates are in single precision about it.

        Raises InputError where the triangles do not fit into the driver's largest texture, GpuUnavailableError
        without a GPU context.
        """
        from ..renderer.device.context import require_gpu

        require_gpu()
        facts = MeshFactsCache()
        placement = Placement(facts)
        placement.move_to(np.asarray(middle, np.float64))
        self._origin = placement.origin
        placed = placement.placed(scene)
        reflectors = set(scene.reflectors)
        chosen = [index for index, item in enumerate(scene.instances) if item.object_id in reflectors]
        self._mirrors = np.array([0, *(scene.instances[index].object_id for index in chosen)])
        self._known = np.array(
            [i for i, item in enumerate(placed.instances) if len(triangles_with_a_place(placed.meshes[item.mesh])[0])]
        )
        self._most = min(scene.mirror_bounces, scene.most_bounces)
        self._rays = RayScene(facts, VertexUploads())
        self._rays.follow(placed, {index: number for number, index in enumerate(chosen, 1)})

    def follow(self, origins: Float64Array, directions: Float64Array, farthest: float = FARTHEST) -> Ways:
        """Lines from `origins` (n, 3) along unit `directions` (n, 3), to a first thing no farther than `farthest`."""
        count = len(origins)
        found = np.empty((5, count, 4))
        for first in range(0, count, SIDE * SIDE):
            some = slice(first, min(first + SIDE * SIDE, count))
            found[:, some] = self._followed(origins[some] - self._origin, directions[some], farthest)
        mirror, place, way, corners, weights = found
        instance = np.rint(corners[:, 3]).astype(np.int64)
        met = instance >= 0
        known = self._known if len(self._known) else np.zeros(1, np.int64)
        return Ways(
            mirror=self._mirrors[np.rint(mirror[:, 3]).astype(np.int64)],
            point=mirror[:, :3] + self._origin,
            end=place[:, :3] + self._origin,
            direction=way[:, :3],
            bounces=np.rint(way[:, 3]).astype(np.int64),
            object=np.rint(place[:, 3]).astype(np.int64),
            instance=np.where(met, known[np.where(met, instance, 0)], -1),
            corners=np.rint(corners[:, :3]).astype(np.int64),
            weights=np.column_stack([1.0 - weights[:, 0] - weights[:, 1], weights[:, :2]]),
        )

    def _followed(self, origins: Float64Array, directions: Float64Array, farthest: float) -> Float64Array:
        """(5, n, 4) the shader's outputs."""
        count = len(origins)
        height = -(-count // SIDE)
        inputs = np.zeros((2, height * SIDE, 4), np.float32)
        inputs[0, :count, :3], inputs[0, :, 3] = origins, min(farthest, FARTHEST)
        inputs[1, :, 2] = 1.0
        inputs[1, :count, :3] = directions
        textures = [texture_2d(item.reshape(height, SIDE, 4)) for item in inputs]
        targets = [empty_texture(SIDE, height) for _ in OUTPUTS]
        shader = _shader()
        with drawing_state(), frame_buffer(*targets).bind():
            set_viewport(0, 0, SIDE, height)
            shader.bind()
            self._rays.bind(shader)
            shader.uniform_float("most_mirrors", float(min(self._most, 1 << 20)))
            shader.uniform_sampler("ray_origins", textures[0])
            shader.uniform_sampler("ray_directions", textures[1])
            full_screen_triangle().draw(shader)
        return np.stack([read_texture(target).reshape(-1, 4)[:count] for target in targets]).astype(np.float64)


def lines_through(view: View, places: Float64Array) -> tuple[Float64Array, Float64Array]:
    """`View.lines_of_sight` through places (n, 2) in shares of the view's width and height from the lower left."""
    return view.lines_of_sight(places * (view.width, view.height))


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "ways by mirrors",
        FULL_SCREEN,
        RAYS,
        Piece(
            samplers=named("FLOAT_2D", "ray_origins", "ray_directions"),
            constants={"most_mirrors": "FLOAT"},
            outputs=named("VEC4", *OUTPUTS),
            fragment="design/mirror_ways.frag.glsl",
        ),
    )
