# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How objects have moved from one state of a scene to another, and whether what lights them is the same. Pure numpy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass

import numpy as np

from ...scene.arrays import Float64Array, MeshArrays, SceneArrays
from ..truth.motion import same_instances
from ..truth.shown_points import NOTHING

MOTION_RECORDS = 4
"""vec4 records of an object: rows of the matrix that takes its points from now to then, and (1 where that is known, its
number then, 0, 0)"""
SAME = 1e-9
"""Relative: instances of one object move alike where their matrices differ by no more"""


def motion_records(now: SceneArrays, then: SceneArrays, place: Float64Array, place_then: Float64Array) -> Float64Array:
    """(MOTION_RECORDS * (largest object_id + 1), 4) by the objects' numbers now.

    `place`, `place_then`: (3,) where in the world the coordinates of what is drawn have their origins. Not known: what
    is not there then, what deforms or is another mesh, and objects whose instances move in several ways.
    """
    other = same_instances(now, then)
    count = max((item.object_id for item in now.instances), default=0) + 1
    records = np.zeros((count, MOTION_RECORDS, 4))
    records[:, :3] = np.eye(4)[:3]
    refused: set[int] = set()
    for index, item in enumerate(now.instances):
        number = item.object_id
        matrix = None if other[index] == NOTHING else _motion(now, index, then, int(other[index]))
        if matrix is None or number in refused:
            refused.add(number)
            continue
        matrix[:3, 3] += matrix[:3, :3] @ place - place_then
        known = records[number]
        if known[3, 0] == 0.0:
            known[:3], known[3, :2] = matrix[:3], (1.0, then.instances[other[index]].object_id)
        elif not np.allclose(known[:3], matrix[:3], rtol=SAME, atol=SAME * (1.0 + np.abs(matrix[:3, 3]).max())):
            refused.add(number)
    for number in refused:
        records[number, 3, 0] = 0.0
    return records.reshape(-1, 4)


def mirror_numbers(
    now: SceneArrays, mirrors: Mapping[int, int], then: SceneArrays, mirrors_then: Mapping[int, int]
) -> Float64Array:
    """(largest mirror's number + 1, 4): the mirror's number then, 0 where it was none; `mirrors`: numbers by the
    indices of their instances."""
    other = same_instances(now, then)
    records = np.zeros((max(mirrors.values(), default=0) + 1, 4))
    for index, number in mirrors.items():
        records[number, 0] = mirrors_then.get(int(other[index]), 0)
    return records


def is_same_light(now: SceneArrays, then: SceneArrays) -> bool:
    """Whether a place that has not moved looks the same: lamps, world, materials and images are equal."""
    names = ("lights", "world", "materials", "images", "diffuse_bounces", "mirror_bounces", "indirect_clamp")
    return all(_is_same(getattr(now, name), getattr(then, name)) for name in names)


def is_same_scenery(now: SceneArrays, then: SceneArrays) -> bool:
    """Whether nothing has moved but the eye."""
    return now is then or (
        len(now.instances) == len(then.instances)
        and all(map(_is_same, now.instances, then.instances))
        and all(map(_has_same_shape, now.meshes, then.meshes))
    )


def _motion(now: SceneArrays, index: int, then: SceneArrays, other: int) -> Float64Array | None:
    """(4, 4) from world space now to then."""
    one, two = now.instances[index], then.instances[other]
    if one.shift != two.shift or not _has_same_shape(now.meshes[one.mesh], then.meshes[two.mesh]):
        return None
    if np.array_equal(one.matrix, two.matrix):
        return np.eye(4)
    try:
        return np.asarray(two.matrix @ np.linalg.inv(one.matrix), np.float64)
    except np.linalg.LinAlgError:
        return None


def _has_same_shape(mesh: MeshArrays, other: MeshArrays) -> bool:
    return mesh is other or all(
        _is_same(getattr(mesh, name), getattr(other, name))
        for name in ("positions", "triangles", "corner_vertex", "corner_normals")
    )


def _is_same(one: object, other: object) -> bool:
    """Equality that knows arrays. What is compared by identity alone (`eq=False`) stays so."""
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_is_same, one, other))
    if is_dataclass(one) and type(one).__eq__ is not object.__eq__:
        return all(_is_same(getattr(one, item.name), getattr(other, item.name)) for item in fields(one))
    return one == other
