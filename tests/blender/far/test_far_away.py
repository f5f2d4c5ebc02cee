# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene looks the same wherever it is and however large, as far as Blender's single precision can say where it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from mathutils import Matrix
from scenes import placed_room

pytestmark = pytest.mark.usefixtures("gpu")
METHODS = ("exact", "newton", "environment_cube")
PLACES = {
    "1e3 m": (1000.0, -2000.0, 500.0),
    "1e5 m": (1e5, -1e5, 5e4),
    "1e7 m": (1e7, -8e6, 5e6),
}
SCALES = {"1e-5": 2.0**-17, "1e-3": 2.0**-10, "1e3": 2.0**10, "1e5": 2.0**17}
VISIBLE = 0.02
"""Of a color"""
FEW = 0.002
"""Share of pixels: those on edges may go to either side"""


def rendered(scene: SceneArrays, view: View, method: str) -> tuple[np.ndarray, Frame]:
    renderer = Renderer(scene, Settings(method=method, samples=2))
    frame = renderer.render(view)
    return frame.color()[..., :3], frame


def share_off(one: np.ndarray, other: np.ndarray) -> float:
    """Of pixels whose colors differ visibly."""
    assert np.isfinite(one).all() and np.isfinite(other).all()
    return float((np.abs(one - other).max(axis=-1) > VISIBLE).mean())


@pytest.fixture(scope="module")
def at_home(gpu: None) -> Iterator[dict[str, tuple[np.ndarray, Frame]]]:
    scene, view = placed_room.read(placed_room.build())
    yield {method: rendered(scene, view, method) for method in METHODS}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", PLACES)
def test_a_scene_far_out_looks_as_at_home(method: str, name: str, at_home: dict[str, tuple[np.ndarray, Frame]]) -> None:
    place = np.array(PLACES[name])
    scene, view = placed_room.read(placed_room.build(PLACES[name]))
    picture, frame = rendered(scene, view, method)
    expected, home = at_home[method]
    assert share_off(picture, expected) <= FEW
    # The pass of positions is the world's, as exact as its numbers can be.
    both = (frame.mask() > 0) & (home.mask() > 0)
    assert both.mean() > 0.05
    step = float(np.spacing(np.float32(np.abs(place).max())))
    for mine, other in (
        (frame.reflector_position(), home.reflector_position()),
        (frame.reflected_position()[..., :3], home.reflected_position()[..., :3]),
    ):
        shows = both & (frame.reflected_position()[..., 3] > 0.0) & (home.reflected_position()[..., 3] > 0.0)
        off = np.abs(mine - place - other)[shows].max(axis=-1)
        assert np.percentile(off, 99) <= 0.01 + step
    assert np.abs(frame.view.place - view.place).max() <= 1e-6


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SCALES)
def test_a_scene_looks_the_same_at_any_scale(
    method: str, name: str, at_home: dict[str, tuple[np.ndarray, Frame]]
) -> None:
    scene, view = placed_room.read(placed_room.build(scale=SCALES[name]))
    assert share_off(rendered(scene, view, method)[0], at_home[method][0]) <= FEW


@pytest.mark.parametrize("method", METHODS)
def test_vertices_far_from_their_object_are_as_near_as_any(
    method: str, at_home: dict[str, tuple[np.ndarray, Frame]]
) -> None:
    """Every mesh lies 4096 m from its object's origin, and the object as far on the other side."""
    ball = placed_room.build()
    for thing in bpy.context.scene.objects:
        if thing.type == "MESH":
            # (To places that single precision has, or the meshes would not be the same.)
            away = Matrix.Translation((4096.0, -4096.0, 2048.0))
            thing.data.transform(away)
            thing.location = (np.array(thing.location) - (4096.0, -4096.0, 2048.0)).tolist()
    scene, view = placed_room.read(ball)
    # Vertices of the ball are rounded by 0.2 mm, which shows at its edges.
    assert share_off(rendered(scene, view, method)[0], at_home[method][0]) <= 5.0 * FEW


def test_near_the_origin_nothing_is_moved() -> None:
    scene, view = placed_room.read(placed_room.build())
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    assert renderer.scene is scene
    assert renderer.reflect(view).view is view and renderer.scene is scene


def test_two_views_take_turns() -> None:
    """One far out, one at home, of one scene: sub-frames of each are what they are alone, whoever was drawn before."""
    ball = placed_room.build()
    far = (2.0e5, 1.0e5, 0.0)
    scene, view = placed_room.read(ball)
    copies = [
        replace(item, object_id=item.object_id + 100, matrix=item.matrix + _shift(far)) for item in scene.instances
    ]
    scene = replace(
        scene,
        instances=(*scene.instances, *copies),
        lights=(*scene.lights, *(replace(lamp, matrix=lamp.matrix + _shift(far)) for lamp in scene.lights[:2])),
        reflectors=(*scene.reflectors, scene.reflectors[0] + 100),
    )
    away = view.about(-np.array(far))
    settings = Settings(method="newton", samples=2)
    alone = []
    for one in (view, away):
        alone.append(Renderer(scene, settings).render(one).color())
    renderer = Renderer(scene, settings)
    reflections = [renderer.reflect(one, is_still=True, at_rest=True) for one in (view, away)]
    canvases = [Canvas.of_size(view.width, view.height) for _ in reflections]
    for index in range(settings.samples):
        for canvas, reflection in zip(canvases, reflections, strict=True):
            renderer.add_sub_frame(canvas, reflection, index, 0.5)
    for canvas, expected in zip(canvases, alone, strict=True):
        # (Edges are split for both mirrors once both have been drawn.)
        assert share_off(read_texture(canvas.texture), expected) <= 5.0 * FEW
    # An orbit far out moves nothing again.
    renderer.reflect(away)
    before = renderer.geometry.counters["chunks built"]
    for turn in range(5):
        renderer.reflect(replace(away, world_to_view=_turned(away.world_to_view, 0.1 * turn)))
    assert renderer.geometry.counters["chunks built"] == before


def _shift(place: tuple[float, float, float]) -> np.ndarray:
    matrix = np.zeros((4, 4))
    matrix[:3, 3] = place
    return matrix


def _turned(world_to_view: np.ndarray, angle: float) -> np.ndarray:
    """The eye goes round the far ball."""
    center = np.array([2.0e5, 1.0e5, 2.0])
    turn, to, back = np.eye(4), np.eye(4), np.eye(4)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    to[:3, 3], back[:3, 3] = -center, center
    return world_to_view @ back @ turn @ to
