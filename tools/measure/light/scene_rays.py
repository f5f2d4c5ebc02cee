# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays of the renderer from any places, and what lamps and the world send there: what caches of light are filled by.

All of it by the passes that fill the patches, so that caches differ in nothing but what they keep.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.cells.lookup import CELLS, At
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import empty_record_texture, read_records, record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from curvrefl.curvrefl_addon.renderer.device.state import blended, drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture
from curvrefl.curvrefl_addon.renderer.indirect.irradiance import Irradiance
from curvrefl.curvrefl_addon.renderer.indirect.patch_picture import PatchPicture
from curvrefl.curvrefl_addon.renderer.indirect.patch_shaders import (
    RAYS_AT_ONCE,
    emitter_links_shader,
    light_shader,
    sent_on_piece,
)
from curvrefl.curvrefl_addon.renderer.indirect.points import POINTS
from curvrefl.curvrefl_addon.renderer.programs.buffers import Buffers, reads
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.surfaces.materials import TABLE
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SURFACE_SAMPLERS

SHADERS = Path(__file__).resolve().parent / "shaders"
GROUPS_AT_ONCE = 16_384
"""Of POINTS places, that send RAYS_AT_ONCE rays together"""
RAYS_OF_PLACE = RAYS_AT_ONCE // POINTS


@dataclass(frozen=True, slots=True)
class Hits:
    """What rays have met; (places, RAYS_OF_PLACE, ..) in order."""

    directions: np.ndarray
    ranges: np.ndarray
    """Infinite where there is nothing"""
    is_within: np.ndarray
    """The ray has begun inside of something solid"""
    positions: np.ndarray
    """Lifted off the surface"""
    normals: np.ndarray
    """Of the side that sends on"""
    albedo: np.ndarray
    """0 where there is nothing"""
    emission: np.ndarray
    shone: np.ndarray
    """Irradiance by what shines that this ray and one to what shines stand for, each weighing the other"""

    def joined(self, other: Hits) -> Hits:
        """With the rays of another batch of the same places."""
        return Hits(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)], axis=1) for f in fields(Hits)))


