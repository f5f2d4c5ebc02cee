# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of programs: what is known of them, and that the GPU has their pixels. (How they are looked up is judged by
the cases of nodes.)"""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture
from curvrefl.curvrefl_addon.renderer.programs.image_pages import ImagePages
from curvrefl.curvrefl_addon.scene.arrays import ImageSource
from curvrefl.curvrefl_addon.scene.programs.image_headers import header_of
from curvrefl.curvrefl_addon.scene.programs.images import ProgramImages
from curvrefl.gpu_shaders.loader import Snippet

MAIN = """
void main()
{
  ShadingPoint s;
  s.records = 0;
  color = image_fetch(image_place(s, 0), ivec2(gl_FragCoord.xy));
}
"""


def source_of(values: np.ndarray, is_srgb: bool = False) -> ImageSource:
    height, width = values.shape[:2]
    is_bytes = values.dtype == np.uint8
    is_opaque = bool((values[..., 3] == (255 if is_bytes else 1.0)).all())
    return ImageSource("image", width, height, is_bytes, is_srgb, is_opaque, (0.0, 1.0), lambda: values)


def random_bytes(width: int, height: int, seed: int = 0, is_opaque: bool = False) -> np.ndarray:
    values = np.random.default_rng(seed).integers(0, 256, (height, width, 4), np.uint8)
    if is_opaque:
        values[..., 3] = 255
    return values


def on_gpu(pages: ImagePages, image: int) -> np.ndarray:
    """(h, w, 4) of an image, fetched one by one."""
    records = pages.records(image)
    width, height = (int(side) for side in records[0][1:3])
    own = Piece(samplers=named("FLOAT_2D", "program_records"), outputs={"color": "VEC4"}, defines={"ATTRIBUTES": 0})
    text = '#include "programs/images.glsl"\n' + MAIN
    shader = build_shader("image test", FULL_SCREEN, own, pages.piece, Piece(fragment=Snippet("test", text)))
    target, table = empty_texture(width, height), record_texture(np.array(records, np.float32))
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, width, height)
        shader.bind()
        shader.uniform_sampler("program_records", table)
        pages.bind(shader)
        full_screen_triangle().draw(shader)
    return read_texture(target)


@pytest.mark.usefixtures("gpu")
def test_pixels_are_the_same_on_the_gpu() -> None:
    bytes_, opaque = random_bytes(300, 17), random_bytes(2100, 1500, 1, is_opaque=True)
    floats = np.random.default_rng(2).normal(0.0, 2.0, (40, 90, 4)).astype(np.float16)
    bright = np.full((3, 2, 4), 1e6, np.float32)
    pages = ImagePages()
    assert pages.follow([source_of(values) for values in (bytes_, opaque, floats, bright)])
    assert pages.records(0)[0][1] == -1.0
    assert pages.fill() and pages.is_complete
    np.testing.assert_array_equal(np.rint(on_gpu(pages, 0) * 255), bytes_)
    np.testing.assert_array_equal(np.rint(on_gpu(pages, 1) * 255), opaque)
    np.testing.assert_array_equal(on_gpu(pages, 2), floats)
    np.testing.assert_allclose(on_gpu(pages, 3), bright, rtol=1e-3)
    assert set(pages.piece.samplers) == {"image_bytes_0", "image_halves_0"}
    assert not pages.warnings


@pytest.mark.usefixtures("gpu")
def test_what_stays_is_not_read_again() -> None:
    reads: list[int] = []
    values = random_bytes(64, 64)

    def counted(number: int) -> ImageSource:
        return ImageSource("image", 64, 64, True, False, False, (0.0, 1.0), lambda: (reads.append(number), values)[1])

    first, second, third = (counted(number) for number in range(3))
    pages = ImagePages()
    assert pages.follow([first, second])
    pages.fill()
    assert not pages.follow([first, second])
    # A third takes the rows of one that went: the shaders may stay.
    assert not pages.follow([third, first])
    assert not pages.is_complete
    pages.fill()
    assert reads == [0, 1, 2]
    np.testing.assert_array_equal(np.rint(on_gpu(pages, 0) * 255), values)
    # One more needs another texture; many more are put together in one.
    assert pages.follow([third, first, second])
    pages.fill()
    assert list(pages.piece.samplers) == ["image_bytes_0", "image_bytes_1"]
    images = [third, first, second]
    for _ in range(3):
        images = [*images, counted(9)]
        pages.follow(images)
        pages.fill()
    assert len(pages.piece.samplers) <= 3
    pages.follow(images, {1})
    assert pages.records(0)[0][1] == 0.0 and pages.records(1)[0][1] == 64.0
    assert pages.follow([])
    assert pages.bytes_used == 0 and pages.is_complete


@pytest.mark.usefixtures("gpu")
def test_the_largest_are_halved_and_named() -> None:
    small, large = random_bytes(32, 32), random_bytes(2048, 1000, 1)
    pages = ImagePages(cap=3 << 20)
    pages.follow([source_of(small), source_of(large)])
    pages.fill()
    assert pages.bytes_used <= 3 << 20
    np.testing.assert_array_equal(np.rint(on_gpu(pages, 0) * 255), small)
    means = large.reshape(500, 2, 1024, 2, 4).mean(axis=(1, 3))
    assert np.abs(np.rint(on_gpu(pages, 1) * 255) - means).max() <= 1.0
    (warning,) = pages.warnings
    assert warning.startswith('The largest images ("image") are shown at half their size or less')


@pytest.mark.usefixtures("gpu")
def test_filling_stops_after_its_time() -> None:
    pages = ImagePages()
    pages.follow([source_of(random_bytes(2048, 600, seed, is_opaque=True)) for seed in range(3)])
    calls = 1
    while not pages.fill(0.0):
        calls += 1
    assert calls >= 9
    np.testing.assert_array_equal(np.rint(on_gpu(pages, 2) * 255), random_bytes(2048, 600, 2, is_opaque=True))


@pytest.mark.usefixtures("gpu")
def test_an_image_that_is_gone_is_magenta() -> None:
    def fails() -> Any:
        raise OSError("gone")

    pages = ImagePages()
    pages.follow([ImageSource("lost", 8, 8, True, False, True, (0.0, 1.0), fails), source_of(random_bytes(8, 8))])
    assert pages.fill()
    assert pages.records(0)[0][1] == 0.0 and pages.records(1)[0][1] == 8.0
    assert pages.warnings == ('Images that can no longer be read are drawn magenta: "lost".',)


def saved(path: Path, values: np.ndarray, kind: str = "PNG") -> str:
    height, width = values.shape[:2]
    image: Any = bpy.data.images.new("saved", width, height, alpha=True)
    image.pixels.foreach_set((values.astype(np.float32) / 255.0).ravel())
    image.file_format = kind
    image.save(filepath=str(path))
    bpy.data.images.remove(image)
    return str(path)


def test_files_are_read_when_they_are_asked_for(tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    values = random_bytes(9, 6)
    images = ProgramImages()
    image = bpy.data.images.load(saved(tmp_path / "a.png", values))
    image.alpha_mode = "CHANNEL_PACKED"
    node = SimpleNamespace(image=image, image_user=None)
    assert images.index_of(node, print) == images.index_of(node, print) == 0
    (source,) = images.sources
    assert (source.width, source.height) == (9, 6) and source.is_bytes and source.is_srgb and not source.is_opaque
    np.testing.assert_array_equal(source.read(), values)
    # Blender has not been made to read it.
    assert not image.has_data
    images.restart()
    assert images.index_of(node, print) == 0 and images.sources == (source,)
    images.forget({image.session_uid})
    images.restart()
    images.index_of(node, print)
    assert images.sources != (source,) and images.reads == 2
    (tmp_path / "a.png").unlink()
    with pytest.raises(OSError):
        images.sources[0].read()
    node.image = None
    assert images.index_of(node, print) is None


def test_equal_packed_images_are_one(tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    path = saved(tmp_path / "a.png", random_bytes(9, 6))
    images = ProgramImages()
    for space in ("sRGB", "sRGB", "Non-Color"):
        image = bpy.data.images.load(path)
        image.pack()
        image.colorspace_settings.name = space
        images.index_of(SimpleNamespace(image=image, image_user=None), print)
    first, second, data = images.sources
    assert first is second and data is not first
    np.testing.assert_array_equal(data.read(), random_bytes(9, 6))


def test_headers(tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    found = {}
    for kind in ("PNG", "JPEG", "TARGA", "BMP"):
        path = saved(tmp_path / kind, random_bytes(300, 200))
        path = saved(tmp_path / kind, random_bytes(300, 200), kind) if kind != "PNG" else path
        found[kind] = header_of(Path(path).read_bytes())
    png, jpeg = found["PNG"], found["JPEG"]
    assert png is not None and (png.width, png.height, png.is_opaque) == (300, 200, False)
    assert jpeg is not None and (jpeg.width, jpeg.height, jpeg.is_opaque) == (300, 200, True)
    assert found["TARGA"] is None and found["BMP"] is None
    # Cut off anywhere they say nothing, or the truth.
    data = (tmp_path / "JPEG").read_bytes()
    for end in range(0, 700):
        assert header_of(data[:end]) in (None, jpeg)
    data = (tmp_path / "PNG").read_bytes()
    for end in range(0, 200):
        part = header_of(data[:end])
        assert part is None or (part.width, part.height, part.is_opaque) == (300, 200, False)
