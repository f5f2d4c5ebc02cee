# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature, combs and joints as tables for other programs (CSV). Lengths are meters of world space."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Sequence
from math import degrees
from typing import Any

import bpy
import numpy as np

from ..errors import InputError
from ..optics.meshes.joints import GRADES
from ..renderer.geometry.mesh_facts import MeshFactsCache
from ..renderer.mirrors.mirror import Mirror, mirrors_of
from ..renderer.shading.combs import CombOptions, Combs
from ..renderer.shading.curvature import Curvatures
from ..scene.changes import Changes
from ..scene.extract import SceneReader
from .joints import CheckedJoints

DIGITS = 9


def read_mirrors(
    depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]
) -> list[Mirror]:
    """The instances of some objects that a depsgraph shows, as the viewports see them. Raises InputError for none."""
    if not objects:
        raise InputError("No object is marked as a mirror: mark what you inspect.")
    arrays = SceneReader().read(depsgraph, scene, objects, Changes(everything=True))
    found = mirrors_of(arrays, [], MeshFactsCache(), Counter())
    if not found:
        raise InputError("No mirror is visible here: show one.")
    return found


def curvature_table(mirrors: Sequence[Mirror]) -> str:
    """A row for each point of the surfaces: a vertex, or each side of one where normals differ."""
    curvatures = Curvatures()
    curvatures.prepare(mirrors)
    head = (
        "object",
        "point",
        *_xyz(""),
        *_xyz("normal_"),
        "gaussian",
        "mean",
        "largest",
        "smallest",
        *_xyz("largest_"),
    )
    rows: list[Sequence[Any]] = []
    for mirror, placed in zip(mirrors, curvatures.known_of(mirrors) or (), strict=True):
        found, turn = placed.curvature, placed.turn
        principal = found.principal
        numbers = np.column_stack(
            [
                found.positions @ turn.T + mirror.instance.matrix[:3, 3],
                found.normals @ turn.T,
                *(principal.gaussian, principal.mean, principal.largest, principal.smallest),
                principal.direction @ turn.T,
            ]
        )
        rows += [(mirror.object_name, point, *row) for point, row in enumerate(numbers.tolist())]
    return _written(head, rows)


def comb_table(mirrors: Sequence[Mirror], options: CombOptions) -> str:
    """A row for each tooth. Raises InputError where the plane cuts no mirror."""
    curvatures = Curvatures()
    curvatures.prepare(mirrors)
    found = Combs(curvatures).of(mirrors, options, np.zeros(3))
    if found is None or not found.combs:
        raise InputError("The plane of the section cuts no mirror: move it.")
    head = ("object", "section", "closed", "length", *_xyz(""), *_xyz("normal_"), "curvature")
    rows: list[Sequence[Any]] = []
    for number, comb in enumerate(found.combs, 1):
        section = comb.section
        numbers = np.column_stack([section.lengths, section.points, section.outwards, section.curvature])
        rows += [(comb.mirror, number, int(section.is_closed), *row) for row in numbers.tolist()]
    return _written(head, rows)


def joint_table(checked: CheckedJoints) -> str:
    """A row for each edge."""
    joints = checked.joints
    head = (
        *("edge", "grade", "gap", "angle_degrees", "curvature_1", "curvature_2", "curvature_difference"),
        *("relative_difference", *_xyz("start_"), *_xyz("end_")),
    )
    rows = [
        (
            number,
            GRADES[grade] if grade >= 0 else "",
            *(joints.gap[number], degrees(joints.angle[number]), *joints.curvature[number]),
            *(joints.difference[number], joints.relative_difference[number], *joints.edges[number].ravel()),
        )
        for number, grade in enumerate(checked.grades.tolist())
    ]
    return _written(head, rows)


def _xyz(prefix: str) -> tuple[str, ...]:
    return tuple(f"{prefix}{axis}" for axis in "xyz")


def _written(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """What is no number stays empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([_cell(value) for value in row] for row in rows)
    return text.getvalue()


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{DIGITS}g}" if np.isfinite(value) else ""
    return str(value)
