# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension, registered in an empty file, and a small scene in a viewport."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import pytest
from curvrefl.curvrefl_addon import registration
from viewport.shown_session import Session


@pytest.fixture
def registered() -> Iterator[None]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    yield
    registration.unregister()


@pytest.fixture
def session(registered: None) -> Iterator[Session]:
    """A mirror, two more balls and a world."""
    chrome = bpy.data.materials.new("Chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    for name, x in (("Mirror", 0.0), ("Other", 4.0), ("Ball", 2.0)):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, location=(x, 0.0, 0.0))
        bpy.context.object.name = name
        bpy.context.object.data.materials.append(chrome)
    bpy.data.objects["Mirror"].curvrefl.is_mirror = True
    bpy.context.scene.world = bpy.data.worlds.new("World")
    made = Session()
    yield made
    made.end()
