# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames that are drawn on for the frames after them: where the same was shown, what it calms, and no ghosts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.exposure import Turn, with_frames_before
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.reuse.earlier import with_earlier
from curvrefl.curvrefl_addon.renderer.reuse.kept_frame import KeptFrame
from curvrefl.curvrefl_addon.renderer.truth.motion import places_then
from curvrefl.curvrefl_addon.report.display import display_transform
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, MaterialArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.paths.soft_room import soft_room, soft_view

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 96, 72
BALLS = slice(2, 5)
"""Of the room's instances"""


def view_at(turn: float = 0.0) -> View:
    return soft_view(WIDTH, HEIGHT, turn=turn)


def moved(scene: SceneArrays, index: int, way: Sequence[float]) -> SceneArrays:
    """With one instance elsewhere."""
    matrix = scene.instances[index].matrix.copy()
    matrix[:3, 3] += way
    item = replace(scene.instances[index], matrix=matrix)
    return replace(scene, instances=(*scene.instances[:index], item, *scene.instances[index + 1 :]))


class Film:
    """Frames one after the other, each with two sub-frames and those of the one before."""

    def __init__(self, scene: SceneArrays, method: str = "exact", samples: int = 2, count: int = 1) -> None:
        self.renderer = Renderer(scene, Settings(method=method, samples=samples * (count + 1)))
        self.count = count
        self.kept: list[KeptFrame] = []

    def shoot(self, view: View, scene: SceneArrays | None = None) -> tuple[np.ndarray, np.ndarray, Frame]:
        """(h, w, 4) without the frames before and with them."""
        if scene is not None:
            self.renderer.update(scene)
        frame = self.renderer.render(view, turn=Turn(len(self.kept), self.count + 1))
        picture, _, kept = with_frames_before(self.renderer, frame, None, self.kept[-self.count :])
        self.kept.append(kept)
        return frame.color(), picture.pixels(), frame

    def places(self, frame: Frame) -> np.ndarray:
        """(h * w, 4) where the frame before the last has shown what the last one does."""
        found: list[np.ndarray] = []

        def read(_: object, sub_frame: object) -> dict[str, object]:
            seen = sub_frame.targets.seen  # type: ignore[attr-defined]
            found.append(read_texture(with_earlier(self.kept[-1], seen, [self.kept[-2]])[2][0]))
            return {}

        self.renderer.surfaces_of(frame.reflection, read)
        return found[0].reshape(-1, 4)


def emissive(*colors: tuple[float, float, float]) -> SceneArrays:
    """The room in the dark, its balls shining, its floor and world black: nothing has noise but edges."""
    room = soft_room(with_lamp=False)
    black = replace(room.materials[0], base_color=(0.0, 0.0, 0.0), specular_level=0.0)
    shining = [MaterialArrays(f"light {k}", (0.0,) * 3, specular_level=0.0, emission=c) for k, c in enumerate(colors)]
    return replace(room, materials=(black, room.materials[1], *shining), world=WorldArrays())


