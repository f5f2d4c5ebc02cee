# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that meshes get as they come and go."""

from __future__ import annotations

from typing import Any

import bpy
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from curvrefl.curvrefl_addon.scene.meshes.mesh_store import MeshStore
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds
from extraction import add_mesh


class Unsearchable(list[MeshArrays]):
    """May be read at a place, not searched."""

    def __iter__(self) -> Any:
        raise AssertionError("searched")

    def __contains__(self, _item: object) -> bool:
        raise AssertionError("searched")


def test_a_free_number_for_a_mesh_is_not_searched_for() -> None:
    """The lowest that is free, so that there are no more numbers than meshes were ever there at once."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects = [add_mesh(f"Mesh {index}", 1.0 + index) for index in range(20)]
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = [obj.evaluated_get(depsgraph) for obj in objects]
    store = MeshStore()
    store.meshes = Unsearchable()

    def walk(chosen: list[int]) -> list[int]:
        store.begin()
        numbers = [store.read(evaluated[index], 1 + index, MeshNeeds(), False).number for index in chosen]
        store.end()
        return numbers

    assert walk(list(range(12))) == list(range(12))
    assert walk([0, 1, 4, 5, 8, 9]) == [0, 1, 4, 5, 8, 9]
    assert walk([0, 1, 4, 5, 8, 9, *range(12, 20)]) == [0, 1, 4, 5, 8, 9, 2, 3, 6, 7, 10, 11, 12, 13]
    for number, index in zip([2, 13], [12, 19], strict=True):
        assert store.meshes[number].positions.max() == 1.0 + index
