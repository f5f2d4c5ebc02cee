# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport shows of the open file, told of every update as in a window."""

from __future__ import annotations

import bpy
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.viewport.light import ViewportLight
from curvrefl.curvrefl_addon.viewport.shown_scene import Look, ViewportScene

PLAIN = Look(ViewportLight())
CAP = 1 << 30


class Session:
    """A ViewportScene that hears of updates as in a window."""

    def __init__(self) -> None:
        self.scene = ViewportScene()
        self.settings = Settings(samples=1, map_resolution=32)
        bpy.app.handlers.depsgraph_update_post.append(self._note)
        bpy.app.handlers.frame_change_post.append(self._note)

    def _note(self, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self.scene.note(depsgraph.updates, scene.frame_current)

    def draw(self, look: Look = PLAIN, cap: int = CAP) -> Renderer | None:
        bpy.context.view_layer.update()
        return self.scene.renderer(bpy.context, look, self.settings, cap, cap)

    def mirrors(self) -> list[str]:
        renderer = self.draw()
        return [] if renderer is None else sorted(mirror.object_name for mirror in renderer.mirrors)

    def end(self) -> None:
        self.scene.free()
        bpy.app.handlers.depsgraph_update_post.remove(self._note)
        bpy.app.handlers.frame_change_post.remove(self._note)


def mark(session: Session, name: str, value: bool = True) -> None:
    bpy.data.objects[name].curvrefl.is_mirror = value
    session.scene.mirrors_changed()  # (the property tells the viewport, which is not this one)
