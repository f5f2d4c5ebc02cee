# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Through a camera a viewport shows depth of field where its shading does, once the view rests."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticColors
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene
from curvrefl.curvrefl_addon.settings_table import OF_SCENES, Settings
from curvrefl.curvrefl_addon.viewport.region import SETTLED_SECONDS, RegionPicture, view_of
from scenes.file_settings.blurred_stage import build_blurred_stage

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = 48
OPTIONS = SimpleNamespace(colors=DiagnosticColors())


def settings(show: str = "REFLECTION") -> Any:
    starts = {item.name: item.start for item in OF_SCENES}
    return SimpleNamespace(**starts | {"show": show, "motion_resolution": "HALF", "stripe_count": 3})


def context_of(scene: bpy.types.Scene, perspective: str = "CAMERA") -> Any:
    """A viewport on the open file."""
    areas = [area for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D"]
    camera, graph = scene.camera, bpy.context.evaluated_depsgraph_get()
    data = SimpleNamespace(
        view_perspective=perspective,
        view_matrix=camera.matrix_world.inverted(),
        window_matrix=camera.calc_matrix_camera(graph, x=SIZE, y=SIZE),
    )
    return SimpleNamespace(
        scene=scene,
        space_data=areas[0].spaces.active,
        region=SimpleNamespace(width=SIZE, height=SIZE),
        region_data=data,
        evaluated_depsgraph_get=lambda: graph,
    )


def test_the_lens_is_seen_where_the_viewport_shows_it() -> None:
    scene = build_blurred_stage()
    shading = context_of(scene).space_data.shading
    shading.type = "RENDERED"
    assert view_of(context_of(scene)).lens is None
    scene.camera.data.dof.use_dof = True
    bpy.context.view_layer.update()
    lens = view_of(context_of(scene)).lens
    assert lens is not None and lens.focus == pytest.approx(scene.camera.data.dof.focus_distance)
    assert view_of(context_of(scene, "PERSP")).lens is None
    shading.type = "SOLID"
    for shown in (False, True):
        shading.use_dof = shown
        assert (view_of(context_of(scene)).lens is not None) == shown


@pytest.mark.parametrize("method", ["exact", "secant_star"])
def test_depth_of_field_comes_when_the_view_rests(method: str) -> None:
    scene = build_blurred_stage()
    scene.camera.data.dof.use_dof = True
    arrays, _ = read_render_scene(scene, bpy.context.view_layer, ["ball"], SIZE, SIZE)
    view = view_of(context_of(scene, "PERSP"))
    context_of(scene).space_data.shading.type = "RENDERED"
    blurred = view_of(context_of(scene))
    renderer = Renderer(arrays, Settings(method=method, samples=8))

    def shown(seen: Any, show: str = "REFLECTION") -> tuple[RegionPicture, np.ndarray]:
        """After some seconds of rest."""
        picture = RegionPicture(None, renderer)  # type: ignore[arg-type]
        for step in range(24):
            picture.advance(seen, settings(show), OPTIONS, step * SETTLED_SECONDS, False, {})
            if step == 0:
                assert picture.is_coarse
        return picture, picture.pixels()

    sharp, soft = shown(view), shown(blurred)
    for picture, _ in (sharp, soft):
        assert picture.is_complete and not picture.is_coarse
    still = renderer.render(blurred).color()
    whole = soft[1][..., 3] > 0.999
    assert whole.sum() > 100
    assert np.abs(soft[1] - still)[whole][:, :3].mean() < 0.1 * np.abs(sharp[1] - still)[whole][:, :3].mean()
    # What explains the mirror is sharp, and comes to rest too.
    picture, zebra = shown(blurred, "ZEBRA")
    assert picture.is_complete and not picture.is_coarse
    assert np.array_equal(zebra, shown(view, "ZEBRA")[1])
    renderer.free()
