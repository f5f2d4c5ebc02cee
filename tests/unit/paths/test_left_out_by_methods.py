# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What methods that follow no rays say of mirrors that are not sharp, and of what is seen through."""

from __future__ import annotations

from dataclasses import replace

import pytest
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.renderer.paths.left_out import left_out_by, reasons_for_rays
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays
from scenes.paths.made_of import CHROME, LEAF, ROUGH_METAL, scene_of, varying

SEE_IT = ": choose Automatic or Exact to see it."
BUMPY = varying(CHROME, normal=(-1.0, 1.0))
OPAQUE = MaterialArrays("opaque")


@pytest.mark.parametrize(
    ("material", "sentences", "reason"),
    [
        (CHROME, [], None),
        (ROUGH_METAL, ['Roughness of mirror "mirror" is left out'], "is rough"),
        (
            replace(ROUGH_METAL, anisotropy=0.5),
            ['Roughness of mirror "mirror" is left out', 'Anisotropy of mirror "mirror" is left out'],
            "is rough",
        ),
        (
            MaterialArrays("glass", roughness=0.0, transmission=1.0, absorption=(1.0, 1.0, 1.0)),
            ['The glass of mirror "mirror" is drawn as a plain mirror'],
            "is glass",
        ),
        (replace(CHROME, alpha=0.5), ['The transparency of mirror "mirror" is left out'], "is transparent in part"),
        (
            replace(CHROME, coat_weight=1.0, coat_roughness=0.0),
            ['The coat of mirror "mirror" is left out'],
            "has a coat",
        ),
        (replace(CHROME, film_thickness=300.0), ['The thin film of mirror "mirror" is left out'], "has a thin film"),
        (
            varying(CHROME, roughness=(0.0, 1.0)),
            [
                'Roughness of mirror "mirror" is left out',
                'Textures of more than its color of mirror "mirror" are left out',
            ],
            "is rough",
        ),
        (
            varying(CHROME, metallic=(0.0, 1.0), roughness=(0.0, 0.0)),
            ['Textures of more than its color of mirror "mirror" are left out'],
            "has textures of its gloss",
        ),
    ],
    ids=lambda item: item.name if isinstance(item, MaterialArrays) else "",
)
@pytest.mark.parametrize("method", ["newton", "environment_cube"])
def test_one_sentence_for_each_kind(
    material: MaterialArrays, sentences: list[str], reason: str | None, method: str
) -> None:
    scene = scene_of(material, OPAQUE)
    assert left_out_by(METHODS[method], scene, [0]) == tuple(sentence + SEE_IT for sentence in sentences)
    assert reasons_for_rays(scene, [0]) == ({} if reason is None else {"mirror": reason})


@pytest.mark.parametrize("method", ["auto", "exact"])
def test_what_rays_show_is_not_left_out(method: str) -> None:
    assert left_out_by(METHODS[method], scene_of(replace(ROUGH_METAL, alpha=0.5), LEAF), [0]) == ()


def test_environments_have_bumps_and_vertices_do_not() -> None:
    scene = scene_of(BUMPY, OPAQUE)
    assert left_out_by(METHODS["environment_cube"], scene, [0]) == ()
    (sentence,) = left_out_by(METHODS["newton"], scene, [0])
    others = "choose Automatic, Exact or an environment method to see them."
    assert sentence == f'Bumps of mirror "mirror" are left out: {others}'
    assert reasons_for_rays(scene, [0]) == {"mirror": "has bumps"}


def test_several_mirrors_share_a_sentence() -> None:
    scene = scene_of(ROUGH_METAL, OPAQUE)
    instances = (*scene.instances, replace(scene.instances[0], object_name="other", object_id=3))
    scene: SceneArrays = replace(scene, instances=instances, reflectors=(1, 3))
    (sentence,) = left_out_by(METHODS["newton"], scene, [0, 2])
    assert sentence == f'Roughness of 2 mirrors ("mirror" and "other") is left out{SEE_IT}'


@pytest.mark.parametrize("method", ["newton", "environment_sphere"])
def test_scenery_that_is_seen_through_is_named(method: str) -> None:
    (sentence,) = left_out_by(METHODS[method], scene_of(CHROME, LEAF), [0])
    assert sentence == (
        'The transparency of object "scenery" is left out in mirrors: choose Automatic or Exact to see what is behind.'
    )
    assert left_out_by(METHODS[method], scene_of(CHROME, LEAF, visible_glossy=False), [0]) == ()
    # A slot that no triangle has.
    assert left_out_by(METHODS[method], scene_of(CHROME, LEAF, (1,)), [0]) == ()
