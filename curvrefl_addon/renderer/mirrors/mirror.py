# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One mirror of a scene: what it is, where it is, and how large a view sees it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from ...optics.surfaces.cube_map import CubeMapSurface
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays, SceneArrays
from ...scene.camera.view import View
from ..geometry.mesh_facts import MeshFacts, MeshFactsCache
from ..geometry.mesh_inside import holds_point
from ..geometry.placed_instances import CORNERS, Sight
from ..geometry.split import split_angle
from .baked_shape import BakedShape
from .placed_mesh import polar

SAME_STRETCH = 1e-6
"""Relative: a matrix whose stretch differs less only moves and turns"""
SLIVER_SHARE = 1e-6
"""A triangle with this share of the largest one's area has no plane"""
INSIDE_SHARE = 0.98
"""Share of the distance to the nearest facet that is inside for sure, dents that count as none included"""
NEAR_SHARE = 0.05
"""Of the radius: nearer to the surface a map does not tell the sides apart, and the mesh is asked"""

MOST_SHAPES = 5
"""Resolutions whose maps are kept, none among them"""
MOST_EYES = 8
"""Places of the eye of which it is remembered whether a mirror holds them"""


class Mirror:
    """A placed reflector and what has been baked of its shape."""

    def __init__(
        self, scene: SceneArrays, index: int, number: int, facts: MeshFacts, counters: Counter[str] | None = None
    ) -> None:
        """The instance `index` of the scene; `number` is 1, 2, ... in the order of the scene's instances.

        `counters` counts what is baked, as "maps baked".
        """
        self.facts = facts
        self.index, self.number = index, number
        self.may_hide_itself = not facts.is_convex
        self._instance = scene.instances[index]
        self._counters = Counter[str]() if counters is None else counters
        self._shapes: dict[int, BakedShape] = {}
        self._inner_radius: float | None = None
        self._held: dict[bytes, bool] = {}
        """By the eye in object space: whether the mesh holds it"""

    def follow(self, scene: SceneArrays, index: int, number: int) -> bool:
        """Be the instance `index` of another state of the scene; False where its shape is another one."""
        instance = scene.instances[index]
        if scene.meshes[instance.mesh] is not self.facts.mesh:
            return False
        if instance is not self._instance:
            if _moved_map(np.eye(4), self._instance, instance) is None:
                return False
            for shape in self._shapes.values():
                place = _moved_map(shape.world_to_map, self._instance, instance)
                assert place is not None, "whether it is stretched does not depend on the map"
                shape.move(place, instance)
        self._instance, self.index, self.number = instance, index, number
        return True

    def shape(self, resolution: int = 0) -> BakedShape:
        """Its frame and map with so many texels along an edge, baked when first asked for; 0: a frame without a map."""
        found = self._shapes.pop(resolution, None)
        if found is None:
            while len(self._shapes) >= MOST_SHAPES:
                # (The one that was not asked for the longest.)
                del self._shapes[next(iter(self._shapes))]
            found = BakedShape(self.facts, self._instance, resolution)
            self._counters["maps baked"] += resolution > 0
        self._shapes[resolution] = found
        return found

    @property
    def baked(self) -> list[BakedShape]:
        """What was baked and is kept, the one used last at the end."""
        return [shape for resolution, shape in self._shapes.items() if resolution > 0]

    @property
    def object_name(self) -> str:
        """Of the object that it is."""
        return self._instance.object_name

    @property
    def object_id(self) -> int:
        """Of the object that it is."""
        return self._instance.object_id

    @property
    def instance(self) -> InstanceArrays:
        """Where it is."""
        return self._instance

    @property
    def mesh(self) -> MeshArrays:
        """Its surface, object space."""
        return self.facts.mesh

    def most_pixels_per_meter(self, view: View, shape: BakedShape) -> float:
        """No length that it reflects covers more pixels: what is seen in a mirror that bends outwards everywhere is no
        larger than it would be at the mirror itself."""
        if not self.facts.never_sees_itself:
            return np.inf
        clip = view.view_to_clip
        scale = max(view.focal_pixels, 0.5 * view.width * float(clip[0, 0]))
        if view.is_orthographic:
            return scale
        nearest = float(np.linalg.norm(view.eye[:3] - shape.center)) - shape.bound
        if nearest <= 0.0:
            return np.inf
        # In the picture's corners, the farthest one of a shifted lens, a radian covers more pixels than straight ahead.
        x, y = ((1.0 + abs(float(clip[axis, 2]))) / float(clip[axis, axis]) for axis in range(2))
        return (1.0 + x**2 + y**2) * scale / nearest

    @property
    def inner_ball(self) -> tuple[Float64Array, float]:
        """Center (3,), world space, and radius, meters, of a ball inside of a closed convex mirror."""
        low, high = (end.astype(np.float64) for end in self.facts.box)
        middle = 0.5 * (low + high)
        matrix = self._instance.matrix
        if self._inner_radius is None:
            # The same wherever it moves: a mirror that is stretched is another one.
            corners = (self.facts.mesh.positions - middle) @ matrix[:3, :3].T
            a, b, c = (corners[self.facts.mesh.corner_vertex[self.facts.mesh.triangles[:, k]]] for k in range(3))
            normals = np.cross(b - a, c - a)
            lengths = np.linalg.norm(normals, axis=1)
            # Slivers have no plane.
            some = lengths > SLIVER_SHARE * lengths.max(initial=0.0)
            heights = np.einsum("ij,ij->i", normals[some], a[some]) / lengths[some]
            self._inner_radius = INSIDE_SHARE * float(np.abs(heights).min(initial=np.inf)) if some.any() else 0.0
        return matrix[:3, :3] @ middle + matrix[:3, 3], self._inner_radius

    def holds_eye(self, view: View, shape: BakedShape) -> bool:
        """Whether lines of sight begin inside of it."""
        if view.is_orthographic or shape.is_open:
            return False
        eye = (shape.world_to_map @ view.start)[:3]
        distance = float(np.linalg.norm(eye))
        if distance >= shape.bound:
            return False
        if shape.map is not None:
            if distance == 0.0:
                return True
            radius = float(CubeMapSurface(shape.map.radial).radius(eye[None] / distance)[0][0])
            if abs(distance - radius) > NEAR_SHARE * radius or not self.facts.is_closed:
                return distance < radius
        return self.facts.is_closed and self._mesh_holds(np.linalg.solve(self._instance.matrix, view.start)[:3])

    def is_cut_open(self, view: View, shape: BakedShape) -> bool:
        """Whether a picture without perspective begins inside of it: some lines of sight do, others do not."""
        if not view.is_orthographic or not self.facts.is_closed:
            return False
        near = view.clip_range[0]
        toward = -view.world_to_view[2]
        center = np.linalg.inv(shape.world_to_map)[:, 3]
        if abs(float(toward @ center) - near) >= shape.bound:
            return False
        depth = self.facts.mesh.positions @ (toward @ self._instance.matrix)[:3] + float(
            toward @ self._instance.matrix[:, 3]
        )
        return bool(depth.min() < near < depth.max())

    def _mesh_holds(self, eye: Float64Array) -> bool:
        """Whether the closed mesh holds a point (3,), object space.

        All triangles are looked at for that: once for all sub-frames of a view, also where a few viewports take turns.
        """
        key = eye.tobytes()
        if key not in self._held:
            while len(self._held) >= MOST_EYES:
                del self._held[next(iter(self._held))]
            self._held[key] = holds_point(self.facts.mesh, eye)
        return self._held[key]

    def window(self, view: View) -> tuple[int, int, int, int]:
        """x, y, width and height of pixels that hold all of the reflector's; the whole picture where it is near."""
        low, high = self.facts.box
        corners = np.ones((8, 4))
        corners[:, :3] = np.where(CORNERS, high, low)
        clip = corners @ (view.world_to_clip @ self._instance.matrix).T
        if (clip[:, 3] <= 1e-6 * np.abs(clip[:, 3]).max()).any():
            return (0, 0, view.width, view.height)
        pixels = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        size = (view.width, view.height)
        first = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, size).astype(int)
        last = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int)
        return (int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1]))

    def sight(self, view: View, tolerance: float, shape: BakedShape, growth: float = 1.0) -> Sight:
        """How finely `tolerance` pixels want the scenery split at `growth` times the mirror's size in this view."""
        x, y, z = shape.center.tolist()
        return Sight((x, y, z), split_angle(growth * shape.radius_pixels(view), tolerance), self.index)

    def side(self, view: View, shape: BakedShape) -> float:
        """1 where the eye sees more of the outer side of the mirror, -1 where it sees more of the inner one."""
        if not shape.is_open:
            return 1.0
        eye = shape.world_to_map @ view.eye
        to_map = shape.world_to_map @ self._instance.matrix
        positions = self.facts.mesh.positions @ to_map[:3, :3].T + to_map[:3, 3]
        corners = positions[self.facts.mesh.corner_vertex[self.facts.mesh.triangles]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        middle = corners.mean(axis=1)
        normals *= np.sign(np.einsum("ij,ij->i", normals, middle))[:, None]
        to_eye = eye[:3] - middle * eye[3]
        seen = np.einsum("ij,ij->i", normals, to_eye) / np.maximum(np.linalg.norm(to_eye, axis=1), 1e-30) ** 3
        return 1.0 if np.maximum(seen, 0.0).sum() >= np.maximum(-seen, 0.0).sum() else -1.0


def mirrors_of(
    scene: SceneArrays, before: Sequence[Mirror], facts: MeshFactsCache, counters: Counter[str]
) -> list[Mirror]:
    """The reflectors of a scene, numbered 1, 2, ...: those of the state before where they only moved."""
    known: dict[int, list[Mirror]] = {}
    for old in before:
        known.setdefault(old.object_id, []).append(old)
    mirrors: list[Mirror] = []
    reflectors = set(scene.reflectors)
    chosen = [index for index, instance in enumerate(scene.instances) if instance.object_id in reflectors]
    for index in chosen:
        instance = scene.instances[index]
        number = len(mirrors) + 1
        same = known.get(instance.object_id)
        mirror = same.pop(0) if same else None
        if mirror is None or not mirror.follow(scene, index, number):
            mirror = Mirror(scene, index, number, facts.of(scene.meshes[instance.mesh]), counters)
        mirrors.append(mirror)
    return mirrors


def _moved_map(world_to_map: Float64Array, before: InstanceArrays, after: InstanceArrays) -> Float64Array | None:
    """The map's frame after its instance has moved or turned; None where it has been stretched."""
    old_rotation, old_stretch = polar(before.matrix[:3, :3])
    rotation, stretch = polar(after.matrix[:3, :3])
    if np.abs(stretch - old_stretch).max() > SAME_STRETCH * np.abs(old_stretch).max():
        return None
    map_to_world = np.linalg.inv(world_to_map)
    offset = old_rotation.T @ (map_to_world[:3, 3] - before.matrix[:3, 3])
    moved = np.eye(4)
    moved[:3, :3] = rotation.T
    moved[:3, 3] = -rotation.T @ (after.matrix[:3, 3] + rotation @ offset)
    return moved
