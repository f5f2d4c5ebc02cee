# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of what lets light straight on: of the lamps' light (1 - alpha) times the tint gets through each surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.materials import Materials
from curvrefl.curvrefl_addon.scene.arrays import ImageSource, LightArrays, MaterialArrays, WorldArrays
from lighting.cycles import cycles_picture
from lighting.harness import our_picture
from lighting.stage import Body, Cut, Stage, box, lamp, plane, scene_arrays
from scenes.paths.programs import Looked, source_of
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
UNDER = {"eye": (0.0, -0.02, 0.9), "width": 1.0, "pixels": 24}
"""A floor from under what hangs 1 m above it"""
SUN = lamp("SUN", (2.0, 2.0, 2.0), (0.0, 0.0, 4.0))
UV = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def seen_through(**changes: Any) -> MaterialArrays:
    return MaterialArrays("leaf", (0.5, 0.5, 0.5), specular_level=0.0, **changes)


def panes(*alphas: float) -> list[Body]:
    """A floor, and sheets above it."""
    return [
        plane(20.0),
        *(plane(4.0, 1.0 + 0.3 * index, material=seen_through(alpha=alpha)) for index, alpha in enumerate(alphas)),
    ]


def share_lit(bodies: list[Body], light: LightArrays = SUN, world: WorldArrays | None = None, **more: Any) -> Any:
    """(pixels, pixels, 3) light over that without what hangs above the floor."""
    stage = Stage(bodies, [light] if world is None else [], world or WorldArrays(), **UNDER, **more)
    bare = Stage(bodies[:1], [light] if world is None else [], world or WorldArrays(), **UNDER)
    return our_picture(stage)[0] / our_picture(bare)[0]


@pytest.mark.parametrize("alphas", [(0.3,), (0.3, 0.6, 0.2)], ids=str)
@pytest.mark.parametrize("angle", [0.0, 0.1], ids=["hard", "soft"])
def test_each_surface_lets_its_share_of_a_lamp_through(alphas: tuple[float, ...], angle: float) -> None:
    light = share_lit(panes(*alphas), replace(SUN, angle=angle))
    through = float(np.prod(1.0 - np.array(alphas)))
    assert light.mean() == pytest.approx(through, abs=0.015)
    # What each place has, whatever falls on it by chance.
    assert np.abs(light - through).std() < 0.1


def test_both_sides_of_a_thin_pane_count() -> None:
    thin = box((-2.0, -2.0, 1.0), (2.0, 2.0, 1.0001), material=seen_through(alpha=0.4))
    assert share_lit([plane(20.0), thin]).mean() == pytest.approx(0.36, rel=0.02)


def test_the_world_is_let_through_as_well() -> None:
    wide = plane(400.0, 1.0, material=seen_through(alpha=0.4))
    assert share_lit([plane(20.0), wide], world=WorldArrays((0.7, 0.7, 0.7))).mean() == pytest.approx(0.6, rel=0.03)


def test_more_sub_frames_leave_less_of_the_chance() -> None:
    """Of lamps, whose maps differ then, and of the world, whose directions are looked at again."""
    wide = plane(400.0, 1.0, material=seen_through(alpha=0.4))
    stages = {
        "soft lamp": Stage([plane(20.0), wide], [replace(SUN, angle=0.1)], **UNDER | {"pixels": 16}),
        "world": Stage([plane(20.0), wide], [], WorldArrays((0.7, 0.7, 0.7)), **UNDER | {"pixels": 16}),
    }
    for name, stage in stages.items():
        few, many = (our_picture(stage, count)[0] for count in (16, 64))
        assert few.mean() == pytest.approx(many.mean(), rel=0.03), name
        assert many.std() < 0.6 * few.std(), name


@pytest.mark.parametrize(
    ("material", "through"),
    [
        (seen_through(alpha=0.0), 1.0),
        (seen_through(alpha=0.0, transparent_tint=(0.0, 0.0, 0.0)), 0.0),
        (seen_through(alpha=0.5, transparent_tint=(0.5, 0.5, 0.5)), 0.25),
        (seen_through(transmission=1.0), 0.0),
    ],
    ids=lambda item: "" if isinstance(item, float) else None,
)
def test_tints_and_glass(material: MaterialArrays, through: float) -> None:
    """Glass is opaque to straight light, as it is in Cycles without caustics."""
    light = share_lit([plane(20.0), plane(4.0, 1.0, material=material)])
    assert light.mean() == pytest.approx(through, rel=0.01, abs=1e-6)


