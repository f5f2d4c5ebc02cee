# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostic views, mostly of a mirror ball whose surface buffers are made by closed-form ray casting."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import MODES, DiagnosticOptions, method_color
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.seen import draw_seen
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shading.lookup import Environment
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from scenes.mirror_room import Room
from scenes.views import look_at
from shading.mirror_ball import COLORS, EYE, VIEW, Ball, close_to, drawn, place_on_ramp

pytestmark = pytest.mark.usefixtures("gpu")
ENVIRONMENTS = [name for name, method in METHODS.items() if method.is_environment]


def test_zebra_bands_are_at_their_reflected_directions() -> None:
    for orthographic in (False, True):
        view = look_at(EYE, np.zeros(3), 160, 120, np.radians(36), orthographic=orthographic)
        ball = Ball(view)
        axis = unit(np.array([0.3, -0.2, 0.9]))
        options = DiagnosticOptions(axis=tuple(3.0 * axis), stripes=5)
        picture = drawn(view, ball.seen(), (), "ZEBRA", options)
        place = np.arccos(np.clip(ball.ray @ axis, -1, 1)) / np.pi * 5
        # Well inside a band, whose share of the pixel is all or nothing.
        middle = ball.inner(0.3) & (np.abs(place * 2 % 1 - 0.5) < 0.25)
        assert middle.sum() > 1000
        white = place % 1 < 0.5
        assert white[middle].any() and not white[middle].all()
        assert np.abs(picture[middle & white][:, :3] - 0.9).max() < 1e-3
        assert picture[middle & ~white][:, :3].max() < 0.02


def test_zebra_finer_than_pixels_is_gray() -> None:
    ball = Ball()
    picture = drawn(VIEW, ball.seen(), (), "ZEBRA", DiagnosticOptions(stripes=20000))
    # The way to the axis itself is a point where the bands are rings.
    inside = ball.inner(0.3) & (np.abs(ball.ray[..., 2]) < 0.95)
    assert np.abs(picture[inside][:, 1] - 0.454).max() < 0.03


def test_line_lights_are_at_their_directions() -> None:
    ball = Ball()
    options = DiagnosticOptions(axis=(1.0, 0.0, 0.0), lines=4, line_width=20.0)
    picture = drawn(VIEW, ball.seen(), (), "LINES", options)
    # Four lamps along x: above, below, in front and behind.
    turn = np.degrees(np.arctan2(ball.ray[..., 1], ball.ray[..., 2]))
    beside = np.abs((turn + 45.0) % 90.0 - 45.0)
    inside = ball.inner(0.3) & (np.abs(ball.ray[..., 0]) < 0.8)
    lit, unlit = inside & (beside < 4.0), inside & (beside > 17.0)
    assert lit.sum() > 50 and unlit.sum() > 500
    assert picture[lit][:, 1].min() > 0.85
    assert picture[unlit][:, 1].max() < 0.02


def test_angle_error_is_the_angle() -> None:
    """What is shown is turned off the reflected ray by an angle that is known at every pixel."""
    ball = Ball()
    wanted = 10 ** np.linspace(-2.5, 1.5, VIEW.width)[None].repeat(VIEW.height, 0)
    side = unit(np.cross(ball.ray, [0.3, 0.5, 0.8]))
    turned = np.cos(np.radians(wanted))[..., None] * ball.ray + np.sin(np.radians(wanted))[..., None] * side
    shown = np.broadcast_to(np.arange(VIEW.height)[:, None] % 3 > 0, ball.mask.shape)
    reflected = ball.shows(ball.point + 2.5 * turned, shown)
    place = place_on_ramp(drawn(VIEW, ball.seen(), reflected, "ANGLE_ERROR"))
    expected = np.clip((np.log10(wanted) + 2.0) / 3.0, 0.0, 1.0)
    assert ball.mask.sum() > 3000
    assert np.abs(place - expected)[ball.mask & shown].max() < 0.02
    assert place[ball.mask & ~shown].max() < 1e-3, "the background is exact"


def test_angle_error_of_an_environment_cube() -> None:
    """A cube map shows, along a ray from the point P, what is along it from the center."""
    ball = Ball()
    size = 64
    distance = 3.0
    from curvrefl.curvrefl_addon.optics.surfaces.cube_map import texel_directions

    faces = np.ones((6, size, size, 4), np.float32)
    faces[..., :3] = distance * texel_directions(size).reshape(6, size, size, 3)
    cube = cube_texture(faces, linear=True)
    environment = Environment("environment_cube", None, lambda: cube)
    picture = drawn(VIEW, ball.seen(), (environment,), "ANGLE_ERROR", DiagnosticOptions(angles=(0.1, 90.0)))
    to_shown = unit(distance * ball.ray - ball.point)
    angle = np.degrees(np.arccos(np.clip((to_shown * ball.ray).sum(-1), -1, 1)))
    ours = 10 ** (place_on_ramp(picture) * np.log10(900.0) - 1.0)
    fair = ball.inner() & (angle > 1.0)
    assert angle[fair].max() > 15.0
    assert (np.abs(ours - angle)[fair] < 0.05 * angle[fair] + 0.3).all()


