# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Tiny scenes in which what hides what is known by construction. No bpy: `builders.build_case` makes them in Blender.

Each has one mirror about the origin (a unit sphere, or one with a lobe), a few flat sheets that shine in one
colour, a black world unless said otherwise, and a camera that looks along +Y. Sheets are put where a chosen
pixel's reflected ray goes, so the pixel's colour follows. `trace` follows a pixel's ray in float64 and is the
second witness; the tests hold both to Cycles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Float64Array = NDArray[np.float64]
type Color = tuple[float, float, float]

RED: Color = (1.0, 0.0, 0.0)
GREEN: Color = (0.0, 1.0, 0.0)
BLUE: Color = (0.0, 0.0, 1.0)
YELLOW: Color = (1.0, 1.0, 0.0)
CYAN: Color = (0.0, 1.0, 1.0)
MAGENTA: Color = (1.0, 0.0, 1.0)
WHITE: Color = (1.0, 1.0, 1.0)
BLACK: Color = (0.0, 0.0, 0.0)
SKY: Color = (0.1, 0.2, 0.3)

SIZE = 128
"""Pictures are SIZE x SIZE pixels"""
LENS = 90.0
"""Millimetres on a 36 mm picture"""
MIRROR = "Mirror"


@dataclass(frozen=True, slots=True)
class Sheet:
    """A flat polygon."""

    name: str
    corners: Float64Array
    """(3 or 4, 3)"""
    color: Color
    """Radiance; of a diffuse sheet the reflectance"""
    diffuse: bool = False
    visible_camera: bool = True
    visible_glossy: bool = True
    holdout: bool = False


@dataclass(frozen=True, slots=True)
class Pixel:
    """What a pixel must show. Rows count from the BOTTOM."""

    column: int
    row: int
    color: Color
    shows: str
    """Name of the sheet, directly or in the mirror; '' is the world"""
    in_mirror: bool
    why: str


@dataclass(frozen=True, slots=True)
class Lobe:
    """A bump of the unit sphere around `axis`, `height` high and `width` radians wide; the rest stays a sphere."""

    axis: tuple[float, float, float]
    height: float
    width: float


@dataclass(frozen=True, slots=True)
class Case:
    """One scene and what it must show."""

    name: str
    sheets: tuple[Sheet, ...]
    pixels: tuple[Pixel, ...]
    eye: tuple[float, float, float] = (0.0, -6.0, 0.0)
    orthographic_width: float | None = None
    lobe: Lobe | None = None
    world: Color = BLACK
    sun_toward: tuple[float, float, float] | None = None
    sun_strength: float = 0.0
    """W/m2"""

    def radius(self, directions: Float64Array) -> Float64Array:
        """Distance (n,) of the mirror from the origin in unit directions (n, 3)."""
        if self.lobe is None:
            return np.ones(len(directions))
        axis = np.asarray(self.lobe.axis) / np.linalg.norm(self.lobe.axis)
        angle = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
        return 1.0 + self.lobe.height * np.clip(1.0 - (angle / self.lobe.width) ** 2, 0.0, None) ** 3


@dataclass(frozen=True, slots=True)
class Seen:
    """What `trace` found at a pixel's centre."""

    color: Color
    shows: str
    in_mirror: bool


# Rays -------------------------------------------------------------------------------------------------------------


def pixel_ray(case: Case, column: float, row: float) -> tuple[Float64Array, Float64Array]:
    """(origin, unit direction) of the ray through the centre of a pixel; the camera looks along +Y, Z is up."""
    x = (column + 0.5) / SIZE - 0.5
    z = (row + 0.5) / SIZE - 0.5
    eye = np.asarray(case.eye, float)
    if case.orthographic_width is not None:
        return eye + case.orthographic_width * np.array([x, 0.0, z]), np.array([0.0, 1.0, 0.0])
    direction = np.array([36.0 / LENS * x, 1.0, 36.0 / LENS * z])
    return eye, direction / np.linalg.norm(direction)


