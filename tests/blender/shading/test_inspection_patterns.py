# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Isophotes, highlight lines, curvature, and what patterns are locked to, of a ball and of meshes with closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import CURVATURES, ONE_SIDED, DiagnosticOptions, ramp_colors
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.pacing.pieces import OutOfTime, paced
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.reflection import Diagnostic
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.seen import draw_seen
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shading.curvature import Curvatures
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import view_block
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.meshes.made import smooth_mesh
from scenes.inspected.analytic_surfaces import SURFACES
from scenes.mirror_room import Room
from scenes.views import look_at
from shading.mirror_ball import COLORS, EYE, VIEW, Ball, drawn, place_on_ramp

pytestmark = pytest.mark.usefixtures("gpu")
AXIS = unit(np.array([0.3, -0.5, 0.6]))
TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def bright(normal: np.ndarray, axis: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Where bands of the angle to an axis are bright, and where a pixel is well inside of one."""
    place = np.arccos(np.clip(normal @ axis, -1, 1)) / np.pi * count
    return place % 1 < 0.5, np.abs(place * 2 % 1 - 0.5) < 0.3


def assert_bands(picture: np.ndarray, where: np.ndarray, axis: np.ndarray, normal: np.ndarray, count: int = 8) -> None:
    white, firm = bright(normal, axis, count)
    firm &= where
    assert (firm & white).sum() > 300 and (firm & ~white).sum() > 300
    assert np.abs(picture[firm & white][:, 1] - 0.9).max() < 1e-3
    assert picture[firm & ~white][:, 1].max() < 0.02


def test_isophotes_are_bands_of_the_normal() -> None:
    """Wherever the eye is: also where the view is orthographic."""
    for orthographic in (False, True):
        ball = Ball(look_at(EYE, np.zeros(3), 160, 120, np.radians(36), orthographic=orthographic))
        picture = drawn(ball.view, ball.seen(), (), "ISOPHOTES", DiagnosticOptions(axis=tuple(AXIS), stripes=8))
        assert_bands(picture, ball.inner(0.3), AXIS, ball.point)


def test_highlight_lines_are_where_normals_pass_near_a_lamp() -> None:
    ball = Ball()
    options = DiagnosticOptions(axis=(0.0, 0.0, 1.0), lines=8, line_width=15.0)
    picture = drawn(VIEW, ball.seen(), (), "HIGHLIGHTS", options)
    # Eight lamps around z, the first along +y.
    turn = np.degrees(np.arctan2(ball.point[..., 0], ball.point[..., 1]))
    beside = np.abs((turn + 22.5) % 45.0 - 22.5)
    inside = ball.inner(0.3) & (np.abs(ball.point[..., 2]) < 0.8)
    assert picture[inside & (beside < 5.0)][:, 1].min() > 0.85
    assert picture[inside & (beside > 10.5)][:, 1].max() < 0.02


@pytest.mark.parametrize("mode", ["ZEBRA", "ISOPHOTES"])
def test_a_pattern_turns_with_what_it_is_locked_to(mode: str) -> None:
    """The same picture by an axis that is turned already; mirrors that turn otherwise have their own."""
    ball = Ball()
    looked_up = ball.ray if mode == "ZEBRA" else ball.point
    count = 4 if mode == "ZEBRA" else 8
    options = DiagnosticOptions(axis=tuple(AXIS), stripes=count)
    turned = drawn(VIEW, ball.seen(), (), mode, options, turns=TURN)
    assert_bands(turned, ball.inner(0.3), TURN @ AXIS, looked_up, count)
    left = np.broadcast_to(np.arange(VIEW.width) < 80, ball.mask.shape)
    both = drawn(
        VIEW,
        ball.seen(np.where(left, 1.0, 2.0)),
        (),
        mode,
        options,
        methods=("secant_star",) * 2,
        turns=np.array([TURN, np.eye(3)]),
    )
    assert_bands(both, ball.inner(0.3) & left, TURN @ AXIS, looked_up, count)
    assert_bands(both, ball.inner(0.3) & ~left, AXIS, looked_up, count)


def test_softness_and_transparency() -> None:
    ball = Ball()
    inside = ball.inner(0.3)
    options = DiagnosticOptions(axis=tuple(AXIS), stripes=4, softness=1.0)
    wave = drawn(VIEW, ball.seen(), (), "ISOPHOTES", options)
    # Half a band wide, an edge is a wave of straight lines.
    place = np.arccos(np.clip(ball.point @ AXIS, -1, 1)) / np.pi * 4
    expected = np.abs(np.abs((place - 0.25) % 1 - 0.5) * 2)
    assert np.abs(wave[..., 1] - (0.008 + 0.892 * expected))[inside].max() < 0.02
    clear = drawn(VIEW, ball.seen(), (), "ISOPHOTES", replace(options, transparency=0.75))
    np.testing.assert_allclose(clear[ball.mask], 0.25 * wave[ball.mask], atol=1e-3)


@pytest.mark.parametrize("kind", CURVATURES)
def test_curvature_of_a_ball(kind: str) -> None:
    ball = Ball()
    for radius in (1.0, -0.8):
        options = DiagnosticOptions(curvature=kind)
        curved = ball.curved(end=2.0, radius=radius)
        picture = drawn(VIEW, ball.seen(), (), "CURVATURE", options, curved=curved)
        stops = COLORS.ramp if kind == ONE_SIDED else COLORS.two_sided
        value = {"GAUSSIAN": radius**-2, "STRONGEST": abs(1 / radius)}.get(kind, 1 / radius)
        expected = value / 2.0 if kind == ONE_SIDED else 0.5 + value / 4.0
        place = place_on_ramp(picture, stops) if kind == ONE_SIDED else two_sided_place(picture)
        assert np.abs(place - expected)[ball.mask].max() < 0.01
    # What is not known of a mirror is not made up.
    unknown = drawn(VIEW, ball.seen(ball.mask * 2.0), (), "CURVATURE", methods=("secant_star",) * 2)
    np.testing.assert_allclose(
        unknown[ball.mask][:, :3], np.broadcast_to(COLORS.background, (ball.mask.sum(), 3)), atol=1e-3
    )


def two_sided_place(picture: np.ndarray) -> np.ndarray:
    fine = ramp_colors(COLORS.two_sided, 401)
    return np.abs(picture[..., None, :3] - fine).sum(-1).argmin(-1) / 400.0


def mirror_alone(name: str, matrix: np.ndarray) -> SceneArrays:
    """A surface with a closed form, placed, as the only mirror."""
    made = SURFACES[name]()
    room = Room()
    room.add_mirror(Ellipsoid())
    arrays = room.arrays()
    mesh = smooth_mesh(name, made.positions, made.normals, made.triangles)
    return replace(arrays, meshes=(mesh,), instances=(replace(arrays.instances[0], matrix=matrix),))


@pytest.mark.parametrize("name", ["torus", "saddle", "ellipsoid"])
def test_pixels_of_placed_meshes_have_the_closed_forms(name: str) -> None:
    """Twice as large, turned and moved: half the curvature, the directions turned."""
    made = SURFACES[name]()
    matrix = np.eye(4)
    matrix[:3, :3] = 2.0 * TURN
    matrix[:3, 3] = (1.0, 2.0, 3.0)
    scene = mirror_alone(name, matrix)
    renderer = Renderer(scene, Settings(samples=1, method="exact"))
    middle = len(made.positions) // 2 + 60
    target = matrix[:3, :3] @ made.positions[middle] + matrix[:3, 3]
    normal = TURN @ made.normals[middle]
    view = look_at(target + 3.0 * unit(normal + 0.1), target, 96, 72, 0.3)
    curvatures = Curvatures()
    buffer = curvatures.draw(renderer.mirrors, view, view_block(view), 1.0)
    diagonal, across = read_texture(buffer.diagonal), read_texture(buffer.across)
    assert (diagonal[36, 48, 3], across.shape[2]) == (1.0, 4)
    six = np.concatenate([diagonal[36, 48, :3], across[36, 48, :3]])
    tensor = six[[0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(3, 3)
    found = np.linalg.eigvalsh(tensor)
    expected = np.sort([0.0, made.largest[middle] / 2.0, made.smallest[middle] / 2.0])
    np.testing.assert_allclose(found, expected, atol=0.01 * np.abs(expected).max())
    assert np.abs(tensor @ normal).max() < 0.01


def torus_normals(points: np.ndarray) -> np.ndarray:
    """(h, w, 3) exact unit normals of the torus at points near it."""
    ring = points * [1, 1, 0]
    return unit(points - 2.0 * ring / np.linalg.norm(ring, axis=-1, keepdims=True).clip(1e-9))


@pytest.mark.parametrize("mode", ["ISOPHOTES", "ZEBRA", "HIGHLIGHTS", "LINES"])
def test_patterns_of_a_torus_have_their_closed_forms(mode: str) -> None:
    """A mesh's pattern is that of the surface itself to 1 percent of a band, where the eye does not look along it.

    Bands are waves of straight lines: brightness tells the place in a band.
    """
    renderer = Renderer(mirror_alone("torus", np.eye(4)), Settings(samples=1, method="exact"))
    view = look_at(np.array([6.0, 2.0, 3.0]), np.array([1.5, 1.0, 0.0]), 160, 120, 0.5)
    count = 6
    options = DiagnosticOptions(axis=tuple(AXIS), stripes=count, lines=count, line_width=180.0 / count, softness=1.0)
    reflection = renderer.reflect(view, solve=False)
    canvas = Canvas.of_size(160, 120)
    renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True, diagnostic=Diagnostic(mode, options))
    seen = draw_seen(renderer._stage, renderer._targets, reflection, renderer.settings)
    position = read_texture(seen.targets.seen.position)
    normal = torus_normals(position[..., :3])
    away = unit(position[..., :3] - view.eye[:3])
    facing = -(away * normal).sum(-1)
    looked_up = away + 2.0 * facing[..., None] * normal if mode in ("ZEBRA", "LINES") else normal
    axis, up, side = options.axes
    along = np.clip((looked_up * axis).sum(-1), -1, 1)
    if mode in ("ZEBRA", "ISOPHOTES"):
        place = np.arccos(along) / np.pi * count
    else:
        place = np.arctan2((looked_up * side).sum(-1), (looked_up * up).sum(-1)) / (2 * np.pi) * count + 0.25
    wave = np.abs(np.abs((place - 0.25) % 1 - 0.5) * 2)
    # (Towards the axis lamps come together, and waves end where they turn.)
    least = 0.1 if mode == "ISOPHOTES" else 0.3
    fair = (position[..., 3] > 0) & (facing > least) & (np.abs(along) < 0.9) & (np.abs(wave - 0.5) < 0.35)
    assert fair.sum() > 1000
    found = (canvas.pixels()[..., 1] - 0.008) / 0.892
    # (Over a band, half a period, the wave goes from 0 to 1.)
    assert np.abs(found - wave)[fair].max() < 0.01


def test_curvature_is_found_once_in_pieces_and_kept_while_a_mirror_moves() -> None:
    scene = mirror_alone("torus", np.eye(4))
    renderer = Renderer(scene, Settings(samples=1, method="exact"))
    curvatures = Curvatures()
    pieces = 0
    while True:
        pieces += 1
        try:
            with paced(0.0):
                curvatures.prepare(renderer.mirrors)
            break
        except OutOfTime as left:
            assert str(left) == "curvature of object 1"
    assert pieces == 2, "57,000 triangles"
    known = curvatures._meshes()[0]
    moved = np.eye(4)
    moved[:3, :3], moved[:3, 3] = TURN, (4.0, 0.0, 0.0)
    renderer.update(replace(scene, instances=(replace(scene.instances[0], matrix=moved),)))
    curvatures.prepare(renderer.mirrors)
    assert curvatures._meshes() == [known]
    end = curvatures.end_of("STRONGEST")
    renderer.update(replace(scene, instances=(replace(scene.instances[0], matrix=np.diag([2.0, 2.0, 2.0, 1.0])),)))
    curvatures.prepare(renderer.mirrors)
    assert known not in curvatures._meshes()
    assert (end, curvatures.end_of("STRONGEST")) == pytest.approx((2.0, 1.0)), "1 / 0.6 and 1 / 1.2"


@pytest.mark.parametrize("show", ["ZEBRA", "CURVATURE"])
def test_the_renderer_draws_them_locked_to_objects_and_views(show: str) -> None:
    scene = mirror_alone("torus", np.eye(4))
    renderer = Renderer(scene, Settings(samples=1, method="exact"))
    view = look_at(np.array([6.0, 2.0, 3.0]), np.array([1.5, 1.0, 0.0]), 96, 72, 0.5)
    pictures = {}
    for lock in ("WORLD", "OBJECT", "VIEW"):
        canvas = Canvas.of_size(96, 72)
        reflection = renderer.reflect(view, solve=False)
        options = DiagnosticOptions(lock=lock, directions=True)
        renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True, diagnostic=Diagnostic(show, options))
        pictures[lock] = canvas.pixels()
        assert (pictures[lock][..., 3] == 1.0).mean() > 0.2
    # The object's axes are the world's here, the view's are not.
    assert np.array_equal(pictures["WORLD"], pictures["OBJECT"])
    assert np.array_equal(pictures["WORLD"], pictures["VIEW"]) == (show == "CURVATURE")
