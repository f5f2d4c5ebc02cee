# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Anamorphoses rendered by the exact method show the picture that was wished for.

What is wished for is the picture hung into its frame before the eye: the mean of its colors at the very places through
which the renderer's sub-frames look, between its pixels as textures are looked up. Pixels count that lie, with those
around them, wholly within the frame and the mirror.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo import anamorphosis as demo
from curvrefl.curvrefl_addon.design.anamorphosis import results
from curvrefl.curvrefl_addon.design.anamorphosis.making import Making, begin
from curvrefl.curvrefl_addon.design.anamorphosis.picture import Picture
from curvrefl.curvrefl_addon.design.anamorphosis.picture_frame import FrameChoice
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes
from curvrefl.curvrefl_addon.design.stage import read_stage
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.pixel_filter import offsets
from curvrefl.curvrefl_addon.report.metrics import flip_in_mask
from curvrefl.curvrefl_addon.scene.arrays import Float32Array
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = (240, 180)
SAMPLES = 8
SCALES = {"sphere": 0.45}
"""Of frames that are smaller than usual: a ball shows the sky by most of itself"""
TEXELS = {"free_form": 2048}
"""Along a side of the image, more than usual where little of it is seen"""


def picture_file(folder: Path, size: int = 128) -> Path:
    path = folder / "picture.png"
    path.write_bytes(png_bytes(demo.picture(size)))
    return path


def framed(path: Path, scale: float = 0.7, surfaces: tuple[str, ...] = (demo.PAPER,)) -> tuple[bpy.types.Image, Making]:
    """The picture on the mirror of the open scene."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    image, picture = results.read_picture(path)
    stage = read_stage(scene, view_layer, [demo.MIRROR], surfaces, None, SIZE, "")
    return image, begin(stage, picture, FrameChoice(scale=scale), fineness=256)


def rendered() -> tuple[Float32Array, np.ndarray]:
    """(h, w, 4) the open scene, and (h, w) where its mirror is with all pixels about."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    arrays, view = read_render_scene(scene, view_layer, [demo.MIRROR], *SIZE)
    renderer = Renderer(arrays, Settings(method="exact", samples=SAMPLES))
    frame = renderer.render(view)
    color, mask = frame.color(), frame.mask() > 0
    renderer.free()
    for y in (-1, 0, 1):
        for x in (-1, 0, 1):
            mask = mask & np.roll(frame.mask() > 0, (y, x), axis=(0, 1))
    return color, mask


def wished(making: Making) -> tuple[Float32Array, np.ndarray]:
    """(h, w, 4) the picture in its frame, and (h, w) whether all of a pixel is within."""
    width, height = SIZE
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    total, inside = np.zeros((height, width, 4)), np.ones((height, width), bool)
    for dx, dy in offsets(SAMPLES):
        places = np.column_stack([((x + dx) / width).ravel(), ((y + dy) / height).ravel()])
        places = making.anamorphosis.frame.in_picture(places)
        inside &= ((places > 0.0) & (places < 1.0)).all(axis=1).reshape(height, width)
        total += making.picture.at(places).reshape(height, width, 4) / SAMPLES
    return total.astype(np.float32), inside


@pytest.mark.parametrize("shape", demo.MIRRORS)
def test_the_mirror_shows_the_picture(shape: str, tmp_path: Path) -> None:
    demo.build_anamorphosis(shape, *SIZE)
    image, making = framed(picture_file(tmp_path), SCALES.get(shape, 0.7))
    texels = TEXELS.get(shape, 1024)
    placed = making.image(making.stage.surfaces[0], texels, texels)
    landing, sentences = making.told([placed])
    assert landing.shown > 0.995 and not any("larger image" in sentence for sentence in sentences)
    put = results.keep_image("Anamorphosis", placed.pixels, image)
    paper = bpy.data.objects[demo.PAPER]
    results.put_on(paper, results.picture_material("A", put, "", "EMISSION", (0.8, 0.8, 0.8), is_clipped=False))
    color, mask = rendered()
    expected, inside = wished(making)
    mask &= inside
    assert mask.sum() > 3000
    flip = flip_in_mask(color, expected, mask)
    assert flip is not None and flip < 0.02
    # It is the picture by far: the same one turned round is another one.
    assert flip_in_mask(color, np.where(mask[..., None], expected[:, ::-1], color), mask) > 0.1
    # Hidden parts are empty: the paper under the mirror, and far from the picture.
    assert (placed.pixels[..., 3] == 0.0).mean() > 0.3


