# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones of directions in which rays off a mirror do not meet it again, on the GPU (`exact.frag.glsl`).

They are found while nothing else is to be done, of mirrors that are closed and may see themselves: without them a ray
looks through the boxes about the place that it leaves, and finds nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays
from ..device.records import record_texture, set_records
from ..device.shaders import Piece, flags, named
from ..geometry.mesh_facts import MeshFactsCache
from .escape_cones import CELLS, NO_CONE, EscapeBuild, EscapeCones

ROW_RECORDS = 4
"""Of a mirror: rows from world space to cells; (first of its cones, 0, 0, 0)"""
MOST_TRIANGLES = 400_000
"""Of a larger mirror to begin with takes too long"""
ESCAPES = Piece(
    records=named("FLOAT_2D", "escape_rows", "escape_cones"),
    defines={**flags("KNOWS_ESCAPES"), "ESCAPE_CELLS": CELLS, "ESCAPE_ROW_RECORDS": ROW_RECORDS},
)
"""What `exact.frag.glsl` needs: `Escapes.bind`"""


class Escapes:
    """Of the mirrors of one scene."""

    def __init__(self, facts: MeshFactsCache) -> None:
        self._facts = facts
        self._mirrors: list[tuple[int, MeshArrays, Float64Array]] = []
        """Numbers, meshes and matrices of those that may have cones"""
        self._most = 0
        """The greatest number of a mirror"""
        self._found: dict[int, tuple[MeshArrays, EscapeCones]] = {}
        """By the mesh's identity"""
        self._build: tuple[MeshArrays, EscapeBuild] | None = None
        self._uploaded: list[int] = []
        """Meshes whose cones are in the texture, in their order"""
        self._rows: Any = None
        self._cones: Any = None

    @property
    def are_known(self) -> bool:
        """Of any mirror."""
        return self._rows is not None

    def bind(self, shader: Any) -> None:
        """Set what `ESCAPES` names on a bound shader; only where they `are_known`."""
        set_records(shader, "escape_rows", self._rows)
        set_records(shader, "escape_cones", self._cones)

    def place(self, numbers: Sequence[int], meshes: Sequence[MeshArrays], instances: Sequence[InstanceArrays]) -> None:
        """Know the instances of a scene, their meshes and the numbers of mirrors among them (0: none)."""
        mirrors = [(number, meshes[k], instances[k].matrix) for k, number in enumerate(numbers) if number]
        self._most = max(numbers, default=0)
        self._mirrors = [mirror for mirror in mirrors if self._may_have_cones(*mirror[1:])]
        present = {id(mesh) for _, mesh, _ in self._mirrors}
        self._found = {key: known for key, known in self._found.items() if key in present}
        if self._build is not None and id(self._build[0]) not in present:
            self._build = None
        self._upload()

    def _may_have_cones(self, mesh: MeshArrays, matrix: Float64Array) -> bool:
        if len(mesh.triangles) > MOST_TRIANGLES or np.linalg.det(matrix[:3, :3]) <= 0.0:
            return False
        known = self._facts.of(mesh)
        return known.is_closed and not known.never_sees_itself

    @property
    def can_improve(self) -> bool:
        """Whether `improve` would do anything."""
        return any(id(mesh) not in self._found for _, mesh, _ in self._mirrors)

    def improve(self) -> None:
        """Go on finding cones: one step, some 20 milliseconds."""
        if self._build is None:
            waiting = [mesh for _, mesh, _ in self._mirrors if id(mesh) not in self._found]
            if waiting:
                self._build = (waiting[0], EscapeBuild(waiting[0]))
            return
        mesh, build = self._build
        if not build.step():
            self._build = None
            self._found[id(mesh)] = (mesh, build.finished())
            self._upload()

    def _upload(self) -> None:
        if not self._found:
            self._rows = self._cones = None
            self._uploaded = []
            return
        if list(self._found) != self._uploaded:
            self._uploaded = list(self._found)
            none = np.array([NO_CONE], np.float32)
            self._cones = record_texture(np.concatenate([none, *(known.cones for _, known in self._found.values())]))
        rows = np.zeros((self._most + 1, ROW_RECORDS, 4))
        for number, mesh, matrix in self._mirrors:
            if id(mesh) in self._found:
                cones = self._found[id(mesh)][1]
                to_object = np.linalg.inv(matrix)[:3]
                to_object[:, 3] -= cones.low
                rows[number, :3] = to_object / cones.size
                rows[number, 3, 0] = 1 + CELLS**3 * self._uploaded.index(id(mesh))
        self._rows = record_texture(rows.reshape(-1, 4).astype(np.float32))
