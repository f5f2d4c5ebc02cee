# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shaders that light surfaces are compiled for, beside the features of the lighting."""

from __future__ import annotations

from dataclasses import dataclass

from ..device.shaders import Piece
from ..device.ways.features import features as device_features
from ..indirect.gather import NO_FEATURES
from ..lighting.lighting import Features, Lighting, lighting_piece
from ..rays.ray_scene import RAYS, RayScene

MIRRORS_END = "MIRRORS_END"
"""Beside the features of lighting: the file follows no more mirrors, so that what they show has its own light alone"""
RAY_SHADOWS, WORLD_RAYS = "RAY_SHADOWS", "WORLD_RAYS"
"""Beside the features of lighting: lamps' shadows by rays, and the world's"""
FILM_TRANSPARENT = "FILM_TRANSPARENT"
"""Of the background: lamps alone are seen there, and they cover nothing"""
WHOLE_PATHS = "WHOLE_PATHS"
"""Of what mirrors show: rays have gone on from mirror to mirror, which the number of the surface's color tells"""
NO_QUADS = "NO_QUADS"
"""Beside the features of lighting: each pixel looks up all directions of the sky, as the device has no `quads`"""
LAMPS = frozenset({"LIGHTING_SUN", "LIGHTING_POINT", "LIGHTING_SPOT", "LIGHTING_AREA"})
_SHADOWS = frozenset({"LIGHTING_MAPS", "LIGHTING_CUBES"})


@dataclass(frozen=True, slots=True)
class RayShadows:
    """Shadows by rays in place of maps."""

    rays: RayScene
    of_lamps: bool
    of_world: bool
    everywhere: bool
    """Also of what the eye sees itself, else of what mirrors show"""


def features_for(
    lighting: Lighting,
    shadows: RayShadows | None,
    is_seen: bool = False,
    ends: bool = False,
    gathered: Features = NO_FEATURES,
) -> Features:
    """Of the lighting, for what mirrors show, or for what the eye sees itself; `ends`: no more mirrors follow;
    `gathered`: of what is left to rays (`Gathering.features`)."""
    features = lighting.features | gathered
    if not device_features().quads:
        features |= {NO_QUADS}
    if ends:
        # (What has its own light alone is in no shadow.)
        return features | {MIRRORS_END}
    if shadows is None or (is_seen and not shadows.everywhere):
        return features
    # Without anything in shadow there is no ray to follow.
    if shadows.of_lamps and features & _SHADOWS:
        features |= {RAY_SHADOWS}
    return features | {WORLD_RAYS} if shadows.of_world and "LIGHTING_WORLD" in features else features


def lighting_pieces(features: Features) -> tuple[Piece, ...]:
    """With the rays that shadow, where these are among the features."""
    return (lighting_piece(features), *((RAYS,) if features & {RAY_SHADOWS, WORLD_RAYS} else ()))


def rays_of(features: Features, shadows: RayShadows | None) -> RayScene | None:
    """What a shader with these features needs bound."""
    return shadows.rays if shadows is not None and features & {RAY_SHADOWS, WORLD_RAYS} else None
