# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lighting against small Cycles renders of the same points, and where the answer is known without."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.world import image_directions
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, MaterialArrays, WorldArrays
from lighting.cycles import cycles_picture
from lighting.harness import our_picture
from lighting.stage import Body, Stage, ball, box, lamp, plane

pytestmark = pytest.mark.usefixtures("gpu")

GRAY = MaterialArrays("gray", (0.7, 0.7, 0.7), specular_level=0.0)
RED = MaterialArrays("red", (0.8, 0.2, 0.1), specular_level=0.0)
POWER = (100.0, 50.0, 20.0)


def sky() -> np.ndarray:
    """A small equirectangular image: a gradient, a dark ground and a low sun of 16 degrees across."""
    directions, _ = image_directions(64, 128)
    image = np.array([0.3, 0.4, 0.6]) * (0.3 + 0.7 * np.clip(directions[..., 2:], 0, 1))
    image = np.where(directions @ np.array([0.6, -0.5, 0.62]) > 0.99, 0.0, 1.0)[..., None] * image
    sun = (directions @ np.array([0.6, -0.5, 0.62]) > 0.99)[..., None]
    return np.where(sun, [20.0, 17.0, 13.0], image).astype(np.float32)


LAMPS = {
    "point": lamp("POINT", POWER, (0.3, 0.2, 3.0)),
    "ball": lamp("POINT", POWER, (0.3, 0.2, 3.0), radius=0.3),
    "sun": lamp("SUN", (2.0, 1.0, 0.5), (1.0, 2.0, 3.0)),
    "wide sun": lamp("SUN", (2.0, 1.0, 0.5), (1.0, 2.0, 3.0), angle=0.6),
    "spot": lamp("SPOT", POWER, (1.0, 0.5, 3.0), spot_angle=0.8, spot_blend=0.5),
    "rectangle": lamp("AREA", POWER, (1.0, 0.5, 3.0), size=(1.0, 0.5)),
    "ellipse": lamp("AREA", POWER, (1.0, 0.5, 3.0), size=(1.0, 0.5), ellipse=True),
}


@pytest.mark.parametrize("name", LAMPS)
def test_lamp_has_blenders_strength_and_falloff(name: str) -> None:
    stage = Stage([plane()], [LAMPS[name]], pixels=16)
    ours, _ = our_picture(stage)
    cycles = cycles_picture(stage, 256)
    assert np.allclose(ours.mean(axis=(0, 1)) / cycles.mean(axis=(0, 1)), 1.0, atol=0.005)
    lit = cycles[..., 0] > 0.1 * cycles[..., 0].max()
    assert np.abs(ours / np.maximum(cycles, 1e-9) - 1.0)[lit].max() < 0.03


@pytest.mark.parametrize("roughness", [0.2, 0.5, 0.9])
@pytest.mark.parametrize(
    ("metallic", "level", "glossy"),
    [(0.0, 0.5, False), (0.0, 1.0, False), (1.0, 0.5, False), (0.5, 0.2, False), (0.0, 0.5, True)],
)
def test_principled_lobes_match_in_a_white_world_and_under_a_sun(
    metallic: float, level: float, glossy: bool, roughness: float
) -> None:
    material = MaterialArrays(
        "m", (0.8, 0.4, 0.1), metallic=metallic, specular_level=level, roughness=roughness, glossy_only=glossy
    )
    for angle in (5.0, 75.0):
        eye = (6 * np.sin(np.radians(angle)), 0.0, 6 * np.cos(np.radians(angle)))
        in_world = Stage(
            [plane(40.0, material=material)], world=WorldArrays((1.0, 1.0, 1.0)), eye=eye, width=1, pixels=4
        )
        in_sun = Stage(
            [plane(40.0, material=material)], [lamp("SUN", (3, 3, 3), (-1, 0.5, 2))], eye=eye, width=1, pixels=4
        )
        for stage, samples in ((in_world, 512), (in_sun, 4)):
            ours, _ = our_picture(stage, 1)
            assert np.allclose(
                ours.mean(axis=(0, 1)) / cycles_picture(stage, samples).mean(axis=(0, 1)), 1.0, atol=0.012
            )


