# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays find their scene in a texture, or on a software driver in an image: both are the same numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from curvrefl.curvrefl_addon.gpu_caches import clear_gpu_caches
from curvrefl.curvrefl_addon.renderer.device import records, shaders
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RAYS
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.gpu_shaders.loader import Snippet
from scenes.mirror_halls import hall
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture
def fresh_shaders() -> Iterator[None]:
    """Before and after: shaders are built for the way that records are read."""
    clear_gpu_caches()
    yield
    clear_gpu_caches()


def picture(are_images: bool, monkeypatch: pytest.MonkeyPatch) -> dict[str, np.ndarray]:
    """Of a mirror that sees itself, with shadows by rays."""
    clear_gpu_caches()
    for module in (records, shaders):
        monkeypatch.setattr(module, "records_are_images", lambda: are_images)
    view = look_at(np.array((0.0, -3.0, 4.0)), np.zeros(3), 120, 90, 0.6)
    renderer = Renderer(hall("bowl"), Settings(method="exact", samples=1, shadow_rays=True))
    frame = renderer.render(view)
    found = {"color": frame.color(), **frame.surfaces}
    renderer.free()
    return found


@pytest.mark.usefixtures("fresh_shaders")
def test_records_are_the_same_numbers_as_textures_and_as_images(monkeypatch: pytest.MonkeyPatch) -> None:
    as_textures, as_images = picture(False, monkeypatch), picture(True, monkeypatch)
    assert (as_textures["reflected_position"][..., 3] > 0.0).sum() > 500
    for name, one in as_textures.items():
        np.testing.assert_array_equal(one, as_images[name], err_msg=name)


def test_a_software_driver_reads_them_as_images(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, backend, is_software in (
        ("llvmpipe (LLVM 15.0.6, 256 bits)", "OPENGL", True),
        ("llvmpipe (LLVM 15.0.6, 256 bits)", "VULKAN", False),
        ("NVIDIA H200/PCIe/SSE2", "OPENGL", False),
    ):
        monkeypatch.setattr(records.context, "renderer_name", lambda name=name: name)
        monkeypatch.setattr(records.context, "backend_name", lambda backend=backend: backend)
        assert records.context.is_software_opengl() == is_software


def test_a_shader_of_which_the_compiler_finds_that_it_follows_no_rays_is_bound() -> None:
    """As of surfaces in a scene all of whose rays are shared."""
    nothing = shaders.Piece(fragment=Snippet("a test", "void main() { color = vec4(1.0); }"))
    color = shaders.Piece(outputs={"color": "VEC4"})
    shader = shaders.build_shader("of a test", shaders.FULL_SCREEN, color, RAYS, nothing)
    renderer = Renderer(hall("bowl"), Settings(method="exact", samples=1))
    shader.bind()
    renderer.rays().bind(shader)
    renderer.free()
