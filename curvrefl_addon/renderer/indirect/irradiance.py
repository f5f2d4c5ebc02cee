# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between the scene's surfaces: radiosity over patches, whose form factors are rays that are followed once.

Each patch sends rays over its hemisphere, by the cosine. Where a ray gets to is kept: which patch is there, and how
much that sends on. Then light goes from patch to patch any number of times without another ray, and again when only
lamps have changed (Goral et al., "Modeling the interaction of light between diffuse surfaces", 1984; the rays are the
Monte Carlo form factors of Shirley, "Radiosity via ray tracing", 1991).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array
from ..cells.lookup import WALLS, At
from ..device.batches import full_screen_triangle
from ..device.frame_buffers import frame_buffer, wait_for
from ..device.records import TEXTURE_WIDTH, empty_record_texture, padded_count, read_records, record_texture
from ..device.shaders import knows
from ..device.state import blended, drawing_state, set_viewport
from ..device.textures import empty_texture, read_texture, texture_2d
from ..lighting.lighting import Lighting
from ..rays.ray_scene import RayScene
from ..surfaces.materials import Materials
from .emitters import Emitters
from .patch_picture import PatchPicture
from .patch_shaders import (
    RAYS_AT_ONCE,
    VERTICES,
    emitter_links_shader,
    emitter_sum_shader,
    light_shader,
    links_shader,
    sum_shader,
    sweep_shader,
    walls_shader,
    weights_shader,
)
from .points import POINTS, Patches

MOST_SWEEPS = 8
"""Surfaces that light bounces off at most"""


