# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in a view a picture is to be seen: a rectangle on the mirror."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...errors import InputError
from ...scene.arrays import Float64Array
from ...scene.camera.view import View
from ..ways import Ways, WaysByMirrors, lines_through

OUTLINE = 256
"""Lines of sight along a side by which a mirror's outline is found, twice: in the view, and in the box found there"""

type Fit = Literal["INSIDE", "COVER", "STRETCH", "CHOSEN"]


@dataclass(frozen=True, slots=True)
class PictureFrame:
    """A rectangle, in shares of the view's width and height from its lower left."""

    left: float
    bottom: float
    width: float
    height: float

    def in_view(self, places: Float64Array) -> Float64Array:
        """Places of the picture (n, 2), from 0 to 1, as places of the view."""
        return np.array([self.left, self.bottom]) + places * [self.width, self.height]

    def in_picture(self, places: Float64Array) -> Float64Array:
        """The inverse."""
        return (places - [self.left, self.bottom]) / [self.width, self.height]


@dataclass(frozen=True, slots=True)
class FrameChoice:
    """How a frame is found."""

    fit: Fit = "INSIDE"
    """All of it within the box about the mirror, or it covers that, or is stretched to it; or a `rectangle`"""
    scale: float = 0.7
    """Of what fits"""
    offset: tuple[float, float] = (0.0, 0.0)
    """Of its middle from the box's, in shares of the box"""
    rectangle: tuple[float, float, float, float] = (0.25, 0.25, 0.5, 0.5)
    """Left, bottom, width and height in shares of the view"""


def frame_on_mirror(
    ways: WaysByMirrors, view: View, mirrors: set[int], choice: FrameChoice, aspect: float, names: str
) -> PictureFrame:
    """The frame of a picture whose width is `aspect` times its height, on mirrors by their object_id.

    `names`: of the mirrors, for messages. Raises InputError where the view does not see them, or for an empty frame.
    """
    if choice.fit == "CHOSEN":
        left, bottom, width, height = choice.rectangle
        if not (width > 0.0 and height > 0.0):
            raise InputError("The picture's frame is empty: give it a width and a height above 0.")
        return PictureFrame(left, bottom, width, height)
    whole = PictureFrame(0.0, 0.0, 1.0, 1.0)
    box = _box(ways, view, mirrors, _box(ways, view, mirrors, whole, names), names)
    # (Of a view's own shape, whatever its pixels': as wide for its height as what it sees.)
    shape = abs(float(view.view_to_clip[1, 1] / view.view_to_clip[0, 0]))
    width, height = box.width, box.height
    if choice.fit != "STRETCH":
        wanted = aspect / shape
        is_wide = wanted > width / height
        if is_wide == (choice.fit == "INSIDE"):
            height = width / wanted
        else:
            width = height * wanted
    width, height = width * choice.scale, height * choice.scale
    middle = (
        box.left + box.width * (0.5 + choice.offset[0]),
        box.bottom + box.height * (0.5 + choice.offset[1]),
    )
    return PictureFrame(middle[0] - 0.5 * width, middle[1] - 0.5 * height, width, height)


def _box(ways: WaysByMirrors, view: View, mirrors: set[int], within: PictureFrame, names: str) -> PictureFrame:
    """Around the lines of sight that meet the mirrors first, and one more on each side."""
    steps = (np.arange(OUTLINE) + 0.5) / OUTLINE
    places = within.in_view(np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2))
    seen = places[np.isin(_ways(ways, view, places).mirror, list(mirrors))]
    if not len(seen):
        raise InputError(f"{names} is not seen: nothing of it is in the view, or other things are before it.")
    step = np.array([within.width, within.height]) / OUTLINE
    low = np.maximum(seen.min(axis=0) - step, [within.left, within.bottom])
    high = np.minimum(seen.max(axis=0) + step, [within.left + within.width, within.bottom + within.height])
    return PictureFrame(float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1]))


def _ways(ways: WaysByMirrors, view: View, places: Float64Array) -> Ways:
    return ways.follow(*lines_through(view, places))


def ways_of_picture(ways: WaysByMirrors, view: View, frame: PictureFrame, places: Float64Array) -> Ways:
    """What lines of sight through places (n, 2) of the picture meet."""
    return _ways(ways, view, frame.in_view(places))
