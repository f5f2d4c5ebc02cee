# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the rays of a batch from patches have met."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.frame_buffers import frame_buffer
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..programs.buffers import MaterialBuffers
from ..rays.material_pass import Hits, MaterialPass
from ..rays.ray_scene import RayScene
from ..surfaces.materials import Materials
from ..surfaces.surface_buffer import SURFACE_SAMPLERS
from .emitters import Emitters
from .patch_shaders import PICTURE_WIDTH, RAYS_AT_ONCE, rays_shader

FOLLOWED = 0.5
"""Depth of all its pixels"""
ROWS_AT_ONCE = 24
"""Of that picture, in one step"""


class PatchPicture:
    """What the rays of a batch have met, a pixel for each."""

    def __init__(self, patches: int) -> None:
        self.width, self.height = PICTURE_WIDTH, -(-patches * RAYS_AT_ONCE // PICTURE_WIDTH)
        size = (self.width, self.height)
        self.position, self.normal = empty_texture(*size), empty_texture(*size)
        self.color = empty_texture(*size, "RGBA16F")
        self.way = empty_texture(*size)
        self.made = MaterialBuffers(*size)
        self.hits: Any = None
        self._depth = depth_texture(*size)
        self._target: Any = None
        self._pass = MaterialPass(*size)

    def follow(
        self,
        rays: RayScene,
        materials: Materials,
        view_uniforms: Any,
        records: tuple[Any, Any],
        patches: int,
        batch: int,
        emitters: Emitters | None = None,
    ) -> Iterator[None]:
        has_programs = materials.has_programs
        if self._target is None or has_programs != (self.hits is not None):
            self.hits = empty_texture(self.width, self.height) if has_programs else None
            held = [] if self.hits is None else [self.hits]
            self._target = frame_buffer(self.position, self.normal, self.color, *held, self.way, depth=self._depth)
            with self._target.bind():
                self._target.clear(depth=FOLLOWED)
        shader = rays_shader(has_programs, emitters is not None, materials.links)
        for first in range(0, self.height, ROWS_AT_ONCE):
            window = (0, first, self.width, min(ROWS_AT_ONCE, self.height - first))
            with drawing_state(), self._target.bind(), scissored(window):
                set_viewport(0, 0, self.width, self.height)
                shader.bind()
                rays.bind(shader)
                shader.uniform_sampler("materials", materials.table)
                shader.uniform_sampler("patch_points", records[0])
                shader.uniform_sampler("solids", records[1])
                shader.uniform_int("patches", patches)
                shader.uniform_int("batch", batch)
                if emitters is not None:
                    emitters.bind(shader)
                full_screen_triangle().draw(shader)
            if has_programs:
                hits = Hits(self.position, self.normal, self.color, self.hits, None, self.way, is_gathered=True)
                made, turn = (rays, materials, view_uniforms), (batch, 1)
                self._pass.draw(hits, self.made, (self._depth, FOLLOWED), *made, window, turn)
            yield

    def drawn_over(self, shader: Any, materials: Materials, bind: Callable[[Any], None]) -> Any:
        """A picture of the same size, out of what the rays have met: its texture. `bind`: sets what else the shader
        reads."""
        drawn = empty_texture(self.width, self.height)
        target = frame_buffer(drawn)
        with drawing_state(), target.bind():
            set_viewport(0, 0, self.width, self.height)
            shader.bind()
            shader.uniform_sampler("materials", materials.table)
            for name, texture in zip(SURFACE_SAMPLERS, (self.position, self.normal, self.color), strict=True):
                shader.uniform_sampler(name, texture)
            shader.uniform_sampler("path_way", self.way)
            self.made.bind(shader, materials.buffers)
            bind(shader)
            full_screen_triangle().draw(shader)
        return drawn