def leaf_image(share: float = 1.0) -> ImageSource:
    """A disk that is there, with a soft rim."""
    y, x = np.mgrid[0:64, 0:64] / 63.0 - 0.5
    alpha = np.clip(8.0 * (0.35 - np.hypot(x, y * 1.4)) + 0.5, 0.0, 1.0)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[..., 3] = share * alpha
    return source_of("leaf", pixels)


@pytest.mark.parametrize(
    "cut",
    [
        Cut(threshold=0.5),
        Cut(),
        Cut(Looked(is_nearest=True, extension="CLIP")),
        Cut(Looked(extension="EXTEND")),
        Cut(Looked(extension="MIRROR")),
    ],
    ids=["clip", "hashed", "nearest", "extend", "mirror"],
)
def test_leaves_shadow_as_in_cycles(cut: Cut) -> None:
    """An image's alpha, on sheets whose uv go beyond it."""
    leaf = plane(1.2, 1.0, material=seen_through(), uv=1.6 * UV - 0.3, cut=cut)
    higher = plane(0.8, 1.2, material=seen_through(), uv=1.6 * UV - 0.3, cut=cut)
    light = lamp("POINT", (100.0, 100.0, 100.0), (0.1, 0.0, 6.0), radius=0.1)
    stage = Stage([plane(20.0), leaf, higher], [light], images=(leaf_image(),), **UNDER)
    ours, cycles = our_picture(stage)[0], cycles_picture(stage, 128)
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.01)
    assert np.abs(ours - cycles).mean() < 0.04 * cycles.mean()


def test_panes_of_cycles_let_through_what_ours_do() -> None:
    stage = Stage(panes(0.5, 0.3), [replace(SUN, angle=0.05)], **UNDER)
    cycles = cycles_picture(stage, 16)
    assert our_picture(stage)[0].mean() == pytest.approx(cycles.mean(), rel=0.01)


def test_a_tint_is_said_to_be_left_out() -> None:
    stage = Stage([plane(20.0), plane(4.0, 1.0, material=seen_through(alpha=0.5, transparent_tint=(1.0, 0.4, 0.1)))])
    geometry = SceneGeometry()
    scene = scene_arrays(stage)
    geometry.update(scene, {})
    (sentence,) = Lighting(scene, geometry, Materials(scene)).warnings
    assert sentence == 'Shadows of material "leaf" are gray where shadow maps serve: its tint is left out.'


def test_shadows_follow_materials_and_images() -> None:
    """A renderer that stays lights as one that is new."""
    leaf = plane(1.2, 1.0, material=seen_through(), uv=UV, cut=Cut(threshold=0.5))
    stage = Stage([plane(20.0), leaf], [SUN], images=(leaf_image(),), **UNDER)
    scene = scene_arrays(stage)
    geometry = SceneGeometry()
    geometry.update(scene, {})
    materials = Materials(scene)
    lighting = Lighting(scene, geometry, materials, 4)
    lighting.prepare(0)
    opaque = replace(scene, materials=(scene.materials[0], seen_through()))
    thinner = replace(scene, images=(leaf_image(0.9),))
    for state in (opaque, scene, thinner):
        materials.follow(state)
        lighting.follow(state, geometry.update(state, {}))
        fresh = Lighting(state, geometry, Materials(state), 4)
        for index in range(4):
            lighting.prepare(index)
            fresh.prepare(index)
        kept, new = (np.array(one._lamp_maps.texture.read(), np.float32) for one in (lighting, fresh))
        assert np.array_equal(kept, new)


def test_shadows_follow_images_that_get_there_by_and_by() -> None:
    """As in the viewport."""
    leaf = plane(1.2, 1.0, material=seen_through(), uv=UV, cut=Cut(threshold=0.5))
    scene = scene_arrays(Stage([plane(20.0), leaf], [SUN], images=(leaf_image(),), **UNDER))
    view = look_at(np.array([0.0, -4.0, 3.0]), np.zeros(3), 48, 36, 0.7)
    pictures = []
    for is_gradual in (False, True):
        renderer = Renderer(scene, Settings(method="exact", samples=1), is_gradual=is_gradual)
        renderer.render(view)
        while renderer.is_loading:
            renderer.load_some(1.0)
        pictures.append(renderer.render(view).color())
        renderer.free()
    assert np.array_equal(*pictures)