@pytest.mark.parametrize(("metallic", "roughness"), [(0.0, 0.1), (0.0, 0.5), (1.0, 0.1), (1.0, 0.25), (1.0, 0.8)])
def test_rough_reflection_of_an_image_world(metallic: float, roughness: float) -> None:
    """One lobe about one direction stands for the real lobe, which grazing angles bend and cut: see the tolerances."""
    color = (0.8, 0.4, 0.1) if metallic else (0.02, 0.02, 0.02)
    material = MaterialArrays("m", color, metallic=metallic, roughness=roughness)
    for angle, tolerance in ((5.0, 0.06), (50.0, 0.06), (80.0, 0.16)):
        eye = (6 * np.sin(np.radians(angle)), 0.3, 6 * np.cos(np.radians(angle)))
        world = WorldArrays((1.0, 1.0, 1.0), sky())
        stage = Stage([plane(40.0, material=material)], world=world, eye=eye, width=1, pixels=4)
        ours, _ = our_picture(stage)
        ratio = ours.mean(axis=(0, 1)) / cycles_picture(stage, 1024).mean(axis=(0, 1))
        assert np.allclose(ratio, 1.0, atol=tolerance), angle


MIRRORS = {
    "metal": MaterialArrays("m", (0.8, 0.4, 0.1), metallic=1.0, roughness=0.0),
    "dielectric": MaterialArrays("m", (0.0, 0.0, 0.0), roughness=0.0, ior=1.5),
    "dielectric, raised": MaterialArrays("m", (0.0, 0.0, 0.0), roughness=0.0, ior=1.33, specular_level=0.9),
    "mixed": MaterialArrays("m", (0.0, 0.0, 0.0), metallic=0.5, roughness=0.0, ior=1.8),
    "glossy": MaterialArrays("m", (0.8, 0.4, 0.1), roughness=0.0, glossy_only=True),
}


@pytest.mark.parametrize("name", MIRRORS)
def test_mirror_reflectance_is_cycles_from_the_middle_to_the_rim(name: str) -> None:
    """A mirror ball in a white world shows its reflectance."""
    stage = Stage([ball((0, 0, 0), 0.95, 96, material=MIRRORS[name])], world=WorldArrays((1.0, 1.0, 1.0)), pixels=32)
    ours, number = our_picture(stage, 1, "mirror_at")
    cycles = cycles_picture(stage, 64)
    # the ball's poles have no normals of their own in Blender
    column, row = np.meshgrid(np.arange(32) - 15.5, np.arange(32) - 15.5)
    inside = (number == 0) & (np.hypot(column, row) > 1.5) & (np.hypot(column, row) < 14.0)
    assert np.abs(ours - cycles)[inside].max() < 0.004


