# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects are said to reflect or to light what they do not here."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.left_out import is_lit_indirectly, left_out
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.names import listed

MATTE = MaterialArrays("matte", (0.6, 0.6, 0.6))
CHROME = MaterialArrays("chrome", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0)
GLOW = MaterialArrays("glow", (0.0, 0.0, 0.0), specular_level=0.0, emission=(3.0, 1.0, 0.0))


def mesh(slots: tuple[int, ...] = (0,)) -> MeshArrays:
    count = len(slots)
    points = np.zeros((3, 3), np.float32)
    corners = np.arange(3, dtype=np.int32)
    triangles = np.tile(corners, (count, 1))
    return MeshArrays("mesh", points, corners, points, None, triangles, np.array(slots, np.int32))


def scene_of(*materials: MaterialArrays, mirrors: tuple[int, ...] = (), **more: Any) -> SceneArrays:
    """One object of each material, called a, b, c and so on, over a matte floor."""
    instances = [
        InstanceArrays("abcdefgh"[index], index + 1, 0, np.eye(4), (index,), **more) for index in range(len(materials))
    ]
    floor = InstanceArrays("floor", 100, 0, np.eye(4), (len(materials),))
    return SceneArrays((mesh(),), (*instances, floor), (*materials, MATTE), (), (), WorldArrays(), mirrors)


@pytest.mark.parametrize(
    ("material", "is_shiny"),
    [
        (MATTE, False),
        (MaterialArrays("white plastic", (0.8, 0.8, 0.8), roughness=0.0), False),
        (MaterialArrays("black plastic", (0.03, 0.03, 0.03), roughness=0.3), True),
        (MaterialArrays("black rubber", (0.03, 0.03, 0.03), roughness=1.0), False),
        (MaterialArrays("coal", (0.03, 0.03, 0.03), specular_level=0.0), False),
        (MaterialArrays("rough metal", (0.7, 0.7, 0.7), metallic=1.0, roughness=0.9), True),
        (MaterialArrays("a tenth of metal", (0.7, 0.7, 0.7), metallic=0.1), True),
        (MaterialArrays("glossy", (0.5, 0.5, 0.5), glossy_only=True), True),
        (MaterialArrays("black metal", (0.0, 0.0, 0.0), metallic=1.0), False),
        (MaterialArrays("glass", (0.03, 0.03, 0.03), roughness=0.0, transmission=1.0), False),
        (MaterialArrays("metal leaf", (0.7, 0.7, 0.7), metallic=1.0, alpha=0.5), False),
    ],
    ids=lambda item: getattr(item, "name", ""),
)
def test_shiny_is_what_pictures_are_off_without(material: MaterialArrays, is_shiny: bool) -> None:
    sentence = 'Only mirrors reflect objects: "a" shows the world and lamps alone.'
    assert left_out(scene_of(material)) == ((sentence,) if is_shiny else ())


def test_one_sentence_names_three_and_counts_the_rest() -> None:
    (sentence,) = left_out(scene_of(CHROME, CHROME, CHROME, CHROME, CHROME, mirrors=(1,)))
    assert sentence == 'Only mirrors reflect objects: "b", "c", "d" and 1 more show the world and lamps alone.'
    assert not left_out(scene_of(CHROME, mirrors=(1,)))


def test_what_is_not_seen_or_hardly_there_is_not_named() -> None:
    hidden = scene_of(CHROME, visible_camera=False, visible_glossy=False)
    assert not left_out(hidden)
    assert not left_out(scene_of(CHROME, holdout=True))
    scene = scene_of(MATTE, CHROME)
    both = replace(scene.instances[0], materials=(0, 1))
    for slots, found in (((0,) * 200 + (1,), 0), ((0, 1, 1), 1)):
        assert len(left_out(replace(scene, meshes=(mesh(slots),), instances=(both, scene.instances[2])))) == found


def test_where_light_bounces_rays_show_what_shiny_things_do() -> None:
    assert left_out(scene_of(CHROME))
    assert not left_out(replace(scene_of(CHROME), diffuse_bounces=1))


def test_indirect_light_needs_bounces_and_something_that_scatters() -> None:
    scene = scene_of(CHROME)
    assert not is_lit_indirectly(scene)
    assert is_lit_indirectly(replace(scene, diffuse_bounces=1))
    assert not is_lit_indirectly(replace(scene, diffuse_bounces=1, instances=scene.instances[:1]))


def test_names_in_sentences() -> None:
    assert [listed("abcde"[:count]) for count in (1, 2, 3, 4)] == [
        '"a"',
        '"a" and "b"',
        '"a", "b" and "c"',
        '"a", "b", "c" and 1 more',
    ]
    assert listed("aab") == '"a" and "b"'
