# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps, world light and their shadows on the GPU, for `lighting.glsl`.

A picture is the mean of `sub_frames` shadings. Each sees one point of every soft lamp and a few directions of the
world, with hard shadows from depth maps; their mean has the half-shadows. The maps belong to the scene, not to the
view: they are drawn when a sub-frame first needs them and kept.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...scene.arrays import Float64Array, LightArrays, SceneArrays
from ...scene.camera.sampling import is_progressive
from ...scene.camera.view import View
from ..cells.lookup import CELLS, THROWN, At, SurfaceLight, ThrownLight
from ..device.shaders import Block, Piece, flags, named, uniform_block
from ..device.textures import texture_2d
from ..geometry.placed_instances import Difference
from ..geometry.scene_geometry import SceneGeometry
from ..paths.surface_features import surface_features
from ..surfaces.materials import Materials
from .coarse_shadows import LAMPS, WORLD, are_too_coarse, things_ahead
from .ggx import GGX_DEFINES, ggx_table
from .lamp_views import LAMP_MAP_RESOLUTIONS, PICKED, picking_turn, picks_lamp, plan_lamps, shadow_features
from .lamps import (
    LAMP_DEFINES,
    LAMP_RECORDS,
    LOOK_RECORD,
    MAX_LAMPS,
    is_soft,
    knows_links,
    lamp_features,
    lamp_points,
    lamp_records,
    link_records,
    strongest,
)
from .left_out import left_out, oddly_seen
from .programs.casters import CasterBake
from .programs.lamps import LOOK_DEFINES, LampLooks, look_samplers
from .programs.textures import WorldTextures, world_samplers
from .programs.world import baked_world
from .shadow_alpha import ALPHA, SHADOW_ALPHA, ShadowAlpha
from .shadow_maps import DIRECTION_RECORDS, ShadowCasters, ShadowMaps, direction_records, fill_shadow_records
from .shadow_reach import cube_holds, shadow_pieces
from .shadow_views import SceneExtent, ShadowView
from .suns import shines, split_suns, suns_of_kinds
from .world import WORLD_DEFINES, world_light

HEADER_RECORDS = 8
MAX_DIRECTIONS = 32
"""World directions of one sub-frame"""
DATA_RECORDS = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS + MAX_DIRECTIONS * DIRECTION_RECORDS
"""vec4 records of the uniform block"""
MANY_TRIANGLES = 300_000
LAMP_SAMPLES, LAMP_SAMPLES_OF_MANY = 16, 4
"""Points on a soft lamp whose maps are kept, and in scenes of more than MANY_TRIANGLES. Pictures of few sub-frames have
no more points; others one for each sub-frame, which are drawn as they are needed"""
WORLD_DIRECTIONS, WORLD_DIRECTIONS_OF_MANY = 128, 16
"""World directions of a whole picture, and in scenes of more than MANY_TRIANGLES; at least one for each sub-frame"""
MOST_WORLD_DIRECTIONS = 256
"""Sub-frames beyond that go through them again: their mean is even, as their shadows are wide"""
DIRECTIONS_AT_ONCE, DIRECTIONS_ALONE = 8, 16
"""World directions of one sub-frame (each costs a tenth of all other shading), and of a picture of only one"""
WORLD_MAP_RESOLUTION = 384
type Features = frozenset[str]
"""Defines of `lighting.glsl`: kinds of lamps, of their shadows, whether lamps or the world light some rays only, what
the world is; what surfaces have (`surface_features`)"""
FEATURES: Features = frozenset(
    f"LIGHTING_{name}"
    for name in ("POINT", "SPOT", "SUN", "AREA", "SPREAD", "BALLS", "PARTS", "MAPS", "CUBES", "IMAGE", "WORLD")
)
INDIRECT = "LIGHTING_INDIRECT"
CAUSTICS = "LIGHTING_CAUSTICS"
"""Of features: light from other surfaces is known (`renderer/indirect`); what mirrors throw (`renderer/caustics`)"""
LARGEST_RECORD = 1e30
"""What of a lamp is larger would overflow in single precision with what it is multiplied by"""


