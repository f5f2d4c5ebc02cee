# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bake operator on Blender's own meshes, without a screen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_files import load
from curvrefl.operators.bake_reflector import CLASSES

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def operator() -> Iterator[None]:
    """The operator in an empty file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    already_there = hasattr(bpy.types, "CURVREFL_OT_bake_reflector")
    if not already_there:
        for cls in CLASSES:
            bpy.utils.register_class(cls)
    yield
    if not already_there:
        for cls in CLASSES:
            bpy.utils.unregister_class(cls)


def add_ball(name: str, place: tuple[float, float, float], radius: float = 1.0) -> bpy.types.Object:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=radius, location=place)
    ball = bpy.context.active_object
    assert ball is not None
    ball.name = name
    bpy.ops.object.shade_smooth()
    return ball


def test_the_active_object_is_baked(tmp_path: Path) -> None:
    add_ball("Other", (5.0, 0.0, 0.0))
    ball = add_ball("Ball", (1.0, 2.0, 3.0), 2.0)
    ball.scale = (1.0, -0.5, 1.0)
    ball.rotation_euler = (0.3, 0.7, -1.0)
    assert bpy.ops.curvrefl.bake_reflector(resolution=32, folder=str(tmp_path / "maps")) == {"FINISHED"}
    baked = load(tmp_path / "maps")
    assert baked.object_name == "Ball" and baked.resolution == 32
    np.testing.assert_allclose(baked.center, [1.0, 2.0, 3.0], atol=1e-3)
    assert baked.r_min == pytest.approx(1.0, rel=1e-2) and baked.r_max == pytest.approx(2.0, rel=1e-2)
    assert baked.holes == 0.0 and baked.multiple_hits == 0.0
    assert [path.name for path in tmp_path.iterdir()] == ["maps"]


def test_a_reflector_is_named(tmp_path: Path) -> None:
    add_ball("Ball", (-4.0, 0.0, 0.0))
    add_ball("Other", (5.0, 0.0, 0.0))
    bpy.ops.curvrefl.bake_reflector(reflector="Ball", resolution=8, folder=str(tmp_path))
    np.testing.assert_allclose(load(tmp_path).center, [-4.0, 0.0, 0.0], atol=1e-3)


def test_modifiers_count(tmp_path: Path) -> None:
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    cube = bpy.context.active_object
    assert cube is not None
    cube.modifiers.new("Round", "SUBSURF").render_levels = 4
    cube.modifiers["Round"].levels = 4
    bpy.ops.curvrefl.bake_reflector(resolution=16, folder=str(tmp_path))
    baked = load(tmp_path)
    assert baked.r_max < 1.2 and baked.r_max / baked.r_min < 1.2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"reflector": "Bal"}, "Bal"),
        ({"folder": ""}, "folder"),
        ({"folder": "//maps"}, "Save the file first"),
        ({"reflector": "Ring"}, "star-shaped"),
    ],
)
def test_mistakes_are_told_and_nothing_is_written(options: dict[str, str], words: str, tmp_path: Path) -> None:
    bpy.ops.mesh.primitive_torus_add(location=(0.0, 8.0, 0.0))
    bpy.context.active_object.name = "Ring"
    add_ball("Ball", (0.0, 0.0, 0.0))
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.curvrefl.bake_reflector(**{"folder": str(tmp_path / "maps"), **options})
    assert not list(tmp_path.iterdir())


def test_without_an_active_object_a_name_is_asked_for(tmp_path: Path) -> None:
    add_ball("Ball", (0.0, 0.0, 0.0))
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="name one"):
        bpy.ops.curvrefl.bake_reflector(folder=str(tmp_path / "maps"))


def test_a_scene_without_meshes_offers_no_bake() -> None:
    assert not bpy.ops.curvrefl.bake_reflector.poll()
    add_ball("Ball", (0.0, 0.0, 0.0))
    assert bpy.ops.curvrefl.bake_reflector.poll()
