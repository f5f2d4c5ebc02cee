# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `auto` does in a view: for each mirror the cheapest way that stays under the error asked for, and why.

A mirror that can be seen in itself, is open, or bends both ways may show a point several times, and one in which
another mirror is seen shows what that one reflects: there every pixel follows its own ray. On a closed convex mirror
reflection points are as good where its radial map tells the mesh's normals well enough (`mirrors/map_fit.py`), and
cheaper where a large mirror shows few vertices. What lies in the shadow of a convex mirror, seen from the eye, is
reflected nowhere, and a mirror that shows no object at all shows the background.

A choice holds until it is clearly the worse one, so that a view that moves does not flip: `KEPT_SHARE`, `KEPT_FIT`.
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

RAYS, VERTICES, NOTHING = "exact", "newton", "nothing"
PIXEL_BY_RAY, PIXEL_BY_RAY_PER_DOUBLING = 0.030, 0.010
"""Cost of following the ray of a mirror pixel beyond that of shading it, which both ways have, and what each doubling
of the triangles adds. This and the other costs are about microseconds of the processor that they were fitted on; only
their proportions count (`docs/figures.md`)."""
LAYER_DRAWN, TRIANGLE_DRAWN = 0.015, 0.66
"""Cost of a mirror pixel for each layer of solved triangles drawn onto it, and of a triangle drawn, per sub-frame"""
VERTEX_SOLVED, EDGES_ASKED = 0.85, 1.45
"""Cost of a solved vertex, and what asking whether its edges leave their chords adds to it in a still: solutions are
read back for that, and midpoints solved"""
SOLVE_BEGUN = 1500.0
"""Cost of a mirror's solve and draw before the first vertex: programs are bound, results waited for"""
SPLIT_TRIANGLES = 30.0
"""Triangles that a ball is split into around a mirror, times the square of the angle that its edges are split to, where
it is as large as it is far away"""
NEAREST_SPLIT = 0.7
"""Radii of a ball from whose centre on its nearness counts no more: of one that touches the mirror, or holds it, most
edges are farther away"""
SAMPLED_VERTICES, SILHOUETTE_SIDES, PIXELS_PROBED = 2000, 16, 16
"""A mirror's silhouette is taken as a polygon of so many sides around about so many of its vertices, and its pixels are
counted by so many probes along each side of its window"""
BEFORE_SHARE, MOST_BEFORE = 0.8, 64
"""Radii of an object's ball, and so many of the largest balls: what they cover in the view counts as before the mirror.
An object fills less than the ball around it."""
MOST_SHARE = 1.0
"""Points are solved up to this share of what rays cost (figures: `tools/measure/measure_auto.py`)"""
KEPT_SHARE = 1.5
"""A way that was taken in the view before is kept until it costs so many times as much as the other"""
STRICTER_SHARE = 0.7
"""Share of the error asked for to which edges are split while a view moves: an edge is half of what a triangle's inside
may be off. In stills solved midpoints see to it."""
MAP_SHARE = 0.25
"""Share of the error asked for that the map may be off"""
KEPT_FIT = 1.2
"""A map that was good enough in the view before is kept up to so many times that"""
MAPS = ((60.0, 64), (250.0, 128), (600.0, 256))
"""Up to this radius in pixels, the texels of the mirror's map to begin with"""
FINEST_MAP = 512
KEPT_MAP = 1.5
"""The map of the view before is kept while the mirror is at most so many times as large as that map is for"""
SHARPEST_SPLIT = np.radians(1.0)
"""Where normals of one place of a mirror differ by more no map tells them apart, and none is baked to find out"""
THINNEST_SHARE = 0.004
"""A mirror is too thin for a map whose inner ball has less than this share of its outer one: texels seen from inside do
not tell its rim's two sides apart at any resolution"""


@dataclass(frozen=True, slots=True)
class MirrorChoice:
    """What is done for one mirror in one view."""

    object_name: str
    settings: Settings
    """With a method in place of `auto`"""
    why: str
    """One sentence"""
    hidden: int
    """Instances that the mirror cannot show"""
    shown: int
    """The others"""
    shows_nothing: bool = False
    """The background alone"""

    @property
    def method(self) -> str:
        """A name in the catalogue, or NOTHING."""
        return NOTHING if self.shows_nothing else self.settings.method

    def as_report(self) -> dict[str, object]:
        """For `report.json` and the panel."""
        return {
            "mirror": self.object_name,
            "method": self.method,
            "why": self.why,
            "map_resolution": self.settings.map_resolution if self.method == VERTICES else 0,
            "objects": {self.method: self.shown, "not reflected": self.hidden},
        }