def hit_mirror(case: Case, origin: Float64Array, direction: Float64Array) -> float:
    """Distance to the mirror along a ray from outside, inf when it misses; marched in small steps, then bisected."""
    reach = 1.0 + (case.lobe.height if case.lobe else 0.0)
    middle = -origin @ direction
    half2 = reach**2 - (origin @ origin - middle**2)
    if half2 <= 0.0 or middle + np.sqrt(half2) <= 0.0:
        return np.inf
    steps = np.linspace(max(0.0, middle - np.sqrt(half2)), middle + np.sqrt(half2), 4000)
    inside = mirror_level(case, origin + steps[:, None] * direction) < 0.0
    if not inside.any():
        return np.inf
    first = int(np.argmax(inside))
    if first == 0:
        return float(steps[0])
    near, far = steps[first - 1], steps[first]
    for _ in range(60):
        half = 0.5 * (near + far)
        if mirror_level(case, (origin + half * direction)[None])[0] < 0.0:
            far = half
        else:
            near = half
    return float(near)


def mirror_level(case: Case, points: Float64Array) -> Float64Array:
    """(n,) distance from the origin minus the mirror's in that direction."""
    distance = np.linalg.norm(points, axis=1)
    return distance - case.radius(points / distance[:, None])


def mirror_normal(case: Case, point: Float64Array) -> Float64Array:
    """(3,) unit normal of the mirror at a point of it."""
    step = 1e-5 * np.eye(3)
    gradient = mirror_level(case, point + step) - mirror_level(case, point - step)
    return gradient / np.linalg.norm(gradient)


def hit_sheet(sheet: Sheet, origin: Float64Array, direction: Float64Array) -> float:
    """Distance to a sheet along a ray, inf when it misses."""
    a, b, c = sheet.corners[:3]
    normal = np.cross(b - a, c - a)
    slope = float(normal @ direction)
    if slope == 0.0:
        return np.inf
    distance = float(normal @ (a - origin)) / slope
    point = origin + distance * direction
    edges = np.roll(sheet.corners, -1, axis=0) - sheet.corners
    sides = np.cross(edges, point - sheet.corners) @ normal
    return distance if distance > 1e-6 and (sides >= 0.0).all() else np.inf


def mirror_ray(case: Case, column: float, row: float) -> tuple[Float64Array, Float64Array]:
    """(origin, unit direction) of the ray that a pixel's ray becomes at the mirror."""
    origin, direction = pixel_ray(case, column, row)
    point = origin + hit_mirror(case, origin, direction) * direction
    if not np.isfinite(point).all():
        raise ValueError(f"Pixel ({column}, {row}) does not see the mirror.")
    normal = mirror_normal(case, point)
    return point, direction - 2.0 * (direction @ normal) * normal


def trace(case: Case, column: float, row: float) -> Seen:
    """What a pixel's centre shows, one reflection deep. Raises ValueError where the mirror would reflect itself."""
    origin, direction = pixel_ray(case, column, row)
    to_mirror = hit_mirror(case, origin, direction)
    sheet, distance = _first(tuple(s for s in case.sheets if s.visible_camera), origin, direction)
    if sheet is not None and distance < to_mirror:
        color = BLACK if sheet.holdout else _radiance(case, sheet, origin + distance * direction)
        return Seen(color, sheet.name, False)
    if not np.isfinite(to_mirror):
        return Seen(case.world, "", False)
    point, way = mirror_ray(case, column, row)
    if np.isfinite(hit_mirror(case, point + 1e-3 * mirror_normal(case, point), way)):
        raise ValueError(f"Pixel ({column}, {row}) shows the mirror in the mirror.")
    sheet, distance = _first(tuple(s for s in case.sheets if s.visible_glossy), point, way)
    if sheet is None:
        return Seen(case.world, "", True)
    return Seen(_radiance(case, sheet, point + distance * way), sheet.name, True)


