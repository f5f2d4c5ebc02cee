# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostic views, mostly of a mirror ball whose surface buffers are made by closed-form ray casting."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostic_colors import (
    MODES,
    DiagnosticColors,
    DiagnosticOptions,
    legend_of,
    method_color,
    ramp_colors,
    view_axis,
)
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.catalogue import METHODS
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.device.batches import indexed_batch
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shading.diagnostic_legend import draw_layout, layout
from curvrefl.curvrefl_addon.renderer.shading.diagnostics import DiagnosticPass
from curvrefl.curvrefl_addon.renderer.shading.lookup import Environment
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import view_block
from curvrefl.curvrefl_addon.renderer.vertices.solution import SolvedChunk, VertexSolution, statistics
from curvrefl.curvrefl_addon.scene.view import View
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([0.8, -4.0, 1.0])
VIEW = look_at(EYE, np.zeros(3), 160, 120, np.radians(36))
COLORS = DiagnosticColors()
PLAIN = DiagnosticOptions()
SECANT = ("secant_star",)
ENVIRONMENTS = [name for name, method in METHODS.items() if method.is_environment]


class Ball:
    """The unit ball about the origin as every pixel's centre sees it. Arrays (h, w, ...)."""

    def __init__(self, view: View = VIEW) -> None:
        self.view = view
        y, x = np.mgrid[0 : view.height, 0 : view.width]
        near, far = (
            np.stack(
                [(2 * x + 1) / view.width - 1, (2 * y + 1) / view.height - 1, np.full(x.shape, z), np.ones(x.shape)], -1
            )
            @ np.linalg.inv(view.world_to_clip).T
            for z in (-1.0, 1.0)
        )
        origin = near[..., :3] / near[..., 3:]
        direction = unit(far[..., :3] / far[..., 3:] - origin)
        along = (origin * direction).sum(-1)
        root = along**2 - (origin**2).sum(-1) + 1.0
        self.mask = root > 0
        distance = -along - np.sqrt(np.maximum(root, 0.0))
        self.point = np.where(self.mask[..., None], origin + distance[..., None] * direction, 0.0)
        self.ray = np.where(
            self.mask[..., None],
            direction - 2 * (direction * self.point).sum(-1, keepdims=True) * self.point,
            [0.0, 0.0, 1.0],
        )
        """This pixel's reflected ray"""

    def seen(self, number: np.ndarray | None = None) -> SurfaceBuffer:
        """Surface buffer with the mirror's `number` per pixel."""
        mirror = np.where(self.mask, 1.0 if number is None else number, 0.0)
        return filled(
            np.dstack([self.point, self.mask * 1.0]),
            np.dstack([self.point, np.zeros(self.mask.shape)]),
            np.dstack([np.ones(self.point.shape), mirror]),
        )

    def shows(self, position: np.ndarray, shown: np.ndarray, iterations: float | np.ndarray = 0.0) -> SurfaceBuffer:
        """Reflected surface buffer: `position` where `shown`, facing the mirror."""
        here = shown & self.mask
        return filled(
            np.dstack([np.where(here[..., None], position, 0.0), here * 7.0]),
            np.dstack([-self.ray, np.zeros(self.mask.shape)]),
            np.dstack([np.ones(self.point.shape), np.where(here, iterations, 0.0)]),
        )

    def inner(self, margin: float = 0.15) -> np.ndarray:
        """Pixels that are not near the rim."""
        facing = (self.point * unit(EYE - self.point)).sum(-1)
        return self.mask & (facing > margin)


def filled(position: np.ndarray, normal: np.ndarray, color: np.ndarray) -> SurfaceBuffer:
    height, width = position.shape[:2]
    buffer = SurfaceBuffer(width, height)
    buffer.position, buffer.normal, buffer.color = (texture_2d(array) for array in (position, normal, color))
    return buffer


