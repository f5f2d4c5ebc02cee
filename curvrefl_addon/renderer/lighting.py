# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps, world light and their shadows on the GPU, for `lighting.glsl`.

A picture is the mean of `sub_frames` shadings. Each sees one point of every soft lamp and a few directions of the
world, with hard shadows from depth maps; their mean has the half-shadows. The maps belong to the scene, not to the
view: they are drawn when a sub-frame first needs them and kept.
"""

from __future__ import annotations

from typing import Any

import gpu
import numpy as np

from ..scene.arrays import Float64Array, Int32Array, LightArrays, SceneArrays
from .geometry import WorldGeometry
from .gpu_objects import buffer_of, texture_2d, uniform_block
from .lighting_ggx import ggx_table
from .lighting_lamps import LAMP_RECORDS, MAX_LAMPS, is_soft, lamp_points, lamp_records
from .lighting_shadow_maps import ShadowCasters, ShadowMaps
from .lighting_shadow_views import MARGIN_TEXELS, SceneExtent, ShadowView
from .lighting_world import world_light

HEADER_RECORDS = 8
DIRECTION_RECORDS = 5
MAX_DIRECTIONS = 32
"""World directions per sub-frame"""
DATA_RECORDS = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS + MAX_DIRECTIONS * DIRECTION_RECORDS
"""vec4 records of the uniform block; as in lighting.glsl"""
SAMPLER_COUNT = 5
MAX_LAMP_SAMPLES = 16
WORLD_DIRECTIONS = 64
"""World directions of a whole picture of 16 sub-frames"""
WORLD_MAP_RESOLUTION = 512
LAMP_MAP_BYTES = 128 << 20


class Lighting:
    """GPU resources that light one scene; `free()` when done."""

    warnings: tuple[str, ...]
    """What could not be represented, one sentence each"""

    def __init__(self, scene: SceneArrays, geometry: WorldGeometry, sub_frames: int = 16) -> None:
        """`geometry`: all that may cast or receive shadows. `sub_frames`: how many shadings make one picture."""
        self.sub_frames = max(sub_frames, 1)
        self.warnings = ()
        triangles = geometry.corner_position[geometry.triangles].reshape(-1, 3)
        casts = _casting_triangles(scene, geometry, triangles)
        self._casters = ShadowCasters(geometry.positions, triangles[casts])
        self._extent = SceneExtent(geometry.positions, triangles, casts)
        self._lights = self._chosen_lights(scene.lights)
        self._samples = min(self.sub_frames, MAX_LAMP_SAMPLES)
        self._plan_lamps()
        self._plan_world(scene)
        self._ggx = texture_2d(ggx_table(), linear=True)
        self._blocks: dict[int, Any] = {}
        self._bound: Any = None

    @staticmethod
    def declare(info: Any, first_sampler: int, uniform_slot: int = 1) -> None:
        """Add SAMPLER_COUNT samplers from slot `first_sampler` and one uniform block to a GPUShaderCreateInfo."""
        for index, (kind, name) in enumerate(
            (
                ("DEPTH_2D_ARRAY", "lighting_lamp_depth"),
                ("DEPTH_2D_ARRAY", "lighting_world_depth"),
                ("FLOAT_2D_ARRAY", "lighting_world_maps"),
                ("FLOAT_2D", "lighting_world_image"),
                ("FLOAT_2D", "lighting_ggx"),
            )
        ):
            info.sampler(first_sampler + index, kind, name)
        info.uniform_buf(uniform_slot, "vec4", f"lighting_data[{DATA_RECORDS}]")

    def prepare(self, sub_frame: int) -> None:
        """Choose the samples of this sub-frame (counted modulo `sub_frames`); draws depth maps still missing.

        Not inside a frame buffer's `bind()` block whose viewport matters: that is restored, but costs time.
        """
        index = sub_frame % self.sub_frames
        if index not in self._blocks:
            lamp_layers, world_layers, records = self._records(index)
            self._lamp_maps.draw(lamp_layers)
            self._world_maps.draw(world_layers)
            self._blocks[index] = uniform_block(records.astype(np.float32).ravel())
        self._bound = self._blocks[index]

    def bind(self, shader: Any) -> None:
        """Set the samplers and the block of the sub-frame last prepared on a bound shader."""
        shader.uniform_block("lighting_data", self._bound)
        shader.uniform_sampler("lighting_lamp_depth", self._lamp_maps.texture)
        shader.uniform_sampler("lighting_world_depth", self._world_maps.texture)
        shader.uniform_sampler("lighting_world_maps", self._world_textures)
        shader.uniform_sampler("lighting_world_image", self._world_image)
        shader.uniform_sampler("lighting_ggx", self._ggx)

    def free(self) -> None:
        """Drop the GPU objects; the instance cannot be used afterwards."""
        self._blocks.clear()
        for name in ("_bound", "_casters", "_lamp_maps", "_world_maps", "_world_textures", "_world_image", "_ggx"):
            self.__dict__.pop(name, None)

    def _chosen_lights(self, lights: tuple[LightArrays, ...]) -> list[LightArrays]:
        shining = [light for light in lights if max(light.color) > 0.0]
        if len(shining) > MAX_LAMPS:
            self.warnings += (f"Only the {MAX_LAMPS} strongest of {len(shining)} lamps are used.",)
            shining.sort(key=lambda light: -sum(light.color))
        return shining[:MAX_LAMPS]

    def _plan_lamps(self) -> None:
        """Choose the points on every lamp, their shadow views and one resolution for all."""
        points = [lamp_points(light, self._samples, index) for index, light in enumerate(self._lights)]
        total = sum(len(place) for place, light in zip(points, self._lights, strict=True) if light.casts_shadow)
        resolution = 2048 if total <= 4 else 1024
        while resolution > 256 and total * resolution * resolution * 4 > LAMP_MAP_BYTES:
            resolution //= 2
        views: list[ShadowView] = []
        self._lamp_places: list[list[tuple[Float64Array, tuple[int, ...]]]] = []
        for light, places in zip(self._lights, points, strict=True):
            planned = []
            for place in places:
                found: tuple[ShadowView | None, ...] = ()
                if light.casts_shadow and light.kind == "SUN":
                    found = (self._extent.parallel_view(place[:3] / np.linalg.norm(place[:3]), resolution),)
                elif light.casts_shadow:
                    found = self._extent.point_views(place[:3], resolution)
                layers = []
                for view in found:
                    layers.append(-1 if view is None else len(views))
                    if view is not None:
                        views.append(view)
                planned.append((place, tuple(layers)))
            self._lamp_places.append(planned)
        self._lamp_maps = ShadowMaps(self._casters, resolution, views)

    def _plan_world(self, scene: SceneArrays) -> None:
        world = scene.world
        lit = max(world.color) > 0.0
        per_frame = min(max(-(-WORLD_DIRECTIONS // self.sub_frames), 2), MAX_DIRECTIONS) if lit else 0
        self._subsets = min(self.sub_frames, 2 * WORLD_DIRECTIONS // max(per_frame, 1))
        self._light = world_light(world, max(per_frame * self._subsets, 1))
        self._world = world
        views: list[ShadowView] = []
        self._world_layers: list[int] = []
        for direction in self._light.directions if lit else ():
            view = self._extent.parallel_view(direction, WORLD_MAP_RESOLUTION)
            self._world_layers.append(-1 if view is None else len(views))
            if view is not None:
                views.append(view)
        self._world_maps = ShadowMaps(self._casters, WORLD_MAP_RESOLUTION, views)
        maps = self._light.maps
        self._world_textures = gpu.types.GPUTexture(
            (maps.shape[2], maps.shape[1]), layers=len(maps), format="RGBA32F", data=buffer_of(maps)
        )
        if world.image is None:
            self._world_image = texture_2d(np.zeros((1, 1, 4), np.float32))
        else:
            image = np.ones((*world.image.shape[:2], 4), np.float32)
            image[..., :3] = world.image
            self._world_image = texture_2d(image, linear=True, repeat=True)

    def _records(self, index: int) -> tuple[list[int], list[int], Float64Array]:
        """Layers that the sub-frame needs, and its uniform block (DATA_RECORDS, 4)."""
        records = np.zeros((DATA_RECORDS, 4))
        lamp_layers: list[int] = []
        for row, (light, planned) in enumerate(zip(self._lights, self._lamp_places, strict=True)):
            place, layers = planned[index % len(planned)]
            start = HEADER_RECORDS + row * LAMP_RECORDS
            block = lamp_records(light, place, len(planned) if is_soft(light) else 1)
            self._shadow_records(block, self._lamp_maps, layers)
            records[start : start + LAMP_RECORDS] = block
            lamp_layers += [layer for layer in layers if layer >= 0]
        chosen = range(index % self._subsets, len(self._world_layers), self._subsets)
        start = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS
        world_layers = []
        for direction in chosen:
            layer = self._world_layers[direction]
            if layer < 0:
                continue
            view = self._world_maps.views[layer]
            records[start, :3] = self._light.directions[direction]
            records[start, 3] = layer
            records[start + 1, :3] = self._light.weights[direction] * self._subsets
            records[start + 2 : start + 5] = _window_rows(view, self._world_maps.resolution)[:3]
            start += DIRECTION_RECORDS
            world_layers.append(layer)
        records[0] = [len(self._lights), len(world_layers), 0.0 if self._world.image is None else 1.0, 0.0]
        records[1, :3] = self._world.color
        records[2:5, :3] = self._world.rotation
        return lamp_layers, world_layers, records

    def _shadow_records(self, block: Float64Array, maps: ShadowMaps, layers: tuple[int, ...]) -> None:
        """Fill in how to look up the shadow: kind in [6, 3] (0 none, 1 one map, 2 cube), data in rows 7 to 11."""
        if len(layers) == 1 and layers[0] >= 0:
            block[6, 3] = 1.0
            block[7:11] = _window_rows(maps.views[layers[0]], maps.resolution)
            block[11, 0] = layers[0]
        elif len(layers) == 6 and max(layers) >= 0:
            block[6, 3] = 2.0
            near_term, far_term = maps.views[max(layers)].depth_terms
            block[7] = layers[:4]
            block[8] = [layers[4], layers[5], near_term, far_term]
            block[9, :2] = [0.5 * maps.resolution, 0.5 * maps.resolution - MARGIN_TEXELS]


def _window_rows(view: ShadowView, resolution: int) -> Float64Array:
    """(4, 4) rows that give a world point's texel x, texel y and depth in 0..1, each times w, and w."""
    to_window = np.array(
        [
            [0.5 * resolution, 0.0, 0.0, 0.5 * resolution],
            [0.0, 0.5 * resolution, 0.0, 0.5 * resolution],
            [0.0, 0.0, 0.5, 0.5],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    return to_window @ view.world_to_clip


def _casting_triangles(scene: SceneArrays, geometry: WorldGeometry, triangles: Int32Array) -> np.ndarray:
    """(triangles,) bool: the object casts shadows."""
    highest = int(geometry.position_object.max()) if len(geometry.position_object) else 0
    casts = np.ones(highest + 1, bool)
    for instance in scene.instances:
        if instance.object_id <= highest:
            casts[instance.object_id] = instance.visible_shadow
    if len(triangles) == 0:
        return np.zeros(0, bool)
    return casts[geometry.position_object[triangles[:, 0]]]
