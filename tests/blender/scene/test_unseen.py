# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is not shown is said, by the name of its object; and what is hidden is not."""

from __future__ import annotations

from pathlib import Path

import bpy
import pytest
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_rendered
from scenes.awkward import SCENES


def warnings_of(name: str, tmp_path: Path) -> str:
    SCENES[name].build(tmp_path)
    return said()


def said() -> str:
    scene, layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and layer is not None
    return "\n".join(read_rendered(scene, layer, ["Mirror"]).warnings)


@pytest.mark.parametrize(
    ("name", "kind", "thing"),
    [
        ("volume_object", "Volumes", "Cloud"),
        ("grease_pencil", "Grease pencil strokes", "Drawing"),
    ],
)
def test_unseen_kinds_are_named(name: str, kind: str, thing: str, tmp_path: Path) -> None:
    assert f'{kind} of object "{thing}"' in warnings_of(name, tmp_path)
    bpy.data.objects[thing].hide_render = True
    assert thing not in said()


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("clamp_direct", "The clamping of direct light, a setting of Cycles, is not followed."),
        ("pixel_filter", "The pixel filter of 6 pixels is not followed: pictures are sharper than that."),
        ("view_layer_no_solid", 'View layer "ViewLayer" leaves out solid surfaces: they are shown all the same.'),
    ],
)
def test_settings_of_whole_pictures_are_named(name: str, sentence: str, tmp_path: Path) -> None:
    assert sentence in warnings_of(name, tmp_path)
    SCENES["plain"].build(tmp_path)
    assert sentence not in said()


def test_a_view_layer_without_its_sky_is_dark(tmp_path: Path) -> None:
    SCENES["view_layer_no_sky"].build(tmp_path)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and layer is not None
    assert read_rendered(scene, layer, ["Mirror"]).world.color == (0.0, 0.0, 0.0)
    layer.use_sky = True
    assert max(read_rendered(scene, layer, ["Mirror"]).world.color) > 0.1


@pytest.mark.usefixtures("gpu")
def test_the_gpu_is_there_after_a_file_with_grease_pencil(tmp_path: Path) -> None:
    """Blender draws grease pencil behind every engine, with a GPU context that it takes away again."""
    import gpu

    warnings_of("grease_pencil", tmp_path)
    assert gpu.types.GPUTexture((4, 4)) is not None
