# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature of the mirrors: found on their meshes when a view first asks for it, drawn as curvature tensors of pixels.

A mirror that only moves and turns keeps its tensors, which are turned with it; another mesh or stretch has others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...diagnostics.colors import rounded_up
from ...optics.meshes.curvature import CurvatureSum, Principal, principal_curvatures
from ...optics.surfaces.radial_surfaces import unit
from ...pacing.pieces import piece_of_work
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays
from ...scene.camera.view import View
from ...scene.meshes.corners import merge_corners
from ..device.batches import indexed_batch
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.records import record_texture
from ..device.shaders import Piece, build_shader, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..mirrors.mirror import SAME_STRETCH, Mirror
from ..mirrors.placed_mesh import polar
from ..surfaces.by_size import BySize
from ..surfaces.primary import LINEAR_DEPTH, depths_of
from ..surfaces.view_block import VIEW

PERCENTILE = 95.0
"""Of the vertices' absolute values: what an automatic range holds"""
MOST_SIZES = 2
"""A viewport draws smaller pictures while it moves"""


class MeshCurvature:
    """Of one mesh, stretched; found by and by (`advance`)."""

    def __init__(self, mesh: MeshArrays, stretch: Float64Array) -> None:
        """`stretch` (3, 3): what object space is multiplied by before it is turned and moved."""
        self.mesh, self.stretch = mesh, stretch
        # (Corners that differ by texture coordinates alone are one point of the surface.)
        merged, models = merge_corners(mesh.corner_vertex, len(mesh.positions), [mesh.corner_normals])
        self.positions: Float64Array = mesh.positions[mesh.corner_vertex[models]].astype(np.float64) @ stretch.T
        """(points, 3) stretched"""
        self.normals = unit(mesh.corner_normals[models].astype(np.float64) @ np.linalg.inv(stretch))
        self.triangles = merged[mesh.triangles]
        """(triangles, 3) of the points"""
        self._merged = merged
        self._sum: CurvatureSum | None = CurvatureSum(self.positions, self.normals, self.triangles)
        self.tensors: Float64Array = np.zeros((0, 6))
        """(points, 6) once it is complete, in the axes of the stretched mesh"""
        self._records: Any = None
        self._batch: Any = None

    def is_of(self, mesh: MeshArrays, stretch: Float64Array) -> bool:
        """Whether it is that of a mesh so stretched."""
        return mesh is self.mesh and bool(np.abs(stretch - self.stretch).max() <= SAME_STRETCH * np.abs(stretch).max())

    @property
    def is_complete(self) -> bool:
        """Nothing is left to find."""
        return self._sum is None

    def advance(self) -> None:
        """Go on for some hundredths of a second."""
        if self._sum is None:
            return
        self._sum.add_some()
        if self._sum.is_complete:
            self.tensors, self._sum = self._sum.tensors(), None

    @property
    def principal(self) -> Principal:
        """Of the points."""
        return principal_curvatures(self.tensors, self.normals)

    def uploaded(self) -> tuple[Any, Any]:
        """Records and batch of the triangles."""
        if self._records is None:
            records = np.zeros((len(self.mesh.corner_vertex), 3, 4), np.float32)
            records[:, 0, :3] = self.mesh.positions[self.mesh.corner_vertex]
            records[:, 1, :3] = self.tensors[self._merged, :3]
            records[:, 2, :3] = self.tensors[self._merged, 3:]
            self._records = record_texture(records.reshape(-1, 4))
            self._batch = indexed_batch(self.mesh.triangles)
        return self._records, self._batch


@dataclass(frozen=True, slots=True)
class CurvatureBuffer:
    """Curvature at the pixels."""

    diagonal: Any
    """RGBA32F: xx, yy, zz of the tensor in world space, 1 / m; the mirror's number"""
    across: Any
    """RGBA32F: xy, xz, yz"""
    end: float
    """What the last color stands for"""


@dataclass(frozen=True, slots=True)
class PlacedCurvature:
    """Of one mirror."""

    instance: InstanceArrays
    """Which it was found for"""
    curvature: MeshCurvature
    turn: Float64Array
    """(3, 3) rotation of the stretched mesh"""


