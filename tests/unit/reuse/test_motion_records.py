# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How objects have moved between two frames, and whether their light is the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.renderer.reuse.motion import (
    MOTION_RECORDS,
    is_same_light,
    is_same_scenery,
    mirror_numbers,
    motion_records,
)
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, SceneArrays
from scenes.mirror_room import Room

NOWHERE = np.zeros(3)


def room() -> SceneArrays:
    """A ball and two rectangles, numbers 1 to 3."""
    made = Room()
    made.add_half_ball(8)
    for height in (-1.0, 1.0):
        made.add_rectangle((0.0, 0.0, height), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    return made.arrays()


def placed(scene: SceneArrays, index: int, matrix: np.ndarray, **changes: object) -> SceneArrays:
    items = list(scene.instances)
    items[index] = replace(items[index], matrix=matrix, **changes)
    return replace(scene, instances=tuple(items))


def turned(angle: float, place: tuple[float, float, float]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    matrix[:3, 3] = place
    return matrix


def test_points_go_where_they_were_with_their_object_whatever_the_origins() -> None:
    scene = room()
    now = placed(scene, 1, turned(0.4, (2.0, 0.0, 0.0)))
    then = placed(scene, 1, turned(-0.3, (0.0, 5.0, 1.0)))
    place, place_then = np.array([100.0, 0.0, 3.0]), np.array([0.0, -7.0, 0.0])
    records = motion_records(now, then, place, place_then).reshape(-1, MOTION_RECORDS, 4)
    local = np.array([0.3, -0.2, 0.1, 1.0])
    here, there = (state.instances[1].matrix @ local for state in (now, then))
    found = records[2, :3] @ np.append(here[:3] - place, 1.0)
    np.testing.assert_allclose(found, there[:3] - place_then, atol=1e-12)
    assert records[2, 3, :2].tolist() == [1.0, 2.0] and records[3, 3, 0] == 1.0
    np.testing.assert_array_equal(motion_records(now, now, NOWHERE, NOWHERE).reshape(-1, 4, 4)[1, :3], np.eye(4)[:3])


def test_what_deforms_is_gone_or_moves_in_several_ways_is_not_known() -> None:
    scene = room()

    def known(then: SceneArrays, now: SceneArrays = scene) -> list[bool]:
        found = motion_records(now, then, NOWHERE, NOWHERE).reshape(-1, MOTION_RECORDS, 4)
        return [bool(value) for value in found[1:, 3, 0]]

    assert known(scene) == [True, True, True]
    mesh = scene.meshes[1]
    bent = replace(mesh, positions=mesh.positions + np.float32([0.0, 0.0, 0.1]))
    assert known(replace(scene, meshes=(scene.meshes[0], bent, *scene.meshes[2:]))) == [True, False, True]
    assert known(replace(scene, instances=scene.instances[:2])) == [True, True, False]
    twins = [replace(item, object_id=2, object_name="twin") for item in scene.instances[1:]]
    both = replace(scene, instances=(scene.instances[0], *twins))
    assert known(both, both) == [True, True]
    apart = placed(both, 2, turned(0.1, (0.0, 0.0, 1.0)))
    assert known(apart, both) == [True, False]


def test_mirrors_are_known_by_their_objects() -> None:
    scene = room()
    numbers = mirror_numbers(scene, {0: 1, 2: 2}, scene, {0: 2, 1: 1})
    assert numbers[:, 0].tolist() == [0.0, 2.0, 0.0], "the second one was no mirror"


def test_light_is_the_same_by_value() -> None:
    scene = room()
    lamp = LightArrays("lamp", "POINT", (1.0, 1.0, 1.0), np.eye(4))
    lit, again = (replace(scene, lights=(replace(lamp, matrix=np.eye(4)),)) for _ in range(2))
    assert is_same_light(lit, again) and is_same_scenery(lit, again)
    for other in (replace(lamp, color=(0.0, 0.0, 0.0)), replace(lamp, matrix=turned(0.1, (0.0, 0.0, 0.0)))):
        assert not is_same_light(lit, replace(scene, lights=(other,)))
    assert not is_same_light(lit, scene)
    moved = placed(scene, 1, turned(0.1, (0.0, 0.0, 0.0)))
    assert is_same_light(scene, moved) and not is_same_scenery(scene, moved)
