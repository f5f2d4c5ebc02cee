# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that moves has as many pixels as its time leaves room for; one at rest has all, whatever was before."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import DiagnosticColors
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene
from curvrefl.curvrefl_addon.settings_table import Settings
from curvrefl.curvrefl_addon.viewport import region
from curvrefl.curvrefl_addon.viewport.motion_resolution import BUDGET_MS
from curvrefl.curvrefl_addon.viewport.region import SETTLED_SECONDS, RegionPicture
from small_scene import build_scene

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 48, 36


class Device:
    """Its time goes with the pixels of a canvas, and it has no other."""

    def __init__(self, ms_per_pixel: float) -> None:
        self._seconds_per_pixel = 1e-3 * ms_per_pixel
        self._now = 0.0

    def clock(self) -> float:
        return self._now

    def draw(self, canvas: Canvas) -> None:
        self._now += self._seconds_per_pixel * canvas.texture.width * canvas.texture.height


def small_renderer(method: str = "exact", size: int = 1) -> tuple[Renderer, View]:
    build_scene()
    scene = bpy.context.scene
    arrays, view = read_render_scene(scene, bpy.context.view_layer, ["Mirror Ball"], size * WIDTH, size * HEIGHT)
    return Renderer(arrays, Settings(method=method, samples=4)), view


def settings(motion: str) -> Any:
    return SimpleNamespace(
        show="REFLECTION", motion_resolution=motion, stripe_direction=(0.0, 0.0, 1.0), stripe_count=3
    )


OPTIONS = SimpleNamespace(colors=DiagnosticColors())


def seen_from(view: View, step: int) -> View:
    turned = view.world_to_view.copy()
    turned[0, 3] += 1e-3 * step
    return replace(view, world_to_view=turned)


@pytest.mark.parametrize(("share_of_budget", "moving"), [(0.1, 1), (3.0, 2), (14.0, 4)])
def test_pixels_follow_the_time_they_take(share_of_budget: float, moving: int, monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, view = small_renderer()
    device = Device(share_of_budget * BUDGET_MS / (WIDTH * HEIGHT))
    monkeypatch.setattr(region, "perf_counter", device.clock)
    monkeypatch.setattr(Canvas, "wait", lambda canvas: device.draw(canvas))
    picture = RegionPicture(None, renderer)  # type: ignore[arg-type]
    for step in range(40):
        seen = seen_from(view, step)
        picture.advance(seen, settings("AUTO"), OPTIONS, 0.01 * step, False, {})
        assert picture._canvas is not None
        if step == 0:
            assert picture._canvas.texture.width == WIDTH // 2
    assert (picture._canvas.texture.width, picture._canvas.texture.height) == (WIDTH // moving, HEIGHT // moving)
    while picture.has_work:
        picture.advance(seen, settings("AUTO"), OPTIONS, 0.4 + 2.0 * SETTLED_SECONDS, False, {})
    assert (picture._canvas.texture.width, picture._canvas.texture.height) == (WIDTH, HEIGHT)
    still = renderer.render(seen).color()
    mirror = picture.pixels()[..., 3] > 0.999
    assert mirror.sum() > 100
    assert np.abs(picture.pixels() - still)[mirror].max() < 1e-5
    renderer.free()


def test_what_is_kept_is_as_fine_as_the_picture_at_rest_needs() -> None:
    """However coarse pictures are meanwhile: else all would be split again as they get finer."""
    renderer, view = small_renderer("newton", 8)
    picture = RegionPicture(None, renderer)  # type: ignore[arg-type]
    counts = []
    for step, motion in enumerate(("QUARTER", "HALF", "FULL", "QUARTER")):
        picture.advance(seen_from(view, step), settings(motion), OPTIONS, 0.01 * step, False, {})
        counts.append({**renderer.geometry.counters, **renderer.counters})
    assert counts[0]["meshes split"] > 0
    assert all(count == counts[0] for count in counts[1:])
    renderer.free()
