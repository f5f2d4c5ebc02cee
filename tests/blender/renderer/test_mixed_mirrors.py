# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several mirrors in one view, each shown in its own way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer import choice as choices
from curvrefl.curvrefl_addon.renderer.choice import NOTHING, RAYS, VERTICES
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.reflection import Diagnostic
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    SceneArrays,
    WorldArrays,
)
from scenes.convex_mirrors import pixel_errors
from scenes.mirror_halls import bowl, slab
from scenes.star_meshes import star_mesh, torus
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -8.0, 2.0]), np.zeros(3), 640, 360, 0.9)


def scene_of_mirrors(apart: bool = True) -> SceneArrays:
    """A sphere, a torus and a bowl in a row among cubes; `apart`: no mirror is seen in another."""
    meshes = (star_mesh(Ellipsoid(), 96), torus(0.9, 0.35), bowl(), slab())
    instances = []
    for index, x in enumerate((-2.6, 0.0, 2.6)):
        matrix = np.eye(4)
        matrix[0, 3] = x
        instances.append(InstanceArrays(f"mirror {index}", index + 1, index, matrix, (1,), visible_glossy=not apart))
    for index, place in enumerate(((-1.4, -2.5, 1.4), (1.3, -2.6, 1.5), (-3.0, -2.0, -1.2), (3.0, -2.4, -0.9))):
        matrix = np.diag([0.4, 0.4, 0.4, 1.0])
        matrix[:3, 3] = place
        instances.append(InstanceArrays(f"cube {index}", 4 + index, 3, matrix, (0,)))
    materials = (MaterialArrays("gray"), MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1.0, roughness=0.0))
    lamp = np.eye(4)
    lamp[:3, 3] = (2.0, -4.0, 5.0)
    light = LightArrays("lamp", "POINT", (500.0, 500.0, 500.0), lamp, radius=0.3)
    return SceneArrays(
        meshes, tuple(instances), materials, (), (light,), WorldArrays((0.3, 0.35, 0.5)), reflectors=(1, 2, 3)
    )


def test_each_mirror_is_shown_by_what_is_right_and_cheapest_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    scene = scene_of_mirrors()
    frame = Renderer(scene, Settings(method="auto", samples=1)).render(VIEW)
    assert frame.reflection.methods == (VERTICES, RAYS, RAYS)
    exact = Renderer(scene, Settings(method="exact", samples=1)).render(VIEW)
    # What is no mirror, and mirrors that follow rays, are the same but for rounding: scenery is split for the sphere.
    mask = exact.mask()
    np.testing.assert_array_equal(frame.mask(), mask)
    difference = np.abs(frame.color() - exact.color())
    assert difference[mask != 1].max() < 0.01
    assert difference[mask != 1].mean() < 1e-6
    assert np.percentile(pixel_errors(frame, exact), 99) < 0.5
    sphere = mask == 1
    assert (frame.reflected_object() != exact.reflected_object())[sphere].mean() < 0.005
    assert difference[sphere].mean() < 2e-3
    report = frame.choice
    assert report is not None and [one["method"] for one in report["mirrors"]] == [VERTICES, RAYS, RAYS]  # type: ignore[attr-defined]


def test_mirrors_alone_as_the_viewport_draws_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Alpha is each mirror's coverage once, whatever the number of ways."""
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    scene = scene_of_mirrors()
    pictures = []
    for method in ("auto", "exact"):
        renderer = Renderer(scene, Settings(method=method, samples=1))
        canvas = Canvas.of_size(VIEW.width, VIEW.height)
        reflection = renderer.reflect(VIEW, is_still=True, at_rest=True)
        renderer.add_sub_frame(canvas, reflection, 0, 1.0, mirrors_only=True)
        pictures.append(read_texture(canvas.texture))
    mixed, exact = pictures
    np.testing.assert_array_equal(mixed[..., 3], exact[..., 3])
    assert np.abs(mixed - exact).mean() < 1e-3


def test_a_mirror_that_shows_no_object_shows_the_background(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    scene = scene_of_mirrors()
    # Nothing but the three mirrors, and what lies behind the sphere.
    behind = np.diag([0.1, 0.1, 0.1, 1.0])
    behind[:3, 3] = 1.5 * (np.array([-2.6, 0.0, 0.0]) - (0.0, -8.0, 2.0)) + (0.0, -8.0, 2.0)
    instances = (*scene.instances[:3], replace(scene.instances[3], matrix=behind))
    scene = replace(scene, instances=instances)
    frame = Renderer(scene, Settings(method="auto", samples=1)).render(VIEW)
    choice = frame.reflection.choice
    assert choice is not None and choice.mirrors[0].method == NOTHING
    exact = Renderer(scene, Settings(method="exact", samples=1)).render(VIEW)
    np.testing.assert_array_equal(frame.color(), exact.color())
    np.testing.assert_array_equal(frame.reflected_object(), exact.reflected_object())


def test_mirrors_that_see_each_other_follow_rays() -> None:
    frame = Renderer(scene_of_mirrors(apart=False), Settings(method="auto", samples=1)).render(VIEW)
    assert set(frame.reflection.methods) == {RAYS}


def test_the_view_of_methods_colors_each_mirror_by_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choices, "MOST_SHARE", 1e9)
    renderer = Renderer(scene_of_mirrors(), Settings(method="auto", samples=1))
    reflection = renderer.reflect(VIEW)
    canvas = Canvas.of_size(VIEW.width, VIEW.height)
    renderer.add_sub_frame(canvas, reflection, 0, 1.0, diagnostic=Diagnostic("METHOD"))
    picture = read_texture(canvas.texture)
    mask = renderer.render(VIEW).mask()
    shown = renderer.render(VIEW).reflected_object() > 0
    hues = []
    for number in (1, 2, 3):
        mine = picture[(mask == number) & shown]
        assert len(mine) > 50
        assert (mine[:, 3] == 1.0).all()
        hues.append(np.median(mine[:, :3] / mine[:, :3].max(axis=1, keepdims=True), axis=0))
    assert np.abs(hues[1] - hues[2]).max() < 0.02
    assert np.abs(hues[0] - hues[1]).max() > 0.1