def _first(sheets: tuple[Sheet, ...], origin: Float64Array, direction: Float64Array) -> tuple[Sheet | None, float]:
    found, nearest = None, np.inf
    for sheet in sheets:
        distance = hit_sheet(sheet, origin, direction)
        if distance < nearest:
            found, nearest = sheet, distance
    return found, nearest


def _radiance(case: Case, sheet: Sheet, point: Float64Array) -> Color:
    """A diffuse sheet sends on reflectance / pi of the sun's irradiance, nothing in shadow. The world must be black."""
    if not sheet.diffuse:
        return sheet.color
    assert case.sun_toward is not None
    toward = np.asarray(case.sun_toward) / np.linalg.norm(case.sun_toward)
    normal = np.cross(sheet.corners[1] - sheet.corners[0], sheet.corners[2] - sheet.corners[0])
    normal /= np.linalg.norm(normal)
    start = point + 1e-4 * toward
    blocked = np.isfinite(hit_mirror(case, start, toward)) or _first(case.sheets, start, toward)[0] is not None
    value = 0.0 if blocked else case.sun_strength * abs(float(normal @ toward)) / np.pi
    return (sheet.color[0] * value, sheet.color[1] * value, sheet.color[2] * value)


# Sheets -----------------------------------------------------------------------------------------------------------