@dataclass(frozen=True, slots=True)
class Choice:
    """What is done in one view, mirror by mirror."""

    mirrors: tuple[MirrorChoice, ...]

    @property
    def methods(self) -> tuple[str, ...]:
        """Each once, in the order of the mirrors."""
        return tuple(dict.fromkeys(mirror.method for mirror in self.mirrors))

    @property
    def why(self) -> str:
        """One sentence each, of mirrors that have the same once."""
        return " ".join(dict.fromkeys(mirror.why for mirror in self.mirrors))

    @property
    def hidden(self) -> int:
        """Instances that no mirror can show; of several mirrors the fewest that one cannot."""
        return min((mirror.hidden for mirror in self.mirrors), default=0)

    @property
    def shown(self) -> int:
        """The others."""
        return max((mirror.shown for mirror in self.mirrors), default=0)

    def as_report(self) -> dict[str, object]:
        """For `report.json`: what most users want to know, and each mirror where there are several."""
        objects: dict[str, int] = {}
        for mirror in self.mirrors:
            objects[mirror.method] = max(objects.get(mirror.method, 0), mirror.shown)
        report: dict[str, object] = {
            "method": ", ".join(self.methods) or RAYS,
            "why": self.why,
            "map_resolution": max(
                (mirror.settings.map_resolution for mirror in self.mirrors if mirror.method == VERTICES), default=0
            ),
            "objects": objects | {"not reflected": self.hidden},
        }
        if len(self.mirrors) > 1:
            report["mirrors"] = [mirror.as_report() for mirror in self.mirrors]
        return report


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
    mirror_centers: Float64Array
    """(mirrors, 3) of balls around the mirrors themselves, in their order"""
    mirror_radii: Float64Array
    """(mirrors,) 0 of those that no other mirror shows"""


def choose(
    settings: Settings,
    view: View,
    mirrors: Sequence[Mirror],
    scenery: Scenery,
    bumpy: Sequence[str] = (),
    is_still: bool = False,
    last: Sequence[MirrorChoice | None] = (),
) -> Choice:
    """For `settings` whose method is `auto`.

    `bumpy`: names of mirrors with bumps, which no map has. The sub-frames of a still share one solve and what splitting
    edges by solved midpoints costs; a view that moves has one sub-frame each, without that. `last`: what was chosen
    for each mirror in the view before. Bakes the maps of mirrors for which reflection points would be cheaper, once for
    each size.
    """
    before = list(last) or [None] * len(mirrors)
    return Choice(
        tuple(
            _choose(
                settings,
                view,
                mirror,
                _others(index, mirror, view, scenery),
                scenery,
                mirror.object_name in bumpy,
                is_still,
                before[index],
            )
            for index, mirror in enumerate(mirrors)
        )
    )


def _others(index: int, mirror: Mirror, view: View, scenery: Scenery) -> bool:
    """Whether another mirror may be seen in this one."""
    there = scenery.mirror_radii > 0.0
    there[index] = False
    if not there.any():
        return False
    return not in_shadow(mirror, view, scenery.mirror_centers[there], scenery.mirror_radii[there]).all()


def _choose(
    settings: Settings,
    view: View,
    mirror: Mirror,
    shows_mirrors: bool,
    scenery: Scenery,
    is_bumpy: bool,
    is_still: bool,
    last: MirrorChoice | None,
) -> MirrorChoice:
    name = mirror.object_name
    unseen = in_shadow(mirror, view, scenery.centers, scenery.radii)
    hidden, shown = int(unseen.sum()), int((~unseen).sum())

    def rays(why: str) -> MirrorChoice:
        return MirrorChoice(name, replace(settings, method=RAYS), f"{why}: rays are followed.", hidden, shown)

    if settings.shadow_rays:
        return rays("Shadows by rays are asked for")
    if is_bumpy:
        return rays(f'"{name}" has bumps')
    if not mirror.facts.never_sees_itself:
        return rays(f'"{name}" may show a point several times')
    if shows_mirrors:
        return rays("Mirrors may be seen in each other")
    if mirror.holds_eye(view, mirror.shape()):
        return rays(f'The eye is inside of "{name}"')
    if shown == 0:
        return MirrorChoice(
            name, replace(settings, method=RAYS), f'"{name}" shows the background alone.', hidden, shown, True
        )
    if mirror.facts.sharpest_split > SHARPEST_SPLIT:
        return rays(f'"{name}" has edges at which its normals jump')
    frame = mirror.shape()
    if mirror.inner_ball[1] < THINNEST_SHARE * frame.bound:
        return rays(f'"{name}" is too thin for a map that reflection points could be found on')
    share, cost = _cost_share(settings, view, mirror, scenery, unseen, is_still)
    was_solved = last is not None and last.method == VERTICES
    kept = 1.0 if last is None or last.method == NOTHING else KEPT_SHARE if was_solved else 1.0 / KEPT_SHARE
    if share > MOST_SHARE * kept:
        return rays(cost)
    tolerance = settings.pixel_tolerance
    most = MAP_SHARE * tolerance * (KEPT_FIT if was_solved else 1.0)
    resolution = _map_resolution(frame.radius_pixels(view), last if was_solved else None)
    while True:
        shape = mirror.shape(resolution)
        if shape.map is None or shape.refusal is not None:
            return rays(f'"{name}" has no map that reflection points could be found on')
        error = shape.fit().pixel_error(view, shape.world_to_map, scenery.centers[~unseen], scenery.radii[~unseen])
        if error <= most:
            break
        # The error of a smooth shape falls with the square of a texel, that of one with kinks with a texel.
        if resolution >= FINEST_MAP or error > 4.0 * most * (FINEST_MAP / resolution):
            return rays(f'Its map would show "{name}" off by {error:.2g} pixels')
        resolution *= 2
    points = replace(
        settings,
        method=VERTICES,
        map_resolution=resolution,
        pixel_tolerance=max(tolerance * (1.0 if is_still else STRICTER_SHARE), 0.01),
    )
    return MirrorChoice(name, points, f"{cost}: reflection points are solved.", hidden, shown)


