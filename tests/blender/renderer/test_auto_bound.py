# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""That `auto` keeps the error it was given on closed convex mirrors of any shape: beside `exact`, pixel by pixel."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer import choice as choices
from curvrefl.curvrefl_addon.renderer.choice import RAYS, VERTICES
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.convex_mirrors import convex_case, pixel_errors, rounded_box, turned, with_normals
from scenes.mirror_halls import slab
from scenes.star_meshes import star_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
BATCH = 16
"""Random mirrors in one test"""


def worst_over(first: int, most_pixels: int) -> tuple[list[str], int]:
    """Random mirrors that are over their tolerance, in words, and how many were shown by reflection points."""
    over, solved = [], 0
    for seed in range(first, first + BATCH):
        case = convex_case(seed, most_pixels)
        renderer = Renderer(case.scene, Settings(method="auto", samples=1, pixel_tolerance=case.tolerance))
        frame = renderer.render(case.view)
        assert frame.choice is not None
        if frame.choice["method"] == RAYS:
            continue
        solved += 1
        exact = Renderer(case.scene, Settings(method="exact", samples=1)).render(case.view)
        worst = float(np.percentile(pixel_errors(frame, exact), 99))
        if worst > case.tolerance:
            over.append(f"{seed}: {case.text}: {worst:.2f} px")
    return over, solved


@pytest.mark.parametrize("first", range(0, 2 * BATCH, BATCH))
def test_random_convex_mirrors_stay_under_the_error_asked_for(first: int) -> None:
    over, _ = worst_over(first, 640 * 480)
    assert over == []