def lighting_piece(features: Features = FEATURES) -> Piece:
    """What `lighting.glsl` needs; with the `features` of a scene, what it has beyond them is left out."""
    linked = MAX_LAMPS if knows_links(features) else 0
    return Piece(
        samplers={
            **named("DEPTH_2D_ARRAY", "lighting_lamp_depth", "lighting_world_depth"),
            "lighting_ggx": "FLOAT_2D",
            **world_samplers(features),
            **look_samplers(features),
            **(SHADOW_ALPHA.samplers if ALPHA in features else {}),
            **({**CELLS.samplers, "patch_light": "FLOAT_2D"} if INDIRECT in features else {}),
            **(THROWN.samplers if CAUSTICS in features else {}),
        },
        constants=CELLS.constants if INDIRECT in features else {},
        blocks={"lighting_data": Block("vec4", length=DATA_RECORDS + linked)},
        defines={
            **flags(*sorted(features)),
            **({"LINK_RECORDS": DATA_RECORDS} if linked else {}),
            "HEADER_RECORDS": HEADER_RECORDS,
            "DIRECTION_RECORDS": DIRECTION_RECORDS,
            **LAMP_DEFINES,
            **LOOK_DEFINES,
            **WORLD_DEFINES,
            **GGX_DEFINES,
            **SHADOW_ALPHA.defines,
            **CELLS.defines,
            **THROWN.defines,
        },
    )