class Irradiance:
    """Of one scene's patches, on the GPU."""

    def __init__(self, patches: Patches, is_solid: NDArray[np.bool_]) -> None:
        """`is_solid`: (instances,) nothing looks at it from within."""
        self.patches = patches
        solids = np.zeros((len(is_solid), 4), np.float32)
        solids[:, 0] = is_solid
        self._solids = record_texture(solids)
        count = patches.count
        self._points: Any = None
        self._fill_points()
        self._walls = _Records(count * WALLS)
        self._has_walls = np.zeros(count, bool)
        self._fill_table()
        self._of_lamps, self._of_sky = _Records(count * POINTS), _Records(count * POINTS)
        self._swept = _Records(count)
        self._open = _Records(count)
        """How many rays of each point have not met something close by"""
        with self._open.target.bind():
            self._open.target.clear(color=(0.0, 0.0, 0.0, 0.0))
        self._shone: _Records | None = None
        """What emitters send straight to the patches; made where there are some"""
        self._sent = [_Sent(count), _Sent(count)]
        """Of the last two sweeps, the last first"""
        self._links: list[Any] = []
        """A texture for each batch"""
        self._picture: PatchPicture | None = None

    def _fill_points(self) -> None:
        points = np.zeros((self.patches.count, 2, POINTS, 4), np.float32)
        points[:, 0, :, :3], points[:, 1, :, :3] = self.patches.positions, self.patches.normals
        self._points = record_texture(points.reshape(-1, 4))

    def _fill_table(self) -> None:
        numbers = self.patches.table
        rows = padded_count(len(numbers)) // TEXTURE_WIDTH
        table = np.full((rows * TEXTURE_WIDTH, 1), -1.0, np.float32)
        table[: len(numbers), 0] = numbers + np.where(numbers >= 0, 0.5 * self._has_walls[numbers], 0.0)
        self._table = texture_2d(table.reshape(rows, TEXTURE_WIDTH, 1), "R32F")

    def find_walls(self, rays: RayScene) -> None:
        """What parts patches from their surroundings."""
        shader = walls_shader()
        with drawing_state(), self._walls.target.bind():
            set_viewport(0, 0, self._walls.texture.width, self._walls.texture.height)
            shader.bind()
            rays.bind(shader)
            self._bind_grid(shader)
            shader.uniform_sampler("patch_points", self._points)
            shader.uniform_int("patches", self.patches.count)
            full_screen_triangle().draw(shader)
        walls = read_records(self._walls.texture, self.patches.count * WALLS).reshape(-1, WALLS, 4)
        self._has_walls = (walls[:, :, 3] > -1e29).any(axis=1)
        self._fill_table()
        self.patches = self.patches.parted(walls[:, :, :3], walls[:, :, 3])
        self._fill_points()

    def wait(self) -> None:
        """Return when the GPU has finished."""
        wait_for(self._sent[0].target)

    @property
    def batches(self) -> int:
        """Of rays that have been followed"""
        return len(self._links)

    def bind(self, shader: Any, at: At) -> None:
        """See `SurfaceLight`."""
        self._bind_cells(shader)
        before, now = self._sent[1], self._sent[0]
        shader.uniform_sampler("patch_light", (before.under_sky, now.arriving, now.under_sky)[at])

    def _bind_cells(self, shader: Any) -> None:
        shader.uniform_sampler("cell_table", self._table)
        shader.uniform_sampler("patch_walls", self._walls.texture)
        self._bind_grid(shader)

    def _bind_grid(self, shader: Any) -> None:
        grid = self.patches.grid
        if knows(shader, "cell_grid"):
            shader.uniform_float("cell_grid", (*grid.focus, grid.half))
            shader.uniform_float("cell_levels", float(grid.levels))

    def follow_rays(
        self,
        rays: RayScene,
        materials: Materials,
        lighting: Lighting,
        view_uniforms: Any,
        emitters: Emitters | None,
        has_caustics: bool,
    ) -> Iterator[None]:
        """Another batch of rays, step by step; `emitters`: surfaces that shine, if there are some;
        `has_caustics`: what reflects sends light on, too."""
        if self._picture is None:
            self._picture = PatchPicture(self.patches.count)
        picture = self._picture
        records = (self._points, self._solids)
        for _ in picture.follow(rays, materials, view_uniforms, records, self.patches.count, self.batches):
            yield
        links = empty_texture(picture.width, picture.height)
        target = frame_buffer(links)
        shader = links_shader(materials.buffers, lighting.features)
        with drawing_state(), target.bind():
            set_viewport(0, 0, picture.width, picture.height)
            shader.bind()
            self._bind_cells(shader)
            shader.uniform_sampler("materials", materials.table)
            shader.uniform_sampler("lighting_ggx", lighting.ggx)
            for name, texture in zip(VERTICES, (picture.position, picture.normal, picture.color), strict=True):
                shader.uniform_sampler(name, texture)
            shader.uniform_sampler("path_way", picture.way)
            shader.uniform_float("has_caustics", float(has_caustics))
            picture.made.bind(shader, materials.buffers)
            full_screen_triangle().draw(shader)
        self._links.append(links)
        self._weigh_points(links)
        if self.batches == 1:
            self._drop_dead()
        if emitters is not None:
            yield
            yield from self._ask_emitters(emitters, rays, materials, view_uniforms)

    def openness(self) -> float:
        """Share of rays that have met nothing, of patches about the focus and what light there has come by."""
        numbers = read_texture(self._links[0])[..., 0].ravel()[: self.patches.count * RAYS_AT_ONCE]
        links = np.floor(numbers).astype(np.int64).reshape(-1, RAYS_AT_ONCE)
        grid = self.patches.grid
        away = np.abs(self.patches.positions[:, 0] - np.array(grid.focus)).max(axis=1)
        # (Most walls have an outer side, too, which sees nothing but sky and nobody looks at.)
        reached = np.where(away < 0.5 * grid.half, 1.0, 0.0)
        for _ in range(2):
            met = links[reached > 0.0].ravel()
            reached = np.bincount(met[met >= 0], minlength=len(links)).astype(np.float64)
        weights = np.where(links > -2, reached[:, None], 0.0)
        return float((weights * (links == -1)).sum() / weights.sum()) if weights.sum() > 0.0 else 1.0

    def arriving(self) -> Float32Array:
        """(patches, 3) irradiance from other surfaces."""
        return read_records(self._sent[0].arriving, self.patches.count)[:, :3]

    def share_of_surfaces(self) -> float:
        """Of all light, at the tenth of the patches that get most of theirs from other surfaces."""
        sent, arriving = (
            read_records(texture, self.patches.count)[:, :3].sum(axis=1)
            for texture in (self._sent[0].sent, self._sent[0].arriving)
        )
        lit = np.abs(sent) > 0.0
        return float(np.quantile(np.abs(arriving[lit]) / np.abs(sent[lit]), 0.9)) if lit.any() else 0.0

    def _weigh_points(self, links: Any) -> None:
        """How open points are, by another batch."""
        with blended("ADDITIVE_PREMULT"), self._open.target.bind():
            set_viewport(0, 0, self._open.texture.width, self._open.texture.height)
            shader = weights_shader()
            shader.bind()
            shader.uniform_int("patches", self.patches.count)
            shader.uniform_sampler("links", links)
            full_screen_triangle().draw(shader)

    def _drop_dead(self) -> None:
        """Patches all of whose points are inside of something, or in crevices: their cells take others beside them."""
        is_open = read_records(self._open.texture, self.patches.count).max(axis=1) > 0.0
        if not is_open.all():
            self.patches = self.patches.without(~is_open)
            self._fill_table()

    def _ask_emitters(
        self, emitters: Emitters, rays: RayScene, materials: Materials, view_uniforms: Any
    ) -> Iterator[None]:
        """What shines that the rays of the batch which was followed last have met, and a batch to places that shine."""
        assert self._picture is not None
        if self._shone is None:
            self._shone = _Records(self.patches.count)
            with self._shone.target.bind():
                self._shone.target.clear(color=(0.0, 0.0, 0.0, 0.0))
        self._add_shining(emitters, materials, of_hemisphere=True)
        picture, records = self._picture, (self._points, self._solids)
        for _ in picture.follow(rays, materials, view_uniforms, records, self.patches.count, self.batches, emitters):
            yield
        self._add_shining(emitters, materials, of_hemisphere=False)

    def _add_shining(self, emitters: Emitters, materials: Materials, of_hemisphere: bool) -> None:
        picture = self._picture
        assert picture is not None and self._shone is not None
        links = empty_texture(picture.width, picture.height)
        target = frame_buffer(links)
        with drawing_state(), target.bind():
            set_viewport(0, 0, picture.width, picture.height)
            shader = emitter_links_shader(materials.buffers, of_hemisphere)
            shader.bind()
            shader.uniform_sampler("materials", materials.table)
            for name, texture in zip(VERTICES, (picture.position, picture.normal, picture.color), strict=True):
                shader.uniform_sampler(name, texture)
            shader.uniform_sampler("path_way", picture.way)
            picture.made.bind(shader, materials.buffers)
            if of_hemisphere:
                shader.uniform_sampler("patch_points", self._points)
                emitters.bind_densities(shader)
            full_screen_triangle().draw(shader)
        with blended("ADDITIVE_PREMULT"), self._shone.target.bind():
            set_viewport(0, 0, self._shone.texture.width, self._shone.texture.height)
            shader = emitter_sum_shader()
            shader.bind()
            shader.uniform_int("patches", self.patches.count)
            shader.uniform_sampler("links", links)
            shader.uniform_sampler("point_weights", self._open.texture)
            full_screen_triangle().draw(shader)

    def light(self, lighting: Lighting, sub_frames: int) -> None:
        """Find what lamps and the world send straight to the patches: the mean of so many sub-frames' lights."""
        for _ in self.light_some(lighting, sub_frames):
            pass

    def light_some(self, lighting: Lighting, sub_frames: int) -> Iterator[None]:
        """The same, step by step."""
        for records in (self._of_lamps, self._of_sky):
            with records.target.bind():
                records.target.clear(color=(0.0, 0.0, 0.0, 0.0))
        for index in range(sub_frames):
            lighting.prepare(index)
            for records, of_sky in ((self._of_lamps, False), (self._of_sky, True)):
                shader = light_shader(lighting.features, of_sky)
                with blended("ADDITIVE_PREMULT"), records.target.bind():
                    set_viewport(0, 0, records.texture.width, records.texture.height)
                    shader.bind()
                    shader.uniform_sampler("patch_points", self._points)
                    shader.uniform_int("patches", self.patches.count)
                    shader.uniform_float("weight", 1.0 / sub_frames)
                    lighting.bind(shader)
                    full_screen_triangle().draw(shader)
            yield

    def sweep(self, bounces: int) -> None:
        """Let light go from patch to patch, off `bounces` surfaces at most."""
        self._sum(is_first=True)
        for _ in range(min(bounces, MOST_SWEEPS)):
            shader = sweep_shader()
            target = self._swept.target
            with target.bind():
                target.clear(color=(0.0, 0.0, 0.0, 0.0))
            with blended("ADDITIVE_PREMULT"), target.bind():
                set_viewport(0, 0, self._swept.texture.width, self._swept.texture.height)
                shader.bind()
                shader.uniform_int("patches", self.patches.count)
                shader.uniform_sampler("patch_sent", self._sent[0].sent)
                shader.uniform_sampler("point_weights", self._open.texture)
                for links in self._links:
                    shader.uniform_sampler("links", links)
                    full_screen_triangle().draw(shader)
            self._sum(is_first=False)

    def _sum(self, is_first: bool) -> None:
        """The next pair of what is sent."""
        self._sent.reverse()
        if is_first:
            with self._swept.target.bind():
                self._swept.target.clear(color=(0.0, 0.0, 0.0, 0.0))
        pair = self._sent[0]
        shader = sum_shader(self._shone is not None)
        with drawing_state(), pair.target.bind():
            set_viewport(0, 0, pair.sent.width, pair.sent.height)
            shader.bind()
            shader.uniform_int("patches", self.patches.count)
            shader.uniform_sampler("patch_swept", self._swept.texture)
            shader.uniform_sampler("patch_lamps", self._of_lamps.texture)
            shader.uniform_sampler("patch_sky", self._of_sky.texture)
            shader.uniform_sampler("point_weights", self._open.texture)
            if self._shone is not None:
                shader.uniform_sampler("patch_shone", self._shone.texture)
            full_screen_triangle().draw(shader)


class _Records:
    """A record texture that is drawn to."""

    def __init__(self, count: int) -> None:
        self.texture = empty_record_texture(count)
        self.target = frame_buffer(self.texture)


class _Sent:
    """All light that patches send on if white; what of it other surfaces have sent; and with what the world has."""

    def __init__(self, count: int) -> None:
        self.sent, self.arriving, self.under_sky = (empty_record_texture(count) for _ in range(3))
        self.target = frame_buffer(self.sent, self.arriving, self.under_sky)
