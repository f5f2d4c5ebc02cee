# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The classic baseline: six pictures of the scene from the reflector's center, looked up by direction.

Blinn & Newell's environment map as a cube. It takes everything as infinitely far away, so it is right for the
background and wrong for what is near. The other environment methods look up the same pictures in other ways.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ...optics.environment import environment_radius
from ...scene.arrays import Float32Array
from ...scene.camera.view import View
from ..device.cubes import cube_texture, empty_cube
from ..device.textures import read_texture
from ..geometry.chunk import Batches, Chunk
from ..lighting.lighting import Lighting
from ..mirrors.baked_shape import BakedShape
from ..shading.lookup import Environment
from ..shading.shade import ShadePass
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.primary import depths_of, draw_primary
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import view_block
from .cube_views import faces_views
from .sphere_map import SphereMap

SUB_FRAMES = 4
"""Jittered shadings per face: the map is looked up at many scales."""
RADIUS_RESOLUTION = 64
"""Texels along an edge of the faces on which distances are measured for the finite radius"""


class EnvironmentCube:
    """The cube map of one mirror's surroundings; drawn once, it does not depend on the eye."""

    def __init__(
        self,
        mirror: int,
        shape: BakedShape,
        scenery: Sequence[tuple[Chunk, Batches]],
        reach: float,
        materials: Materials,
        lighting: Lighting,
        shade: ShadePass,
        resolution: int,
    ) -> None:
        """`mirror`: its number; `reach`: distance from its center to the scenery's farthest point, meters, or more."""
        near = 0.05 * shape.nearest_surface
        self._mirror = mirror
        self._center, self._bound = shape.center, shape.bound
        self._views = faces_views(self._center, near, max(2.0 * reach, 10.0 * near), resolution)
        self._scenery, self._materials = scenery, materials
        self._seen = SurfaceBuffer(resolution, resolution)
        self._positions: Any = None
        self._sphere: SphereMap | None = None
        self.color: Any = empty_cube(resolution)
        """Scene-linear radiance by world direction"""
        for face, view in enumerate(self._views):
            canvas = Canvas(self.color, face)
            canvas.clear()
            for i in range(SUB_FRAMES):
                uniforms = self._draw_face(self._seen, view.jittered(((i & 1) - 0.5) / 2, ((i >> 1) - 0.5) / 2))
                lighting.prepare(i * max(lighting.sub_frames // SUB_FRAMES, 1) % lighting.sub_frames)
                shade.add(canvas, self._seen, None, uniforms, 1.0 / SUB_FRAMES, by_camera=False)

    def environment(self, method: str, view: View) -> Environment:
        """What a method of the catalog looks up in a view; for `environment_cube_vertex` the cube itself, out of
        which `VertexLookups` draws what it looks up."""
        if method == "environment_sphere":
            sphere = self._sphere_map(view)
            return Environment(
                method, sphere.radiance, lambda: sphere.positions(self.positions()), sphere.constants, self._mirror
            )
        constants = {}
        if method == "environment_parallax":
            x, y, z = self._center.tolist()
            constants = {"environment_ball": (x, y, z, self.radius)}
        return Environment(method, self.color, self.positions, constants, self._mirror)

    def positions(self) -> Any:
        """Cube texture of world positions and object_ids (0: background); made when first asked for."""
        if self._positions is None:
            self._positions = cube_texture(self.geometry(), linear=False)
        return self._positions

    @cached_property
    def radius(self) -> float:
        """Meters, of the ball that stands for the surroundings where their distance counts; 0 where there are none."""
        return environment_radius(self._geometry(RADIUS_RESOLUTION), self._center, self._bound)

    def geometry(self) -> Float32Array:
        """(6, n, n, 4): world position and object_id (0: background) at each texel's center."""
        return self._geometry(self._views[0].width)

    def _geometry(self, resolution: int) -> Float32Array:
        target = self._seen
        if resolution != target.width:
            target = SurfaceBuffer(resolution, resolution)
        faces = []
        for view in self._views:
            self._draw_face(target, replace(view, width=resolution, height=resolution))
            faces.append(read_texture(target.position))
        return np.stack(faces)

    def _draw_face(self, target: SurfaceBuffer, view: View) -> Any:
        uniforms = view_block(view)
        draw_primary(target, self._scenery, self._materials, uniforms, depths=depths_of(view))
        return uniforms

    def _sphere_map(self, view: View) -> SphereMap:
        """Drawn again only where the axis from the mirror to the eye has changed."""
        to_eye = view.eye[:3] - self._center * view.eye[3]
        distance = np.linalg.norm(to_eye)
        axis = to_eye / distance if distance > 0.0 else np.array([0.0, 0.0, 1.0])
        # Another object and not another drawing: the last one may still be shown in another region of the window.
        if self._sphere is None or not np.array_equal(self._sphere.axis, axis):
            self._sphere = SphereMap(self.color, axis, self._views[0].width)
        return self._sphere
