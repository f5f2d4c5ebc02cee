# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lights a viewport: the scene, its own studio light, an image."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.viewport.light import ViewportLight, light_of
from curvrefl.curvrefl_addon.viewport.shown_scene import MOST_RENDERERS, Look
from scenes.views import look_at
from viewport.shown_session import Session

pytestmark = pytest.mark.usefixtures("gpu")


def test_a_view_without_a_world_is_dark(session: Session) -> None:
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 60, 60, np.radians(30))
    bpy.data.worlds["World"].node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)

    def brightest() -> float:
        renderer = session.draw()
        assert renderer is not None
        return float(renderer.render(view).color()[..., :3].max())

    assert brightest() == pytest.approx(1.0, abs=1e-3)
    bpy.context.scene.world = None
    assert brightest() == 0.0
    bpy.context.view_layer.world_override = bpy.data.worlds["World"]
    assert brightest() == pytest.approx(1.0, abs=1e-3)
    bpy.context.view_layer.world_override = None
    assert brightest() == 0.0


class _Space:
    """Of a viewport, what chooses its light."""

    def __init__(self, kind: str, **shading: Any) -> None:
        light = type("Light", (), {"type": "WORLD", "path": "/light.exr"})
        options = {
            "type": kind,
            "use_scene_lights": False,
            "use_scene_world": False,
            "use_scene_lights_render": True,
            "use_scene_world_render": True,
            "selected_studio_light": light,
            "studiolight_intensity": 0.5,
            "studiolight_rotate_z": 1.0,
            **shading,
        }
        self.shading = type("Shading", (), options)


def test_environment_is_the_viewports(session: Session) -> None:
    settings = bpy.context.scene.curvrefl
    studio = ViewportLight(False, "/light.exr", strength=0.5, rotation=1.0)
    assert light_of(_Space("MATERIAL"), settings) == studio  # type: ignore[arg-type]
    assert light_of(_Space("MATERIAL", use_scene_world=True), settings) == ViewportLight(False)  # type: ignore[arg-type]
    assert light_of(_Space("RENDERED"), settings) == ViewportLight()  # type: ignore[arg-type]
    assert light_of(_Space("SOLID"), settings) == ViewportLight()  # type: ignore[arg-type]
    settings.environment = "SCENE"
    assert light_of(_Space("MATERIAL"), settings) == ViewportLight()  # type: ignore[arg-type]


def test_image_lights_the_scene(session: Session) -> None:
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 60, 60, np.radians(30))
    image = bpy.data.images.new("Sky", 8, 4, float_buffer=True)
    image.pixels.foreach_set(np.tile(np.array([0.0, 0.0, 3.0, 1.0], np.float32), 32))
    settings = bpy.context.scene.curvrefl
    settings.environment, settings.environment_image, settings.environment_strength = "IMAGE", image, 2.0
    look = Look(light_of(_Space("SOLID"), settings))  # type: ignore[arg-type]
    renderer = session.draw(look)
    assert renderer is not None
    color = renderer.render(view).color()
    np.testing.assert_allclose(color[0, 0, :3], [0.0, 0.0, 6.0], atol=1e-3)


@pytest.mark.parametrize("module", ["OpenImageIO", "images"])
def test_studio_light_file(session: Session, tmp_path: Path, module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By either reader; no image is left in the file."""
    from curvrefl.curvrefl_addon.report.images import save_exr

    if module == "images":
        monkeypatch.setitem(sys.modules, "OpenImageIO", None)
    pixels = np.zeros((4, 8, 3), np.float32)
    pixels[:2] = (0.0, 3.0, 0.0)  # below the horizon: row 0 is at the bottom
    pixels[2:] = (0.0, 0.0, 5.0)
    save_exr(tmp_path / "light.exr", pixels)
    look = Look(ViewportLight(False, str(tmp_path / "light.exr"), strength=0.5))
    renderer = session.draw(look)
    assert renderer is not None
    up, down = (
        renderer.render(look_at(np.array([0.0, 9.0, 9.0]), np.array([0.0, 30.0, 9.0 + 30 * z]), 8, 8, 0.2)).color()
        for z in (1, -1)
    )
    np.testing.assert_allclose(up[4, 4, :3], [0.0, 0.0, 2.5], atol=1e-2)
    np.testing.assert_allclose(down[4, 4, :3], [0.0, 1.5, 0.0], atol=1e-2)
    assert not bpy.data.images
    assert session.draw(Look(ViewportLight(path=str(tmp_path / "none.exr")))) is None
    assert "none.exr" in session.scene.messages[0]


def test_few_looks_are_kept(session: Session) -> None:
    for index in range(MOST_RENDERERS + 3):
        session.draw(Look(ViewportLight(strength=1.0 + index, scene_lights=bool(index % 2))))
    assert len(session.scene.renderers) == MOST_RENDERERS