def drawn(
    view: View,
    seen: SurfaceBuffer,
    reflected: Any,
    mode: str,
    options: DiagnosticOptions = PLAIN,
    methods: tuple[str, ...] = SECANT,
    parts: Any = (),
    weights: tuple[float, ...] = (1.0,),
) -> np.ndarray:
    """(h, w, 4) picture of one view."""
    color = empty_texture(view.width, view.height)
    canvas = frame_buffer(color)
    with canvas.bind():
        canvas.clear(color=(0.0, 0.0, 0.0, 0.0))
    diagnostics = DiagnosticPass(COLORS)
    uniforms = view_block(view)
    for weight in weights:
        diagnostics.add(canvas, seen, reflected, uniforms, weight, mode, options, methods, parts)
    return read_texture(color)


def close_to(picture: np.ndarray, color: tuple[float, float, float]) -> np.ndarray:
    """(h, w) which pixels have a color, but for half precision."""
    return np.abs(picture[..., :3] - np.array(color)).max(-1) < 2e-3


def place_on_ramp(picture: np.ndarray) -> np.ndarray:
    """(h, w) from 0 to 1: where on the ramp each pixel's color is; on a mirror it may be the background's, too."""
    fine = ramp_colors(COLORS.ramp, 2001)
    weights = np.array([0.2, 0.7, 0.1])
    place = np.interp(picture[..., :3] @ weights, fine @ weights, np.linspace(0.0, 1.0, 2001))
    known = np.abs(fine[np.rint(2000.0 * place).astype(int)] - picture[..., :3]).max(-1) < 5e-3
    assert (known | close_to(picture, COLORS.background) | (picture[..., 3] == 0.0)).all()
    return place


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


def test_zebra_finer_than_pixels_is_grey() -> None:
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
    """A cube map shows, along a ray from the point P, what is along it from the centre."""
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


def solved_ball_points() -> tuple[np.ndarray, np.ndarray]:
    """Points of the ball that the eye sees, in a lattice, and a status for each."""
    place = np.stack(np.meshgrid(np.linspace(-0.6, 0.6, 7), np.linspace(-0.6, 0.6, 6)), -1).reshape(-1, 2)
    right, up = VIEW.world_to_view[0, :3], VIEW.world_to_view[1, :3]
    across = place[:, :1] * right + place[:, 1:] * up
    points = across + np.sqrt(1 - (across**2).sum(1))[:, None] * unit(EYE)
    codes = np.array([status.REFLECTED, status.HIDDEN, status.UNSOLVED, status.INVALID])
    return points, codes[np.arange(len(points)) * 7 % 4]


def solution_of(points: np.ndarray, code: np.ndarray) -> VertexSolution:
    """As the solver stores it: each vertex a metre from its point, and where it is itself if it was not found."""
    behind = points - unit(EYE - points)
    behind[code == status.UNSOLVED] = points[code == status.UNSOLVED] + [1.0, 0.0, 0.0]
    packed = code + 4 * 3
    return VertexSolution(
        record_texture(np.column_stack([points, packed])),
        record_texture(np.column_stack([behind, np.ones(len(points))])),
        len(points),
    )


def solved_chunk(points: np.ndarray, code: np.ndarray, triangles: np.ndarray) -> Any:
    corners = np.zeros((len(points), 2, 4), np.float32)
    corners[:, 0, 3] = np.arange(len(points))
    chunk: Any = SimpleNamespace(
        positions=record_texture(np.column_stack([points, np.ones(len(points))])),
        corners=record_texture(corners.reshape(-1, 4)),
    )
    batches = ((0, indexed_batch(triangles)),) if len(triangles) else ()
    return SolvedChunk(chunk, batches, solution_of(points, code))


