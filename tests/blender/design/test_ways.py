# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of sight by mirrors on the GPU, against closed forms and against the exact method's own pictures."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.design.anamorphosis.picture_frame import FrameChoice, frame_on_mirror
from curvrefl.curvrefl_addon.design.ways import Ways, WaysByMirrors, lines_through
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.anamorphosis import off_cone, off_cylinder, to_floor
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import (
    Float64Array,
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.camera.looking import look_at
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.meshes.made import quad_mesh, smooth_mesh

pytestmark = pytest.mark.usefixtures("gpu")

COLUMNS, ROWS = 700, 120
RADIUS, HEIGHT = 0.5, 0.8
EYE = np.array([0.0, -2.4, 2.6])
MIRROR, FLOOR = 1, 2


def mantle(top: float) -> MeshArrays:
    """The front third of one whose radius is 0.5 at z = 0 and `top` at 0.8, up to 0.64, with the true normals. (Long
    thin triangles would cost digits.)"""
    turn = np.linspace(-5.0 * np.pi / 6.0, -np.pi / 6.0, COLUMNS + 1)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    rings = [
        np.column_stack([circle * (RADIUS + (top - RADIUS) * z / HEIGHT), np.full(len(turn), z)])
        for z in np.linspace(0.0, 0.8 * HEIGHT, ROWS + 1)
    ]
    slope = (RADIUS - top) / HEIGHT
    normals = np.column_stack([circle, np.full(len(turn), slope)]) / np.hypot(1.0, slope)
    low = (np.arange(ROWS)[:, None] * (COLUMNS + 1) + np.arange(COLUMNS)).ravel()
    quads = np.column_stack([low, low + 1, low + COLUMNS + 2, low + COLUMNS + 1])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    return smooth_mesh("mantle", np.concatenate(rings), np.tile(normals, (ROWS + 1, 1)), triangles)


def scene_of(mirror: MeshArrays, move: Float64Array | None = None) -> SceneArrays:
    """A mirror on a floor."""
    corners = np.array([[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]])
    matrix = np.eye(4) if move is None else move
    instances = (
        InstanceArrays("mirror", MIRROR, 0, matrix, (0,)),
        InstanceArrays("floor", FLOOR, 1, matrix, (0,)),
    )
    return SceneArrays(
        (mirror, quad_mesh("floor", corners, (0.0, 0.0, 1.0))),
        instances,
        (MaterialArrays("chrome", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0),),
        (),
        (),
        WorldArrays(),
        reflectors=(MIRROR,),
    )


def view_of(eye: Float64Array = EYE) -> View:
    return look_at(eye, np.array([0.0, 0.0, 0.5 * HEIGHT]), 64, 48, 0.6)


def followed(scene: SceneArrays, view: View, count: int = 150) -> tuple[Ways, Float64Array]:
    """Ways through the middle of a view, and their directions."""
    x, y = np.meshgrid(np.linspace(0.3, 0.7, count), np.linspace(0.3, 0.7, count))
    origins, directions = lines_through(view, np.column_stack([x.ravel(), y.ravel()]))
    return WaysByMirrors(scene, np.zeros(3)).follow(origins, directions), directions


@pytest.mark.parametrize("top", [RADIUS, 0.0])
def test_cylinder_and_cone_are_as_their_closed_forms(top: float) -> None:
    """Up to 1e-5 of the mirror's size, with the mesh's own error. Near the outline the floor shows any error of a ray
    many times as large, so places count whose way over the floor is no longer than the mirror is large."""
    eye = EYE if top else np.array([0.0, -0.8, 3.4])
    ways, directions = followed(scene_of(mantle(top)), view_of(eye))
    turned = off_cylinder(eye, directions, RADIUS, HEIGHT) if top else off_cone(eye, directions, RADIUS, HEIGHT)
    expected = to_floor(turned)
    met = ways.mirror == MIRROR
    inside = np.isfinite(turned[0][:, 0])
    turn = np.arctan2(turned[0][:, 1], turned[0][:, 0])
    on_patch = inside & (turned[0][:, 2] < 0.8 * HEIGHT) & (np.abs(turn + 0.5 * np.pi) < np.pi / 3.0)
    # (The mesh is inside of the surface by a millionth.)
    assert (met != on_patch).mean() < 0.002
    both = met & on_patch & (ways.object == FLOOR) & (np.linalg.norm(expected - turned[0], axis=1) < 2.0 * RADIUS)
    assert both.sum() > 1500
    assert np.linalg.norm(ways.point - turned[0], axis=1)[both].max() < 1e-5
    # (On the floor the last digits of a steep ray count for more.)
    error = np.linalg.norm(ways.end - expected, axis=1)[both]
    assert np.percentile(error, 99.5) < 1e-5 and error.max() < 2e-5
    assert (ways.bounces[both] == 1).all() and (ways.instance[both] == 1).all()
    corners = np.array([[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]])
    places = np.einsum("nk,nkj->nj", ways.weights[both], corners[ways.corners[both]])
    np.testing.assert_allclose(places, ways.end[both], atol=1e-5)


def test_far_from_the_origin_they_are_as_near_it() -> None:
    mirror = mantle(RADIUS)
    near, directions = followed(scene_of(mirror), view_of(), 40)
    move = np.eye(4)
    move[:3, 3] = (4e5, -3e5, 1e5)
    x, y = np.meshgrid(np.linspace(0.3, 0.7, 40), np.linspace(0.3, 0.7, 40))
    origins, _ = lines_through(view_of(), np.column_stack([x.ravel(), y.ravel()]))
    far = WaysByMirrors(scene_of(mirror, move), move[:3, 3]).follow(origins + move[:3, 3], directions)
    same = (near.mirror == far.mirror) & (near.object == far.object)
    assert same.mean() > 0.995
    both = same & (near.object == FLOOR) & (near.mirror == MIRROR)
    off = np.linalg.norm(far.end - move[:3, 3] - near.end, axis=1)[both]
    assert np.median(off) < 1e-6


def test_they_end_where_the_exact_method_does() -> None:
    mirror = mantle(0.2)
    scene, view = scene_of(mirror), view_of()
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    frame = renderer.render(view)
    x, y = np.meshgrid((np.arange(view.width) + 0.5) / view.width, (np.arange(view.height) + 0.5) / view.height)
    ways = WaysByMirrors(scene, np.zeros(3)).follow(*lines_through(view, np.column_stack([x.ravel(), y.ravel()])))
    mask = (frame.mask() == MIRROR).ravel()
    shown, position = frame.reflected_object().ravel(), frame.reflected_position().reshape(-1, 4)
    renderer.free()
    assert 300 < mask.sum() < mask.size
    assert (mask != (ways.mirror == MIRROR)).sum() <= 2
    # (The picture's own surfaces are those on the first reflected ray.)
    both = mask & (ways.mirror == MIRROR) & (ways.bounces == 1)
    assert (shown[both] != ways.object[both]).sum() <= 2
    both &= (shown == FLOOR) & (ways.object == FLOOR)
    off = np.linalg.norm(position[both, :3] - ways.end[both], axis=1)
    assert np.percentile(off, 99) < 1e-3 and np.median(off) < 1e-5


@pytest.mark.parametrize(
    ("choice", "aspect", "expected"),
    [
        (FrameChoice("STRETCH", 1.0), 1.0, (1.0, 1.0)),
        (FrameChoice("INSIDE", 1.0), 4.0, (1.0, None)),
        (FrameChoice("INSIDE", 0.5), 0.1, (None, 0.5)),
        (FrameChoice("COVER", 1.0), 4.0, (None, 1.0)),
    ],
)
def test_frames_fit_the_box_about_the_mirror(
    choice: FrameChoice, aspect: float, expected: tuple[float | None, float | None]
) -> None:
    """The mirror's outline, projected point by point, is the box."""
    mirror = mantle(RADIUS)
    view = view_of()
    outline = view.project(mirror.positions.astype(np.float64)) / [view.width, view.height]
    low, high = outline.min(axis=0), outline.max(axis=0)
    ways = WaysByMirrors(scene_of(mirror), np.zeros(3))
    found = frame_on_mirror(ways, view, {MIRROR}, choice, aspect, "the mirror")
    size = np.array([found.width, found.height]) / (high - low)
    for share, wanted in zip(size.tolist(), expected, strict=True):
        assert wanted is None or share == pytest.approx(wanted, abs=0.01)
    if choice.fit != "STRETCH":
        assert found.width * view.width / (found.height * view.height) == pytest.approx(aspect)
    middle = np.array([found.left + 0.5 * found.width, found.bottom + 0.5 * found.height])
    np.testing.assert_allclose(middle, 0.5 * (low + high), atol=0.005)


def test_a_mirror_that_is_not_seen_is_said() -> None:
    mirror = mantle(RADIUS)
    away = look_at(EYE, np.subtract(EYE, [0.0, 1.0, 0.0]), 64, 48, 0.5)
    ways = WaysByMirrors(scene_of(mirror), np.zeros(3))
    with pytest.raises(InputError, match='"A" is not seen'):
        frame_on_mirror(ways, away, {MIRROR}, FrameChoice(), 1.0, '"A"')
    with pytest.raises(InputError, match="empty"):
        frame_on_mirror(ways, away, {MIRROR}, FrameChoice("CHOSEN", rectangle=(0.0, 0.0, 0.0, 1.0)), 1.0, '"A"')