@pytest.mark.parametrize("first", range(1000, 1000 + 2 * BATCH, BATCH))
def test_so_they_do_where_points_are_taken_whatever_they_cost(first: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bound alone decides: else most small pictures are of rays."""
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    over, solved = worst_over(first, 640 * 480)
    assert over == []
    assert solved > 0


def three_cubes(mesh: MeshArrays) -> SceneArrays:
    """The mirror and few vertices around it, so that points are cheap."""
    instances = [InstanceArrays("mirror", 1, 0, np.eye(4), (1,))]
    for index, place in enumerate(((1.5, -2.0, 1.6), (-2.2, -0.5, 1.8), (0.3, 2.0, 1.5))):
        matrix = np.diag([0.4, 0.4, 0.4, 1.0])
        matrix[:3, 3] = place
        instances.append(InstanceArrays(f"cube {index}", 2 + index, 1, matrix, (0,)))
    materials = (MaterialArrays("gray"), MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1.0, roughness=0.0))
    return SceneArrays(
        (mesh, slab()), tuple(instances), materials, (), (), WorldArrays((0.5, 0.5, 0.5)), reflectors=(1,)
    )


def cylinder(height: float) -> MeshArrays:
    return turned(np.array([(0.0, height), (1.0, height), (1.0, -height), (0.0, -height)]), 64)


THIN = {
    "bevelled slab": lambda: rounded_box(np.array([3.0, 3.0, 0.02]), 0.01, 3),
    "disc": lambda: cylinder(0.01),
    "flat cylinder": lambda: with_normals(cylinder(1.0), 0.0),
    "flat cone": lambda: with_normals(turned(np.array([(0.0, 1.2), (1.0, -0.8), (0.0, -0.8)]), 32), 0.0),
    "ellipsoid": lambda: star_mesh(Ellipsoid(3.0, 3.0, 0.05), 48),
}


@pytest.mark.parametrize("name", THIN)
def test_thin_and_flat_shaded_mirrors_show_what_exact_shows(name: str) -> None:
    """On each of these `auto` had solved vertices on a map that was nothing like the mirror."""
    scene = three_cubes(THIN[name]())
    view = look_at(np.array([0.5, -6.0, 4.0]), np.zeros(3), 1280, 960, 0.9)
    frame = Renderer(scene, Settings(method="auto", samples=1)).render(view)
    exact = Renderer(scene, Settings(method="exact", samples=1)).render(view)
    mirror = exact.mask() > 0
    assert (exact.reflected_object()[mirror] > 0).mean() > 0.001
    assert (frame.reflected_object() != exact.reflected_object())[mirror].mean() < 0.001
    assert np.percentile(pixel_errors(frame, exact), 99) < 0.5


def test_a_good_mirror_with_few_vertices_is_solved() -> None:
    """What the bound refuses it must not refuse everywhere."""
    scene = three_cubes(star_mesh(Ellipsoid(), 96))
    view = look_at(np.array([0.5, -6.0, 4.0]), np.zeros(3), 1280, 960, 0.4)
    frame = Renderer(scene, Settings(method="auto", samples=1)).render(view)
    assert frame.choice is not None and frame.choice["method"] == VERTICES


def test_a_convex_mirror_that_no_map_can_hold_follows_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is found out only when the map is baked, and the mirror goes on showing what it should."""
    from curvrefl.curvrefl_addon.errors import InputError
    from curvrefl.curvrefl_addon.renderer.mirrors import baked_shape

    def refuse(*_arguments: object, **_named: object) -> None:
        raise InputError("No.")

    monkeypatch.setattr(baked_shape, "bake_placed", refuse)
    scene = three_cubes(star_mesh(Ellipsoid(), 96))
    view = look_at(np.array([0.5, -6.0, 4.0]), np.zeros(3), 640, 480, 0.4)
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    frame = Renderer(scene, Settings(method="auto", samples=1)).render(view)
    assert frame.choice is not None and frame.choice["method"] == RAYS
    assert "no map" in str(frame.choice["why"])
    exact = Renderer(scene, Settings(method="exact", samples=1)).render(view)
    np.testing.assert_array_equal(frame.color(), exact.color())


def turning(degrees: float, distance: float = 7.0, width: int = 640, height: int = 480) -> View:
    angle = np.radians(degrees)
    eye = distance * np.array([np.sin(angle), -np.cos(angle), 0.45])
    return look_at(eye, np.zeros(3), width, height, 0.5)


def flips(scene: SceneArrays, views: list[View], monkeypatch: pytest.MonkeyPatch, kept: float) -> int:
    """How often a viewport changes its way along these views; only the choice is asked for."""
    monkeypatch.setattr(choices, "KEPT_SHARE", kept)
    renderer = Renderer(scene, Settings(method="auto", samples=1))
    last, methods = None, []
    for view in views:
        last = renderer.reflect(view, last=last)
        methods.append(last.methods)
    return sum(one != other for one, other in pairwise(methods))


def threshold(scene: SceneArrays, views: list[View]) -> float:
    """Cost of a vertex at which about half of these views would be solved."""
    renderer = Renderer(scene, Settings(method="auto", samples=1))
    shares = []
    for view in views:
        why = renderer.reflect(view).choice
        assert why is not None
        words = why.why.split()
        shares.append(float(words[words.index("about") + 1]))
    return float(np.median(shares))


@pytest.mark.parametrize("path", ["orbit", "dolly"])
def test_a_view_that_moves_about_the_threshold_does_not_flip(path: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = three_cubes(star_mesh(Ellipsoid(1.3, 0.9, 1.0), 64))
    if path == "orbit":
        views = [turning(6.0 * step) for step in range(60)]
    else:
        # In and out again, over the sizes at which the map changes too.
        views = [turning(20.0, 7.0 + 0.8 * np.sin(0.35 * step) - 0.02 * step) for step in range(60)]
    monkeypatch.setattr(choices, "MOST_SHARE", threshold(scene, views))
    without = flips(scene, views, monkeypatch, kept=1.0)
    assert without > 2
    assert flips(scene, views, monkeypatch, kept=1.5) <= 1


def test_an_animation_flips_no_more_often_than_the_scene_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = three_cubes(star_mesh(Ellipsoid(), 64))
    view = turning(20.0)
    monkeypatch.setattr(choices, "MOST_SHARE", threshold(scene, [view]))
    renderer = Renderer(scene, Settings(method="auto", samples=1))
    last, methods = None, []
    for step in range(24):
        instances = list(scene.instances)
        matrix = instances[1].matrix.copy()
        matrix[2, 3] += 0.4 * np.sin(step)
        instances[1] = replace(instances[1], matrix=matrix)
        renderer.update(replace(scene, instances=tuple(instances)))
        last = renderer.reflect(view, last=last)
        methods.append(last.methods)
    assert sum(one != other for one, other in pairwise(methods)) <= 1


def test_maps_are_not_baked_again_while_a_view_dollies() -> None:
    """Around the sizes at which another map would do: each is baked once and kept."""
    scene = three_cubes(star_mesh(Ellipsoid(), 96))
    renderer = Renderer(scene, Settings(method="auto", samples=1))
    last = None
    for step in range(24):
        last = renderer.reflect(turning(10.0, 7.0 + 2.0 * np.sin(0.9 * step), 1280, 960), last=last)
    assert renderer.counters["maps baked"] <= 2


def test_one_viewport_does_not_change_what_another_chose() -> None:
    """A renderer keeps nothing of a view: what was chosen, and points to start from, go with its reflection."""
    scene = three_cubes(star_mesh(Ellipsoid(), 96))
    renderer = Renderer(scene, Settings(method="auto", samples=1))
    large = renderer.reflect(turning(10.0, 4.0, 1280, 960))
    assert large.methods == (VERTICES,)
    small = renderer.reflect(turning(40.0, 12.0, 160, 120))
    assert small.methods == (RAYS,)
    assert large.methods == (VERTICES,)
    again = renderer.reflect(turning(10.0, 4.0, 1280, 960), last=large)
    assert [one is other for one, other in zip(again.solutions, large.solutions, strict=True)] == [True] * len(
        large.solutions
    )


def test_surfaces_of_a_scene_that_is_gone_are_refused() -> None:
    scene = three_cubes(star_mesh(Ellipsoid(), 24))
    renderer = Renderer(scene, Settings(method="exact", samples=1))
    frame = renderer.render(turning(0.0, width=64, height=48))
    renderer.update(replace(scene, instances=scene.instances[:2]))
    with pytest.raises(RuntimeError, match="another state"):
        frame.mask()
