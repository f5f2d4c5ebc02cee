# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth of field and motion blur are those of Cycles, in mirrors and beside them."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.camera.lens import Lens
from curvrefl.curvrefl_addon.scene.camera.shutter import Moment, shutter_times
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_moments
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.file_settings.blurred_stage import build_blurred_stage, slide

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 64, 48


class Stage:
    """Reads the open scene again and again."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self.scene = scene
        self._reader = SceneReader()
        self.still = self._read(1)[0]

    def moments(self, samples: int) -> tuple[tuple[Moment, ...], tuple[str, ...]]:
        return self._read(samples)[1:]

    def _read(self, samples: int) -> tuple[Moment, tuple[Moment, ...], tuple[str, ...]]:
        layer = bpy.context.view_layer
        return read_render_moments(self.scene, layer, ["ball"], WIDTH, HEIGHT, samples, reader=self._reader)


def cycles_picture(scene: bpy.types.Scene) -> np.ndarray:
    return render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 512).pixels[..., :3]


def drawn(stage: Stage, method: str, samples: int = 64, sharp: bool = False) -> np.ndarray:
    renderer = Renderer(stage.still.scene, Settings(method=method, samples=samples))
    view = replace(stage.still.view, lens=None) if sharp else stage.still.view
    picture = renderer.render(view, moments=() if sharp else stage.moments(samples)[0]).color()
    renderer.free()
    return picture[..., :3]


def off(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one - other).mean())


@pytest.mark.parametrize("kind", ["round", "blades", "orthographic", "focus object"])
def test_depth_of_field_is_that_of_cycles(kind: str) -> None:
    scene = build_blurred_stage(kind == "orthographic")
    dof = scene.camera.data.dof
    dof.use_dof = True
    if kind == "blades":
        dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 3, 0.4, 2.0
    if kind == "focus object":
        dof.focus_object, dof.focus_distance = bpy.data.objects["cube 2"], 1.0
    bpy.context.view_layer.update()
    expected = cycles_picture(scene)
    stage = Stage(scene)
    sharp = off(drawn(stage, "exact", sharp=True), expected)
    for method in ("exact", "secant_star", "auto") if kind == "round" else ("exact",):
        assert off(drawn(stage, method), expected) < 0.35 * sharp, method


@pytest.mark.parametrize("position", ["CENTER", "START", "END"])
def test_motion_blur_is_that_of_cycles(position: str) -> None:
    scene = build_blurred_stage()
    slide("cube 0", 0, -2.8, -0.4)
    slide("ball", 2, 0.3, 0.0)
    if position == "START":
        slide("camera", 0, 0.2, -0.2)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.8
    scene.render.motion_blur_position = position
    expected = cycles_picture(scene)
    stage = Stage(scene)
    sharp = off(drawn(stage, "exact", sharp=True), expected)
    for method in ("exact", "secant_star") if position == "CENTER" else ("exact",):
        assert off(drawn(stage, method, 16), expected) < 0.4 * sharp, method
    assert (scene.frame_current, scene.frame_subframe) == (1, 0.0)


def test_what_is_off_or_does_not_move_costs_nothing() -> None:
    scene = build_blurred_stage()
    stage = Stage(scene)
    assert stage.still.view.lens is None
    plain = drawn(stage, "exact", 4)
    scene.render.use_motion_blur = True
    assert stage.moments(4) == ((), ())
    scene.camera.data.dof.use_dof, scene.render.use_motion_blur = True, False
    bpy.context.view_layer.update()
    lens = Stage(scene).still.view.lens
    assert lens == Lens(pytest.approx(0.5), pytest.approx(5.2))
    assert np.array_equal(drawn(stage, "exact", 4), plain)


def test_one_sample_is_sharp_and_says_so() -> None:
    scene = build_blurred_stage()
    slide("cube 0", 0, -2.8, -0.4)
    scene.render.use_motion_blur = scene.camera.data.dof.use_dof = True
    bpy.context.view_layer.update()
    stage = Stage(scene)
    moments, sentences = stage.moments(1)
    assert not moments and sentences == ("Motion blur is left out: it takes more than one sample.",)
    renderer = Renderer(stage.still.scene, Settings(method="exact", samples=1))
    warnings = renderer.render(stage.still.view).warnings
    renderer.free()
    assert "Depth of field is left out: it takes more than one sample." in warnings


def test_motion_that_is_not_cycles_is_named() -> None:
    scene = build_blurred_stage()
    slide("cube 0", 0, -2.8, -0.4)
    bpy.data.objects["cube 0"].cycles.use_motion_blur = False
    scene.render.use_motion_blur, scene.cycles.rolling_shutter_type = True, "TOP"
    _, sentences = Stage(scene).moments(4)
    assert len(sentences) == 2 and '"cube 0"' in sentences[0] and "rolling shutter" in sentences[1]


def test_a_picture_after_motion_is_that_before() -> None:
    """The renderer shows the frame itself again: surfaces can be read, and the next picture has no trace."""
    scene = build_blurred_stage()
    slide("ball", 2, 0.6, -0.2)
    scene.render.use_motion_blur = True
    stage = Stage(scene)
    renderer = Renderer(stage.still.scene, Settings(method="exact", samples=4))
    before = renderer.render(stage.still.view)
    mask, picture = before.mask(), before.color()
    moved = renderer.render(stage.still.view, moments=stage.moments(4)[0])
    assert np.array_equal(moved.mask(), mask) and not np.array_equal(moved.color(), picture)
    assert np.array_equal(renderer.render(stage.still.view).color(), picture)
    renderer.free()


def test_shutter_curves_weigh_time() -> None:
    scene = build_blurred_stage()
    scene.render.motion_blur_shutter, scene.render.motion_blur_position = 0.5, "CENTER"
    assert np.sort(shutter_times(scene, 4)) == pytest.approx([-0.1875, -0.0625, 0.0625, 0.1875], abs=1e-3)
    curve = scene.render.motion_blur_shutter_curve
    points = curve.curves[0].points
    for point, place in zip(points, ((0.0, 1.0), (0.5, 1.0), (1.0, 0.0)), strict=True):
        point.location = place
    curve.update()
    assert shutter_times(scene, 64).mean() < -0.03
    scene.render.motion_blur_position = "START"
    assert shutter_times(scene, 64).min() >= 0.0


@pytest.mark.parametrize("blades", [0, 3, 6])
def test_points_on_the_aperture_are_spread_evenly(blades: int) -> None:
    points = Lens(2.0, 1.0, blades, 0.3, 0.5).points(4096)
    inside = np.hypot(points[:, 0] * 0.5, points[:, 1]) / 2.0
    assert inside.max() <= 1.0 + 1e-9
    assert points.mean(axis=0) == pytest.approx([0.0, 0.0], abs=0.02)
    # Half of the points lie within the shape of half the area.
    area = np.pi if blades == 0 else 0.5 * blades * np.sin(2 * np.pi / blades)
    assert (inside < 0.3).mean() == pytest.approx(np.pi * 0.3**2 / area, rel=0.05)
