# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who hides whom, each in its own small scene whose answer is known by ray casting in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, Float64Array, tangential, unit
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

VIEW = look_at(np.array([0.8, -4.0, 1.0]), np.zeros(3), 240, 180, np.radians(36))


def render(room: Room, view=VIEW, **settings: object) -> Frame:
    return Renderer(room.arrays(), Settings(samples=1, **settings)).render(view)


def ball_room() -> Room:
    room = Room()
    room.add_mirror(Ellipsoid())
    return room


def wrong_share(room: Room, frame: Frame, view=VIEW) -> float:
    """Share of the mirror's pixels, edge pixels left out, that show another object than the ray cast."""
    on_ball, hit, _ = room.seen_in_ball(view)
    inner = on_ball & (frame.mask() > 0)
    assert (on_ball != (frame.mask() > 0)).mean() < 0.01
    return float((frame.reflected_object() != hit)[inner].mean())


def test_scene_over_reflector() -> None:
    room = ball_room()
    front = room.add_ball((1.1, -1.4, 0.2), 0.25)
    frame = render(room)
    x, y = VIEW.project(np.array([[1.1, -1.4, 0.2]]))[0].astype(int)
    assert frame.mask()[y, x] == 0, "the ball in front hides the mirror"
    assert front in frame.reflected_object(), "the mirror shows the ball's back side beside it"
    assert wrong_share(room, frame) < 0.01


def test_object_behind_the_mirror_is_not_in_it() -> None:
    room = ball_room()
    wall = room.add_rectangle((0.0, 3.0, 0.0), (6, 0, 0), (0, 0, 6))
    frame = render(room)
    on_ball, hit, _ = room.seen_in_ball(VIEW)
    assert wall in hit[on_ball], "the rim of the ball shows the wall"
    assert frame.reflected_object()[90, 120] == 0
    assert wrong_share(room, frame) < 0.01


def test_long_triangles_under_and_behind() -> None:
    room = ball_room()
    room.add_rectangle((0.0, 0.0, -1.0), (40, 0, 0), (0, 40, 0))
    frame = render(room)
    assert wrong_share(room, frame) < 0.01
    assert frame.solve["hidden"] > 0


@pytest.mark.parametrize("gap", [0.1, 0.01, 0.001])
def test_thin_layers_keep_their_order(gap: float) -> None:
    """Layered sheets fight in depth where distances are interpolated from vertices (the papers' figure 13)."""
    room = ball_room()
    for distance in (2.4, 2.4 + gap):
        room.add_rectangle((-0.8 * distance, -0.6 * distance, 0.3), (0.48, -0.64, 0), (0, 0, 0.8))
    frame = render(room)
    on_ball, hit, _ = room.seen_in_ball(VIEW)
    front = on_ball & (hit == 2) & (frame.reflected_object() > 0)
    assert front.sum() > 300
    assert (frame.reflected_object()[front] == 2).mean() > 0.995


def test_nearer_object_wins_in_the_mirror() -> None:
    room = ball_room()
    room.add_ball((-1.4, -1.2, 0.5), 0.3)
    room.add_ball((-3.0, -2.8, 1.0), 0.9)
    room.add_rectangle((0.0, -8.0, 0.0), (5, 0, 0), (0, 0, 5))
    frame = render(room)
    on_ball, hit, _ = room.seen_in_ball(VIEW)
    assert {2, 3, 4} <= set(hit[on_ball])
    assert wrong_share(room, frame) < 0.02


@pytest.mark.parametrize("gap", [0.1, 0.01])
def test_contact(gap: float) -> None:
    room = ball_room()
    room.add_ball((0.9 + gap, -0.9 - gap, 0.3), 0.3)
    room.add_rectangle((0.0, 0.0, -1.0 - gap), (6, 0, 0), (0, 6, 0))
    frame = render(room)
    assert wrong_share(room, frame) < 0.015


class Dumbbell:
    """Two lobes along z: each hides a part of the other."""

    bound = 1.1

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        z = u[:, 2]
        gradient = np.zeros_like(u)
        gradient[:, 2] = 0.6 * z
        return 0.8 + 0.3 * z**2, tangential(gradient, u)


