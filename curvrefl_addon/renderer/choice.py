# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `auto` does in a view: the cheapest way that stays under the error asked for, and why. Pure numpy.

A mirror that can be seen in itself, is open or bends both ways may show a point several times: there every pixel
follows its own ray. On a closed convex mirror reflection points are as good, and cheaper where a large mirror shows few
vertices. An object that lies in the shadow of a convex mirror, seen from the eye, is reflected nowhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..scene.arrays import Float64Array
from ..scene.view import View
from .geometry.split import split_angle
from .mirrors.mirror import Mirror
from .settings import Settings

RAYS, VERTICES = "exact", "newton"
PIXEL_BY_RAY, PIXEL_BY_RAY_PER_DOUBLING = 0.47, 0.005
"""Cost of a mirror pixel whose ray is followed, and what each doubling of the triangles adds (`docs/figures.md`)"""
LAYER_DRAWN, VERTEX_SOLVED, TRIANGLE_DRAWN = 0.21, 1.5, 0.7
"""Cost of a mirror pixel for each layer of solved triangles drawn onto it, of a solved vertex, of a triangle drawn"""
EDGES_SPLIT = 115.0
"""What splitting edges by solved midpoints adds, times the mirror's size in pixels (the root of their number): twice as
large it bends twice as far from a chord"""
SPLIT_TRIANGLES = 100.0
"""Triangles that splitting adds around a mirror, times the square of the angle that it splits to"""
MOST_SHARE = 1.04
"""Points are solved up to this share of what rays cost: the costs are of all that differs between the two, and known to
a few percent (figures: `tools/measure_auto.py`)"""
STRICTER = 0.7
"""Share of the error asked for to which edges are split while a view moves: an edge is half of what a triangle's inside
may be off. In stills solved midpoints see to it."""
MAPS = ((60.0, 64), (250.0, 128), (600.0, 256))
"""Up to this radius in pixels, the texels of the mirror's map whose own error stays under a tenth of a pixel"""
FINEST_MAP = 512


@dataclass(frozen=True, slots=True)
class Choice:
    """What is done in one view."""

    settings: Settings
    """With a method in place of `auto`"""
    why: str
    """One sentence"""
    hidden: int
    """Instances that no mirror can show"""
    shown: int
    """The others that mirrors may see"""

    def as_report(self) -> dict[str, object]:
        """For `report.json` and the panel."""
        return {
            "method": self.settings.method,
            "why": self.why,
            "map_resolution": 0 if self.settings.method == RAYS else self.settings.map_resolution,
            "objects": {self.settings.method: self.shown, "not reflected": self.hidden},
        }


@dataclass(frozen=True, slots=True)
class Scenery:
    """What mirrors may see, but themselves."""

    centers: Float64Array
    """(instances, 3) of balls around them, world space"""
    radii: Float64Array
    """(instances,)"""
    vertices: NDArray[np.int64]
    """(instances,)"""
    triangles: NDArray[np.int64]
    """(instances,)"""


def choose(
    settings: Settings,
    view: View,
    mirrors: Sequence[Mirror],
    scenery: Scenery,
    bumpy: Sequence[str] = (),
    is_still: bool = False,
) -> Choice:
    """For `settings` whose method is `auto`; the maps of mirrors are not needed.

    `bumpy`: names of mirrors with bumps, which no map has. The sub-frames of a still share one solve and
    what splitting edges by solved midpoints costs; a view that moves has one sub-frame each, without that.
    """
    unseen = np.ones(len(scenery.radii), bool)
    for mirror in mirrors:
        unseen &= in_shadow(mirror, view, scenery.centers, scenery.radii)
    hidden, shown = int(unseen.sum()), int((~unseen).sum())
    rays = replace(settings, method=RAYS)
    if settings.shadow_rays:
        return Choice(rays, "Shadows by rays are asked for: rays are followed.", hidden, shown)
    if bumpy:
        return Choice(rays, f'"{bumpy[0]}" has bumps: rays are followed.', hidden, shown)
    several = next((mirror for mirror in mirrors if not mirror.facts.never_sees_itself), None)
    if several is not None:
        why = f'"{several.object_name}" may show a point several times: rays are followed.'
        return Choice(rays, why, hidden, shown)
    if len(mirrors) > 1:
        return Choice(rays, "Mirrors may be seen in each other: rays are followed.", hidden, shown)
    refused = next((mirror for mirror in mirrors if mirror.refusal is not None), None)
    if refused is not None:
        why = f'"{refused.object_name}" has no map that reflection points could be found on: rays are followed.'
        return Choice(rays, why, hidden, shown)
    pixels = sum(mirror_pixels(mirror, view) for mirror in mirrors)
    vertices, triangles = int(scenery.vertices[~unseen].sum()), int(scenery.triangles[~unseen].sum())
    largest = max((mirror.radius_pixels(view) for mirror in mirrors), default=1.0)
    tolerance = settings.pixel_tolerance * (1.0 if is_still else STRICTER)
    added = SPLIT_TRIANGLES / split_angle(largest, tolerance) ** 2
    by_rays = pixels * (PIXEL_BY_RAY + PIXEL_BY_RAY_PER_DOUBLING * np.log2(max(triangles, 2)))
    once = VERTEX_SOLVED * (vertices + 0.5 * added) + (EDGES_SPLIT * np.sqrt(pixels) if is_still else 0.0)
    layers = sum(layers_around(mirror, scenery.centers[~unseen], scenery.radii[~unseen]) for mirror in mirrors)
    by_points = pixels * LAYER_DRAWN * layers + TRIANGLE_DRAWN * (triangles + added)
    by_points += once / (settings.samples if is_still else 1)
    share = by_points / max(by_rays, 1e-30)
    cost = f"{vertices:,} vertices to solve cost about {share:.2f} times what {pixels:,.0f} rays do"
    if not mirrors or share > MOST_SHARE:
        return Choice(rays, f"{cost}: rays are followed.", hidden, shown)
    resolution = next((texels for radius, texels in MAPS if largest <= radius), FINEST_MAP)
    points = replace(
        settings,
        method=VERTICES,
        map_resolution=max(resolution, 8),
        pixel_tolerance=max(tolerance, 0.01),
    )
    return Choice(points, f"{cost}: reflection points are solved.", hidden, shown)


def layers_around(mirror: Mirror, centers: Float64Array, radii: Float64Array) -> float:
    """About how many surfaces a mirror shows behind each other: what balls (n, 3), (n,) cover of all directions."""
    distance = np.linalg.norm(centers - mirror.center, axis=1)
    sine = np.minimum(radii / np.maximum(distance, 1e-30), 1.0)
    return float(np.where(distance <= radii, 1.0, 0.5 - 0.5 * np.sqrt(1.0 - sine * sine)).sum())


def mirror_pixels(mirror: Mirror, view: View) -> float:
    """About how many pixels of a view a mirror covers: that part of the window around its box that a ball fills."""
    _, _, width, height = mirror.window(view)
    return np.pi / 6.0 * max(width, 0) * max(height, 0)


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
