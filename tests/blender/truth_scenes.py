# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose mirrors' truth is known, drawn with it read."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.truth.truth import MirrorTruth
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import Room

RED = (0.5, 0.25, 0.125)


def drawn(scene: SceneArrays, view: View, method: str = "exact", bounces: int = 4) -> Frame:
    """With its truth read."""
    renderer = Renderer(scene, Settings(method=method, samples=1, bounces=bounces))
    frame = renderer.render(view)
    assert frame.surfaces and isinstance(frame.truth, MirrorTruth)
    renderer.free()
    return frame


def with_mirrors(room: Room, *mirrors: int) -> SceneArrays:
    """Things of these numbers are mirrors, the others red; each rectangle has its corners' order as UV map."""
    arrays = room.arrays()
    red = MaterialArrays("red", base_color=RED)
    chosen = [
        replace(item, materials=(1 if item.object_id in mirrors else 2,), object_id=10 * item.object_id)
        for item in arrays.instances
    ]
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    meshes = [replace(mesh, corner_uv=corners if len(mesh.positions) == 4 else None) for mesh in arrays.meshes]
    return replace(
        arrays,
        instances=tuple(chosen),
        meshes=tuple(meshes),
        materials=(*arrays.materials, red),
        reflectors=tuple(10 * number for number in mirrors),
    )
