# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which shadow views the points on lamps need, and which of these share a layer of the maps' texture. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...scene.arrays import Float64Array, LightArrays
from .shadow_views import SceneExtent, ShadowView

LAMP_MAP_RESOLUTIONS = (2048, 1024, 512, 256)
LAMP_MAP_BYTES = 160 << 20
"""The finest resolution that fits is taken"""
PICKED = "LIGHTING_PICKED"
"""Among the features of the lighting: one lamp of many in each sub-frame, where shadows are found by rays"""
FEWEST_PICKING = 8
"""Sub-frames: in fewer the shadows of one lamp would be seen apart from those of others"""
GOLDEN_SECTION = 0.6180339887498949


def picks_lamp(lights: Iterable[LightArrays], sub_frames: int) -> bool:
    """Whether one lamp's shadow ray stands for those of all (`lamps_on` in `lamps.glsl`)."""
    return sub_frames >= FEWEST_PICKING and sum(light.casts_shadow for light in lights) > 1


def picking_turn(sub_frame: int) -> float:
    """In 0 .. 1: of successive sub-frames any few are spread evenly."""
    return sub_frame * GOLDEN_SECTION % 1.0


@dataclass(frozen=True, slots=True)
class LampViews:
    """Of all lamps."""

    places: list[list[tuple[Float64Array, tuple[int, ...]]]]
    """Per lamp its points (4,), each with the numbers of its views: one or a cube's six; -1: nothing in shadow there"""
    views: list[ShadowView]
    layers: list[int]
    """By view"""
    resolution: int


def plan_lamps(
    extent: SceneExtent, lights: Sequence[LightArrays], points: Sequence[Float64Array], kept: int
) -> LampViews:
    """Views of lamps from `points` (n, 4) on each, and one resolution for all.

    Every `kept`th point of a lamp has the same layers: what one sub-frame needs is there at once, and of `kept`
    sub-frames nothing is drawn twice.
    """
    for resolution in LAMP_MAP_RESOLUTIONS:
        planned = _plan(extent, lights, points, kept, resolution)
        if (max(planned.layers, default=-1) + 1) * resolution * resolution * 4 <= LAMP_MAP_BYTES:
            break
    return planned


def _plan(
    extent: SceneExtent, lights: Sequence[LightArrays], points: Sequence[Float64Array], kept: int, resolution: int
) -> LampViews:
    planned = LampViews([], [], [], resolution)
    layers: dict[tuple[int, int, int], int] = {}
    for row, (light, places) in enumerate(zip(lights, points, strict=True)):
        planned.places.append([])
        for number, place in enumerate(places):
            found: tuple[ShadowView | None, ...] = ()
            if light.casts_shadow and light.kind == "SUN":
                found = (extent.parallel_view(place[:3] / np.linalg.norm(place[:3]), resolution),)
            elif light.casts_shadow:
                found = extent.point_views(place[:3], resolution)
            faces = []
            for face, view in enumerate(found):
                faces.append(-1 if view is None else len(planned.views))
                if view is not None:
                    planned.views.append(replace(view, turn=(number, len(places)), blocked_by=light.blocked_by))
                    planned.layers.append(layers.setdefault((row, number % kept, face), len(layers)))
            planned.places[-1].append((place, tuple(faces)))
    return planned


def shadow_features(places: Sequence[Sequence[tuple[Float64Array, tuple[int, ...]]]]) -> set[str]:
    """Defines of `lamps.glsl`: which kinds of maps there are, by `LampViews.places`."""
    shadows = {len(layers) for planned in places for _, layers in planned if max(layers, default=-1) >= 0}
    return {name for faces, name in ((1, "LIGHTING_MAPS"), (6, "LIGHTING_CUBES")) if faces in shadows}