@pytest.mark.parametrize("eye", [(0.5, -3.0, 4.0), (0.4, -0.6, 5.0), (3.0, -3.0, 0.5)])
def test_reflector_over_itself(eye: tuple[float, float, float]) -> None:
    """The near lobe hides the waist and the far lobe: no pixel may show what those reflect, where a ray cast finds
    nothing."""
    from mathutils.bvhtree import BVHTree

    room = Room()
    room.add_mirror(Dumbbell(), 256)
    for i, angle in enumerate(np.linspace(0, 2 * np.pi, 9)[:-1]):
        room.add_ball((2.2 * np.cos(angle), 2.2 * np.sin(angle), -1.2 + 0.4 * (i % 5)), 0.3)
    view = look_at(np.array(eye), np.zeros(3), 320, 240, np.radians(34))
    frame = render(room, view)
    mirror = room.arrays().meshes[0]
    itself = BVHTree.FromPolygons(mirror.positions.tolist(), mirror.triangles.tolist())
    point, normal = frame.surfaces["seen_position"][..., :3], frame.surfaces["seen_normal"][..., :3]
    to_eye = unit(view.eye[:3] - point)
    ray = 2 * (normal * to_eye).sum(-1, keepdims=True) * normal - to_eye
    truth, _ = room.cast(point.astype(float), ray.astype(float))
    on_mirror = np.argwhere(frame.mask() > 0)
    free = np.zeros(frame.mask().shape, bool)
    for y, x in on_mirror:
        start = point[y, x] + 1e-3 * normal[y, x]
        free[y, x] = itself.ray_cast(start.tolist(), ray[y, x].tolist())[0] is None
    shown = frame.reflected_object()
    assert (shown[free] > 0).sum() > 200
    false_image = free & (shown > 0) & (truth != shown)
    # One-pixel rims of true images are allowed; a lobe's worth of wrong image is not.
    assert false_image.sum() / (shown[free] > 0).sum() < 0.12


def test_visibility_flags() -> None:
    room = ball_room()
    hidden_from_mirrors = room.add_ball((1.2, -1.5, 0.2), 0.3, visible_glossy=False)
    hidden_from_eye = room.add_ball((-0.9, -1.4, 0.4), 0.3, visible_camera=False)
    frame = render(room)
    seen = np.rint(frame.surfaces["seen_position"][..., 3])
    assert hidden_from_mirrors in seen and hidden_from_mirrors not in frame.reflected_object()
    assert hidden_from_eye not in seen and hidden_from_eye in frame.reflected_object()


def test_holdout_cuts_the_picture_but_not_the_mirror() -> None:
    room = ball_room()
    cutter = room.add_ball((1.1, -1.4, 0.2), 0.25, holdout=True)
    frame = render(room)
    x, y = VIEW.project(np.array([[1.1, -1.4, 0.2]]))[0].astype(int)
    assert frame.color()[y, x].tolist() == [0.0, 0.0, 0.0, 0.0]
    assert cutter in frame.reflected_object()


def test_orthographic() -> None:
    view = look_at(np.array([0.8, -4.0, 1.0]), np.zeros(3), 240, 180, np.radians(36), orthographic=True)
    room = ball_room()
    room.add_ball((0.9, -1.4, 0.3), 0.4)
    room.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    frame = render(room, view)
    assert wrong_share(room, frame, view) < 0.015


def test_shown_points_are_where_rays_meet() -> None:
    room = ball_room()
    room.add_rectangle((0.0, 0.0, -1.0), (10, 0, 0), (0, 10, 0))
    room.add_ball((1.2, -1.2, -0.5), 0.5)
    frame = render(room)
    on_ball, hit, shown = room.seen_in_ball(VIEW)
    same = on_ball & (frame.mask() > 0) & (frame.reflected_object() == hit) & (hit > 0)
    point = frame.reflector_position()
    ours, truth = unit(frame.reflected_position()[..., :3] - point), unit(shown - point)
    angle = np.degrees(np.arccos(np.clip((ours * truth).sum(-1), -1, 1)))[same]
    # Half a pixel on a ball of 90 pixels turns the reflected ray by 0.6 degrees.
    assert np.median(angle) < 0.25
    assert np.percentile(angle, 95) < 1.3


def test_mirror_out_of_view_and_nothing_to_reflect() -> None:
    alone = ball_room()
    frame = render(alone)
    np.testing.assert_allclose(frame.color()[90, 120, :3], 0.5, atol=0.02)
    away = look_at(np.array([0.0, -4.0, 1.0]), np.array([0.0, -8.0, 1.0]), 120, 90, np.radians(36))
    frame = render(alone, away)
    assert not frame.mask().any()
    np.testing.assert_allclose(frame.color()[..., :3], 0.5, atol=1e-3)


def test_eye_inside_the_mirror() -> None:
    room = ball_room()
    room.add_ball((3.0, 0.0, 0.0), 0.5)
    frame = render(room, look_at(np.array([0.2, 0.0, 0.1]), np.array([1.0, 0.3, 0.0]), 120, 90, np.radians(60)))
    assert np.isfinite(frame.color()).all()
    assert frame.color()[..., :3].max() == 0.0
    assert any("inside" in sentence for sentence in frame.warnings)


def test_bumpy_mirror_shows_finite_colors() -> None:
    room = Room()
    room.add_mirror(Bumpy(0.3))
    room.add_rectangle((0.0, 0.0, -1.4), (10, 0, 0), (0, 10, 0))
    frame = render(room)
    assert np.isfinite(frame.color()).all()
    assert frame.solve["unconverged"] <= 0.01 * frame.solve["vertices"]
