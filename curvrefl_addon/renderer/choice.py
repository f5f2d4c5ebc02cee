# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `auto` does in a view: for each mirror the cheapest way that stays under the error asked for, and why.

A mirror that can be seen in itself, is open, or bends both ways may show a point several times, and one in which
another mirror is seen shows what that one reflects: there every pixel follows its own ray, and where a mirror or what
it shows is rough, coated or seen through. On a closed convex mirror
reflection points are as good where its radial map tells the mesh's normals well enough (`mirrors/map_fit.py`), and
cheaper where a large mirror shows few vertices. What lies in the shadow of a convex mirror, seen from the eye, is
reflected nowhere, and a mirror that shows no object at all shows the background.

A choice holds until it is clearly the worse one, so that a view that moves does not flip: `KEPT_SHARE`, `KEPT_FIT`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ..scene.camera.view import View
from .costs.model import STILL_SHARE, STRICTER_SHARE, Scenery, cost_share, in_shadow
from .costs.table import costs_in_use
from .device.ways.features import features
from .mirrors.mirror import Mirror
from .settings import Settings

RAYS, VERTICES, NOTHING = "exact", "newton", "nothing"
MOST_SHARE = 1.0
"""Points are solved up to this share of what rays cost (figures: `tools/measure/measure_auto.py`)"""
KEPT_SHARE = 1.5
"""A way that was taken in the view before is kept until it costs so many times as much as the other"""
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
SHARPEST_BEND = np.radians(16.0)
"""Where normals turn by more within a triangle, what is reflected has kinks at the triangle's sides, of which the
midpoint of an edge does not tell"""
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
        """A name in the catalog, or NOTHING."""
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


def choose(
    settings: Settings,
    view: View,
    mirrors: Sequence[Mirror],
    scenery: Scenery,
    reasons: Mapping[str, str] = MappingProxyType({}),
    is_still: bool = False,
    last: Sequence[MirrorChoice | None] = (),
) -> Choice:
    """For `settings` whose method is `auto`.

    `reasons`: why mirrors need rays whatever the view, by their names. The sub-frames of a still share one solve and
    what splitting edges by solved midpoints costs; a view that moves has one sub-frame each, without that. `last`: what
    was chosen for each mirror in the view before. Bakes the maps of mirrors for which reflection points would be
    cheaper, once for each size.
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
                reasons.get(mirror.object_name),
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
    reason: str | None,
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
    if reason is not None:
        return rays(f'"{name}" {reason}')
    if not mirror.facts.never_sees_itself:
        return rays(f'"{name}" may show a point several times')
    if shows_mirrors:
        return rays("Mirrors may be seen in each other")
    if scenery.seen_through[~unseen].any():
        return rays(f'"{name}" may show what is seen through')
    if mirror.holds_eye(view, mirror.shape()):
        return rays(f'The eye is inside of "{name}"')
    if shown == 0:
        return MirrorChoice(
            name, replace(settings, method=RAYS), f'"{name}" shows the background alone.', hidden, shown, True
        )
    if mirror.facts.sharpest_split > SHARPEST_SPLIT:
        return rays(f'"{name}" has edges at which its normals jump')
    if mirror.facts.sharpest_bend > SHARPEST_BEND:
        return rays(f'"{name}" has too few faces for its bends')
    frame = mirror.shape()
    if mirror.inner_ball[1] < THINNEST_SHARE * frame.bound:
        return rays(f'"{name}" is too thin for a map that reflection points could be found on')
    if VERTICES in features().distrusted:
        return rays("This graphics driver gets reflection points wrong")
    was_solved = last is not None and last.method == VERTICES
    kept = 1.0 if last is None or last.method == NOTHING else KEPT_SHARE if was_solved else 1.0 / KEPT_SHARE
    most_share = MOST_SHARE * kept
    share, cost = cost_share(settings, view, mirror, scenery, unseen, is_still, most_share, costs_in_use())
    if share > most_share:
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
        pixel_tolerance=max(tolerance * (STILL_SHARE if is_still else STRICTER_SHARE), 0.01),
    )
    return MirrorChoice(name, points, f"{cost}: reflection points are solved.", hidden, shown)


def _map_resolution(radius: float, last: MirrorChoice | None) -> int:
    """Texels along an edge of the map to begin with, for a mirror of so many pixels."""
    wanted = next((texels for most, texels in MAPS if radius <= most), FINEST_MAP)
    if last is None:
        return wanted
    # A finer map than needed does no harm.
    largest = next((most for most, texels in MAPS if texels == last.settings.map_resolution), np.inf)
    return last.settings.map_resolution if radius <= KEPT_MAP * largest else wanted
