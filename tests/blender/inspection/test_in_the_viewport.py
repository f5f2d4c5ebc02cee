# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature and combs in a viewport's redraws: found in pieces, then kept; many mirrors of one mesh share it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticColors
from curvrefl.curvrefl_addon.inspection import shown
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.overlays import matrices_of
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shading.combs import CombOptions, Combs
from curvrefl.curvrefl_addon.renderer.shading.curvature import Curvatures
from curvrefl.curvrefl_addon.settings_table import OF_SCENES
from curvrefl.curvrefl_addon.viewport import region
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 96, 72, 0.5)


def fine_ball() -> Room:
    """Of 64,000 triangles."""
    made = Room()
    made.add_mirror(Ellipsoid(), 256)
    return made


def scene_of(**changed: Any) -> Any:
    starts = {item.name: item.start for item in OF_SCENES} | changed
    return SimpleNamespace(curvrefl=SimpleNamespace(**starts), cursor=SimpleNamespace(matrix=np.eye(4)))


def test_a_view_of_curvature_comes_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(region, "SLICE_SECONDS", 0.0)
    renderer = Renderer(fine_ball().arrays(), Settings(samples=1, method="exact"))
    picture = region.RegionPicture(SimpleNamespace(), renderer)
    options = SimpleNamespace(colors=DiagnosticColors())
    settings = scene_of(show="CURVATURE", motion_resolution="FULL", curvature_kind="GAUSSIAN").curvrefl
    waited = 0
    for step in range(10):
        picture.advance(VIEW, settings, options, 1.0 * step, False, {})
        if picture.progress != "curvature of object 1":
            break
        waited += 1
        assert picture.legend() is None and not picture.pixels().any() and picture.has_work
    assert waited == 1, "two pieces"
    assert (picture.pixels()[..., 3] > 0.99).mean() > 0.1
    legend = picture.legend()
    assert legend is not None and legend.ticks[-1] == (1.0, "1"), "a ball of radius 1, but for rounding"


def test_combs_are_drawn_once_curvature_is_known() -> None:
    renderer = Renderer(fine_ball().arrays(), Settings(samples=1, method="exact"))
    scene = scene_of(comb_show=True, comb_axis="Z", comb_teeth=40)
    texture = empty_texture(VIEW.width, VIEW.height)
    target = frame_buffer(texture)

    def drawn() -> tuple[bool, np.ndarray]:
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0))
            with matrices_of(VIEW.world_to_view, VIEW.view_to_clip):
                done = shown.show_combs(renderer, scene, VIEW, 0.0)
        return done, read_texture(texture)

    shown.forget_combs()
    done, picture = drawn()
    assert not done and not picture.any() and shown.comb_rows() == []
    done, picture = drawn()
    assert done and (picture[..., 3] > 0.3).sum() > 100
    rows = dict(shown.comb_rows())
    assert rows["Sections"] == "1" and rows["Smallest Radius"] == "1 m"
    shown.forget_combs()


def test_mirrors_of_one_mesh_share_it_and_combs_are_kept() -> None:
    made = fine_ball().arrays()
    first = made.instances[0]
    matrices = [np.eye(4) for _ in range(300)]
    for number, matrix in enumerate(matrices):
        matrix[0, 3] = 3.0 * number
    instances = tuple(replace(first, matrix=matrix) for matrix in matrices)
    renderer = Renderer(replace(made, instances=instances), Settings(samples=1, method="exact"))
    curvatures = Curvatures()
    combs = Combs(curvatures)
    options, nowhere = CombOptions(axis="Z", teeth=4), np.zeros(3)
    assert combs.of(renderer.mirrors, options, nowhere) is None
    curvatures.prepare(renderer.mirrors)
    assert len(curvatures._meshes()) == 1
    found = combs.of(renderer.mirrors[:3], options, nowhere)
    assert found is not None and len(found.combs) == 3
    centers = [comb.section.points.mean(axis=0) for comb in found.combs]
    np.testing.assert_allclose(centers, [[0.0, 0, 0], [3.0, 0, 0], [6.0, 0, 0]], atol=1e-6)
    assert combs.of(renderer.mirrors[:3], options, nowhere) is found
    assert combs.of(renderer.mirrors[:3], replace(options, offset=0.5), nowhere) is not found
