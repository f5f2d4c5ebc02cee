# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as shown have the bytes of Blender's own renders; errors do not depend on how a picture is shown."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.report.as_shown import save_as_shown
from curvrefl.curvrefl_addon.report.compare import Comparison, compare_open_scene
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.report.images import load_exr
from curvrefl.curvrefl_addon.scene.camera.film import on_film
from report.stand_ins import HEIGHT, SAMPLES, WIDTH, CyclesRenderer

pytestmark = pytest.mark.usefixtures("gpu")


def show_otherwise(scene: bpy.types.Scene) -> None:
    scene.view_settings.view_transform, scene.view_settings.look = "AgX", "AgX - Punchy"
    scene.view_settings.exposure, scene.view_settings.gamma = 2.0, 1.2


def bytes_of(path: Path) -> np.ndarray:
    """(h, w, 4)"""
    image: Any = bpy.data.images.load(str(path), check_existing=False)
    image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    return np.rint(pixels * 255.0).astype(int)


@pytest.mark.parametrize("transparent", [False, True])
def test_the_picture_is_that_of_f12(blend: Path, tmp_path: Path, transparent: bool) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene = bpy.context.scene
    show_otherwise(scene)
    scene.render.film_transparent, scene.cycles.film_exposure = transparent, 0.5
    pixels = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, SAMPLES, "full").pixels
    save_as_shown(tmp_path / "ours.png", on_film(pixels, scene), scene)
    render: Any = scene.render
    render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", SAMPLES, False
    scene.cycles.use_adaptive_sampling, render.image_settings.color_mode = False, "RGBA" if transparent else "RGB"
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    render.filepath = str(tmp_path / "blender.png")
    bpy.ops.render.render(write_still=True)
    ours, blenders = bytes_of(tmp_path / "ours.png"), bytes_of(tmp_path / "blender.png")
    # (Blender may dither, and film exposure is a factor before or after the sum of samples.)
    assert np.abs(ours - blenders).max() <= 1
    assert (ours[..., 3].min() == 0) == transparent


def test_pictures_follow_the_view_and_errors_do_not(blend: Path, tmp_path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.view_settings.view_transform = "Standard"
    comparison = Comparison(("exact",), WIDTH, HEIGHT, SAMPLES, "direct", ("cycles1",))
    reports, pictures = [], []
    for name in ("plain", "otherwise"):
        reports.append(
            compare_open_scene(scene, layer, ["ball"], comparison, tmp_path / name, make_renderer=CyclesRenderer)
        )
        names = ("exact", "reference", "cycles1", "exact_error")
        pictures.append({picture: bytes_of(tmp_path / name / f"{picture}.png") for picture in names})
        show_otherwise(scene)
        scene.cycles.film_exposure = 4.0
    assert reports[0]["methods"]["exact"]["image"] == reports[1]["methods"]["exact"]["image"]
    for picture in ("exact", "reference", "cycles1"):
        assert np.abs(pictures[0][picture] - pictures[1][picture]).mean() > 10, picture
    assert np.array_equal(pictures[0]["exact_error"], pictures[1]["exact_error"])
    assert "Standard view" in (tmp_path / "plain" / "report.html").read_text()


@pytest.mark.parametrize(("space", "name"), [("Linear Rec.709", b"lin_rec709_scene"), ("ACEScg", b"lin_ap1_scene")])
def test_an_exr_holds_all_bits_and_names_its_space(tmp_path: Path, space: str, name: bytes) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if space != "Linear Rec.709":
        bpy.ops.wm.set_working_color_space(working_space=space)
    scene = bpy.context.scene
    show_otherwise(scene)
    pixels = np.random.default_rng(1).normal(size=(4, 6, 4)).astype(np.float32)
    save_as_shown(tmp_path / "a.exr", pixels, scene)
    assert name in (tmp_path / "a.exr").read_bytes()
    assert np.array_equal(load_exr(tmp_path / "a.exr"), pixels)


def test_a_picture_that_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    images = set(bpy.data.images.keys())
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(OSError, match=r"a\.png"):
        save_as_shown(tmp_path / "file" / "a.png", np.ones((2, 2, 4), np.float32), bpy.context.scene)
    assert set(bpy.data.images.keys()) == images
