# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample of the awkward scenes: right, or a sentence. `./curvrefl test awkward` tries them all."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from awkward import judge

pytestmark = pytest.mark.usefixtures("gpu")
SETTINGS = (
    *("view_agx", "film_transparent", "border", "view_layer_no_sky", "subdivision_of_mirror", "hidden_by_eye"),
    *("dof_on_mirror", "motion_blur_thing", "camera_scaled", "orthographic_near"),
)
SURFACES = ("gltf_leather", "fog_cube", "glass", "shiny_ball", "image_alpha_unlinked", "mapping_rotation", "uv_named")
LIGHT = ("area_spread", "lamp_far", "light_linking", "world_one_pixel", "world_invisible_to_camera")
THINGS = (
    *("nan_place", "far_1e5", "shape_cube_smooth", "shape_half_flipped", "nodes_hidden_seed", "mirror_in_collection"),
    *("particles_hair", "grease_pencil"),
)
SAMPLE = (*SETTINGS, *SURFACES, *LIGHT, *THINGS)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, dict[str, Any]]]:
    folder = tmp_path_factory.mktemp("awkward")
    yield {result["name"]: result for result in judge.try_scenes(SAMPLE, folder, 1)}


@pytest.mark.parametrize("name", SAMPLE)
def test_awkward_scene(name: str, results: dict[str, dict[str, Any]]) -> None:
    result = results[name]
    assert result["outcome"] not in judge.FAILURES, judge.table_line(result) + result.get("crash", "")
