# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the ways of showing a mirror cost in a view, and what of the scene it cannot show. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array
from ...scene.camera.view import View
from ..geometry.split import split_angle
from ..mirrors.mirror import Mirror
from ..settings import Settings
from ..surfaces.windows import Window
from .table import Costs

SAMPLED_VERTICES, SILHOUETTE_SIDES, PIXELS_PROBED = 2000, 16, 16
"""A mirror's silhouette is taken as a polygon of so many sides around about so many of its vertices, and its pixels are
counted by so many probes along each side of its window"""
BEFORE_SHARE, MOST_BEFORE = 0.58, 64
"""Radii of an object's ball, and so many of the largest balls: what they cover in the view counts as before the mirror.
The balls hold the objects' boxes: so much of it is a round object's own radius."""
SPLIT_TRIANGLES = 30.0
"""Triangles that a ball is split into around a mirror, times the square of the angle that its edges are split to, where
it is as large as it is far away"""
NEAREST_SPLIT = 0.7
"""Radii of a ball from whose center on its nearness counts no more: of one that touches the mirror, or holds it, most
edges are farther away"""
STRICTER_SHARE = 0.7
"""Share of the error asked for to which edges are split while a view moves: an edge is half of what a triangle's inside
may be off. In stills solved midpoints see to it."""
STILL_SHARE = 0.75
"""The same in stills: the rest is the map's and the search's"""


@dataclass(frozen=True, slots=True)
class Scenery:
    """What mirrors may see, mirrors apart from the rest."""

    centers: Float64Array
    """(instances, 3) of balls around them, world space"""
    radii: Float64Array
    """(instances,)"""
    vertices: NDArray[np.int64]
    """(instances,)"""
    triangles: NDArray[np.int64]
    """(instances,)"""
    seen_through: NDArray[np.bool_]
    """(instances,)"""
    mirror_centers: Float64Array
    """(mirrors, 3) of balls around the mirrors themselves, in their order"""
    mirror_radii: Float64Array
    """(mirrors,) 0 of those that no other mirror shows"""


def cost_share(
    settings: Settings,
    view: View,
    mirror: Mirror,
    scenery: Scenery,
    unseen: NDArray[np.bool_],
    is_still: bool,
    most: float,
    costs: Costs,
) -> tuple[float, str]:
    """What solving costs over what following rays does, and that in words.

    Where it is more than `most` even if the mirror had all pixels of its window, they are not counted, and it is at
    least so much.
    """
    vertices, triangles = int(scenery.vertices[~unseen].sum()), int(scenery.triangles[~unseen].sum())
    added = split_triangles(settings, view, mirror, scenery, unseen, is_still)
    by_ray = costs.pixel_by_ray + costs.pixel_by_ray_per_doubling * np.log2(max(triangles, 2))
    vertex = costs.vertex_solved + (costs.edges_asked if is_still else 0.0)
    once = costs.solve_begun + vertex * (vertices + 0.5 * added)
    layers = layers_around(mirror.shape().center, scenery.centers[~unseen], scenery.radii[~unseen])
    whatever_pixels = costs.triangle_drawn * (triangles + added) + costs.pixel_cleared * view.width * view.height
    whatever_pixels += once / (settings.samples if is_still else 1)

    def share_of(pixels: float) -> float:
        """The more pixels, the less."""
        # (Of one pixel at least, where all may be hidden.)
        return float((costs.layer_drawn * layers + whatever_pixels / max(pixels, 1.0)) / by_ray)

    window = mirror.window(view)
    least = share_of(window[2] * window[3])
    if least > most:
        return least, f"{vertices:,} vertices to solve cost at least {least:.2f} times what rays do"
    pixels = mirror_pixels(mirror, view, scenery, window)
    share = share_of(pixels)
    return share, f"{vertices:,} vertices to solve cost about {share:.2f} times what {pixels:,.0f} rays do"


def split_triangles(
    settings: Settings, view: View, mirror: Mirror, scenery: Scenery, unseen: NDArray[np.bool_], is_still: bool
) -> float:
    """About how many triangles splitting adds to what a mirror may show: none where they are small already."""
    frame = mirror.shape()
    tolerance = settings.pixel_tolerance * (STILL_SHARE if is_still else STRICTER_SHARE)
    radii = scenery.radii[~unseen]
    distance = np.linalg.norm(scenery.centers[~unseen] - frame.center, axis=1)
    angle = radii / np.maximum(np.maximum(distance, NEAREST_SPLIT * radii), 1e-30)
    wanted = SPLIT_TRIANGLES * (angle / split_angle(frame.radius_pixels(view), tolerance)) ** 2
    return float(np.maximum(wanted - scenery.triangles[~unseen], 0.0).sum())