def test_status_shows_every_vertex_that_the_statistics_count() -> None:
    ball = Ball()
    points, code = solved_ball_points()
    part = solved_chunk(points, code, np.zeros((0, 3), np.int32))
    nothing = ball.shows(ball.point, np.zeros(ball.mask.shape, bool))
    picture = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=6.0), parts=((part,),))
    pixels = np.floor(VIEW.project(points)).astype(int)
    there = picture[pixels[:, 1], pixels[:, 0]][None]
    found = {
        "reflected": int(close_to(there, COLORS.converged).sum()),
        "hidden": int(close_to(there, tuple(0.6 * np.array(COLORS.hidden))).sum()),
        "failed": int(close_to(there, COLORS.failed).sum()),
    }
    counts = statistics([part.solution])
    # A vertex that is no number has no place to be shown at.
    invalid = int((code == status.INVALID).sum())
    assert found == {
        "reflected": counts["reflected"],
        "hidden": counts["hidden"],
        "failed": counts["unconverged"] - invalid,
    }
    assert min(found.values()) > 5 and invalid > 5
    without = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=0.0), parts=((part,),))
    assert close_to(without, COLORS.background)[ball.mask].all()


def test_status_leaves_out_vertices_that_the_reflection_covers() -> None:
    ball = Ball()
    points, _ = solved_ball_points()
    part = solved_chunk(points, np.zeros(len(points), int), np.zeros((0, 3), np.int32))
    pixels = np.floor(VIEW.project(points)).astype(int)
    all_over = np.ones(ball.mask.shape, bool)
    for distance, visible in ((0.5, False), (1.5, True)):
        cover = ball.shows(ball.point + distance * ball.ray, all_over)
        picture = drawn(VIEW, ball.seen(), cover, "STATUS", DiagnosticOptions(point_size=6.0), parts=((part,),))
        there = close_to(picture, COLORS.converged)[pixels[:, 1], pixels[:, 0]]
        assert there.all() if visible else not there.any()


def test_status_hatches_triangles_that_are_left_out() -> None:
    ball = Ball()
    points, _ = solved_ball_points()
    code = np.zeros(len(points), int)
    triangles = np.array([[0, 2, 15], [3, 5, 18], [23, 25, 38]], np.int32)
    code[15] = code[3] = status.UNSOLVED
    code[18] = status.INVALID
    part = solved_chunk(points, code, triangles)
    nothing = ball.shows(ball.point, np.zeros(ball.mask.shape, bool))
    picture = drawn(VIEW, ball.seen(), nothing, "STATUS", DiagnosticOptions(point_size=0.0), parts=((part,),))
    failed = close_to(picture, COLORS.failed) | close_to(picture, tuple(0.35 * np.array(COLORS.failed)))
    x, y = np.floor(VIEW.project(points[triangles].mean(axis=1))).astype(int).T
    assert failed[y, x].tolist() == [True, False, False]
    assert 0 < failed.sum() < 0.15 * ball.mask.sum()


def room() -> Room:
    made = Room()
    made.add_mirror(Ellipsoid())
    made.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    made.add_ball((1.3, -1.6, 0.1), 0.5)
    return made


def rendered(method: str, mode: str) -> tuple[np.ndarray, np.ndarray, Renderer]:
    """A view through the pixel centres and the shade pass's picture of the mirrors beside it."""
    renderer = Renderer(room().arrays(), Settings(method=method, samples=1, environment_resolution=64))
    canvas = Canvas.of_size(VIEW.width, VIEW.height)
    reflection = renderer.reflect(VIEW)
    renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True)
    # One sub-frame has no jitter: it is the view's own.
    sub_frame = renderer._draw_surfaces(VIEW, reflection)
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


def test_ramp_goes_through_its_stops_ever_lighter() -> None:
    ramp = ramp_colors(COLORS.ramp, 257)
    np.testing.assert_allclose(ramp[::64], np.array(COLORS.ramp), atol=1e-5)
    lightness = np.cbrt(ramp @ np.array([0.2126, 0.7152, 0.0722]))
    assert (np.diff(lightness) > 0).all()


