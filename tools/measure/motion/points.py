# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflection points of some vertices, followed over frames against the oracle: pops, and what is not found."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.renderer.geometry.chunk import Chunk
from curvrefl.curvrefl_addon.renderer.mirrors.baked_shape import OPEN_LIMITS
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_bake import bake_instance
from curvrefl.curvrefl_addon.renderer.reflection import Reflection
from curvrefl.curvrefl_addon.scene.arrays import Float64Array, InstanceArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.study.solvers.oracle import Oracle
from numpy.typing import NDArray

FINE = 512
"""Texels along an edge of the oracle's map of a mirror: twice those of methods by default"""
NODES = 24
"""Along an edge of the oracle's grid"""


@dataclass
class Followed:
    """A method's errors in the frames so far."""

    last: Float64Array | None = None
    """(vertices, 2) error in the frame before, pixels; NaN where there is none"""
    worst_pop: list[float] = field(default_factory=list)
    """Of each frame: the largest change of an error since the frame before, pixels"""
    worst_error: list[float] = field(default_factory=list)
    missing: list[int] = field(default_factory=list)
    """Vertices in the picture that the oracle reflects and the method does not"""
    judged: list[int] = field(default_factory=list)

    def note(self, pixels: Float64Array, truth: Float64Array) -> None:
        """Where a method and the oracle have vertices (n, 2); NaN where nowhere, or where it does not matter."""
        error = pixels - truth
        size = np.linalg.norm(error, axis=1)
        self.judged.append(int(np.isfinite(size).sum()))
        self.worst_error.append(_largest(size))
        self.worst_pop.append(0.0 if self.last is None else _largest(np.linalg.norm(error - self.last, axis=1)))
        self.missing.append(int((np.isfinite(truth).all(axis=1) & ~np.isfinite(pixels).all(axis=1)).sum()))
        self.last = error


def _largest(values: Float64Array) -> float:
    values = values[np.isfinite(values)]
    return float(values.max(initial=0.0))


class TrueVertices:
    """Of one mirror: vertices of a scene, chosen at random, and where the oracle sees them."""

    def __init__(self, scene: SceneArrays, mirror: int, count: int) -> None:
        """`mirror`: index of its instance."""
        self.mirror = mirror
        fine = bake_instance(scene, mirror, FINE, limits=OPEN_LIMITS)
        self._instance_to_map = fine.world_to_map @ np.asarray(scene.instances[mirror].matrix, float)
        self._oracle = Oracle(CubeMapSurface(fine.radial), NODES)
        sizes = [
            0
            if item.object_id in scene.reflectors or not item.visible_glossy
            else len(scene.meshes[item.mesh].positions)
            for item in scene.instances
        ]
        starts = np.cumsum([0, *sizes])
        chosen = np.random.default_rng(1).choice(starts[-1], min(count, int(starts[-1])), replace=False)
        self.instance = np.searchsorted(starts, chosen, side="right") - 1
        self.vertex = chosen - starts[self.instance]

    def truth(self, scene: SceneArrays, view: View) -> Float64Array:
        """(n, 2) pixels; NaN of what has no reflection, or one out of the picture, or one that the mirror hides."""
        world_to_map = self._instance_to_map @ np.linalg.inv(np.asarray(scene.instances[self.mirror].matrix, float))
        points = np.empty((len(self.instance), 3))
        for index in np.unique(self.instance):
            here = self.instance == index
            item = scene.instances[index]
            local = scene.meshes[item.mesh].positions[self.vertex[here]].astype(float)
            points[here] = _moved(np.asarray(item.matrix, float), local)
        found = self._oracle.reflection_points(world_to_map @ view.eye, _moved(world_to_map, points))
        single = found.counts(len(points)) == 1
        first = found.first(len(points))
        pixels = np.full((len(points), 2), np.nan)
        pixels[single] = view.project(_moved(np.linalg.inv(world_to_map), first[single]))
        inside = (pixels >= 0.0).all(axis=1) & (pixels[:, 0] < view.width) & (pixels[:, 1] < view.height)
        pixels[~inside] = np.nan
        return pixels

    def solved(self, scene: SceneArrays, reflection: Reflection, view: View) -> Float64Array | None:
        """(n, 2) where a method has them in the picture; None where its mirror is not shown by vertices."""
        shown = next(one for one in reflection.shown if one.mirror.index == self.mirror)
        if not shown.parts:
            return None
        pixels = np.full((len(self.instance), 2), np.nan)
        for part in shown.parts:
            chunk = part.chunk
            if part.image != 0 or not isinstance(chunk, Chunk):
                continue
            points, code, _, _ = part.solution.read()
            start = 0
            for item in chunk.placed:
                # (Splitting adds vertices behind those of the mesh.)
                here = self._of_instance(scene, item.instance)
                rows = start + self.vertex[here]
                start += len(item.drawn.positions)
                reflected = code[rows] == status.REFLECTED
                chosen = np.flatnonzero(here)[reflected]
                world = points[rows[reflected]].astype(float) + reflection.origin
                pixels[chosen] = view.project(world)
        return pixels

    def _of_instance(self, scene: SceneArrays, placed: InstanceArrays) -> NDArray[np.bool_]:
        """(n,) which vertices are of it. (Where the scene is drawn about another origin its matrix is another.)"""
        here = np.zeros(len(self.instance), bool)
        for index in np.unique(self.instance):
            item = scene.instances[index]
            if item.object_id == placed.object_id:
                here |= self.instance == index
        return here


def _moved(matrix: Float64Array, points: Float64Array) -> Float64Array:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
