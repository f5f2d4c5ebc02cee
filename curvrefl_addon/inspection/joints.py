# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How smoothly surfaces of the open scene meet: along edges of one object, or between two."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import degrees
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..optics.meshes.cut_mesh import border_edges
from ..optics.meshes.joints import GRADES, Joints, joints_of_borders, joints_of_edges, mean_length
from ..scene.arrays import Float64Array
from ..scene.opened.blend_file import SURFACE_TYPES

EDGE_MARKS = {"SHARP": "sharp_edge", "SEAM": "uv_seam", "FREESTYLE": "freestyle_edge", "SELECTED": ".select_edge"}
"""Attributes of edges, which modifiers keep"""
REACH = 0.5
"""Of a border's mean edge: what two objects may be apart where nothing is chosen"""
MOST_EDGES = 20000
"""A quarter of a minute"""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """The largest that count as none."""

    gap: float = 0.0001
    """Meters"""
    angle: float = np.radians(0.1)
    """Radians"""
    curvature: float = 0.1
    """Difference over the larger of both curvatures"""


@dataclass(frozen=True, slots=True)
class CheckedJoints:
    """What came of a check. World space."""

    objects: tuple[str, ...]
    joints: Joints
    grades: NDArray[np.int64]
    """(n,) places in GRADES, -1: not measured"""
    left_out: int = 0
    """Marked edges that are no joints: not just two faces meet there"""

    def counts(self) -> list[tuple[str, int]]:
        """How many edges have which grade, the bad ones first."""
        found = [(name, int((self.grades == number).sum())) for number, name in enumerate(GRADES)]
        return [(name, count) for name, count in found if count]

    def rows(self) -> list[tuple[str, str]]:
        """Label and value, for a panel."""
        joints = self.joints
        rows = [("Edges", str(len(joints.gap))), *((name, str(count)) for name, count in self.counts())]
        if len(joints.gap):
            rows += [
                ("Largest Gap", f"{1e3 * joints.gap.max():.4g} mm"),
                ("Largest Angle", f"{_most(np.degrees(joints.angle)):.4g}\u00b0"),
                ("Curvature", f"{_most(joints.difference):.4g} 1/m apart at most"),
            ]
        return rows

    def worst(self, count: int) -> list[int]:
        """Numbers of so many edges: by grade, then by the angle."""
        order = np.lexsort((-np.nan_to_num(self.joints.angle, nan=-1.0), np.where(self.grades < 0, 9, self.grades)))
        return [int(number) for number in order[:count]]

    @property
    def messages(self) -> list[str]:
        """What is not measured, one sentence each."""
        found = []
        if self.left_out:
            found.append(f"{self.left_out} marked edges are left out: two faces meet at a joint, not one or three.")
        if lost := int((self.grades < 0).sum()):
            found.append(f"{lost} edges separate nothing: mark the edges beside them, or a whole loop.")
        if flat := int((np.isnan(self.joints.difference) & (self.grades >= 0)).sum()):
            found.append(f"{flat} edges have too few faces beside them to tell how they bend: these count as flat.")
        return found

    def sentence(self) -> str:
        """The whole in one line."""
        worst = degrees(float(_most(self.joints.angle)))
        counts = ", ".join(f"{count} {name}" for name, count in self.counts())
        return f"{len(self.joints.gap)} edges ({counts}); the largest angle is {worst:.4g}\u00b0"


def check_edges(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, marked_by: str, tolerances: Tolerances
) -> CheckedJoints:
    """Along the edges of an evaluated object that are marked by one of EDGE_MARKS.

    Raises InputError where there are none, or too many.
    """
    with _evaluated(obj, depsgraph) as mesh:
        attribute = mesh.attributes.get(EDGE_MARKS[marked_by])
        chosen = np.zeros(len(mesh.edges), bool)
        if attribute is not None and attribute.domain == "EDGE" and attribute.data_type == "BOOLEAN":
            attribute.data.foreach_get("value", chosen)
        if not chosen.any():
            raise InputError(f'"{obj.name}" has no edges {_MARKED_HOW[marked_by]}: choose how its joints are marked.')
        if chosen.sum() > MOST_EDGES:
            raise InputError(f"{int(chosen.sum())} edges are too many to measure: mark {MOST_EDGES} or fewer.")
        vertices = np.empty(2 * len(mesh.edges), np.int32)
        mesh.edges.foreach_get("vertices", vertices)
        positions, triangles = _triangulated(obj, mesh)
    joints, left_out = joints_of_edges(positions, triangles, vertices.reshape(-1, 2)[chosen])
    return _checked((obj.name,), joints, tolerances, left_out)


def check_objects(
    one: bpy.types.Object,
    other: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    reach: float,
    tolerances: Tolerances,
) -> CheckedJoints:
    """Along the border of one evaluated object where that of another is within `reach` meters; 0: half an edge.

    Raises InputError where either has no border, or they do not meet.
    """
    surfaces = []
    for obj in (one, other):
        with _evaluated(obj, depsgraph) as mesh:
            surfaces.append(_triangulated(obj, mesh))
        border = border_edges(surfaces[-1][1])
        if not len(border):
            raise InputError(f'"{obj.name}" has no open edge, so that it has no joint: choose two open surfaces.')
        if len(border) > MOST_EDGES:
            raise InputError(f'The border of "{obj.name}" has more than {MOST_EDGES} edges: make its mesh coarser.')
    (positions, triangles), (others, other_triangles) = surfaces
    reach = reach or REACH * mean_length(positions, border_edges(triangles))
    joints = joints_of_borders(positions, triangles, others, other_triangles, reach)
    if not len(joints.gap):
        raise InputError(
            f'No edge of "{one.name}" has an edge of "{other.name}" within {reach:.4g} m: make the reach larger.'
        )
    return _checked((one.name, other.name), joints, tolerances, 0)


_MARKED_HOW = {
    "SHARP": "that are marked sharp",
    "SEAM": "that are seams",
    "FREESTYLE": "that are marked for Freestyle",
    "SELECTED": "that are selected",
}


def _checked(objects: tuple[str, ...], joints: Joints, tolerances: Tolerances, left_out: int) -> CheckedJoints:
    grades = joints.grades(tolerances.gap, tolerances.angle, tolerances.curvature)
    return CheckedJoints(objects, joints, grades, left_out)


@contextmanager
def _evaluated(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Iterator[Any]:
    """The mesh of an object with its modifiers. Raises InputError for what has none."""
    if obj.type not in SURFACE_TYPES:
        raise InputError(f'"{obj.name}" has no surface: choose a mesh.')
    if obj.mode == "EDIT":
        # (What is selected comes to the object's mesh only so.)
        obj.update_from_editmode()
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    if mesh is None:
        raise InputError(f'"{obj.name}" has no surface: choose a mesh.')
    try:
        yield mesh
    finally:
        evaluated.to_mesh_clear()


def _triangulated(obj: bpy.types.Object, mesh: Any) -> tuple[Float64Array, NDArray[np.int32]]:
    """Vertices (n, 3) in world space and triangles (m, 3). Raises InputError for places that are no numbers."""
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    matrix = np.array(obj.matrix_world, np.float64)
    placed = positions.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    if not np.isfinite(placed).all():
        raise InputError(f'"{obj.name}" has vertices at no finite place: repair it.')
    triangles = corners.reshape(-1, 3)
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        triangles = triangles[:, ::-1]
    return placed, triangles


def _most(values: Float64Array) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else float("nan")