@pytest.mark.parametrize(("samples", "count"), [(8, 4), (24, 3), (64, 4)])
def test_frames_one_after_the_other_have_all_sub_frames(samples: int, count: int) -> None:
    turns = [list(Turn(number, count).sub_frames(samples)) for number in range(-3, count - 3)]
    assert sorted(index for turn in turns for index in turn) == list(range(samples))
    assert {len(turn) for turn in turns} == {samples // count}
    assert list(Turn(5 * count - 3, count).sub_frames(samples)) == turns[0]


@pytest.mark.parametrize("method", ["exact", "newton"])
@pytest.mark.parametrize("moves", ["eye", "ball", "mirror"])
def test_the_place_is_where_the_same_point_was_shown(method: str, moves: str) -> None:
    """Against float64: half of the errors are below a twentieth of a pixel, nearly all that is shown is found."""
    scene, later = soft_room(), soft_room()
    if moves == "ball":
        later = moved(scene, 2, (-0.3, 0.2, 0.3))
    if moves == "mirror":
        later = moved(scene, 0, (0.04, -0.02, 0.03))
    film = Film(scene, method)
    *_, first = film.shoot(view_at(0.0))
    assert first.truth
    *_, frame = film.shoot(view_at(2.0 if moves == "eye" else 0.0), later)
    points = frame.truth.points
    exact, known = places_then(later, points, scene, first.view, lambda: None)
    found = film.places(frame)[points.pixel]
    film.renderer.free()
    both = known & (found[:, 2] > 0.5)
    error = np.linalg.norm(found[both, :2] - exact[both], axis=1)
    assert both.sum() > 0.93 * known.sum(), both.mean()
    assert np.median(error) < 0.05 and np.quantile(error, 0.95) < 0.3, (np.median(error), np.quantile(error, 0.95))
    if moves == "ball":
        ball = both & (points.instance == 2)
        way = np.linalg.norm(exact - (np.column_stack([points.pixel % WIDTH, points.pixel // WIDTH]) + 0.5), axis=1)
        assert ball.sum() > 20 and np.median(way[ball]) > 1.0, "it has moved in the mirror"


def test_a_view_that_rests_has_all_sub_frames_and_does_not_flicker() -> None:
    """Two frames of four sub-frames are the picture of eight, from the second on the same in each frame."""
    scene = soft_room(0.3)
    film = Film(scene, samples=4)
    pictures = [film.shoot(view_at())[1] for _ in range(4)]
    whole = film.renderer.render(view_at()).color()
    film.renderer.free()
    for one, other in ((pictures[1], whole), (pictures[2], pictures[1])):
        # (A lone pixel of a thing, as at the picture's end, is found nowhere.)
        assert np.isclose(one, other, rtol=1e-3, atol=2e-3).all(axis=-1).mean() > 0.995
    assert np.abs(pictures[0] - whole).max() > 0.1


@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_noise_is_less_and_flickers_less(roughness: float) -> None:
    film, plain = (
        Film(soft_room(roughness), count=3),
        Renderer(soft_room(roughness), Settings(method="exact", samples=2)),
    )
    truth = Renderer(soft_room(roughness), Settings(method="exact", samples=48))
    errors: dict[str, list[np.ndarray]] = {"with": [], "without": []}
    for number in range(5):
        view = view_at(2.0 * number)
        _, picture, frame = film.shoot(view)
        if number >= 3:
            right = shown(truth.render(view).color())
            errors["with"].append(shown(picture) - right)
            errors["without"].append(shown(plain.render(view).color()) - right)
    found = film.places(frame)
    for renderer in (film.renderer, plain, truth):
        renderer.free()
    here = (frame.mask().ravel() > 0) & (found[:, 2] > 0.5)
    then = np.floor(found[here, :2]).astype(int)
    wrong, flicker = {}, {}
    for name, (before, now) in errors.items():
        change = now.reshape(-1, 3)[here] - before[then[:, 1], then[:, 0]]
        wrong[name], flicker[name] = np.sqrt((now.reshape(-1, 3)[here] ** 2).mean()), np.sqrt((change**2).mean())
    assert wrong["with"] < 0.75 * wrong["without"], wrong
    # (Of a sharp mirror in so small a picture most of it are edges, whose sub-frames were the same in all frames.)
    assert flicker["with"] < (0.75 if roughness else 0.9) * flicker["without"], flicker


def shown(pixels: np.ndarray) -> np.ndarray:
    return 255.0 * display_transform(pixels[..., :3])


def test_what_jumps_away_leaves_nothing() -> None:
    """A bright ball that is out of sight in the next frame: that frame is as if drawn alone, where the ball was too."""
    scene = emissive((20.0, 5.0, 1.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))
    gone = moved(scene, 2, (40.0, 60.0, -30.0))
    film = Film(scene, samples=4)
    _, before, _ = film.shoot(view_at())
    alone, with_before, _ = film.shoot(view_at(), gone)
    film.renderer.free()
    was = before[..., 0] > 1.0
    assert was.sum() > 50
    assert not alone[..., 0].any() and not with_before[..., 0].any()


def test_what_passes_before_another_takes_nothing_along() -> None:
    """A red ball goes by before a green one: where the mirror shows the green one, there is no red, and none of the
    green where it shows the red one."""
    scene = emissive((4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0))
    scene = moved(moved(scene, 3, (1.5, -1.6, 0.5)), 2, (-1.2, -1.3, 0.4))
    film, width, height = Film(scene, samples=1, count=3), 240, 180
    looked_at = {3: 0, 4: 0}
    for step in range(5):
        here = moved(scene, 2, (-0.3 * step, 0.0, 0.0))
        _, picture, frame = film.shoot(soft_view(width, height), here)
        centers = np.pad(frame.reflected_object(), 3, constant_values=-1)
        around = np.stack([centers[y : y + height, x : x + width] for y in range(7) for x in range(7)])
        for object_id, other in ((3, 1), (4, 0)):
            inside = (around == object_id).all(axis=0)
            looked_at[object_id] += int(inside.sum())
            np.testing.assert_array_equal(picture[inside][:, other], 0.0)
        assert np.isfinite(picture).all()
    assert min(looked_at.values()) > 50, looked_at
    film.renderer.free()


def test_a_lamp_that_goes_out_is_out_at_once() -> None:
    scene = soft_room()
    dark = replace(scene, lights=())
    film = Film(scene)
    film.shoot(view_at())
    alone, picture, _ = film.shoot(view_at(0.5), dark)
    film.renderer.free()
    np.testing.assert_array_equal(picture, alone)


def test_another_camera_begins_anew_where_it_sees_something_else() -> None:
    """From the other side, the mirror shows other points, or the same ones in other places: no picture is smeared."""
    scene = emissive((4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 4.0))
    film = Film(scene, samples=4)
    film.shoot(view_at(0.0))
    alone, picture, frame = film.shoot(view_at(140.0))
    film.renderer.free()
    inside = (frame.mask() > 0) & (np.abs(np.gradient(alone[..., :3].sum(axis=-1))).max(axis=0) == 0.0)
    assert inside.sum() > 100
    # (A pixel beside another thing's has a little of it, then as now.)
    assert np.isclose(picture[inside], alone[inside], atol=1e-6).all(axis=-1).mean() > 0.98


def test_mirrors_with_a_base_follow_their_surface_within_bounds() -> None:
    """A varnished thing's own color stays where it is while what it reflects moves: no picture can follow both. What is
    added is within what the pixels around show."""
    scene = soft_room()
    varnish = MaterialArrays("varnish", (0.5, 0.1, 0.1), roughness=0.0)
    scene = replace(scene, materials=(scene.materials[0], varnish, *scene.materials[2:]))
    film = Film(scene)
    film.shoot(view_at(-20.0))
    alone, picture, frame = film.shoot(view_at())
    film.renderer.free()
    inside = frame.mask() > 0
    around = np.stack([np.roll(alone, (y, x), (0, 1)) for y in range(-2, 3) for x in range(-2, 3)])
    assert inside.sum() > 300 and not np.array_equal(picture[inside], alone[inside])
    low, high = around.min(axis=0)[inside], around.max(axis=0)[inside]
    assert ((picture[inside] <= 2.0 * high - low + 1e-3) & (picture[inside] >= 2.0 * low - high - 1e-3)).all()


def test_a_shadow_that_moves_does_not_lag() -> None:
    """A ball's shadow is gone with it, on the floor and in the mirror: no pixel there is darker than without the frames
    before by more than the display's last steps, but at edges."""
    lamp = LightArrays("sun", "SUN", (3.0, 3.0, 3.0), np.eye(4), angle=0.0)
    scene = replace(soft_room(), lights=(lamp,), world=WorldArrays())
    gone = moved(scene, 2, (30.0, 60.0, -20.0))
    film = Film(scene, samples=4)
    _, before, _ = film.shoot(view_at())
    alone, picture, _ = film.shoot(view_at(), gone)
    film.renderer.free()
    was_dark = (shown(before).max(axis=-1) < 30.0) & (shown(alone).max(axis=-1) > 100.0)
    assert was_dark.sum() > 50
    darker = (shown(alone) - shown(picture)).max(axis=-1)[was_dark]
    assert np.median(darker) < 0.5 and np.mean(darker > 4.0) < 0.2, np.quantile(darker, [0.5, 0.9, 1.0])