def test_what_lands_nowhere_is_said(tmp_path: Path) -> None:
    """Of a frame that is larger than the mirror, on a sheet that is cut off, with a thing on it."""
    demo.build_anamorphosis("cylinder", *SIZE)
    sheet = bpy.data.objects[demo.PAPER]
    sheet.scale.x = 0.3
    bpy.ops.mesh.primitive_cube_add(size=0.03, location=(0.0, -0.12, 0.015))
    bpy.context.active_object.name = "Dice"
    _, making = framed(picture_file(tmp_path, 1024), 1.3)
    landing, sentences = making.told([making.image(making.stage.surfaces[0], 256, 256)])
    parts = [landing.shown, landing.off_mirror, landing.background, landing.twice, landing.outside]
    assert sum(parts) + sum(landing.elsewhere.values()) == pytest.approx(1.0)
    assert landing.off_mirror > 0.2 and landing.background > 0.05 and landing.elsewhere["Dice"] > 0.005
    assert any(sentence.endswith("is not on the mirror.") for sentence in sentences)
    assert any(sentence.endswith('lands on "Dice".') for sentence in sentences)
    # The sheet's texels hold many pixels of so small a picture of it.
    assert any("larger image" in sentence for sentence in sentences)


def test_places_that_share_texels_are_counted(tmp_path: Path) -> None:
    """The UV map of the paper's right half is that of its left one, mirrored."""
    demo.build_anamorphosis("cylinder", *SIZE)
    mesh = bpy.data.objects[demo.PAPER].data
    bpy.context.view_layer.objects.active = bpy.data.objects[demo.PAPER]
    _, whole = framed(picture_file(tmp_path))
    assert whole.told([whole.image(whole.stage.surfaces[0], 512, 512)])[0].twice < 0.005
    mesh.clear_geometry()
    half = 0.5 * demo.SHEET
    positions = [(-half, -half, 0), (0, -half, 0), (half, -half, 0), (half, half, 0), (0, half, 0), (-half, half, 0)]
    mesh.from_pydata(positions, [], [(0, 1, 4, 5), (1, 2, 3, 4)])
    layer = mesh.uv_layers.new(name="UVMap")
    places = [(0, 0), (1, 0), (1, 1), (0, 1), (1, 0), (0, 0), (0, 1), (1, 1)]
    layer.uv.foreach_set("vector", np.array(places, np.float32).ravel())
    _, folded = framed(picture_file(tmp_path))
    landing = folded.told([folded.image(folded.stage.surfaces[0], 512, 512)])[0]
    assert landing.twice == pytest.approx(0.5, abs=0.05) and landing.shown == pytest.approx(0.5, abs=0.05)


def test_a_picture_with_alpha_leaves_the_paper_free() -> None:
    own = np.ones((16, 16, 4), np.float32)
    own[:, :8, 3] = 0.0
    demo.build_anamorphosis("cylinder", *SIZE)
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    stage = read_stage(scene, view_layer, [demo.MIRROR], [demo.PAPER], None, SIZE, "")
    making = begin(stage, Picture(own, True), FrameChoice(), fineness=64)
    placed = making.image(stage.surfaces[0], 256, 256)
    alpha = placed.pixels[..., 3]
    assert (alpha > 0.99).sum() > 500
    # The left of the picture is where x < 0 in this symmetric view.
    assert alpha[:, :108].max() == 0.0 and placed.pixels[alpha > 0.5][:, :3].min() > 0.99
