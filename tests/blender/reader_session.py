# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene, and what has to be read of it again."""

from __future__ import annotations

from typing import Any

import bpy
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader


class Session:
    """A scene, its reader, and what its updates changed since the last read."""

    def __init__(self) -> None:
        self.reader = SceneReader()
        self.changes = Changes(everything=True)
        bpy.app.handlers.depsgraph_update_post.append(self._note)
        bpy.app.handlers.frame_change_post.append(self._note)

    def _note(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self.changes.add(depsgraph.updates)

    def read(self) -> SceneArrays:
        bpy.context.view_layer.update()
        changes, self.changes = self.changes, Changes()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return self.reader.read(depsgraph, bpy.context.scene, [bpy.data.objects["Mirror"]], changes)

    def end(self) -> None:
        bpy.app.handlers.depsgraph_update_post.remove(self._note)
        bpy.app.handlers.frame_change_post.remove(self._note)


def assert_equal(one: SceneArrays, other: SceneArrays) -> None:
    """Up to the numbers of objects, meshes and materials."""

    def picture(scene: SceneArrays) -> list[Any]:
        return [
            (
                instance.object_name,
                instance.matrix.tolist(),
                scene.meshes[instance.mesh].positions.tolist(),
                scene.meshes[instance.mesh].triangles.tolist(),
                [scene.materials[index].base_color for index in instance.materials],
                (instance.visible_camera, instance.visible_glossy, instance.visible_shadow, instance.holdout),
                instance.object_id in scene.reflectors,
            )
            for instance in scene.instances
        ]

    assert picture(one) == picture(other)
    assert [(light.name, light.color, light.matrix.tolist()) for light in one.lights] == [
        (light.name, light.color, light.matrix.tolist()) for light in other.lights
    ]
    assert one.world.color == other.world.color
