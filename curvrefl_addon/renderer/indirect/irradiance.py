# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between the scene's surfaces: radiosity over patches, whose form factors are rays that are followed once.

Each patch sends rays over its hemisphere, by the cosine. Where a ray gets to is kept: which patch is there, and how
much that sends on. Then light goes from patch to patch any number of times without another ray, and again when only
lamps have changed (Goral et al., "Modeling the interaction of light between diffuse surfaces", 1984; the rays are the
Monte Carlo form factors of Shirley, "Radiosity via ray tracing", 1991).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import OutOfTime, paced
from ...scene.arrays import Float32Array
from ..cells.lookup import WALLS, At
from ..device.batches import full_screen_triangle
from ..device.frame_buffers import frame_buffer, wait_for
from ..device.records import TEXTURE_WIDTH, empty_record_texture, padded_count, read_records, record_texture
from ..device.shaders import knows
from ..device.state import blended, drawing_state, set_viewport
from ..device.textures import read_texture, texture_2d
from ..lighting.lighting import Lighting
from ..rays.ray_scene import RayScene
from ..surfaces.materials import Materials
from .emitters import Emitters
from .patch_picture import PatchPicture
from .patch_shaders import (
    LINK_NOTHING,
    LINK_WITHIN,
    RAYS_AT_ONCE,
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
PART_SECONDS, MOST_PARTS = 0.03, 64
"""Of a step that draws shadow maps, and steps in which a sub-frame's have to be there"""


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
        self._open.clear()
        self._shone: _Records | None = None
        """What emitters send straight to the patches; made where there are some"""
        self._sent = [_Sent(count), _Sent(count)]
        """Of the last two sweeps, the last first"""
        self._links: list[Any] = []
        """A texture for each batch"""
        self._picture: PatchPicture | None = None

    def _fill_points(self) -> None:
        points = np.zeros((self.patches.count, 2, POINTS, 4), np.float32)
        points[:, 0, :, 3] = self.patches.light_sets
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
        has_caustics: float,
    ) -> Iterator[None]:
        """Another batch of rays, step by step; `emitters`: surfaces that shine, if there are some;
        `has_caustics`: what reflects sends light on, too: 1 all, 0.5 what is rough alone."""
        if self._picture is None:
            self._picture = PatchPicture(self.patches.count)
        picture = self._picture
        records = (self._points, self._solids)
        for _ in picture.follow(rays, materials, view_uniforms, records, self.patches.count, self.batches):
            yield

        def bind(shader: Any) -> None:
            self._bind_cells(shader)
            shader.uniform_sampler("lighting_ggx", lighting.ggx)
            shader.uniform_float("has_caustics", has_caustics)

        links = picture.drawn_over(links_shader(materials.buffers, lighting.features), materials, bind)
        self._links.append(links)
        self._add_up(self._open, weights_shader(), [links], {})
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
        weights = np.where(links != LINK_WITHIN, reached[:, None], 0.0)
        return float((weights * (links == LINK_NOTHING)).sum() / weights.sum()) if weights.sum() > 0.0 else 1.0

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

    def _add_up(self, records: _Records, shader: Any, batches: Sequence[Any], textures: dict[str, Any]) -> None:
        """Add to what each patch has in `records` the sum over its rays of some batches, of which these are the links.
        `textures`: what else the shader reads."""
        with blended("ADDITIVE_PREMULT"), records.target.bind():
            set_viewport(0, 0, records.texture.width, records.texture.height)
            shader.bind()
            shader.uniform_int("patches", self.patches.count)
            for name, texture in textures.items():
                shader.uniform_sampler(name, texture)
            for links in batches:
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
            self._shone.clear()
        self._add_shining(emitters, materials, of_hemisphere=True)
        picture, records = self._picture, (self._points, self._solids)
        for _ in picture.follow(rays, materials, view_uniforms, records, self.patches.count, self.batches, emitters):
            yield
        self._add_shining(emitters, materials, of_hemisphere=False)

    def _add_shining(self, emitters: Emitters, materials: Materials, of_hemisphere: bool) -> None:
        assert self._picture is not None and self._shone is not None

        def bind(shader: Any) -> None:
            if of_hemisphere:
                shader.uniform_sampler("patch_points", self._points)
                emitters.bind_densities(shader)

        shader = emitter_links_shader(materials.buffers, of_hemisphere, materials.links)
        links = self._picture.drawn_over(shader, materials, bind)
        self._add_up(self._shone, emitter_sum_shader(), [links], {"point_weights": self._open.texture})

    def light(self, lighting: Lighting, sub_frames: int) -> None:
        """Find what lamps and the world send straight to the patches: the mean of so many sub-frames' lights."""
        for _ in self.light_some(lighting, sub_frames):
            pass

    def light_some(self, lighting: Lighting, sub_frames: int) -> Iterator[None]:
        """The same, step by step."""
        for records in (self._of_lamps, self._of_sky):
            records.clear()
        for index in range(sub_frames):
            for _ in range(MOST_PARTS):
                try:
                    with paced(PART_SECONDS):
                        lighting.prepare(index)
                    break
                except OutOfTime:
                    yield
            yield
            # (What is drawn between steps may have prepared another.)
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
        self._swept.clear()
        self._sum()
        for _ in range(min(bounces, MOST_SWEEPS)):
            self._swept.clear()
            textures = {"patch_sent": self._sent[0].sent, "point_weights": self._open.texture}
            self._add_up(self._swept, sweep_shader(), self._links, textures)
            self._sum()

    def _sum(self) -> None:
        """The next pair of what is sent."""
        self._sent.reverse()
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

    def clear(self) -> None:
        """Nothing at all of them."""
        with self.target.bind():
            self.target.clear(color=(0.0, 0.0, 0.0, 0.0))


class _Sent:
    """All light that patches send on if white; what of it other surfaces have sent; and with what the world has."""

    def __init__(self, count: int) -> None:
        self.sent, self.arriving, self.under_sky = (empty_record_texture(count) for _ in range(3))
        self.target = frame_buffer(self.sent, self.arriving, self.under_sky)
