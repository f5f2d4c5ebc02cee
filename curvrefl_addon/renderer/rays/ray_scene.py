# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as rays need it: a hierarchy over the triangles of every mesh, and one over the placed meshes.

A mesh's hierarchy is in object space and made once for all its instances, quickly at first; `improve` makes it better
while nothing else is to be done. A mesh that deforms keeps the tree of its topology, whose boxes are fitted on the GPU
(`hierarchy_fit`). What moves changes the top level alone. All of it is one record texture (see `ray_walk.glsl`).
"""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...pacing.pieces import outcome
from ...scene.arrays import LARGEST_COORDINATE, Float32Array, InstanceArrays, MeshArrays, SceneArrays
from ...scene.programs.program import Attribute
from ..device.record_regions import UNIT, RecordRegions
from ..device.records import set_records
from ..device.shaders import Piece, knows
from ..geometry.chunk_attributes import LACKING_BY_NAME, attributes_of
from ..geometry.mesh_facts import MeshFactsCache
from ..geometry.placed_instances import Elsewhere, things_elsewhere
from ..geometry.vertex_uploads import VertexUploads
from ..paths.features import lets_straight_on
from .escapes import Escapes
from .hierarchy import Hierarchy
from .hierarchy_build import HierarchyBuild, build
from .hierarchy_fit import HierarchyFit
from .mesh_rays import (
    MeshRays,
    MeshTree,
    batches_of,
    of_same_topology,
    triangle_boxes,
    triangles_with_a_place,
    world_boxes,
)
from .mesh_trees import WORSE, Arrivals, Fresh, tree_steps
from .ray_instances import INSTANCE_RECORDS, fill_records, places_hit
from .ray_records import NODE_RECORDS, TRIANGLE_RECORDS, InstanceFlag, NumberLists, node_records, put_boxes

COUNTED = ("hierarchies built", "hierarchies fitted", "hierarchies improved", "top levels built")
STACK = 64
"""Levels of the top and the deepest mesh together"""
RAYS = Piece(
    records={"rays": "FLOAT_2D"},
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


class RayScene:
    """Hierarchies of one scene on the GPU. `follow` before the first use."""

    def __init__(self, facts: MeshFactsCache, uploads: VertexUploads) -> None:
        self.regions = RecordRegions()
        self.counters = dict.fromkeys(COUNTED, 0)
        self.build_ms = 0.0
        """Of the last time that meshes came"""
        self._facts, self._uploads = facts, uploads
        self.escapes = Escapes(facts)
        self._arrivals = Arrivals(self.regions, self.counters)
        self._left_out: list[MeshArrays] = []
        """Of which some triangles have no place"""
        self._meshes: dict[int, MeshRays] = {}
        self._leaving: list[MeshRays] = []
        """Whose successors, the same with their vertices elsewhere, are on their way"""
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
        """Set what `RAYS` names on a bound shader, of which the compiler may have found that it follows none."""
        set_records(shader, "rays", self.regions.texture)
        if knows(shader, "rays_top"):
            shader.uniform_int("rays_top", self._top_places)

    def follow(self, scene: SceneArrays, numbers: Mapping[int, int]) -> None:
        """Show a state of the scene; `numbers`: mirrors (1, 2, ...) by the index of their instance.

        Raises InputError where the triangles do not fit into the graphics driver's largest texture, OutOfTime within
        `paced`: the next call goes on.
        """
        seen_through = frozenset(index for index, item in enumerate(scene.materials) if item.is_seen_through)
        clear = frozenset(index for index in seen_through if lets_straight_on(scene.materials[index]))
        attributes = attributes_of(scene)
        is_same = (seen_through, clear, attributes) == (self._seen_through, self._clear, self._attributes)
        found = self._elsewhere(scene, numbers) if is_same else None
        self._seen_through, self._clear, self._attributes = seen_through, clear, attributes
        # (Not followed before all is there: what runs out of time on the way is asked again.)
        self._followed = (scene, dict(numbers)) if found is not None else None
        if found is not None:
            self._follow_places(scene, found)
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
        self._followed = (scene, dict(numbers))

    def numbers_of(self, index: int) -> tuple[int, NDArray[np.int64]]:
        """Of an instance of the scene that has triangles, as `packed_hit` of `ray_surface.glsl` has them: its own, and
        (triangles,) those of its mesh's, -1 of such as have no place."""
        place = self._place_of[index]
        item = self._items[place]
        numbers = np.full(len(item.mesh.triangles), -1)
        numbers[item.kept[item.hierarchy.order]] = np.arange(len(item.kept))
        return place, numbers

    def _elsewhere(self, scene: SceneArrays, numbers: Mapping[int, int]) -> Elsewhere | None:
        """What is not where it was; None where more has changed, or a tree cannot be fitted where it is."""
        if self._followed is None:
            return None
        found = things_elsewhere(self._followed, (scene, dict(numbers)))
        if found is None or not all(self._can_deform(*pair) for pair in found.meshes):
            return None
        return found

    def _can_deform(self, before: MeshArrays, mesh: MeshArrays) -> bool:
        item = self._meshes.get(id(before))
        if item is None or len(item.kept) < len(mesh.triangles) or not HierarchyFit.serves(item.hierarchy, mesh):
            return False
        low, high = self._facts.of(mesh).box
        return bool(np.maximum(np.abs(low), np.abs(high)).max() < LARGEST_COORDINATE)

    def _follow_places(self, scene: SceneArrays, found: Elsewhere) -> None:
        """Where nothing else has changed."""
        seen = [index for index in (*found.moved, *found.deformed) if index in self._place_of]
        places = [self._place_of[index] for index in seen]
        for place, index in zip(places, seen, strict=True):
            self._instances[place] = scene.instances[index]
        if found.meshes:
            self._mesh_of = [scene.meshes[instance.mesh] for instance in self._instances]
        if self._deform(found.meshes):
            self._place(is_same=True)
        elif places:
            self._fill(places)
            self._store_top(is_same=True)
            if any(self._mirrors[place] for place in places):
                self.escapes.place(self._mirrors, self._mesh_of, self._instances)

    def _deform(self, pairs: list[tuple[MeshArrays, MeshArrays]]) -> bool:
        """Fit the trees of meshes, as they were and as they are; returns whether any had to be built anew."""
        items = [self._meshes.pop(id(before)) for before, _ in pairs]
        for item, (before, mesh) in zip(items, pairs, strict=True):
            self._meshes[id(mesh)] = item
            item.mesh, item.box = mesh, self._facts.of(mesh).box
            if self._build is not None and self._build[0] is item:
                self._build = None
            if self._rebuild_if_worse(item):
                continue
            item.fit = item.fit or HierarchyFit(item.hierarchy, mesh)
            item.fit.fit(self.regions, item.starts, before, mesh, self._uploads)
            self.counters["hierarchies fitted"] += 1
        return any(self._meshes[id(item.mesh)] is not item for item in items)

    def _rebuild_if_worse(self, item: MeshRays) -> bool:
        """Build the tree of a mesh that deforms anew where it has been found to be bad; returns whether it has."""
        if item.fit is None or not item.is_judged or item.fit.cost() < WORSE * item.cost:
            return False
        return self._replace(item, outcome(tree_steps([Fresh(item.mesh, item.kept)], self.counters)))

    def _replace(self, item: MeshRays, trees: list[MeshTree]) -> bool:
        """Put another tree in the place of a mesh's own; False where there is no room for both."""
        try:
            # (The regions of the other are free only then.)
            self._meshes |= {id(stored.mesh): stored for stored in self._arrivals.store(trees)}
        except InputError:
            # What is there serves as well, only slower.
            return False
        item.leave(self.regions)
        return True

    def known(self, hits: Float32Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Of `packed_hit` (n, 4) the index of the instance in the scene and of the triangle in its mesh, (n,) each."""
        return places_hit(hits, self._items, list(self._place_of))

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return tuple(
            f'"{mesh.name}" has vertices too far out: their triangles are left out.' for mesh in self._left_out
        )

    @property
    def can_improve(self) -> bool:
        """Whether `improve` would do anything."""
        waits = any(not item.is_best or item.is_judged for item in self._meshes.values())
        return waits or self._build is not None or self.escapes.can_improve

    def improve(self) -> None:
        """Go on making the trees better: one step, about a third of a microsecond for each triangle of a mesh."""
        if self._build is None:
            for item in [item for item in self._meshes.values() if item.is_judged]:
                if self._rebuild_if_worse(item):
                    self._place(is_same=True)
                    return
            waiting = [item for item in self._meshes.values() if not item.is_best]
            if not waiting:
                self.escapes.improve()
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
        tree = MeshTree(chosen.mesh, chosen.kept, better, better.cost(), is_best=True)
        if better.cost() < chosen.present_hierarchy.cost() and self._replace(chosen, [tree]):
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
        self._leaving += [self._meshes.pop(key) for key in list(self._meshes) if key not in meshes]
        fresh = []
        for key, mesh in meshes.items():
            if key in self._meshes:
                continue
            kept, some_too_far = triangles_with_a_place(mesh)
            if some_too_far and not any(mesh is other for other in self._left_out):
                self._left_out.append(mesh)
            if len(kept):
                fresh.append(Fresh(mesh, kept, of_same_topology(mesh, self._leaving)))
        wanted = {id(item.before) for item in fresh}
        for item in self._leaving:
            if id(item) not in wanted:
                item.leave(self.regions)
        self._leaving = [item for item in self._leaving if id(item) in wanted]
        for batch in batches_of(fresh, [len(item.kept) for item in fresh]):
            self._meshes |= {id(item.mesh): item for item in self._arrivals.bring(batch)}
            taken = {id(item.before) for item in batch}
            self._leaving = [item for item in self._leaving if id(item) not in taken]
        if fresh:
            self.build_ms = 1e3 * (perf_counter() - start)

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
        self.escapes.place(self._mirrors, self._mesh_of, self._instances)

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
        self._top_region = self.regions.put_again(self._top_region, joined)
        start = self._top_region[0]
        start_of_instances = start + len(self._top_nodes)
        self._top_places = (start, start_of_instances, start_of_instances + len(instances), 0)
