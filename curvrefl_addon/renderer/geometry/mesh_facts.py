# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is worth knowing of a mesh whatever its placement, found once."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, MeshArrays
from .convexity import is_convex
from .mesh_inside import is_closed
from .mesh_pieces import MeshPieces, box_of, mesh_pieces, piece_steps, pieces_of_box
from .solid import solid_side
from .split import longest_edge
from .split_normals import sharpest_bend, sharpest_split


class MeshFacts:
    """Object space; each found when first asked for."""

    def __init__(self, mesh: MeshArrays) -> None:
        self.mesh = mesh
        self.loose: NDArray[np.int8] | None = None
        """Of a mesh that deforms (triangles,) zeros, for `pieces_of_box`"""

    @cached_property
    def box(self) -> tuple[Float32Array, Float32Array]:
        """Lowest and highest corner (3,) of the box around the mesh."""
        return box_of(self.mesh.positions)

    @cached_property
    def longest_edge(self) -> float:
        return longest_edge(self.mesh)

    @cached_property
    def is_convex(self) -> bool:
        return is_convex(self.mesh)

    @cached_property
    def is_closed(self) -> bool:
        return is_closed(self.mesh)

    @cached_property
    def sharpest_split(self) -> float:
        """Largest angle, radians, between shading normals that corners of triangles have in one place."""
        return sharpest_split(self.mesh)

    @cached_property
    def sharpest_bend(self) -> float:
        """Largest angle, radians, that shading normals turn by within a triangle."""
        return sharpest_bend(self.mesh)

    @property
    def never_sees_itself(self) -> bool:
        """As a mirror."""
        return self.is_convex and self.is_closed

    @cached_property
    def solid_side(self) -> int:
        """See `solid.solid_side`."""
        return solid_side(self.mesh)

    def piece_steps(self) -> Generator[None, None, MeshPieces]:
        """`pieces`, found in steps."""
        if self.loose is None and "pieces" not in self.__dict__:
            self.__dict__["pieces"] = yield from piece_steps(self.mesh)
        return self.pieces

    @cached_property
    def pieces(self) -> MeshPieces:
        """Planes on its hull and outlines, for shadow maps."""
        return mesh_pieces(self.mesh) if self.loose is None else pieces_of_box(*self.box, self.loose)


class MeshFactsCache:
    """By identity: arrays are frozen, an edited mesh is another one."""

    def __init__(self) -> None:
        self._facts: dict[int, MeshFacts] = {}
        self.is_loose = True
        """What deforms is a box to shadow maps, which saves time where it does so all the time"""

    def of(self, mesh: MeshArrays) -> MeshFacts:
        facts = self._facts.get(id(mesh))
        if facts is None:
            facts = self._facts[id(mesh)] = MeshFacts(mesh)
        return facts

    def deform(self, before: MeshArrays, mesh: MeshArrays) -> MeshFacts:
        """Know a mesh as another one with its vertices elsewhere (`is_deformed`)."""
        loose = self.of(before).loose
        found = self.of(mesh)
        if found.loose is None and self.is_loose:
            found.loose = np.zeros(len(mesh.triangles), np.int8) if loose is None else loose
        return found

    def keep(self, meshes: Iterable[MeshArrays]) -> None:
        """Forget all others."""
        kept = {id(mesh) for mesh in meshes}
        self._facts = {key: facts for key, facts in self._facts.items() if key in kept}