def layers_around(center: Float64Array, centers: Float64Array, radii: Float64Array) -> float:
    """About how many surfaces a mirror about `center` shows behind each other: what balls (n, 3), (n,) cover of all
    directions."""
    distance = np.linalg.norm(centers - center, axis=1)
    sine = np.minimum(radii / np.maximum(distance, 1e-30), 1.0)
    return float(np.where(distance <= radii, 1.0, 0.5 - 0.5 * np.sqrt(1.0 - sine * sine)).sum())


def mirror_pixels(mirror: Mirror, view: View, scenery: Scenery, window: Window) -> float:
    """About how many pixels of a view a mirror covers in its window there; of one that is not convex, those of its
    hull."""
    x, y, width, height = window
    if width <= 0 or height <= 0:
        return 0.0
    positions = mirror.mesh.positions
    positions = positions[:: max(1, len(positions) // SAMPLED_VERTICES)].astype(np.float64)
    to_clip = view.world_to_clip @ mirror.instance.matrix
    clip = positions @ to_clip[:, :3].T + to_clip[:, 3]
    steps = (np.arange(PIXELS_PROBED) + 0.5) / PIXELS_PROBED
    probes = np.stack(np.meshgrid(x + width * steps, y + height * steps), axis=-1).reshape(-1, 2)
    covered = ~behind_others(mirror, view, scenery, probes)
    # (One that reaches behind the eye fills its window.)
    if (clip[:, 3] > 1e-6 * np.abs(clip[:, 3]).max()).all():
        seen = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        turn = np.arange(SILHOUETTE_SIDES) * (2.0 * np.pi / SILHOUETTE_SIDES)
        sides = np.stack([np.cos(turn), np.sin(turn)])
        covered &= (probes @ sides <= (seen @ sides).max(axis=0)).all(axis=-1)
    return float(width * height * covered.mean())


def behind_others(mirror: Mirror, view: View, scenery: Scenery, probes: Float64Array) -> NDArray[np.bool_]:
    """(n,) whether at pixels (n, 2) objects are seen before a mirror, as far as their balls tell: not those of what is
    all around the eye or the mirror."""
    if view.is_orthographic:
        return np.zeros(len(probes), bool)
    eye, center = view.eye[:3], mirror.shape().center
    to_balls = scenery.centers - eye
    distance = np.linalg.norm(to_balls, axis=1)
    before = (distance < np.linalg.norm(center - eye)) & (distance > scenery.radii)
    before &= np.linalg.norm(scenery.centers - center, axis=1) > scenery.radii
    chosen = np.flatnonzero(before)
    sine = BEFORE_SHARE * scenery.radii[chosen] / distance[chosen]
    largest = np.argsort(-sine)[:MOST_BEFORE]
    chosen, sine = chosen[largest], sine[largest]
    clip = np.column_stack([2.0 * probes / (view.width, view.height) - 1.0, np.tile((-1.0, 1.0), (len(probes), 1))])
    near = clip @ np.linalg.inv(view.world_to_clip).T
    rays = near[:, :3] / near[:, 3:] - eye
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosine = rays @ (to_balls[chosen] / distance[chosen, None]).T
    return np.asarray((cosine > np.sqrt(1.0 - sine**2)).any(axis=1))


def in_shadow(mirror: Mirror, view: View, centers: Float64Array, radii: Float64Array) -> NDArray[np.bool_]:
    """(n,) whether balls lie wholly in what a mirror's inner ball hides from the eye: a closed convex mirror reflects
    nothing there, as the way from the eye over the mirror to such a point would have to pass through the mirror."""
    if not mirror.facts.never_sees_itself or view.is_orthographic:
        return np.zeros(len(radii), bool)
    center, inner = mirror.inner_ball
    axis = center - view.eye[:3]
    away = float(np.linalg.norm(axis))
    if away <= inner:
        return np.zeros(len(radii), bool)
    to_balls = centers - view.eye[:3]
    distance = np.maximum(np.linalg.norm(to_balls, axis=1), 1e-30)
    cosine = np.clip(to_balls @ axis / (distance * away), -1.0, 1.0)
    reach = np.where(distance > radii, np.arcsin(np.minimum(radii / distance, 1.0)), np.pi)
    return (np.arccos(cosine) + reach < np.arcsin(inner / away)) & (distance - radii > away)
