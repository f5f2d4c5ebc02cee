# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Tiny scenes in which what hides what is known by construction. No bpy: `builders.build_case` makes them in Blender.

Sheets are put where a chosen pixel's reflected ray goes, so the pixel's color follows. `sheet_rays.trace` is the
second witness; the tests hold both to Cycles.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .sheet_rays import mirror_ray, pixel_ray
from .sheets import BLACK, BLUE, CYAN, GREEN, MAGENTA, RED, SKY, WHITE, YELLOW, Case, Lobe, Pixel, Sheet, across, level


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
    """A gray floor, partly in the shadows of a small sheet and of the mirror, under a sun straight above."""
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
