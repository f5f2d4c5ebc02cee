# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders know of light linking where something is linked, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.lamps import lamp_features, lamp_records, link_records
from curvrefl.curvrefl_addon.renderer.lighting.left_out import seen_in_spite_of_links
from curvrefl.curvrefl_addon.renderer.lighting.lighting import DATA_RECORDS, FEATURES, MAX_LAMPS, lighting_piece
from curvrefl.curvrefl_addon.renderer.surfaces.light_sets import LINKED, SHADOWS_LINKED, links_of, sets_of_varies
from curvrefl.curvrefl_addon.scene.arrays import EVERY_SET, LightArrays, MaterialArrays, SceneArrays, WorldArrays
from scenes.paths.made_of import CHROME, scene_of

LAMP = LightArrays("lamp", "POINT", (1.0, 1.0, 1.0), np.eye(4), radius=0.1)
SHINE = MaterialArrays("shine", emission=(1.0, 1.0, 1.0))


def made(light: LightArrays = LAMP, material: MaterialArrays = SHINE) -> SceneArrays:
    """A mirror, a thing that shines and a lamp."""
    return replace(scene_of(CHROME, material), lights=(light,))


@pytest.mark.parametrize(
    ("scene", "links"),
    [
        (made(), set()),
        (made(replace(LAMP, lights_on=1)), {LINKED}),
        (made(material=replace(SHINE, light_set=1)), {LINKED}),
        (made(material=replace(SHINE, shines_on=1)), {LINKED}),
        (made(replace(LAMP, blocked_by=1)), {SHADOWS_LINKED}),
        (made(material=replace(SHINE, blocked_by=1)), {SHADOWS_LINKED}),
        (made(replace(LAMP, lights_on=1, blocked_by=1)), {LINKED, SHADOWS_LINKED}),
    ],
)
def test_links_are_known_where_there_are_some(scene: SceneArrays, links: set[str]) -> None:
    assert links_of(scene) == links
    assert lamp_features(scene.lights, WorldArrays(), scene) == {"LIGHTING_POINT"} | links


def test_without_links_shaders_have_nothing_of_them() -> None:
    plain = lighting_piece()
    assert {LINKED, SHADOWS_LINKED}.isdisjoint(FEATURES)
    assert {LINKED, SHADOWS_LINKED, "LINK_RECORDS"}.isdisjoint(plain.defines)
    assert plain.blocks["lighting_data"].length == DATA_RECORDS
    assert sets_of_varies(SHINE, frozenset()) == 0
    for name in (LINKED, SHADOWS_LINKED):
        linked = lighting_piece(FEATURES | {name})
        assert linked.defines["LINK_RECORDS"] == DATA_RECORDS
        assert linked.blocks["lighting_data"].length == DATA_RECORDS + MAX_LAMPS
        # (Uniform blocks hold so much everywhere.)
        assert 16 * linked.blocks["lighting_data"].length <= 16 << 10


def test_bits_survive_single_precision() -> None:
    lights = [replace(LAMP, lights_on=EVERY_SET, blocked_by=EVERY_SET - 1), replace(LAMP, lights_on=1 << 19)]
    records = link_records(lights).astype(np.float32)
    assert records[:2, :2].astype(int).tolist() == [[EVERY_SET, EVERY_SET - 1], [1 << 19, EVERY_SET]]
    assert int(np.float32(sets_of_varies(SHINE, frozenset({LINKED})) + 7)) == (EVERY_SET << 3) + 7


def test_the_camera_sees_no_sun_that_has_shadow_linking() -> None:
    sun = replace(LAMP, kind="SUN", angle=0.1)
    seen = [lamp_records(light, np.zeros(4), 1.0)[11, 3] for light in (sun, replace(sun, blocked_by=1))]
    assert seen == [1.0, 0.0]
    assert lamp_records(replace(LAMP, blocked_by=1), np.zeros(4), 1.0)[11, 3] == 1.0


def test_environments_name_what_is_not_for_the_mirror() -> None:
    assert seen_in_spite_of_links(made()) == ()
    assert seen_in_spite_of_links(made(replace(LAMP, lights_on=1))) == ()
    (sentence,) = seen_in_spite_of_links(made(replace(LAMP, lights_on=2), replace(SHINE, shines_on=2)))
    assert sentence.startswith('In mirrors "lamp" and "')
    assert seen_in_spite_of_links(made(replace(LAMP, lights_on=2, radius=0.0))) == ()
    assert seen_in_spite_of_links(made(replace(LAMP, lights_on=2, visible_glossy=False))) == ()