class Lighting:
    """GPU resources that light one scene; `free()` when done."""

    def __init__(self, scene: SceneArrays, geometry: SceneGeometry, materials: Materials, sub_frames: int = 16) -> None:
        """`geometry`: all that may cast or receive shadows. `sub_frames`: how many shadings make one picture."""
        self.sub_frames = max(sub_frames, 1)
        self._geometry = geometry
        self.ggx = texture_2d(ggx_table(), linear=True)
        """Texture of `ggx_table`"""
        self._lamp_maps = ShadowMaps(LAMP_MAP_RESOLUTIONS[0], bias_texels=1.0)
        self._world_maps = ShadowMaps(WORLD_MAP_RESOLUTION, bias_texels=0.5)
        self._blocks: dict[int, tuple[Any, list[int], list[int]]] = {}
        """By sub-frame its uniform block and the views of its lamps' and the world's maps"""
        self._bound: Any = None
        self._surfaces: SurfaceLight | None = None
        self._thrown: ThrownLight | None = None
        self._sub_frame, self._has_moved = 0, False
        self._looks = LampLooks()
        self._lamp_warnings: tuple[str, ...] = ()
        self.world_warnings: tuple[str, ...] = ()
        self._scene = scene
        self._left_out, self._oddly_seen = left_out(scene), oddly_seen(scene)
        self._alpha = ShadowAlpha(scene, CasterBake(materials))
        self._of_surfaces = surface_features(scene)
        self._read_geometry()
        self._read_world()
        self._plan_lamps()
        self._plan_world_shadows()
        self.features = self._found_features()
        """What a shader that lights this scene has to have (see `declare`)"""

    def follow(self, scene: SceneArrays, difference: Difference, is_fresh: bool = False) -> None:
        """Light another state of the scene, whose geometry the `difference` has changed; `is_fresh`: see `Renderer`."""
        before, self._scene = self._scene, scene
        if scene.instances is not before.instances:
            self._oddly_seen = oddly_seen(scene)
        if difference.structure or scene.materials is not before.materials or scene.reflectors != before.reflectors:
            self._left_out = left_out(scene)
            self._of_surfaces = surface_features(scene)
        moved = difference.elsewhere
        was_hashed = self._alpha.is_hashed
        drawn_anew = self._alpha.follow(scene) or bool(moved)
        planned = difference.structure or (bool(moved) and (is_fresh or not self._holds(moved)))
        planned |= self._alpha.is_hashed != was_hashed or (is_fresh and self._has_moved)
        self._has_moved = not planned and (bool(moved) or self._has_moved)
        if planned:
            self._read_geometry()
        if scene.world is not before.world or self._alpha.is_hashed != was_hashed:
            self._read_world()
        if planned or scene.lights is not before.lights or scene.world is not before.world:
            self._plan_lamps()
        elif drawn_anew:
            self._lamp_maps.forget()
        if planned or scene.world is not before.world:
            self._plan_world_shadows()
        elif drawn_anew:
            self._world_maps.forget()
        self.features = self._found_features()
        self._blocks.clear()

    def _read_geometry(self) -> None:
        pieces, self._standing_apart = shadow_pieces(self._geometry)
        self._extent = SceneExtent(pieces)
        self._casters = ShadowCasters(self._geometry, self._extent, self._alpha)
        self._many = sum(chunk.triangle_count for chunk in self._geometry.chunks) > MANY_TRIANGLES

    def _holds(self, moved: list[int]) -> bool:
        """Whether the maps' views serve for the scene with these instances where they are now."""
        corners = self._geometry.box_corners(moved).reshape(-1, 3)
        if not self._extent.spares(moved, corners):
            return False
        pairs = zip(self._lights, self._lamp_places, strict=True)
        lamps = [view for light, planned in pairs if light.casts_shadow for view in planned]
        # Where nothing could be in shadow there is no map, and now something may.
        if any(len(layers) == 0 or layers == (-1,) for _, layers in lamps) or -1 in self._world_layers:
            return False
        if not self._lamp_maps.hold([layers[0] for _, layers in lamps if len(layers) == 1], corners):
            return False
        if not self._world_maps.hold(range(len(self._world_maps.views)), corners):
            return False
        balls = self._geometry.balls(np.array(moved))
        cubes = [(place[:3], layers) for place, layers in lamps if len(layers) == 6]
        return all(cube_holds(self._lamp_maps, place, layers, *balls) for place, layers in cubes)

    def _found_features(self) -> Features:
        found = lamp_features(self._lights, self._world, self._scene) | shadow_features(self._lamp_places)
        flagged = {"LIGHTING_IMAGE": self._world.image is not None, "LIGHTING_WORLD": self._world_is_lit}
        flagged |= {ALPHA: bool(self._alpha.materials), PICKED: picks_lamp(self._lights, self.sub_frames)}
        flagged |= {INDIRECT: self._surfaces is not None, CAUSTICS: self._thrown is not None}
        flagged["LIGHTING_CLAMPED"] = bool(self._lights) and self._scene.indirect_clamp > 0.0
        found |= {name for name, is_so in flagged.items() if is_so}
        return frozenset(found) | self._world_textures.features | self._looks.features | self._of_surfaces

    def use(self, surfaces: SurfaceLight | None, thrown: ThrownLight | None) -> None:
        """Light from other surfaces, and what lamps throw over mirrors, or none."""
        self._surfaces, self._thrown = surfaces, thrown
        self.features = self._found_features()

    def too_coarse(self, view: View) -> tuple[bool, bool]:
        """Whether the shadow maps of lamps and of the world are too coarse for a view."""
        pairs = ((self._lamp_maps, LAMPS), (self._world_maps, WORLD))
        ahead = things_ahead(view, *self._geometry.balls())
        lamps, world = (are_too_coarse(one.views, one.resolution, limit, ahead) for one, limit in pairs)
        return lamps, world

    def prepare(self, sub_frame: int, sky_is_gathered: bool = False) -> None:
        """Choose the samples of this sub-frame (counted modulo `sub_frames`); draws depth maps still missing. Where
        `sky_is_gathered` the world's are not drawn again for what else is there by chance: nearly nothing asks them.

        Not inside a frame buffer's `bind()` block whose viewport matters: that is restored, but costs time.
        """
        index = self._sub_frame = sub_frame % self.sub_frames
        if index not in self._blocks:
            lamp_views, world_views, records = self._records(index)
            # (A strong lamp of nearly no size would shine endlessly there.)
            records = np.clip(records, -LARGEST_RECORD, LARGEST_RECORD)
            self._blocks[index] = uniform_block(records.astype(np.float32).ravel()), lamp_views, world_views
        self._bound, lamp_views, world_views = self._blocks[index]
        self._alpha.prepare()
        # (Another sub-frame may have drawn over them.)
        self._lamp_maps.draw(lamp_views, self._casters)
        begun = index * self._directions_at_once // len(self._world_light.draws)
        visit = 0 if sky_is_gathered else begun % self._world_visits
        self._world_maps.draw(world_views, self._casters, (visit, self._world_visits))

    def lamp_points(self, sub_frame: int) -> list[tuple[LightArrays, Float64Array]]:
        """The lamps, in the order of their records, and where on them (4,) a sub-frame's light comes from."""
        planned = zip(self._lights, self._lamp_places, strict=True)
        return [(light, places[sub_frame % len(places)][0]) for light, places in planned]

    def bind(self, shader: Any) -> None:
        """Set the samplers and the block of the sub-frame last prepared on a bound shader."""
        shader.uniform_block("lighting_data", self._bound)
        shader.uniform_sampler("lighting_lamp_depth", self._lamp_maps.texture)
        shader.uniform_sampler("lighting_world_depth", self._world_maps.texture)
        if ALPHA in self.features:
            self._alpha.bind(shader)
        self._world_textures.bind(shader)
        self._looks.bind(shader)
        shader.uniform_sampler("lighting_ggx", self.ggx)
        if self._surfaces is not None:
            self._surfaces.bind(shader, At.ENDS)
        if self._thrown is not None:
            self._thrown.bind(shader, self._sub_frame)

    def free(self) -> None:
        """Drop the GPU objects; the instance cannot be used afterwards."""
        self._blocks.clear()
        for name in ("_bound", "_casters", "_lamp_maps", "_world_maps", "_world_textures", "ggx"):
            self.__dict__.pop(name, None)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What could not be represented, one sentence each."""
        oddly_seen = self._oddly_seen if self._world_is_lit else ()
        return (*self._lamp_warnings, *self._left_out, *self._alpha.warnings, *oddly_seen)

    def _plan_lamps(self) -> None:
        """Choose the points on every lamp, their shadow views and one resolution for all."""
        self._lamp_warnings = self._standing_apart
        lights = self._looks.follow(self._scene.lights, self._baked.suns, self._baked.looks)
        self._lights, left_out = strongest(lights + self._image_suns)
        self._lamp_warnings += left_out + self._looks.warnings
        kept = LAMP_SAMPLES_OF_MANY if self._many else LAMP_SAMPLES
        samples = self.sub_frames if is_progressive(self.sub_frames) else min(self.sub_frames, kept)
        points = [self._alpha.repeated(lamp_points(lamp, samples, k), samples) for k, lamp in enumerate(self._lights)]
        planned = plan_lamps(self._extent, self._lights, points, kept)
        self._lamp_places = planned.places
        self._lamp_maps.plan(planned.views, planned.resolution, planned.layers)

    def _read_world(self) -> None:
        """Choose the world's directions; fill its textures."""
        baked = self._baked = baked_world(self._scene.world)
        world = self._world = baked.glossy
        self._sky = split_suns(world)
        even = self._sky if baked.diffuse is world else split_suns(baked.diffuse)
        self._image_suns = suns_of_kinds(self._sky, even)
        lit = shines(world, world.visible_glossy) or shines(baked.diffuse, world.visible_diffuse)
        at_once = DIRECTIONS_AT_ONCE if self.sub_frames > 1 else DIRECTIONS_ALONE
        most = WORLD_DIRECTIONS_OF_MANY if self._many else WORLD_DIRECTIONS
        self._directions_at_once = min(-(-most // self.sub_frames), at_once) if lit else 0
        count = min(self._directions_at_once * self.sub_frames, MOST_WORLD_DIRECTIONS)
        self._world_visits = 1
        if lit and self._alpha.is_hashed and not self._many and count:
            # More than the directions what is there by chance wants a mean of many.
            self._directions_at_once, count = at_once, min(at_once * self.sub_frames, most)
            self._world_visits = -(-at_once * self.sub_frames // count)
        self.with_all_directions = -(-count // self._directions_at_once) if self._directions_at_once else 1
        """Sub-frames, from the first on, that have all directions of the world"""
        light = world_light(self._sky.world, max(count, 1), even.world)
        self._world_light, self._world_is_lit = light, lit
        self._world_textures = WorldTextures(baked, light.maps)
        self.world_warnings = self._world_textures.warnings

    def _plan_world_shadows(self) -> None:
        """Shadow views of the world's directions."""
        views: list[ShadowView] = []
        directions = self._world_light.directions
        self._world_layers = np.full(len(directions), -1)
        for index, direction in enumerate(directions if self._world_is_lit else ()):
            view = self._extent.parallel_view(direction, WORLD_MAP_RESOLUTION)
            if view is not None:
                self._world_layers[index] = len(views)
                # (What is there by chance in one direction's map has nothing to do with the others'.)
                views.append(replace(view, turn=(index, 1)))
        self._world_maps.plan(views)

    def _records(self, index: int) -> tuple[list[int], list[int], Float64Array]:
        """Views of lamps and world that the sub-frame needs, and its uniform block."""
        records = np.zeros((DATA_RECORDS, 4))
        lamp_layers: list[int] = []
        for row, (light, planned) in enumerate(zip(self._lights, self._lamp_places, strict=True)):
            place, layers = planned[index % len(planned)]
            start = HEADER_RECORDS + row * LAMP_RECORDS
            block = lamp_records(light, place, len(planned) if is_soft(light) else 1)
            block[LOOK_RECORD] = self._looks.record(light)
            fill_shadow_records(block, self._lamp_maps, layers)
            records[start : start + LAMP_RECORDS] = block
            lamp_layers += [layer for layer in layers if layer >= 0]
        draws = range(index * self._directions_at_once, (index + 1) * self._directions_at_once)
        block, world_layers = direction_records(self._world_light, self._world_layers, self._world_maps, draws)
        start = HEADER_RECORDS + MAX_LAMPS * LAMP_RECORDS
        records[start : start + len(block)] = block
        # (Directions of a sky of one color weigh the same: what is drawn without an image reads it once.)
        records[5] = block[-1] if len(block) else 0.0
        records[0] = [len(self._lights), len(world_layers), float(self._world.image is not None), picking_turn(index)]
        records[1] = [*self._world.color, min(self._sky.limit, 1e30)]
        world = self._world
        records[2:5, :3] = world.rotation
        records[6, :3] = world.visible_camera, world.visible_diffuse, world.visible_glossy
        records[7, 0] = self._scene.indirect_clamp
        if knows_links(self.features):
            records = np.concatenate([records, link_records(self._lights)])
        return lamp_layers, world_layers, records
