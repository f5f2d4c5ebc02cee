# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mirrors will need split when they are larger is split by and by before, and looked up then."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from curvrefl.curvrefl_addon.renderer.geometry.placed_instances import Sight  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.split import has_long_edges  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import (  # noqa: E402
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)

pytestmark = pytest.mark.usefixtures("gpu")


def floor() -> MeshArrays:
    """From -6 to 6 at height 0."""
    corners = 6.0 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    up = np.tile(np.array([0, 0, 1], np.float32), (4, 1))
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return MeshArrays("floor", corners, np.arange(4, dtype=np.int32), up, None, triangles, np.zeros(2, np.int32))


def floors(count: int) -> SceneArrays:
    """A mirror and so many floors below it, each a mesh of its own."""
    instances = []
    for index in range(1 + count):
        matrix = np.eye(4)
        matrix[2, 3] = -0.1 * index
        instances.append(InstanceArrays(f"object {index}", index + 1, index, matrix, (0,)))
    return SceneArrays(
        meshes=tuple(floor() for _ in range(1 + count)),
        instances=tuple(instances),
        materials=(MaterialArrays("plain"),),
        images=(),
        lights=(),
        world=WorldArrays(),
        reflectors=(1,),
    )


def test_what_is_split_ahead_is_what_would_be_split_when_it_is_needed() -> None:
    now, soon = (Sight((0.0, 0.0, 1.0), angle, 0) for angle in (0.2, 0.14))
    drawn = []
    for ahead in (False, True):
        geometry = SceneGeometry()
        geometry.update(floors(4), {0: 1})
        geometry.refine([now])
        before = [item.drawn for item in geometry.placed]
        for share, done in ((0.2, 1), (0.2, 1), (1.0, 2), (1.0, 3), (1.0, 4), (1.0, 4)) if ahead else ():
            geometry.refine_ahead([soon], share)
            assert geometry.ahead.done == done, "no more than are due, and few at a time"
        assert all(item.drawn is mesh for item, mesh in zip(geometry.placed, before, strict=True)), "drawn as before"
        geometry.refine([soon])
        assert geometry.counters["meshes split"] == 8
        drawn.append([item.drawn for item in geometry.placed])
    for one, other in zip(*drawn, strict=True):
        assert np.array_equal(one.positions, other.positions)
        assert np.array_equal(one.triangles, other.triangles)


def test_what_is_split_ahead_serves_only_where_it_is_fine_enough() -> None:
    """The mirror has come closer to some floors meanwhile, one has another mesh, and one was not done in time."""
    scene = floors(4)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    geometry.refine([Sight((0.0, 0.0, 1.0), 0.2, 0)])
    for _ in range(3):
        geometry.refine_ahead([Sight((0.0, 0.0, 1.0), 0.14, 0)], 1.0)
    meshes = [*scene.meshes]
    meshes[2] = replace(meshes[2], positions=1.5 * meshes[2].positions)
    geometry.update(replace(scene, meshes=tuple(meshes)), {0: 1})
    sight = Sight((0.0, 0.0, 0.6), 0.14, 0)
    geometry.refine([sight])
    for item in geometry.placed[1:]:
        shift = item.instance.matrix[:3, 3] - np.array(sight.center)
        relative = item.drawn.positions @ item.instance.matrix[:3, :3].T + shift
        assert not has_long_edges(item.drawn, relative.astype(np.float32), sight.angle)