def test_axis_of_the_view() -> None:
    np.testing.assert_allclose(view_axis("Z", VIEW.world_to_view), unit(EYE), atol=1e-12)
    np.testing.assert_allclose(np.dot(view_axis("X", VIEW.world_to_view), (0, 0, 1)), 0.0, atol=1e-12)
    for axis in ((0.0, 0.0, 2.0), (1.0, 2.0, 3.0), view_axis("Y", VIEW.world_to_view)):
        axes = DiagnosticOptions(axis=axis).axes
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(axes[0], unit(np.array(axis)))


@pytest.mark.parametrize(
    "wrong",
    [
        {"iterations": (5.0, 5.0)},
        {"angles": (0.0, 1.0)},
        {"angles": (2.0, 1.0)},
        {"stripes": 0},
        {"lines": 0},
        {"line_width": 0.0},
        {"axis": (0.0, 0.0, 0.0)},
        {"axis": (np.nan, 0.0, 1.0)},
    ],
)
def test_options_out_of_range(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        DiagnosticOptions(**wrong)


def test_legends_say_what_the_colors_mean() -> None:
    angles = legend_of("ANGLE_ERROR", COLORS, PLAIN)
    assert angles is not None
    assert [label for _, label in angles.ticks] == ["0.01°", "0.1°", "1°", "10°"]
    np.testing.assert_allclose([place for place, _ in angles.ticks], [0, 1 / 3, 2 / 3, 1], atol=1e-12)
    iterations = legend_of("ITERATIONS", COLORS, DiagnosticOptions(iterations=(0.0, 8.0)))
    assert iterations is not None
    assert [label for _, label in iterations.ticks] == ["0", "2", "4", "6", "8+"]
    found = legend_of("STATUS", COLORS, PLAIN)
    assert found is not None
    assert found.swatches[2] == (COLORS.failed, "Not Found")
    used = legend_of("METHOD", COLORS, PLAIN, ("environment_cube", "environment_cube"))
    assert used is not None
    assert [label for _, label in used.swatches] == ["Environment Cube", "Background"]
    assert legend_of("ZEBRA", COLORS, PLAIN) is None and legend_of("LINES", COLORS, PLAIN) is None


def test_legend_is_drawn_in_the_corner() -> None:
    import gpu
    from mathutils import Matrix

    width, height = 400, 160
    legend = legend_of("STATUS", COLORS, PLAIN)
    assert legend is not None
    placed = layout(legend, width - 30.0, 20.0, 1.0)
    x, y, w, h = placed.panel
    assert x > 0 and x + w == pytest.approx(width - 46.0)
    assert y == pytest.approx(36.0) and y + h < height
    offscreen = gpu.types.GPUOffScreen(width, height, format="RGBA32F")
    with offscreen.bind():
        gpu.state.active_framebuffer_get().clear(color=(0.0, 0.0, 0.0, 0.0))
        with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            pixels = Matrix(((2 / width, 0, 0, -1), (0, 2 / height, 0, -1), (0, 0, -1, 0), (0, 0, 0, 1)))
            gpu.matrix.load_projection_matrix(pixels)
            draw_layout(placed)
    assert gpu.state.blend_get() == "NONE"
    picture = read_texture(offscreen.texture_color)
    outside = np.ones((height, width), bool)
    outside[int(y) : int(y + h) + 1, int(x) : int(x + w) + 1] = False
    assert (picture[outside] == 0.0).all()
    for (left, low, wide, high), color in placed.colors:
        shown = picture[int(low + high / 2), int(left + wide / 2), :3]
        linear = np.where(shown > 0.04045, ((shown + 0.055) / 1.055) ** 2.4, shown / 12.92)
        np.testing.assert_allclose(linear, color, atol=5e-3)
    text = picture[int(y) : int(y + h), int(x + 30) : int(x + w), :3]
    assert (text.min(-1) > 0.6).sum() > 50, "there are letters"
    offscreen.free()