class Curvatures:
    """Of the mirrors of a scene; those that are the same mesh with the same stretch share one."""

    def __init__(self) -> None:
        self._placed: dict[int, PlacedCurvature] = {}
        """By the instance's identity: it is another one where anything of it changes"""
        self._targets = BySize(_Target, MOST_SIZES)
        self._ends: dict[str, float] = {}

    def prepare(self, mirrors: Sequence[Mirror]) -> None:
        """Find all that is not known, in pieces (see `pacing`); what no mirror has any more is let go."""
        if any(id(mirror.instance) not in self._placed for mirror in mirrors) or len(mirrors) != len(self._placed):
            self._place(mirrors)
        for mirror in mirrors:
            found = self._placed[id(mirror.instance)].curvature
            while not found.is_complete:
                with piece_of_work(f"curvature of {mirror.object_name}"):
                    found.advance()

    def _place(self, mirrors: Sequence[Mirror]) -> None:
        before = self._meshes()
        by_mesh: dict[int, list[MeshCurvature]] = {}
        for known in before:
            by_mesh.setdefault(id(known.mesh), []).append(known)
        placed: dict[int, PlacedCurvature] = {}
        for mirror in mirrors:
            turn, stretch = polar(mirror.instance.matrix[:3, :3])
            same = by_mesh.setdefault(id(mirror.mesh), [])
            found = next((known for known in same if known.is_of(mirror.mesh, stretch)), None)
            if found is None:
                found = MeshCurvature(mirror.mesh, stretch)
                same.append(found)
            placed[id(mirror.instance)] = PlacedCurvature(mirror.instance, found, turn)
        self._placed = placed
        if set(map(id, self._meshes())) != set(map(id, before)):
            self._ends.clear()

    def _meshes(self) -> list[MeshCurvature]:
        """Each once."""
        return list({id(placed.curvature): placed.curvature for placed in self._placed.values()}.values())

    def end_of(self, kind: str) -> float:
        """An automatic range of one of `diagnostics.colors.CURVATURES`, from the mirrors that are found by now."""
        if kind in self._ends:
            return self._ends[kind]
        meshes = self._meshes()
        values = [np.abs(curvature_of(found.principal, kind)) for found in meshes if found.is_complete]
        each = np.concatenate(values) if values else np.zeros(0)
        end = rounded_up(float(np.percentile(each, PERCENTILE)) if len(each) else 0.0)
        if len(values) == len(meshes):
            self._ends[kind] = end
        return end

    def draw(self, mirrors: Sequence[Mirror], view: View, view_uniforms: Any, end: float) -> CurvatureBuffer:
        """At the pixels where mirrors would be seen if there was nothing else."""
        self.prepare(mirrors)
        target = self._targets.of(view.width, view.height)
        depths = depths_of(view)
        all_placed = [self._placed[id(mirror.instance)] for mirror in mirrors]
        uploaded = [placed.curvature.uploaded() for placed in all_placed]
        with drawing_state("LESS_EQUAL", depth_write=True, mirrored=view.is_mirrored), target.frame_buffer.bind():
            set_viewport(0, 0, view.width, view.height)
            target.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            shader = _shader(depths is not None)
            for mirror, placed, (records, batch) in zip(mirrors, all_placed, uploaded, strict=True):
                shader.bind()
                shader.uniform_block("view", view_uniforms)
                if depths is not None:
                    shader.uniform_float("depths", depths)
                shader.uniform_float("number", float(mirror.number))
                rows = placed.instance.matrix[:3].tolist()
                for axis, row, turned in zip("xyz", rows, placed.turn.tolist(), strict=True):
                    shader.uniform_float(f"place_{axis}", row)
                    shader.uniform_float(f"turn_{axis}", turned)
                shader.uniform_sampler("curved", records)
                batch.draw(shader)
        return CurvatureBuffer(target.diagonal, target.across, end)

    def known_of(self, mirrors: Sequence[Mirror]) -> list[PlacedCurvature] | None:
        """Of each mirror; None while some is not found."""
        found = [self._placed.get(id(mirror.instance)) for mirror in mirrors]
        known = [placed for placed in found if placed is not None and placed.curvature.is_complete]
        return known if len(known) == len(mirrors) else None


def curvature_of(principal: Principal, kind: str) -> Float64Array:
    """(n,) a curvature of `diagnostics.colors.CURVATURES`."""
    values: Float64Array = getattr(principal, kind.lower())
    return values


class _Target:
    """Render target of tensors."""

    def __init__(self, width: int, height: int) -> None:
        self.diagonal = empty_texture(width, height)
        self.across = empty_texture(width, height)
        self._depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.diagonal, self.across, depth=self._depth)


@gpu_cache
def _shader(has_linear_depth: bool) -> Any:
    return build_shader(
        "curvature",
        VIEW,
        *((LINEAR_DEPTH,) if has_linear_depth else ()),
        Piece(
            samplers={"curved": "FLOAT_2D"},
            constants={
                **named("VEC4", "place_x", "place_y", "place_z"),
                **named("VEC3", "turn_x", "turn_y", "turn_z"),
                "number": "FLOAT",
            },
            smooth=named("VEC3", "diagonal", "across"),
            outputs=named("VEC4", "curved_diagonal", "curved_across"),
            vertex="diagnostics/curvature.vert.glsl",
            fragment="diagnostics/curvature.frag.glsl",
        ),
    )