def across(origin: Float64Array, direction: Float64Array, distance: float, half: float) -> Float64Array:
    """(4, 3) corners of a square sheet of half width `half`, at right angles across a ray at `distance`."""
    helper = np.array([0.0, 0.0, 1.0]) if abs(direction[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    second = np.cross(direction, first)
    center = origin + distance * direction
    return np.array([center + half * (i * first + j * second) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def level(x: tuple[float, float], y: tuple[float, float], z: float) -> Float64Array:
    """(4, 3) corners of a level rectangle, facing up."""
    return np.array([(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)], float)


# Cases ------------------------------------------------------------------------------------------------------------


def scene_over_mirror() -> Case:
    """A thing between the camera and the mirror hides the reflection; the mirror hides a thing behind it."""
    empty = Case("scene_over_mirror", (), ())
    front = Sheet("Front", across(*pixel_ray(empty, 84, 60), 3.5, 0.12), RED)
    behind = Sheet("Behind", across(*pixel_ray(empty, 50, 60), 9.0, 0.8), GREEN)
    shown = Sheet("Shown", across(*mirror_ray(empty, 84, 76), 1.5, 1.2), BLUE)
    return Case(
        empty.name,
        (front, behind, shown),
        (
            Pixel(84, 60, RED, "Front", False, "the front sheet hides the mirror"),
            Pixel(84, 76, BLUE, "Shown", True, "beside the front sheet the mirror shows the blue one"),
            Pixel(50, 60, SKY, "", True, "the mirror hides the sheet behind it"),
        ),
        world=SKY,
    )


def mirror_over_itself() -> Case:
    """A lobe of the mirror hides what the sphere behind it reflects."""
    ball = Case("mirror_over_itself", (), ())
    lobe = Lobe(axis=(0.85, -0.5, 0.0), height=0.55, width=0.45)
    shown = Sheet("Shown", across(*mirror_ray(ball, 104, 48), 2.0, 1.3), GREEN)
    return Case(
        ball.name,
        (shown,),
        (
            Pixel(107, 58, SKY, "", True, "the lobe stands before the point of the sphere that would show green"),
            Pixel(98, 41, GREEN, "Shown", True, "clear of the lobe the sphere shows green"),
            Pixel(30, 64, SKY, "", True, "the other side shows the world"),
        ),
        lobe=lobe,
        world=SKY,
    )


def layers() -> Case:
    """Thin sheets close behind each other: the front one wins, whichever is drawn first."""
    empty = Case("layers", (), ())
    right, left = mirror_ray(empty, 96, 64), mirror_ray(empty, 32, 64)
    colors = (RED, GREEN, BLUE, YELLOW, CYAN)
    distances = (1.50, 1.51, 1.52, 1.53, 1.54)
    near_first = [
        Sheet(f"Right {i}", across(*right, d, 0.5), c) for i, (d, c) in enumerate(zip(distances, colors, strict=True))
    ]
    far_first = [
        Sheet(f"Left {i}", across(*left, d, 0.5), c)
        for i, (d, c) in enumerate(zip(reversed(distances), colors, strict=True))
    ]
    return Case(
        empty.name,
        (*near_first, *far_first),
        (
            Pixel(96, 64, RED, "Right 0", True, "red is nearest to the mirror, and listed first"),
            Pixel(97, 67, RED, "Right 0", True, "red is nearest to the mirror, and listed first"),
            Pixel(32, 64, CYAN, "Left 4", True, "cyan is nearest to the mirror, and listed last"),
            Pixel(31, 61, CYAN, "Left 4", True, "cyan is nearest to the mirror, and listed last"),
        ),
    )


def wall_behind() -> Case:
    """A wall behind the mirror shows near the mirror's rim only."""
    wall = Sheet("Wall", np.array([(-60, 4, -60), (60, 4, -60), (60, 4, 60), (-60, 4, 60)], float), MAGENTA)
    return Case(
        "wall_behind",
        (wall,),
        (
            Pixel(64, 64, SKY, "", True, "the middle looks back to the camera's side"),
            Pixel(80, 50, SKY, "", True, "still the camera's side"),
            Pixel(64, 112, MAGENTA, "Wall", True, "grazing rays go on to the wall"),
            Pixel(20, 50, MAGENTA, "Wall", True, "grazing rays go on to the wall"),
            Pixel(6, 120, MAGENTA, "Wall", False, "past the mirror the wall is seen directly"),
        ),
        world=SKY,
    )


def floor_past_horizon() -> Case:
    """One long triangle of floor under the mirror; two of its three vertices are hidden behind the mirror."""
    floor = Sheet("Floor", np.array([(0, -14, -1.05), (4.0, 40, -1.05), (-4.0, 40, -1.05)], float), YELLOW)
    return Case(
        "floor_past_horizon",
        (floor,),
        (
            Pixel(64, 40, YELLOW, "Floor", True, "under the camera"),
            Pixel(64, 26, YELLOW, "Floor", True, "below the mirror"),
            Pixel(68, 18, YELLOW, "Floor", True, "below the mirror, nearer the horizon"),
            Pixel(64, 90, SKY, "", True, "the upper half shows the world"),
            Pixel(100, 40, SKY, "", True, "beside the floor's edge"),
        ),
        world=SKY,
    )


def bar_past_horizon() -> Case:
    """A long sheet that goes on past the mirror's horizon, and one that stands through the floor."""
    bar = Sheet("Bar", np.array([(1.6, -9, -0.4), (1.6, 30, -0.4), (1.6, 30, 0.5), (1.6, -9, 0.5)], float), RED)
    post = Sheet("Post", np.array([(-3.4, -2, -4.0), (-1.6, -2, -4.0), (-1.6, -2, 1.0), (-3.4, -2, 1.0)], float), GREEN)
    floor = Sheet("Floor", level((-30.0, 30.0), (-30.0, 30.0), -1.05), BLUE)
    return Case(
        "bar_past_horizon",
        (bar, post, floor),
        (
            Pixel(93, 64, RED, "Bar", True, "the bar's near part"),
            Pixel(110, 64, RED, "Bar", True, "the bar's far part, near the rim"),
            Pixel(39, 70, GREEN, "Post", True, "the post above the floor"),
            Pixel(43, 43, BLUE, "Floor", True, "the floor hides the post's lower part"),
            Pixel(64, 22, BLUE, "Floor", True, "floor"),
        ),
        world=SKY,
    )


def ray_visibility() -> Case:
    """Things that reflections must skip, things that only reflections show, and a holdout."""
    empty = Case("ray_visibility", (), ())
    right, left, up = mirror_ray(empty, 96, 64), mirror_ray(empty, 32, 64), mirror_ray(empty, 64, 94)
    return Case(
        empty.name,
        (
            Sheet("Not glossy", across(*right, 1.0, 0.6), RED, visible_glossy=False),
            Sheet("Right", across(*right, 1.6, 1.0), GREEN),
            Sheet("Glossy only", across(*left, 1.0, 0.6), CYAN, visible_camera=False),
            Sheet("Left", across(*left, 1.6, 1.0), YELLOW),
            Sheet("Holdout", across(*up, 1.2, 0.5), MAGENTA, holdout=True),
            Sheet("Hole", across(*pixel_ray(empty, 64, 36), 3.0, 0.1), WHITE, holdout=True),
        ),
        (
            Pixel(96, 64, GREEN, "Right", True, "the red sheet is hidden from glossy rays"),
            Pixel(32, 64, CYAN, "Glossy only", True, "hidden from the camera but not from the mirror"),
            Pixel(64, 94, MAGENTA, "Holdout", True, "Cycles cuts holes for camera rays only"),
            Pixel(64, 36, BLACK, "Hole", False, "a holdout before the mirror leaves nothing"),
        ),
        world=SKY,
    )


def sun_and_shadow() -> Case:
    """A grey floor, partly in the shadows of a small sheet and of the mirror, under a sun straight above."""
    floor = Sheet("Floor", level((-8.0, 8.0), (-14.0, 8.0), -1.2), (0.8, 0.8, 0.8), diffuse=True)
    shade = Sheet("Shade", level((1.2, 3.2), (-5.0, 1.0), 3.0), BLACK)
    lit = 0.8 * 2.0 / np.pi
    return Case(
        "sun_and_shadow",
        (floor, shade),
        (
            Pixel(45, 34, (lit, lit, lit), "Floor", True, "lit: reflectance / pi times the sun's irradiance"),
            Pixel(91, 44, BLACK, "Floor", True, "in the shade of the small sheet"),
            Pixel(58, 22, BLACK, "Floor", True, "in the shade of the mirror"),
            Pixel(64, 90, BLACK, "", True, "world"),
        ),
        sun_toward=(0.0, 0.0, 1.0),
        sun_strength=2.0,
    )


def orthographic() -> Case:
    """The same by an orthographic camera: the eye is a direction."""
    empty = Case("orthographic", (), (), orthographic_width=2.6)
    front = Sheet("Front", across(*pixel_ray(empty, 84, 60), 3.5, 0.12), RED)
    shown = Sheet("Shown", across(*mirror_ray(empty, 90, 80), 1.5, 0.8), BLUE)
    wall = Sheet("Wall", np.array([(-60, 4, -60), (60, 4, -60), (60, 4, 60), (-60, 4, 60)], float), MAGENTA)
    return Case(
        empty.name,
        (front, shown, wall),
        (
            Pixel(84, 60, RED, "Front", False, "the front sheet hides the mirror"),
            Pixel(90, 80, BLUE, "Shown", True, "the mirror shows the blue sheet"),
            Pixel(60, 64, SKY, "", True, "the middle looks back to the camera's side"),
            Pixel(64, 18, MAGENTA, "Wall", True, "grazing rays go on to the wall"),
            Pixel(4, 4, MAGENTA, "Wall", False, "past the mirror the wall is seen directly"),
        ),
        orthographic_width=2.6,
        world=SKY,
    )


CASES: dict[str, Callable[[], Case]] = {
    function.__name__: function
    for function in (
        scene_over_mirror,
        mirror_over_itself,
        layers,
        wall_behind,
        floor_past_horizon,
        bar_past_horizon,
        ray_visibility,
        sun_and_shadow,
        orthographic,
    )
}