class SceneRays:
    """Of a renderer that has drawn a picture in full light."""

    def __init__(self, renderer: Renderer, lift: float) -> None:
        """`lift`: how far off surfaces rays go on."""
        self.appearance = renderer._appearance
        self.indirect = self.appearance.indirect
        self.rays, self.view_uniforms = renderer.rays(), renderer._view_uniforms
        self.lighting, self.materials = self.appearance.lighting, self.appearance.materials
        self.bounces, self.has_caustics = renderer.scene.diffuse_bounces, renderer.scene.caustics
        self.lights = max(min(16, self.lighting.sub_frames), self.lighting.with_all_directions)
        self._lift = lift
        self._pictures: dict[int, PatchPicture] = {}
        self._solids: Any = None if self.indirect.irradiance is None else self.indirect.irradiance._solids
        self.rays_followed, self.seconds = 0, 0.0

    def follow(self, positions: np.ndarray, normals: np.ndarray, batch: int, with_emitters: bool) -> Hits:
        """RAYS_OF_PLACE rays from each place (n, 3), by the cosine about its normal, and as many to what shines."""
        parts = []
        count = len(positions)
        padding = -count % POINTS
        positions, normals = (np.concatenate([all_, all_[:padding]]) for all_ in (positions, normals))
        step = GROUPS_AT_ONCE * POINTS
        for first in range(0, len(positions), step):
            some = slice(first, first + step)
            parts.append(self._follow(positions[some], normals[some], batch, with_emitters))
        whole = (np.concatenate([getattr(part, f.name) for part in parts])[:count] for f in fields(Hits))
        return Hits(*whole)

    def _follow(self, positions: np.ndarray, normals: np.ndarray, batch: int, with_emitters: bool) -> Hits:
        groups = len(positions) // POINTS
        points = np.zeros((groups, 2, POINTS, 4), np.float32)
        points[:, 0, :, :3], points[:, 1, :, :3] = (part.reshape(groups, POINTS, 3) for part in (positions, normals))
        records = (record_texture(points.reshape(-1, 4)), self._solids)
        if groups not in self._pictures:
            self._pictures[groups] = PatchPicture(groups)
        picture = self._pictures[groups]
        means = (self.rays, self.materials, self.view_uniforms, records, groups, batch)
        start = perf_counter()
        for _ in picture.follow(*means):
            pass
        way = self._rows(picture.way, groups)
        self.seconds += perf_counter() - start
        self.rays_followed += groups * RAYS_AT_ONCE
        position = self._rows(picture.position, groups)
        albedo, side, emission = (self._rows(texture, groups) for texture in self._sent(picture))
        shone = np.zeros((*way.shape[:2], 3), np.float32)
        if with_emitters and self.indirect.emitters is not None:
            shone += self._rows(self._shining(picture, records[0], True), groups)[..., :3]
            for _ in picture.follow(*means, self.indirect.emitters):
                pass
            shone += self._rows(self._shining(picture, records[0], False), groups)[..., :3]
            shone *= 0.5
            self.rays_followed += groups * RAYS_AT_ONCE
        met = position[..., 3] > 0.5
        normals_met = side[..., :3]
        return Hits(
            directions_of(way),
            np.where(met, way[..., 3], np.inf),
            way[..., 2] > 0.5,
            position[..., :3] + self._lift * normals_met,
            normals_met,
            np.where((met & (way[..., 2] < 0.5))[..., None], albedo[..., :3], 0.0),
            emission[..., :3],
            shone,
        )

    def _rows(self, texture: Any, groups: int) -> np.ndarray:
        """(places, RAYS_OF_PLACE, 4): a group's rays take turns among its places."""
        flat = read_texture(texture).reshape(-1, 4)[: groups * RAYS_AT_ONCE]
        rays = flat.reshape(groups, RAYS_OF_PLACE, POINTS, 4).swapaxes(1, 2)
        return rays.reshape(groups * POINTS, RAYS_OF_PLACE, 4)

    def _sent(self, picture: PatchPicture) -> list[Any]:
        drawn = [empty_texture(picture.width, picture.height) for _ in range(3)]
        shader = _hits_shader(self.materials.buffers, self.lighting.features)
        with drawing_state(), frame_buffer(*drawn).bind():
            set_viewport(0, 0, picture.width, picture.height)
            shader.bind()
            shader.uniform_sampler("materials", self.materials.table)
            textures = (picture.position, picture.normal, picture.color)
            for name, texture in zip(SURFACE_SAMPLERS, textures, strict=True):
                shader.uniform_sampler(name, texture)
            shader.uniform_sampler("path_way", picture.way)
            shader.uniform_sampler("lighting_ggx", self.lighting.ggx)
            shader.uniform_float("has_caustics", float(self.has_caustics))
            picture.made.bind(shader, self.materials.buffers)
            full_screen_triangle().draw(shader)
        return drawn

    def _shining(self, picture: PatchPicture, points: Any, of_hemisphere: bool) -> Any:
        def bind(shader: Any) -> None:
            if of_hemisphere:
                shader.uniform_sampler("patch_points", points)
                self.indirect.emitters.bind_densities(shader)

        return picture.drawn_over(emitter_links_shader(self.materials.buffers, of_hemisphere), self.materials, bind)

    def lit(self, positions: np.ndarray, normals: np.ndarray, sub_frames: range) -> np.ndarray:
        """(n, 3) irradiance straight from lamps and the world at places (n, 3): the mean of these sub-frames."""
        count = len(positions)
        groups = -(-count // POINTS)
        points = np.zeros((2, groups * POINTS, 4), np.float32)
        points[0, :count, :3], points[1, :count, :3] = positions, normals
        asked = record_texture(points.reshape(2, groups, POINTS, 4).swapaxes(0, 1).reshape(-1, 4))
        found = empty_record_texture(groups * POINTS)
        target = frame_buffer(found)
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0))
        for index in sub_frames:
            self.lighting.prepare(index)
            for of_sky in (False, True):
                shader = light_shader(self.lighting.features, of_sky)
                with blended("ADDITIVE_PREMULT"), target.bind():
                    set_viewport(0, 0, found.width, found.height)
                    shader.bind()
                    shader.uniform_sampler("patch_points", asked)
                    shader.uniform_int("patches", groups)
                    shader.uniform_float("weight", 1.0 / len(sub_frames))
                    self.lighting.bind(shader)
                    full_screen_triangle().draw(shader)
        return read_records(found, count)[:, :3]

    def read_patches(self, irradiance: Irradiance, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """(n, 3) irradiance from other surfaces at places (n, 3), as a moving view reads it off patches."""
        records = np.zeros((len(positions), 2, 4), np.float32)
        records[:, 0, :3], records[:, 1, :3] = positions, normals
        asked, found = record_texture(records.reshape(-1, 4)), empty_record_texture(len(positions))
        shader = _read_shader()
        with drawing_state(), frame_buffer(found).bind():
            set_viewport(0, 0, found.width, found.height)
            shader.bind()
            shader.uniform_sampler("asked", asked)
            irradiance.bind(shader, At.ENDS)
            full_screen_triangle().draw(shader)
        return read_records(found, len(positions))[:, :3]


def directions_of(way: np.ndarray) -> np.ndarray:
    """(.., 3) of ways as `path_state.glsl` packs them."""
    found = np.concatenate([way[..., :2], 1.0 - np.abs(way[..., :2]).sum(axis=-1, keepdims=True)], axis=-1)
    folded = (1.0 - np.abs(found[..., 1::-1])) * np.where(found[..., :2] < 0.0, -1.0, 1.0)
    found[..., :2] = np.where(found[..., 2:] < 0.0, folded, found[..., :2])
    return found / np.maximum(np.linalg.norm(found, axis=-1, keepdims=True), 1e-20)


@cache
def _hits_shader(buffers: Buffers, features: Any) -> Any:
    return build_shader(
        "what hits send",
        FULL_SCREEN,
        TABLE,
        reads(buffers),
        sent_on_piece(features),
        Piece(
            outputs=named("VEC4", "albedo_out", "side_out", "shone_out"),
            fragment=SHADERS / "what_hits_send.frag.glsl",
        ),
    )


@cache
def _read_shader() -> Any:
    return build_shader(
        "reading patches",
        FULL_SCREEN,
        CELLS,
        Piece(
            samplers=named("FLOAT_2D", "asked", "patch_light"),
            outputs=named("VEC4", "color"),
            defines=flags("SMOOTH_CELLS"),
            fragment=SHADERS / "read_patches.frag.glsl",
        ),
    )
