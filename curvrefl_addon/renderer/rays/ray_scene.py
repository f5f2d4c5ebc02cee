# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as rays need it: a hierarchy over the triangles of every mesh, and one over the placed meshes.

A mesh's hierarchy is in object space and made once for all its instances, quickly at first; `improve` makes it better
while nothing else is to be done. A mesh that deforms keeps the tree of its topology with new boxes. What moves
changes the top level alone. All of it is one record texture (see `ray_walk.glsl`).
"""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...scene.arrays import InstanceArrays, MeshArrays, SceneArrays
from ...scene.programs.program import Attribute
from ..device.record_regions import UNIT, RecordRegions
from ..device.shaders import Piece
from ..geometry.chunk_attributes import LACKING_BY_NAME, attributes_of
from ..geometry.mesh_facts import MeshFactsCache
from ..geometry.placed_instances import others
from ..paths.features import lets_straight_on
from .hierarchy import Boxes, Hierarchy
from .hierarchy_build import HierarchyBuild, build, build_all, build_all_quickly
from .mesh_rays import (
    MeshRays,
    MeshTree,
    all_but_place,
    batches_of,
    of_same_topology,
    triangle_boxes,
    triangles_with_a_place,
    world_boxes,
)
from .ray_instances import INSTANCE_RECORDS, fill_records
from .ray_records import (
    NODE_RECORDS,
    TRIANGLE_RECORDS,
    InstanceFlag,
    NumberLists,
    attribute_records,
    corner_records,
    node_records,
    put_boxes,
    triangle_records,
)

PARTS = 4
"""Regions of a mesh"""
STACK = 64
"""Levels of the top and the deepest mesh together"""
RAYS = Piece(
    samplers={"rays": "FLOAT_2D"},
    constants={"rays_top": "IVEC4"},
    defines={
        "STACK": STACK,
        "NODE_RECORDS": NODE_RECORDS,
        "INSTANCE_RECORDS": INSTANCE_RECORDS,
        "TRIANGLE_RECORDS": TRIANGLE_RECORDS,
        "REGION_UNIT": UNIT,
        "LACKING_BY_NAME": LACKING_BY_NAME,
        **{flag.name: int(flag) for flag in InstanceFlag if flag.name is not None},
    },
)
"""What `ray_walk.glsl` needs"""
FEW = 4096
"""A mesh of no more triangles gets the best tree at once: 15 milliseconds at most in place of 8, and rays look at a
third of the boxes, also while the mesh deforms and nothing can be improved"""
MOST_IMPROVED = 400_000
"""A mesh of more triangles keeps the tree of the quick build: a step of the better one, 0.4 microseconds a triangle,
would be felt in a viewport"""
WORSE = 1.4
"""A top level whose cost has grown by this factor since it was built is built anew"""


class RayScene:
    """Hierarchies of one scene on the GPU. `follow` before the first use."""

    def __init__(self, facts: MeshFactsCache) -> None:
        self.regions = RecordRegions()
        counted = ("hierarchies built", "hierarchies fitted", "hierarchies improved", "top levels built")
        self.counters = dict.fromkeys(counted, 0)
        self.build_ms = 0.0
        """Of the last time that meshes came"""
        self._facts = facts
        self._left_out: list[MeshArrays] = []
        """Of which some triangles have no place"""
        self._meshes: dict[int, MeshRays] = {}
        self._instances: list[InstanceArrays] = []
        """Those that have triangles"""
        self._mesh_of: list[MeshArrays] = []
        self._mirrors: list[int] = []
        self._seen_through: frozenset[int] = frozenset()
        self._clear: frozenset[int] = frozenset()
        """Indices of materials that light goes on through, and of those it goes straight on through"""
        self._attributes: tuple[Attribute, ...] = ()
        """All that programs of the scene read, in their order"""
        self._followed: tuple[SceneArrays, dict[int, int]] | None = None
        self._place_of: dict[int, int] = {}
        """Index in `_instances` by index in the scene"""
        self._items: list[MeshRays] = []
        """As `_instances`; so are the next: boxes in world space, records, and the deepest of the trees"""
        self._low = self._high = np.empty((0, 3), np.float32)
        self._records = np.empty((0, INSTANCE_RECORDS, 4), np.float32)
        self._materials = np.empty((0, 4), np.float32)
        self._deepest = 0
        self._top: Hierarchy | None = None
        self._top_nodes = np.empty((0, 4), np.float32)
        """Its records"""
        self._top_cost = 0.0
        self._top_region = (0, 0)
        self._top_places = (0, 0, 0, 0)
        self._build: tuple[MeshRays, HierarchyBuild] | None = None

    def bind(self, shader: Any) -> None:
        """Set what `RAYS` names on a bound shader."""
        shader.uniform_sampler("rays", self.regions.texture)
        shader.uniform_int("rays_top", self._top_places)

    def follow(self, scene: SceneArrays, numbers: Mapping[int, int]) -> None:
        """Show a state of the scene; `numbers`: mirrors (1, 2, ...) by the index of their instance.

        Raises InputError where the triangles do not fit into the graphics driver's largest texture.
        """
        seen_through = frozenset(index for index, item in enumerate(scene.materials) if item.is_seen_through)
        clear = frozenset(index for index in seen_through if lets_straight_on(scene.materials[index]))
        attributes = attributes_of(scene)
        is_same = (seen_through, clear, attributes) == (self._seen_through, self._clear, self._attributes)
        moved = self._moved(scene, numbers) if is_same else None
        self._seen_through, self._clear, self._attributes = seen_through, clear, attributes
        self._followed = (scene, dict(numbers))
        if moved is not None:
            for index in moved:
                self._instances[self._place_of[index]] = scene.instances[index]
            if moved:
                self._fill([self._place_of[index] for index in moved])
                self._store_top(is_same=True)
            return
        self._read_meshes(scene)
        known = [
            index for index, instance in enumerate(scene.instances) if id(scene.meshes[instance.mesh]) in self._meshes
        ]
        instances = [scene.instances[index] for index in known]
        meshes = [scene.meshes[instance.mesh] for instance in instances]
        mirrors = [numbers.get(index, 0) for index in known]
        # The same objects as before, though they may have moved: the tree over them still serves.
        is_same = [item.object_id for item in instances] == [item.object_id for item in self._instances]
        self._instances, self._mesh_of, self._mirrors = instances, meshes, mirrors
        self._place_of = {index: place for place, index in enumerate(known)}
        if instances:
            self._place(is_same)

    def _moved(self, scene: SceneArrays, numbers: Mapping[int, int]) -> list[int] | None:
        """Instances (with triangles) that have another matrix, where nothing else has changed since the last time."""
        if self._followed is None:
            return None
        before, numbers_before = self._followed
        if len(scene.instances) != len(before.instances) or numbers != numbers_before:
            return None
        if list(map(id, scene.meshes)) != list(map(id, before.meshes)):
            return None
        found = others(before.instances, scene.instances)
        if any(all_but_place(before.instances[index]) != all_but_place(scene.instances[index]) for index in found):
            return None
        return [index for index in found if index in self._place_of]

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return tuple(
            f'"{mesh.name}" has vertices too far out: their triangles are left out.' for mesh in self._left_out
        )

    @property
    def can_improve(self) -> bool:
        """Whether `improve` would do anything."""
        return self._build is not None or any(not item.is_best for item in self._meshes.values())

    def improve(self) -> None:
        """Go on making the trees better: one step, about a third of a microsecond for each triangle of a mesh."""
        if self._build is None:
            waiting = [item for item in self._meshes.values() if not item.is_best]
            if not waiting:
                return
            # What is seen most is unknown; what is large has most to gain.
            chosen = max(waiting, key=lambda item: len(item.kept))
            self._build = (chosen, HierarchyBuild(*triangle_boxes(chosen.mesh, chosen.kept)))
        chosen, growth = self._build
        if self._meshes.get(id(chosen.mesh)) is not chosen:
            self._build = None
            return
        if growth.step():
            return
        self._build = None
        better = growth.finished()
        chosen.is_best = True
        if better.cost() < chosen.hierarchy.cost():
            try:
                # (This puts the better one in the place of the other, whose regions are free only then.)
                self._store([MeshTree(chosen.mesh, chosen.kept, better, better.cost(), is_best=True)])
            except InputError:
                # No room for both: what is there serves as well, only slower.
                return
            self._free(chosen)
            self.counters["hierarchies improved"] += 1
            self._place(is_same=True)

    def finish(self) -> None:
        """All improvements at once."""
        while self.can_improve:
            self.improve()

    def _read_meshes(self, scene: SceneArrays) -> None:
        start = perf_counter()
        self._left_out = [mesh for mesh in self._left_out if any(mesh is other for other in scene.meshes)]
        used = {instance.mesh for instance in scene.instances}
        meshes = {id(mesh): mesh for index, mesh in enumerate(scene.meshes) if index in used}
        gone = {key: item for key, item in self._meshes.items() if key not in meshes}
        fresh = []
        for key, mesh in meshes.items():
            if key in self._meshes:
                continue
            kept, some_too_far = triangles_with_a_place(mesh)
            if some_too_far:
                self._left_out.append(mesh)
            if len(kept):
                fresh.append((mesh, kept, of_same_topology(mesh, gone.values())))
        trees = self._trees(fresh)
        for item in gone.values():
            self._forget(item)
        for batch in batches_of(trees, [len(tree.kept) for tree in trees]):
            self._store(batch)
        if fresh:
            self.build_ms = 1e3 * (perf_counter() - start)

    def _trees(self, fresh: list[tuple[MeshArrays, NDArray[np.int64], MeshRays | None]]) -> list[MeshTree]:
        """Of meshes that have come, or were another with their vertices elsewhere."""
        trees: list[MeshTree] = []
        to_build: list[tuple[MeshArrays, NDArray[np.int64], Boxes, Hierarchy | None]] = []
        for mesh, kept, before in fresh:
            boxes = triangle_boxes(mesh, kept)
            fitted = None
            if before is not None and np.array_equal(before.kept, kept):
                fitted = before.hierarchy.fitted(*boxes)
                if fitted.cost() < WORSE * before.cost:
                    self.counters["hierarchies fitted"] += 1
                    trees.append(MeshTree(mesh, kept, fitted, before.cost, before.is_best))
                    continue
            to_build.append((mesh, kept, boxes, fitted))
        for is_best, build_them in ((True, build_all), (False, build_all_quickly)):
            group = [item for item in to_build if (len(item[1]) <= FEW) == is_best]
            for batch in batches_of(group, [len(kept) for _, kept, _, _ in group]):
                built = build_them([boxes for _, _, boxes, _ in batch])
                for (mesh, kept, _, fitted), tree in zip(batch, built, strict=True):
                    # One that has come apart may still be better than one that is built quickly.
                    better = fitted if fitted is not None and fitted.cost() < tree.cost() else tree
                    trees.append(MeshTree(mesh, kept, better, better.cost(), is_best or len(kept) > MOST_IMPROVED))
        self.counters["hierarchies built"] += len(to_build)
        return trees

    def _store(self, trees: list[MeshTree]) -> None:
        """All at once: each would be an upload, and make the texture grow, of its own."""
        parts = [
            part
            for tree in trees
            for part in (
                node_records(tree.hierarchy, tree.hierarchy.link, tree.hierarchy.count),
                triangle_records(tree.mesh, tree.kept[tree.hierarchy.order]),
                corner_records(tree.mesh),
                attribute_records(tree.mesh),
            )
        ]
        sizes = [len(part) for part in parts]
        # (What has no records gets no region.)
        stored = iter(self.regions.put([part for part in parts if len(part)]))
        starts = [next(stored) if size else 0 for size in sizes]
        for index, tree in enumerate(trees):
            own = slice(PARTS * index, PARTS * (index + 1))
            self._meshes[id(tree.mesh)] = MeshRays(
                tree.mesh, tree.hierarchy, tree.kept, starts[own], sizes[own], tree.cost, tree.is_best
            )

    def _forget(self, item: MeshRays) -> None:
        del self._meshes[id(item.mesh)]
        self._free(item)

    def _free(self, item: MeshRays) -> None:
        for start, size in zip(item.starts, item.sizes, strict=True):
            if size:
                self.regions.drop(start, size)

    def _place(self, is_same: bool) -> None:
        """The top level; the tree over the instances may be kept where they are the `same`."""
        self._items = [self._meshes[id(mesh)] for mesh in self._mesh_of]
        self._deepest = max(item.hierarchy.depth for item in self._items)
        lists = NumberLists()
        firsts = [lists.first_record(instance.materials) for instance in self._instances]
        places = [lists.first_of_places(self._attributes, mesh) for mesh in self._mesh_of]
        self._materials = lists.records
        count = len(self._items)
        self._low, self._high = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
        self._records = np.zeros((count, INSTANCE_RECORDS, 4), np.float32)
        self._records[:, 4, 3] = firsts
        self._records[:, 5, 2] = places
        self._records[:, 5, 3] = list(self._place_of)
        self._fill(list(range(count)))
        self._store_top(is_same)

    def _fill(self, places: list[int]) -> None:
        """Boxes and records of some instances."""
        items, placed = [self._items[place] for place in places], [self._instances[place] for place in places]
        low, high = world_boxes(items, np.array([instance.matrix for instance in placed]))
        self._low[places], self._high[places] = low, high
        mirrors = [self._mirrors[place] for place in places]
        records = self._records[places]
        fill_records(records, items, placed, mirrors, high - low, self._seen_through, self._clear, self._facts)
        self._records[places] = records

    def _store_top(self, is_same: bool) -> None:
        """The tree over the instances, and all that belongs to the top level, to the GPU."""
        top = self._top.fitted(self._low, self._high) if is_same and self._top is not None else None
        if top is not None and len(top.children) and top.cost() <= WORSE * self._top_cost:
            put_boxes(self._top_nodes, top)
        else:
            top = build(self._low, self._high, leaf=1)
            self._top_cost = top.cost()
            self.counters["top levels built"] += 1
            leaves = top.order[np.where(top.count > 0, top.link, 0)]
            self._top_nodes = node_records(top, leaves, np.full(len(top.count), -1))
        self._top = top
        if top.depth + self._deepest > STACK:
            raise InputError("The scene's objects are nested too deeply for ray walks: choose another method.")
        instances = self._records.reshape(-1, 4)
        joined = np.concatenate([self._top_nodes, instances, self._materials])
        start, size = self._top_region
        if size < len(joined) or size == 0:
            if size:
                self.regions.drop(start, size)
            (start,) = self.regions.put([joined])
            self._top_region = (start, len(joined))
        else:
            self.regions.replace(start, joined)
        start_of_instances = start + len(self._top_nodes)
        self._top_places = (start, start_of_instances, start_of_instances + len(instances), 0)
