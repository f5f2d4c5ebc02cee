# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mirrors show until their scene is there: its background alone, in a coarse picture."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..renderer.renderer import Renderer
from ..renderer.settings import Settings
from ..renderer.surfaces.canvas import Canvas
from ..scene.arrays import MaterialArrays, SceneArrays, WorldArrays
from ..scene.camera.view import View
from .composite import composite

SHARE = 4
"""Of the region's width and height, one part"""
SETTINGS = Settings(method="exact", samples=1)
METAL = MaterialArrays("mirror", base_color=(0.9, 0.9, 0.9), metallic=1.0, roughness=0.0)


class Sketch:
    """Of one scene; `free()` when done."""

    def __init__(self, scene: SceneArrays, background: tuple[float, float, float]) -> None:
        """A scene with its mirrors, whatever it lacks; `background`: scene-linear."""
        self._scene, self._background = scene, background
        self._renderer = Renderer(_mirrors_of(scene, background), SETTINGS)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        if scene is not self._scene:
            self._scene = scene
            self._renderer.update(_mirrors_of(scene, self._background))

    def show(self, view: View, frame_buffer: Any, viewport: tuple[int, int, int, int]) -> None:
        """Put it over a viewport's own picture."""
        size = (max(view.width // SHARE, 1), max(view.height // SHARE, 1))
        small = replace(view, width=size[0], height=size[1], lens=None)
        canvas = Canvas.of_size(*size, linear=True)
        self._renderer.add_sub_frame(canvas, self._renderer.reflect(small, solve=False), 0, 1.0, mirrors_only=True)
        composite(canvas, 1, frame_buffer, viewport)

    def free(self) -> None:
        """Let go of all GPU resources."""
        self._renderer.free()


def _mirrors_of(scene: SceneArrays, background: tuple[float, float, float]) -> SceneArrays:
    """The mirrors alone, of plain metal: without a shadow to be drawn."""
    instances = tuple(
        replace(instance, materials=(0,), visible_shadow=False, values=())
        for instance in scene.instances
        if instance.object_id in scene.reflectors
    )
    world = WorldArrays(color=background)
    return SceneArrays(
        meshes=scene.meshes,
        instances=instances,
        materials=(METAL,),
        images=(),
        lights=(),
        world=world,
        reflectors=scene.reflectors,
    )