@pytest.mark.parametrize(
    "light",
    [
        lamp("POINT", POWER, (0.1, 0.0, 3.0), radius=0.5),
        lamp("SPOT", POWER, (0.1, 0.0, 3.0), (0.1, 0.0, 0.0), radius=0.5, spot_angle=1.2, spot_blend=0.3),
        lamp("AREA", POWER, (0.1, 0.0, 3.0), (0.1, 0.0, 0.0), size=(1.0, 0.6)),
        lamp("AREA", POWER, (0.1, 0.0, 3.0), (0.1, 0.0, 0.0), size=(1.0, 0.6), ellipse=True),
    ],
    ids=lambda light: f"{light.kind} {'ellipse' if light.ellipse else ''}",
)
def test_lamp_bodies_look_in_a_mirror_as_in_cycles(light: LightArrays) -> None:
    mirror = MaterialArrays("mirror", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
    stage = Stage([plane(20.0, material=mirror)], [light], WorldArrays((0.1, 0.1, 0.1)), width=2, pixels=32)
    ours, _ = our_picture(stage, 1, "world_and_lamps_at")
    cycles = cycles_picture(stage, 8)
    differs = np.abs(ours - cycles).max(axis=-1) > 0.01 * cycles.max()
    assert ours.max() > 5.0
    assert differs.mean() < 0.01  # pixels on the outline


def test_lamp_behind_something_or_hidden_from_mirrors_is_not_seen() -> None:
    mirror = MaterialArrays("mirror", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
    light = lamp("AREA", POWER, (0.0, 0.0, 3.0), size=(1.0, 1.0))
    hidden = lamp("AREA", POWER, (0.0, 0.0, 3.0), size=(1.0, 1.0), visible_glossy=False)
    turned = lamp("AREA", POWER, (0.0, 0.0, 3.0), (0.0, 0.0, 5.0), size=(1.0, 1.0))
    bodies = [plane(20.0, material=mirror)]
    seen, _ = our_picture(Stage(bodies, [light], pixels=4, width=0.5), 1, "lamps_nearer_than_4")
    assert np.allclose(seen, np.array(POWER) / np.pi, rtol=1e-5)
    for lights, function in (
        ([light], "lamps_nearer_than_2"),
        ([hidden], "lamps_nearer_than_4"),
        ([turned], "lamps_nearer_than_4"),
    ):
        assert np.all(our_picture(Stage(bodies, lights, pixels=4, width=0.5), 1, function)[0] == 0.0)


def still_life() -> list[Body]:
    """A ball in contact with the floor, a box standing on it and a board hanging above it."""
    return [
        plane(20.0, material=GRAY),
        ball((0, 0, 0.5), 0.5, material=RED),
        box((0.7, -0.4, 0), (1.2, 0.3, 0.6), material=GRAY),
        box((-1.4, -0.6, 0.4), (-0.8, 0.6, 0.45), material=RED),
    ]


STILL_LIVES: dict[str, tuple[list[LightArrays], WorldArrays, float]] = {
    "sun": ([lamp("SUN", (2, 2, 2), (2, -1, 3), angle=0.1)], WorldArrays(), 0.02),
    "hard sun": ([lamp("SUN", (2, 2, 2), (2, -1, 3))], WorldArrays(), 0.02),
    "ball lamp": ([lamp("POINT", (200, 200, 200), (2, -1, 3), radius=0.2)], WorldArrays(), 0.02),
    "low ball lamp": ([lamp("POINT", (50, 50, 50), (-0.4, -0.8, 1), radius=0.1)], WorldArrays(), 0.02),
    "spot": (
        [lamp("SPOT", (300, 300, 300), (1, -2, 3), radius=0.1, spot_angle=0.6, spot_blend=0.3)],
        WorldArrays(),
        0.03,
    ),
    "area": ([lamp("AREA", (100, 100, 100), (2, -1, 3), size=(1.5, 1))], WorldArrays(), 0.03),
    "even world": ([], WorldArrays((0.7, 0.7, 0.7)), 0.025),
    "image": ([], WorldArrays((1, 1, 1), sky()), 0.025),
}


@pytest.mark.parametrize("name", STILL_LIVES)
def test_shadows_match_cycles(name: str) -> None:
    """Mean absolute difference in parts of the mean; no light leaks, no self-shadowing of more than a few pixels."""
    lights, world, tolerance = STILL_LIVES[name]
    stage = Stage(still_life(), lights, world, eye=(1.5, -5, 3), target=(0, 0, 0.3), width=3.6, pixels=64)
    ours, _ = our_picture(stage)
    cycles = cycles_picture(stage, 256)
    difference = np.abs(ours - cycles).max(axis=-1)
    assert difference.mean() < tolerance * cycles.mean()
    assert (difference > 0.25 * np.percentile(cycles, 99)).mean() < 0.01


def test_shadow_border_lies_where_rays_say() -> None:
    """A point lamp 4 m over a floor and a board of 1 m at half the height: the shadow is 2 m wide, black, and sharp."""
    light = lamp("POINT", (100, 100, 100), (0.0, 0.0, 4.0))
    board = box((-0.5, -0.5, 2.0), (0.5, 0.5, 2.0001))
    stage = Stage([plane(10.0), board], [light], eye=(0.0, -0.02, 1.5), target=(0, 0, 0), width=2.4, pixels=96)
    ours, number = our_picture(stage, 1)
    x = ((np.arange(96) + 0.5) / 96 - 0.5) * 2.4
    distance = np.maximum(np.abs(x)[None, :], np.abs(x)[:, None])
    assert np.all(number == 0)
    assert np.all(ours[distance < 0.96] == 0.0)
    assert np.all(ours[distance > 1.04] > 0.0)


def test_floor_lit_from_a_lamp_among_walls_has_no_self_shadow() -> None:
    """A closed room round the lamp: every wall is lit in full, as if there were no shadows."""
    room = box((-2, -2, -2), (2, 2, 2))
    inside_out = Body(room.positions, room.triangles[:, ::-1].copy())
    lit = lamp("POINT", (100, 100, 100), (0.3, 0.5, 0.7))
    unshadowed = lamp("POINT", (100, 100, 100), (0.3, 0.5, 0.7), casts_shadow=False)
    for eye in ((0.5, 0.5, 1.9), (-1.9, 0.5, 0.3)):
        pictures = [
            our_picture(Stage([inside_out], [light], eye=eye, width=3.6, pixels=48), 1)[0]
            for light in (lit, unshadowed)
        ]
        assert np.allclose(pictures[0], pictures[1], rtol=1e-6)


def test_object_that_casts_no_shadow_casts_none() -> None:
    light = lamp("SUN", (1, 1, 1), (0.0, 0.0, 4.0))
    hovering: dict[bool, Any] = {
        casts: our_picture(
            Stage(
                [plane(10.0), box((-0.5, -0.5, 2), (0.5, 0.5, 2.1), visible_shadow=casts)],
                [light],
                eye=(0, -0.02, 1.5),
                pixels=16,
                width=0.5,
            ),
            1,
        )[0]
        for casts in (True, False)
    }
    assert np.all(hovering[True] == 0.0)
    assert np.allclose(hovering[False], 0.5 / np.pi, rtol=1e-3)


def test_world_light_under_a_lid_is_what_the_open_angle_lets_in() -> None:
    """A floor point under the middle of a square lid sees pi times one minus the lid's form factor."""
    half, height = 1.0, 1.0
    lid = box((-half, -half, height), (half, half, height + 0.001))
    stage = Stage([plane(40.0), lid], world=WorldArrays((1.0, 1.0, 1.0)), eye=(0, -0.01, 0.5), width=0.02, pixels=2)
    ours, _ = our_picture(stage)
    a = half / height
    quarter = 2 * a / np.sqrt(1 + a * a) * np.arctan(a / np.sqrt(1 + a * a)) / (2 * np.pi)
    assert np.allclose(ours, 0.5 * (1 - 4 * quarter), atol=0.02)


def test_inside_a_closed_box_no_world_light_arrives() -> None:
    room = box((-2, -2, -2), (2, 2, 2))
    inside_out = Body(room.positions, room.triangles[:, ::-1].copy())
    for world in (WorldArrays((1.0, 1.0, 1.0)), WorldArrays((1.0, 1.0, 1.0), sky())):
        ours, _ = our_picture(Stage([inside_out], world=world, eye=(0.3, 0.2, 0.5), width=2.0, pixels=16))
        # a line of pixels along an edge of the room is within a texel of the outside
        assert (np.abs(ours).max(axis=-1) > 0.01).mean() < 0.05
        assert np.abs(ours).mean() < 0.005


def test_sub_frames_are_repeatable_and_any_number_has_the_same_mean() -> None:
    stage = Stage(
        still_life(),
        [lamp("SUN", (1, 1, 1), (2, -1, 3), angle=0.1)],
        WorldArrays((0.5, 0.5, 0.5)),
        eye=(1.5, -5, 3),
        width=3.6,
        pixels=32,
    )
    first, again, few, one = (our_picture(stage, count)[0] for count in (16, 16, 4, 1))
    assert np.array_equal(first, again)
    assert abs(few.mean() / first.mean() - 1) < 0.01
    assert abs(one.mean() / first.mean() - 1) < 0.02


def test_empty_scene_is_its_world() -> None:
    far = plane(0.01, z=-50.0)
    ours, number = our_picture(
        Stage([far], world=WorldArrays((0.2, 0.3, 0.4)), eye=(5.0, 5.0, 6.0), target=(5, 5, 0), pixels=4)
    )
    assert np.all(number == -1)
    assert np.allclose(ours, [0.2, 0.3, 0.4])