def _cost_share(
    settings: Settings, view: View, mirror: Mirror, scenery: Scenery, unseen: NDArray[np.bool_], is_still: bool
) -> tuple[float, str]:
    """What solving costs over what following rays does, and that in words."""
    pixels = mirror_pixels(mirror, view, scenery)
    vertices, triangles = int(scenery.vertices[~unseen].sum()), int(scenery.triangles[~unseen].sum())
    added = _split_triangles(settings, view, mirror, scenery, unseen, is_still)
    by_rays = pixels * (PIXEL_BY_RAY + PIXEL_BY_RAY_PER_DOUBLING * np.log2(max(triangles, 2)))
    vertex = VERTEX_SOLVED + (EDGES_ASKED if is_still else 0.0)
    once = SOLVE_BEGUN + vertex * (vertices + 0.5 * added)
    layers = layers_around(mirror.shape().center, scenery.centers[~unseen], scenery.radii[~unseen])
    by_points = pixels * LAYER_DRAWN * layers + TRIANGLE_DRAWN * (triangles + added)
    by_points += once / (settings.samples if is_still else 1)
    share = by_points / max(by_rays, 1e-30)
    return share, f"{vertices:,} vertices to solve cost about {share:.2f} times what {pixels:,.0f} rays do"


def _split_triangles(
    settings: Settings, view: View, mirror: Mirror, scenery: Scenery, unseen: NDArray[np.bool_], is_still: bool
) -> float:
    """About how many triangles splitting adds to what a mirror may show: none where they are small already."""
    frame = mirror.shape()
    tolerance = settings.pixel_tolerance * (1.0 if is_still else STRICTER_SHARE)
    radii = scenery.radii[~unseen]
    distance = np.linalg.norm(scenery.centers[~unseen] - frame.center, axis=1)
    angle = radii / np.maximum(np.maximum(distance, NEAREST_SPLIT * radii), 1e-30)
    wanted = SPLIT_TRIANGLES * (angle / split_angle(frame.radius_pixels(view), tolerance)) ** 2
    return float(np.maximum(wanted - scenery.triangles[~unseen], 0.0).sum())


def _map_resolution(radius: float, last: MirrorChoice | None) -> int:
    """Texels along an edge of the map to begin with, for a mirror of so many pixels."""
    wanted = next((texels for most, texels in MAPS if radius <= most), FINEST_MAP)
    if last is None:
        return wanted
    # A finer map than needed does no harm.
    largest = next((most for most, texels in MAPS if texels == last.settings.map_resolution), np.inf)
    return last.settings.map_resolution if radius <= KEPT_MAP * largest else wanted


def layers_around(center: Float64Array, centers: Float64Array, radii: Float64Array) -> float:
    """About how many surfaces a mirror about `center` shows behind each other: what balls (n, 3), (n,) cover of all
    directions."""
    distance = np.linalg.norm(centers - center, axis=1)
    sine = np.minimum(radii / np.maximum(distance, 1e-30), 1.0)
    return float(np.where(distance <= radii, 1.0, 0.5 - 0.5 * np.sqrt(1.0 - sine * sine)).sum())


def mirror_pixels(mirror: Mirror, view: View, scenery: Scenery) -> float:
    """About how many pixels of a view a mirror covers; of one that is not convex, those of its hull."""
    x, y, width, height = mirror.window(view)
    if width <= 0 or height <= 0:
        return 0.0
    positions = mirror.mesh.positions
    positions = positions[:: max(1, len(positions) // SAMPLED_VERTICES)].astype(np.float64)
    to_clip = view.world_to_clip @ mirror.instance.matrix
    clip = positions @ to_clip[:, :3].T + to_clip[:, 3]
    steps = (np.arange(PIXELS_PROBED) + 0.5) / PIXELS_PROBED
    probes = np.stack(np.meshgrid(x + width * steps, y + height * steps), axis=-1).reshape(-1, 2)
    covered = ~_behind_others(mirror, view, scenery, probes)
    # (One that reaches behind the eye fills its window.)
    if (clip[:, 3] > 1e-6).all():
        seen = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        turn = np.arange(SILHOUETTE_SIDES) * (2.0 * np.pi / SILHOUETTE_SIDES)
        sides = np.stack([np.cos(turn), np.sin(turn)])
        covered &= (probes @ sides <= (seen @ sides).max(axis=0)).all(axis=-1)
    return float(width * height * covered.mean())


def _behind_others(mirror: Mirror, view: View, scenery: Scenery, probes: Float64Array) -> NDArray[np.bool_]:
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
