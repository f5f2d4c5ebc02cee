# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a view is so close that the texels of shadow maps, which hold the whole scene, are too large. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...scene.arrays import Float64Array
from ...scene.camera.view import View
from .shadow_views import ShadowView


@dataclass(frozen=True, slots=True)
class Coarseness:
    """A texel is too large that is both."""

    pixels: float
    """Of the view"""
    share: float
    """Of an object's radius, half the diagonal of its box"""


LAMPS, WORLD = Coarseness(12.0, 1.0 / 25.0), Coarseness(48.0, 1.0 / 10.0)
"""Against Cycles fur and a rough mesh are off in more than 2 % of a picture's blocks with larger ones. The shadows of
the world, the mean of many maps, are wider"""
SEEN = 0.25
"""Of the picture's height, across an object's ball: what is smaller shadows too little of the picture"""


@dataclass(frozen=True, slots=True)
class ThingsAhead:
    """Objects that are large in a view, before the eye."""

    points: Float64Array
    """(n, 4) homogeneous middles, world space"""
    pixels: Float64Array
    """(n,) meters that a pixel is wide at their nearest"""
    radii: Float64Array
    """(n,) in meters"""


def things_ahead(view: View, centers: Float64Array, radii: Float64Array) -> ThingsAhead:
    """Of objects in balls (n, 3), (n,)."""
    clip = centers @ view.world_to_clip[:, :3].T + view.world_to_clip[:, 3]
    if view.is_orthographic:
        pixel = np.full(len(centers), 1.0 / view.focal_pixels)
        large = 2.0 * radii > SEEN * view.height * pixel
    else:
        away = np.linalg.norm(centers - view.eye[:3], axis=1) - radii
        pixel = np.maximum(away, 0.0) / view.focal_pixels
        large = 2.0 * radii > SEEN * view.height * pixel
        # (What the eye is in the ball of, a floor, shows the shadows of other things.)
        large &= (clip[:, 3] > 0.0) & (away > 0.0)
    chosen = np.flatnonzero(large)
    reach = radii[chosen, None] * np.linalg.norm(view.world_to_clip[:2, :3], axis=1)
    chosen = chosen[(np.abs(clip[chosen, :2]) - reach <= np.abs(clip[chosen, 3:])).all(axis=1)]
    return ThingsAhead(np.column_stack([centers[chosen], np.ones(len(chosen))]), pixel[chosen], radii[chosen])


def are_too_coarse(views: Sequence[ShadowView], resolution: int, limit: Coarseness, ahead: ThingsAhead) -> bool:
    """Whether the texels of these maps are too large for any of the things ahead."""
    if not views or len(ahead.points) == 0:
        return False
    least = np.maximum(limit.pixels * ahead.pixels, limit.share * ahead.radii)
    return bool((_largest_texels(views, resolution, ahead.points) > least).any())


def _largest_texels(views: Sequence[ShadowView], resolution: int, points: Float64Array) -> Float64Array:
    """(n,) in meters, of any of the maps at each of homogeneous points (n, 4)."""
    # (All at once: this is asked for each view of an orbit.)
    matrices = np.array([one.world_to_clip for one in views])
    is_perspective = np.array([one.is_perspective for one in views])
    parallel, others = matrices[~is_perspective], matrices[is_perspective]
    widest = (2.0 / resolution / np.linalg.norm(parallel[:, :2, :3], axis=2).min(axis=1)).max(initial=0.0)
    slopes = np.array([one.texel_slope for one in views])[is_perspective]
    return np.maximum(slopes * (points @ others[:, 3].T), 0.0).max(axis=1, initial=widest)
