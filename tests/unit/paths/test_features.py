# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of paths is compiled for a scene: nothing where none of its paths needs it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from curvrefl.curvrefl_addon.renderer.paths.features import (
    ABSORPTION,
    ALPHA,
    ANISOTROPY,
    COAT,
    FILM,
    GLASS,
    ROUGH,
    TINT,
    VARIES,
    path_features,
)
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from scenes.paths.made_of import CHROME, LEAF, ROUGH_METAL, scene_of, varying


@pytest.mark.parametrize(
    ("mirror", "needed"),
    [
        (CHROME, set()),
        (replace(CHROME, metallic=0.5), set()),
        (replace(CHROME, anisotropy=0.5), set()),
        (replace(CHROME, roughness=0.0264), set()),
        (replace(CHROME, roughness=0.0265), {ROUGH}),
        (ROUGH_METAL, {ROUGH}),
        (replace(ROUGH_METAL, anisotropy=-0.5), {ROUGH, ANISOTROPY}),
        (MaterialArrays("dielectric"), {ROUGH}),
        (MaterialArrays("matte", specular_level=0.0), set()),
        (MaterialArrays("air", ior=1.0), set()),
        (replace(CHROME, coat_weight=0.5, coat_roughness=0.0), {COAT}),
        (replace(CHROME, coat_weight=0.5, coat_roughness=0.1), {COAT, ROUGH}),
        (replace(CHROME, film_thickness=300.0), {FILM}),
        (replace(CHROME, specular_tint=(0.2, 1.0, 0.2)), {TINT}),
        (replace(CHROME, specular_tint=(0.2, 1.0, 0.2), glossy_only=True), set()),
        (replace(CHROME, absorption=(1.0, 0.0, 0.0)), set()),
        (MaterialArrays("glass", roughness=0.0, transmission=1.0), {GLASS}),
        (MaterialArrays("green", roughness=0.0, transmission=1.0, absorption=(1.0, 0.0, 1.0)), {GLASS, ABSORPTION}),
        (replace(CHROME, alpha=0.9), {ALPHA}),
        (varying(CHROME, roughness=(0.0, 1.0)), {ROUGH, VARIES}),
        (varying(CHROME, roughness=(0.0, 0.02)), {VARIES}),
        (varying(CHROME, metallic=(0.0, 1.0)), {VARIES}),
        (varying(CHROME, alpha=(0.5, 1.0)), {ALPHA, VARIES}),
        (
            varying(CHROME, transmission=(0.0, 1.0), coat_weight=(0.0, 1.0), coat_roughness=(0.0, 0.0)),
            {GLASS, COAT, VARIES},
        ),
        (varying(CHROME, film_thickness=(0.0, 0.0), specular_tint=(1.0, 1.0), anisotropy=(0.0, 0.0)), {VARIES}),
        (varying(CHROME, base_color=(0.0, 1.0), normal=(-1.0, 1.0)), set()),
        (
            varying(ROUGH_METAL, film_thickness=(0.0, 300.0), specular_tint=(0.0, 1.0), anisotropy=(0.0, 1.0)),
            {FILM, TINT, ANISOTROPY, ROUGH, VARIES},
        ),
    ],
    ids=lambda value: value.name if isinstance(value, MaterialArrays) else "-".join(sorted(value)),
)
def test_what_a_mirror_is_made_of(mirror: MaterialArrays, needed: set[str]) -> None:
    assert path_features(scene_of(mirror, MaterialArrays("scenery"))) == needed


def test_scenery_counts_where_it_is_seen_through() -> None:
    assert path_features(scene_of(CHROME, ROUGH_METAL)) == set()
    assert path_features(scene_of(CHROME, LEAF)) == {ALPHA}
    hidden = {"visible_camera": False, "visible_glossy": False, "visible_transmission": False}
    assert path_features(scene_of(CHROME, LEAF, **hidden)) == set()


@pytest.mark.parametrize(("slots", "needed"), [((1, 1), set()), ((1, 0), {ALPHA}), ((7,), set())])
def test_a_slot_that_no_triangle_has_does_not_count(slots: tuple[int, ...], needed: set[str]) -> None:
    assert path_features(scene_of(CHROME, LEAF, slots)) == needed
