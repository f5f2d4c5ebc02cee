# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of what mirrors show, and how often they show it, against closed forms and against rays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.truth.shown_points import ShownPoints
from curvrefl.curvrefl_addon.renderer.truth.truth import MirrorTruth
from curvrefl.curvrefl_addon.report.geometry_reference import GeometryReference
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.shutter import Moment
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.study.sequence.motion import motion_before, offsets
from scenes.mirror_room import MIRROR, Room
from scenes.views import lines_of_sight, look_at
from truth_scenes import drawn, with_mirrors

pytestmark = pytest.mark.usefixtures("gpu")
EYE = np.array([0.4, -1.0, 0.3])
VIEW = look_at(EYE, np.array([0.0, 2.0, 0.1]), 48, 36, 0.5)


def moved(scene: SceneArrays, number: int, matrix: np.ndarray) -> SceneArrays:
    """With a transform before that of instance `number`."""
    instances = list(scene.instances)
    instances[number] = replace(instances[number], matrix=matrix @ instances[number].matrix)
    return replace(scene, instances=tuple(instances))


def shifted(*way: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = way
    return matrix


def flat_scene() -> SceneArrays:
    """A mirror in the plane y = 2 that is larger than the view, a wall at y = -3 behind the eye."""
    room = Room()
    room.add_rectangle((0.0, 2.0, 0.0), (5.0, 0.0, 0.0), (0.0, 0.0, 5.0))
    room.add_rectangle((0.0, -3.0, 0.0), (-9.0, 0.0, 0.0), (0.0, 0.0, 9.0))
    return with_mirrors(room, 1)


def mirrored_wall(view: View) -> np.ndarray:
    """(h, w, 3) image behind the mirror of the wall's point that each pixel shows."""
    _, sight = lines_of_sight(view)
    return EYE + (8.0 / sight[..., 1])[..., None] * sight


def test_vectors_in_a_flat_mirror_are_those_of_the_mirrored_world() -> None:
    """The wall goes sideways and up; another time the mirror comes nearer; another time the camera moves and turns."""
    scene = flat_scene()
    now = mirrored_wall(VIEW)
    shift = np.array([0.05, 0.1, -0.02])
    turned = look_at(EYE + shift, np.array([0.1, 2.0, 0.1]), 48, 36, 0.5)
    cases: list[tuple[Moment, np.ndarray, View]] = [
        (Moment(moved(scene, 1, shifted(0.3, 0.1, -0.2)), VIEW), now + np.array([0.3, -0.1, -0.2]), VIEW),
        (Moment(moved(scene, 0, shifted(0.0, -0.25, 0.0)), VIEW), now + np.array([0.0, -0.5, 0.0]), VIEW),
        (Moment(scene, turned), now, turned),
        (Moment(moved(scene, 1, shifted(0.1, 0.0, 0.0)), turned), now + np.array([0.1, 0.0, 0.0]), turned),
    ]
    truth = drawn(scene, VIEW).truth
    here = np.stack(np.meshgrid(np.arange(48) + 0.5, np.arange(36) + 0.5), axis=-1)
    for before, image_before, view_before in cases:
        for after, image_after, view_after in cases[:2]:
            truth.beside, truth.remarks = (before, after), []
            vector = truth.vector()
            assert not truth.remarks
            then = view_before.project(image_before.reshape(-1, 3)).reshape(36, 48, 2)
            later = view_after.project(image_after.reshape(-1, 3)).reshape(36, 48, 2)
            # (as Blender's: X, Y from here to before, Z, W from after to here)
            np.testing.assert_allclose(vector[..., :2], then - here, atol=2e-3)
            np.testing.assert_allclose(vector[..., 2:], here - later, atol=2e-3)
            assert np.abs(vector).max() > 0.5


def test_what_stands_still_does_not_move_and_what_cannot_be_known_is_said() -> None:
    scene = flat_scene()
    truth = drawn(scene, VIEW).truth
    truth.beside = (Moment(scene, VIEW), None)
    assert np.abs(truth.vector()).max() < 1e-3
    assert truth.remarks == ["The frame after cannot be read: Vector is 0 towards it."]
    other = scene.meshes[1]
    cut = replace(other, triangles=other.triangles[:1], triangle_slot=other.triangle_slot[:1])
    truth.beside, truth.remarks = (Moment(replace(scene, meshes=(scene.meshes[0], cut)), VIEW), Moment(scene, VIEW)), []
    assert not truth.vector()[..., :2].any()
    assert truth.remarks == [
        f"In {48 * 36} pixels the mirror does not show the same in the frame before: Vector is 0 there."
    ]


def as_cycles(points: ShownPoints, scene: SceneArrays) -> GeometryReference:
    """What rays have found, as Cycles' own passes would have it."""
    size = (points.view.height, points.view.width)
    numbers = np.array([0, *(item.object_id for item in scene.instances)], np.int32)

    def picture(values: np.ndarray) -> np.ndarray:
        whole = np.zeros((size[0] * size[1], *values.shape[1:]), values.dtype)
        whole[points.pixel] = values
        return whole.reshape(*size, *values.shape[1:])

    return GeometryReference(
        mask=picture(numbers[points.mirror + 1]),
        reflector_position=picture(points.seen.astype(np.float32)),
        reflected_position=picture(points.shown.astype(np.float32)),
        reflected_object=picture(numbers[points.instance + 1]),
        valid=picture(np.ones(len(points.pixel), bool)),
    )


def test_motion_to_the_frame_before_is_that_of_the_mirrored_world() -> None:
    """As Vector: the wall moves, the mirror moves, the camera moves; what Cycles does not see so is left out."""
    scene = flat_scene()
    frame = drawn(scene, VIEW)
    points, now = frame.truth.points, mirrored_wall(VIEW)
    truth = as_cycles(points, scene)
    here = VIEW.pixel_centers.reshape(36, 48, 2)
    turned = look_at(EYE + np.array([0.05, 0.1, -0.02]), np.array([0.1, 2.0, 0.1]), 48, 36, 0.5)
    cases = [
        (moved(scene, 1, shifted(0.3, 0.1, -0.2)), VIEW, now + np.array([0.3, -0.1, -0.2])),
        (moved(scene, 0, shifted(0.0, -0.25, 0.0)), VIEW, now + np.array([0.0, -0.5, 0.0])),
        (scene, turned, now),
        (scene, VIEW, now),
    ]
    for then, view, image in cases:
        motion = motion_before(scene, points, truth, then, view)
        expected = view.project(image.reshape(-1, 3)).reshape(36, 48, 2)
        np.testing.assert_allclose(motion.place, expected - here, atol=2e-3)
        depth = then.instances[0].matrix[1, 3] - scene.instances[0].matrix[1, 3] + 2.0 - view.place[1]
        in_mirror = view.place + (image - view.place) * depth / (image[..., 1:2] - view.place[1])
        np.testing.assert_allclose(motion.distance, np.linalg.norm(image - in_mirror, axis=-1), rtol=1e-4)
    assert not motion.place.any()
    other = truth.reflected_object.copy()
    other[10, 20] = 99
    lost = replace(truth, reflected_object=other)
    known = np.isfinite(motion_before(scene, points, lost, scene, turned).place).all(axis=-1)
    assert not known[10, 20] and known.sum() == 48 * 36 - 1
    position = frame.reflected_position().copy()
    assert np.abs(offsets(scene, points, frame.mask(), position)).max() < 1e-3
    # A method that shows the wall as if it were 0.3 to the left shows it 0.3 too far to the right.
    position[..., 0] -= 0.3
    off = offsets(scene, points, frame.mask(), position)
    expected = VIEW.project((now - (0.3, 0.0, 0.0)).reshape(-1, 3)).reshape(36, 48, 2)
    np.testing.assert_allclose(off, expected - here, atol=2e-3)


def ball_scene() -> SceneArrays:
    """Over a floor."""
    room = Room()
    room.add_mirror(Ellipsoid(), 256)
    room.add_rectangle((0.0, 0.0, -1.2), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    return room.arrays()


def test_vectors_in_a_ball_lead_to_where_rays_see_the_same_point() -> None:
    """Closed form: from the place where a pixel's point is seen a frame before, the ray off the unit ball meets it."""
    scene = ball_scene()
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 64, 48, 0.4)
    way = np.array([0.12, -0.2, 0.05])
    truth = drawn(scene, view).truth
    truth.beside = (Moment(moved(scene, 1, shifted(*way)), view), Moment(scene, view))
    vector = truth.vector().reshape(-1, 4)
    points = truth.points
    floor = points.is_surface & (np.einsum("ij,ij->i", points.facing, unit(view.place - points.seen)) > 0.35)
    assert floor.sum() > 300
    pixel = points.pixel[floor]
    place = np.column_stack([pixel % 64, pixel // 64]) + 0.5 + vector[pixel, :2]
    assert np.abs(vector[pixel, 2:]).max() < 0.01
    clip = np.column_stack([2.0 * place / [64, 48] - 1.0, np.zeros(len(place)), np.ones(len(place))])
    far = clip @ np.linalg.inv(view.world_to_clip).T
    sight = unit(far[:, :3] / far[:, 3:] - view.place)
    b = sight @ view.place
    seen = view.place + (-b - np.sqrt(b * b - view.place @ view.place + 1.0))[:, None] * sight
    ray = sight - 2.0 * np.einsum("ij,ij->i", sight, seen)[:, None] * seen
    met = seen + ((way[2] - 1.2 - seen[:, 2]) / ray[:, 2])[:, None] * ray
    off = np.linalg.norm(met - (points.shown[floor, :3] + way), axis=1)
    # (The mesh stands for the ball: a facet's points are 8e-5 inside.)
    moves = np.linalg.norm(vector[pixel, :2], axis=1)
    assert np.median(moves) > 0.5
    assert np.median(off) < 4e-3 and np.percentile(off, 90) < 0.03


def test_counts_of_images() -> None:
    """A flat mirror shows a point once; a corner of two of them, seen from within, twice; a ball once; what is hidden
    from one of two mirrors is shown by the other alone."""
    scene = flat_scene()
    truth = drawn(scene, VIEW).truth
    np.testing.assert_array_equal(truth.images(), 1.0)

    def two(room: Room) -> None:
        room.add_rectangle((2.0, 2.0, 0.0), (2.0, 0.0, 0.0), (0.0, 0.0, 4.0))
        room.add_rectangle((0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 4.0))

    room = Room()
    two(room)
    room.add_rectangle((2.0, -0.5, 0.0), (0.3, 0.0, 0.0), (0.0, 0.0, 0.9))
    blocker = room.add_rectangle((1.0, -0.3, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 4.0))
    view = look_at(np.array([2.5, 0.5, 0.0]), np.array([0.6, 1.6, 0.0]), 120, 60, 2.2)
    clear = with_mirrors(room, 1, 2)
    clear = replace(clear, instances=clear.instances[:-1])
    shows_sheet = drawn(clear, view)
    sheet = shows_sheet.reflected_object() == 30
    assert sheet.sum() > 30
    mirrors = shows_sheet.mask()
    assert {10, 20} == set(np.unique(mirrors[sheet]).tolist())
    np.testing.assert_array_equal(shows_sheet.truth.images()[sheet], 2.0)
    hidden = drawn(with_mirrors(room, 1, 2), view)
    still = hidden.reflected_object() == 30
    assert blocker == 4 and 10 < still.sum() < sheet.sum()
    assert set(np.unique(hidden.truth.images()[still]).tolist()) == {1.0}
    scene = ball_scene()
    frame = drawn(scene, look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 40, 30, 0.4))
    counts = frame.truth.images()[frame.reflected_object() > 0]
    assert (counts == 1.0).mean() > 0.99 and frame.mask().max() == MIRROR


def test_a_search_can_be_stopped() -> None:
    def stop() -> None:
        raise KeyboardInterrupt

    truth: MirrorTruth = drawn(flat_scene(), VIEW).truth
    truth.pause = stop
    with pytest.raises(KeyboardInterrupt):
        truth.images()
