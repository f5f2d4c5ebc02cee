# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame in which the points of one mirror are searched for, and the maps of its shape that go with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from ...errors import InputError
from ...scene.arrays import Float64Array, InstanceArrays
from ...scene.camera.view import View
from ..device.cubes import cube_texture
from ..geometry.chunk import Batches, Chunk
from ..geometry.mesh_facts import MeshFacts
from ..geometry.placed_instances import CORNERS
from .companion import closed_companion
from .map_fit import MapFit
from .mirror_plane import Plane, flat_parts
from .placed_mesh import polar
from .reflector_bake import Limits, bake_placed
from .reflector_map import ReflectorMap

OPEN_LIMITS = Limits(holes=0.6)
"""Of the maps of open mirrors, for methods that take them"""
OPEN_SHARE = 0.02
"""Share of directions without a surface from which on a mirror counts as open: it may show its inner side"""


class BakedShape:
    """One mirror's radial map at one resolution, or why there is none.

    A shape that no radial map can hold has none: methods that need one raise its `refusal`. An open mirror has both,
    for methods that take open ones and for those that do not. Without a map the frame is about the middle of the box.
    """

    def __init__(self, facts: MeshFacts, instance: InstanceArrays, resolution: int) -> None:
        """Bakes, unless `resolution` (texels along an edge of the cube map) is 0. Needs a GPU context only for that."""
        start = perf_counter()
        self.resolution = resolution
        self.map: ReflectorMap | None = None
        self.refusal: InputError | None = None
        self.radial: Any = None
        """Cube texture of the map"""
        self.world_to_map, self.bound = _bounding_frame(facts, instance)
        """(4, 4) rigid, and the largest distance of the surface from the frame's origin, meters"""
        if resolution > 0:
            try:
                self.map = bake_placed(facts.mesh, instance, resolution)
            except InputError as error:
                self.refusal = error
                self.map = _open_map(facts, instance, resolution, 2.0 * self.bound)
        if self.map is not None:
            self.radial = cube_texture(self.map.radial)
            self.world_to_map, self.bound = self.map.world_to_map, self.map.r_max
        self.bake_ms = 1e3 * (perf_counter() - start)
        self._facts, self._instance = facts, instance
        self._parametric: Any = None
        self._planes: Sequence[Plane] | None = None
        self._companion: tuple[Chunk, Batches] | None = None
        self._fit: MapFit | None = None

    def move(self, world_to_map: Float64Array, instance: InstanceArrays) -> None:
        """Be where the same shape is now."""
        self.world_to_map, self._instance = world_to_map, instance
        self._companion = None
        if self.map is not None:
            self.map = replace(self.map, world_to_map=world_to_map, object_name=instance.object_name)

    @property
    def center(self) -> Float64Array:
        """(3,) star center in world space; the middle of a shape without radial map."""
        return -self.world_to_map[:3, :3].T @ self.world_to_map[:3, 3]

    @property
    def nearest_surface(self) -> float:
        """Meters from the center to the surface, or less."""
        return self.map.r_min if self.map is not None else 1e-3 * self.bound

    @property
    def warnings(self) -> tuple[str, ...]:
        """Of the map, one sentence each."""
        return () if self.map is None else self.map.warnings

    @property
    def is_open(self) -> bool:
        """Whether it may show its inner side."""
        return self.map is not None and self.map.holes > OPEN_SHARE

    def radius_pixels(self, view: View) -> float:
        """Size of the ball around it in the picture, or in the one that this one stands for."""
        distance = 1.0
        if not view.is_orthographic:
            distance = max(float(np.linalg.norm(view.eye[:3] - self.center)), self.bound)
        return view.stands_for * view.focal_pixels * self.bound / distance

    def parametric(self) -> Any:
        """Its parametric map, baked when first asked for. Raises InputError where it has no UV map that serves."""
        from .parametric_map import bake_parametric

        if self._parametric is None:
            self._parametric = bake_parametric(self._facts.mesh, self._instance, self.world_to_map)
        return self._parametric

    def planes(self) -> Sequence[Plane]:
        """Its flat parts, found when first asked for."""
        if self._planes is None:
            self._planes = flat_parts(self._facts.mesh, self._instance, self.world_to_map)
        return self._planes

    def companion(self) -> tuple[Chunk, Batches] | None:
        """The closed shape that goes with an open mirror; None without a map."""
        if self._companion is None and self.map is not None:
            self._companion = closed_companion(self.map, self._instance, self.world_to_map)
        return self._companion

    def fit(self) -> MapFit:
        """How far the map is off the mesh; there must be a map."""
        assert self.map is not None
        if self._fit is None:
            self._fit = MapFit(self._facts.mesh, self._instance, self.map)
        return self._fit


def _open_map(facts: MeshFacts, instance: InstanceArrays, resolution: int, largest: float) -> ReflectorMap | None:
    """The map of an open mirror; None where there is none that reaches no farther than `largest` meters."""
    try:
        found = bake_placed(facts.mesh, instance, resolution, limits=OPEN_LIMITS)
    except InputError:
        # The caller has the sentence that says why not.
        return None
    return found if found.r_max <= largest else None


def _bounding_frame(facts: MeshFacts, instance: InstanceArrays) -> tuple[Float64Array, float]:
    """World to a frame about the middle of an instance's box, and the box's half diagonal, meters."""
    rotation, _ = polar(instance.matrix[:3, :3])
    low, high = (np.asarray(end, np.float64) for end in facts.box)
    center = instance.matrix[:3, :3] @ (0.5 * (low + high)) + instance.matrix[:3, 3]
    world_to_map = np.eye(4)
    world_to_map[:3, :3] = rotation.T
    world_to_map[:3, 3] = -rotation.T @ center
    corners = (np.where(CORNERS, high, low) - 0.5 * (low + high)) @ instance.matrix[:3, :3].T
    return world_to_map, float(np.linalg.norm(corners, axis=1).max())