def test_iterations_are_the_reflected_buffers() -> None:
    ball = Ball()
    count = np.broadcast_to(np.arange(VIEW.width) * 30.0 / VIEW.width, ball.mask.shape)
    shown = np.broadcast_to(np.arange(VIEW.height)[:, None] < 60, ball.mask.shape)
    picture = drawn(VIEW, ball.seen(), ball.shows(3.0 * ball.point, shown, count), "ITERATIONS")
    place = place_on_ramp(picture)
    here = ball.mask & shown
    assert np.abs(place - np.clip(count / 20.0, 0.0, 1.0))[here].max() < 0.02
    assert close_to(picture, COLORS.background)[ball.mask & ~shown].all()


def test_every_mirror_has_its_methods_color() -> None:
    ball = Ball()
    left = np.broadcast_to(np.arange(VIEW.width) < 80, ball.mask.shape)
    shown = np.broadcast_to(np.arange(VIEW.height)[:, None] < 60, ball.mask.shape)
    picture = drawn(
        VIEW,
        ball.seen(np.where(left, 1.0, 2.0)),
        ball.shows(ball.point + ball.ray, shown),
        "METHOD",
        methods=("secant_star", "environment_cube"),
    )
    # Faces that look at the mirror are not darkened.
    assert close_to(picture, method_color("secant_star"))[ball.mask & shown & left].all()
    assert close_to(picture, method_color("environment_cube"))[ball.mask & shown & ~left].all()
    assert close_to(picture, COLORS.background)[ball.mask & ~shown].all()


@pytest.mark.parametrize("mode", MODES)
def test_sub_frames_add_up_on_mirrors_alone(mode: str) -> None:
    ball = Ball()
    reflected = ball.shows(ball.point + ball.ray, np.ones(ball.mask.shape, bool), 5.0)
    picture = drawn(VIEW, ball.seen(), reflected, mode, weights=(0.25, 0.75))
    assert (picture[ball.mask][:, 3] == 1.0).all()
    assert (picture[~ball.mask] == 0.0).all()
    whole = drawn(VIEW, ball.seen(), reflected, mode)
    np.testing.assert_allclose(picture, whole, atol=1e-5)


def room() -> Room:
    made = Room()
    made.add_mirror(Ellipsoid())
    made.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    made.add_ball((1.3, -1.6, 0.1), 0.5)
    return made


def rendered(method: str, mode: str) -> tuple[np.ndarray, np.ndarray, Renderer]:
    """A view through the pixel centers and the shade pass's picture of the mirrors beside it."""
    renderer = Renderer(room().arrays(), Settings(method=method, samples=1, environment_resolution=64))
    canvas = Canvas.of_size(VIEW.width, VIEW.height)
    reflection = renderer.reflect(VIEW)
    renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True)
    # One sub-frame has no jitter: it is the view's own.
    sub_frame = draw_seen(renderer._stage, renderer._targets, reflection, renderer.settings)
    ((kind, members),) = reflection.groups
    shown = kind.draw(members, sub_frame, of_positions=True)
    assert shown is not None
    picture = drawn(VIEW, sub_frame.targets.seen, shown, mode, methods=(method,), parts=reflection.parts)
    return picture, read_texture(canvas.texture), renderer


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("method", ["secant_star", *ENVIRONMENTS])
def test_covers_what_the_shade_pass_covers(method: str, mode: str) -> None:
    picture, shaded, _ = rendered(method, mode)
    assert 0.2 < (shaded[..., 3] == 1.0).mean() < 0.9
    assert np.array_equal(picture[..., 3], shaded[..., 3])
    assert np.isfinite(picture).all()


def test_angle_error_tells_the_methods_apart() -> None:
    truth, hit, _ = room().seen_in_ball(VIEW)
    near = Ball().inner(0.4) & truth & (hit > 0)
    assert near.sum() > 500
    degrees = {
        method: 10 ** (3.0 * place_on_ramp(rendered(method, "ANGLE_ERROR")[0])[near] - 2.0)
        for method in ("secant_star", "environment_cube")
    }
    assert np.median(degrees["secant_star"]) < 0.3
    assert np.median(degrees["environment_cube"]) > 5.0
