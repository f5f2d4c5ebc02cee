# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which casters let light straight on, and for which of them maps of one lamp have to differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.programs.casters import CasterImage
from curvrefl.curvrefl_addon.renderer.lighting.shadow_alpha import HASHED_SAMPLES, MOST_KEPT, ShadowAlpha
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays
from scenes.paths.made_of import CHROME, LEAF, scene_of
from scenes.paths.programs import cut_out, painted, source_of

CUT = cut_out(replace(LEAF, name="threshold"), threshold=0.5)
SOFT = cut_out(LEAF)
NOWHERE = replace(SOFT, name="nowhere")
IMAGE = source_of("alpha", np.full((2, 2, 4), 0.5, np.float32))


class Bake:
    """Stands for what the GPU makes of programs."""

    def __init__(self, is_there: bool = True) -> None:
        self.is_there = is_there

    def is_known(self, index: int) -> bool:
        return self.is_there

    def __call__(self, scene: SceneArrays, index: int) -> CasterImage:
        material = scene.materials[index]
        alpha = np.array([[0.0, 1.0] if "threshold" in material.name else [0.25, 0.75]], np.float32)
        return CasterImage(alpha, -1 if material.name == "nowhere" else 0)


def alpha_of(material: MaterialArrays) -> ShadowAlpha:
    return ShadowAlpha(replace(scene_of(CHROME, material), images=(IMAGE,)), Bake())


@pytest.mark.parametrize(
    ("material", "is_clear", "casts", "is_hashed"),
    [
        (MaterialArrays("opaque"), False, False, False),
        (MaterialArrays("glass", transmission=1.0), False, False, False),
        (LEAF, True, True, True),
        (SOFT, True, True, True),
        (CUT, True, True, False),
        (replace(CUT, transparent_tint=(0.5, 0.5, 0.5)), True, True, True),
        (replace(LEAF, alpha=0.0), True, False, False),
        (replace(LEAF, alpha=0.0, transparent_tint=(0.0, 0.0, 0.0)), False, False, False),
        (painted(LEAF), True, True, True),
        (replace(SOFT, ranges=(("alpha", 1.0, 1.0),)), False, False, False),
        (replace(SOFT, ranges=(("alpha", 0.0, 0.0),)), True, False, False),
    ],
    ids=lambda value: value.name if isinstance(value, MaterialArrays) else "",
)
def test_what_casts_in_part(material: MaterialArrays, is_clear: bool, casts: bool, is_hashed: bool) -> None:
    alpha = alpha_of(material)
    assert alpha.materials == ({1} if is_clear else set())
    assert alpha.hashed == ({1} if casts else set())
    assert alpha.is_hashed == is_hashed


def test_a_point_has_several_maps_where_they_differ() -> None:
    point, several = np.zeros((1, 4)), np.zeros((5, 4))
    for material, count in ((LEAF, HASHED_SAMPLES), (CUT, 1), (CHROME, 1)):
        assert len(alpha_of(material).repeated(point, 16)) == count
    assert len(alpha_of(LEAF).repeated(point, 4)) == 4
    assert len(alpha_of(LEAF).repeated(point, 4 * MOST_KEPT)) == 4 * MOST_KEPT
    assert alpha_of(LEAF).repeated(several, 16) is several


def test_a_state_that_changes_no_shadow_is_no_other() -> None:
    scene = replace(scene_of(CHROME, SOFT), images=(IMAGE,))
    alpha = ShadowAlpha(scene, Bake())
    rougher = (scene.materials[0], replace(SOFT, roughness=0.9), *scene.materials[2:])
    assert not alpha.follow(replace(scene, materials=rougher))
    assert alpha.follow(replace(scene, images=(source_of("other", np.zeros((2, 2, 4), np.float32)),)))
    assert alpha.follow(replace(scene, materials=(scene.materials[0], CHROME, *scene.materials[2:])))
    assert not alpha.materials


def test_what_is_on_no_uv_map_is_said() -> None:
    (sentence,) = alpha_of(NOWHERE).warnings
    assert sentence.startswith('Shadows of material "nowhere" let light through everywhere alike')
    assert not alpha_of(SOFT).warnings


def test_what_is_not_there_yet_is_opaque_until_then() -> None:
    scene = replace(scene_of(CHROME, SOFT), images=(IMAGE,))
    bake = Bake(is_there=False)
    alpha = ShadowAlpha(scene, bake)
    assert not alpha.materials and not alpha.follow(scene)
    bake.is_there = True
    assert alpha.follow(scene) and alpha.hashed == {1}
