# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All instances of a scene on the GPU, kept up to date with the least work.

Instances lie in chunks. One that moves has its matrix uploaded; only a chunk whose meshes, materials or members change
is built again. Each reflector is a chunk of its own, and what mirrors do not see lies apart from what they do, so that
the scenery of a mirror is a list of whole chunks.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import outcome
from ...scene.arrays import Float64Array, Int32Array, MeshArrays, SceneArrays
from ...scene.camera.view import View
from .chunk import Batches, Chunk, Placed
from .instance_bounds import ChunkBoxes, InstanceBounds
from .mesh_facts import MeshFactsCache
from .placed_instances import (
    Difference,
    Sight,
    deformed_item,
    differs_in_place_only,
    differs_in_vertices_only,
    in_groups,
    matched,
    may_be_coarse,
    placed_elsewhere,
    require_room,
    stretches_of,
)
from .split import SplitAhead
from .vertex_uploads import VertexUploads

CHUNK_TRIANGLES = 1 << 16
"""A chunk takes no more instances when it has so many: small enough to build again while something is edited, large
enough that a scene has few"""


class SceneGeometry:
    """Chunks of one scene."""

    def __init__(self) -> None:
        self.chunks: list[Chunk] = []
        self.facts = MeshFactsCache()
        self.uploads = VertexUploads()
        """Of the meshes that deform"""
        self._bounds = InstanceBounds(self.facts)
        self.placed: list[Placed] = []
        """As the scene's instances"""
        self.counters = {"chunks built": 0, "instances placed": 0, "instances deformed": 0, "meshes split": 0}
        self.revision = 0
        """Another one when chunks are not the same any more"""
        self._boxes = ChunkBoxes(self._bounds)
        self._sceneries: dict[int, list[tuple[Chunk, Batches]]] = {}
        """By the mirror's instance; of this revision, as the next"""
        self._seen: list[tuple[Chunk, Batches]] | None = None
        self._rows: dict[int, Int32Array] = {}
        """By a chunk's id, indices of its instances in the scene; of this revision"""
        self._where: list[tuple[Chunk, int] | None] = []
        self._angles: list[float] = []
        """Per instance the angle it is split with, endless where it is not"""
        self._sights: tuple[Sight, ...] = ()
        self._unchecked: set[int] = set()
        self.ahead = SplitAhead()
        self._followed: tuple[SceneArrays, dict[int, int]] | None = None
        """The scene and its mirrors of the last update"""

    def update(self, scene: SceneArrays, mirrors: Mapping[int, int], anew: bool = False) -> Difference:
        """Follow the scene; `mirrors` numbers reflectors (1, 2, ...) by the index of their instance.

        `anew`: in other chunks than before, so that those of an earlier picture stay where they are.
        """
        return outcome(self.updating(scene, mirrors, anew))

    def updating(
        self, scene: SceneArrays, mirrors: Mapping[int, int], anew: bool = False
    ) -> Generator[None, None, Difference]:
        """The same in steps: a chunk in each, or a mesh that nothing is known of."""
        before, self._followed = self._followed, (scene, dict(mirrors))
        if before and not anew and (followed := placed_elsewhere(self.placed, before, self._followed, self.facts)):
            return self._follow_moved(*followed)
        old = matched(self.placed, scene.instances)
        known = [None if before is None else self.placed[before] for before in old]
        difference = Difference(structure=old != list(range(len(self.placed))))
        numbers = [0] * len(old)
        for index, number in mirrors.items():
            numbers[index] = number
        dirty: list[int] = []
        for index, (item, instance, number) in enumerate(zip(known, scene.instances, numbers, strict=True)):
            mesh = scene.meshes[instance.mesh]
            same = item if item is not None and item.mesh is mesh else None
            if same is not None and not anew and differs_in_place_only(same, instance, number):
                if same.instance is not instance or same.mirror != number:
                    known[index] = replace(same, instance=instance, mirror=number)
                    difference.moved.append(index)
                continue
            if item is not None and not anew and differs_in_vertices_only(item, instance, mesh, number):
                known[index] = deformed_item(item, scene, index, number, self.facts)
                difference.deformed.append(index)
                continue
            dirty.append(index)
            if same is not None:
                known[index] = Placed(instance, mesh, same.drawn, same.pieces, number)
            else:
                pieces = yield from self.facts.of(mesh).piece_steps()
                known[index] = Placed(instance, mesh, mesh, pieces.triangle_piece, number)
        placed = [item for item in known if item is not None]
        if not difference.structure and not dirty:
            return self._follow_moved(placed, difference)
        require_room(scene)
        difference.structure = True
        where = [None if before is None else self._where[before] for before in old]
        self._angles = [
            np.inf if before is None or item.drawn is item.mesh else self._angles[before]
            for item, before in zip(placed, old, strict=True)
        ]
        gone = set(range(len(self.placed))) - {before for before in old if before is not None}
        stale = {id(found[0]) for index in gone if (found := self._where[index]) is not None}
        self.placed, self._where = placed, where
        self._bounds.follow(placed)
        self._rows.clear()
        self._unchecked, self.ahead = set(range(len(placed))), SplitAhead()
        self._move(difference.moved)
        self._deform(difference.deformed)
        yield from self._build(dirty, stale)
        self._forget_meshes()
        return difference

    def refine(self, sights: Sequence[Sight]) -> None:
        """Split what mirrors need finer than it is: of what changed since the last call, or all for other sights."""
        if tuple(sights) != self._sights:
            self._unchecked = set(range(len(self.placed)))
            self._sights = tuple(sights)
        chosen = np.array(sorted(self._unchecked), np.int64)
        self._unchecked.clear()
        if len(chosen) == 0 or not sights:
            return
        finest, needed = min(sight.angle for sight in sights), self._needed(sights, chosen)
        outcome(self._build([index for index, some in needed.items() if self._split(index, some, finest)], set()))

    def refine_ahead(self, sights: Sequence[Sight], share: float) -> None:
        """Have this share done of the splitting that mirrors will need soon: `refine` finds it done then."""
        if self.ahead.is_new(sights):
            self.ahead.begin(sights, self._needed(sights, np.arange(len(self.placed))))
        self.ahead.go_on(self.placed, share)

    def _needed(self, sights: Sequence[Sight], chosen: NDArray[np.int64]) -> dict[int, list[Sight]]:
        """Of these instances those that may have to be split otherwise, and for which mirrors."""
        some = [self.placed[index] for index in chosen]
        angles = np.array([self._angles[index] for index in chosen])
        balls = self.balls(chosen)
        coarse = np.stack([may_be_coarse(some, chosen, angles, balls, self.facts, sight) for sight in sights], axis=1)
        return {
            int(chosen[row]): [sight for sight, wanted in zip(sights, coarse[row], strict=True) if wanted]
            for row in np.flatnonzero(coarse.any(axis=1))
        }

    def join(self) -> None:
        """Draw all meshes as they are, until `refine` splits them as if for the first time."""
        split = [index for index, item in enumerate(self.placed) if item.drawn is not item.mesh]
        for index in split:
            self._draw(index, self.placed[index].mesh)
        self._sights, self.ahead = (), SplitAhead()
        outcome(self._build(split, set()))

    def scenery(self, own: int) -> list[tuple[Chunk, Batches]]:
        """All that a mirror, the instance `own`, may show."""
        if own not in self._sceneries:
            itself, _ = self.place_of(own)
            self._sceneries[own] = [
                (chunk, chunk.batches(np.ones(len(chunk.placed), bool)))
                for chunk in self.chunks
                if chunk is not itself and chunk.placed[0].instance.visible_glossy
            ]
        return self._sceneries[own]

    def hidden_faces(self, chunk: Chunk, view: View) -> str:
        """Which faces the eye cannot see for sure: 'BACK', 'FRONT' (of what is inside out) or 'NONE'.

        Of mirrors only, whose many triangles are worth it: closed ones that lie wholly before the eye.
        """
        if len(chunk.placed) > 1 or not chunk.placed[0].mirror:
            return "NONE"
        item = chunk.placed[0]
        clip = self._boxes.of(chunk, self.rows_of(chunk)) @ view.world_to_clip.T
        if (clip[:, 2] <= -clip[:, 3]).any() or (clip[:, 3] <= 0.0).any():
            return "NONE"
        side = self.facts.of(item.drawn).solid_side * np.sign(np.linalg.det(item.instance.matrix[:3, :3]))
        return ("NONE", "BACK", "FRONT")[int(side)]

    def may_be_in(self, chunks: Sequence[Chunk], world_to_clip: Float64Array) -> NDArray[np.bool_]:
        """(chunks,) False for chunks that are outside of the view volume of a matrix (4, 4) for sure."""
        clip = self._boxes.joined(chunks, self.rows_of) @ world_to_clip.T
        outside = (clip[..., :3] > clip[..., 3:]).all(axis=1) | (clip[..., :3] < -clip[..., 3:]).all(axis=1)
        return np.asarray(~outside.any(axis=1))

    def chunk_balls(self, chunks: Sequence[Chunk]) -> tuple[Float64Array, Float64Array]:
        """Centers (n, 3) and radii (n,) of balls around chunks, world space."""
        boxes = self._boxes.joined(chunks, self.rows_of)[..., :3]
        low, high = boxes.min(axis=1), boxes.max(axis=1)
        return 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)

    def seen(self, view: View) -> list[tuple[Chunk, Batches]]:
        """All that the eye may see directly."""
        if self._seen is None:
            self._seen = []
            for chunk in self.chunks:
                keep = np.array([item.instance.visible_camera for item in chunk.placed])
                if batches := chunk.batches(keep, holdouts=True):
                    self._seen.append((chunk, batches))
        return list(compress(self._seen, self.may_be_in([chunk for chunk, _ in self._seen], view.world_to_volume)))

    def of_instance(self, index: int) -> tuple[Chunk, Batches]:
        """A reflector's own chunk."""
        chunk, _ = self.place_of(index)
        assert len(chunk.placed) == 1, "a reflector is a chunk of its own"
        return chunk, chunk.batches(np.ones(1, bool))

    def place_of(self, index: int) -> tuple[Chunk, int]:
        """Chunk of an instance and its index there."""
        found = self._where[index]
        assert found is not None
        return found

    def rows_of(self, chunk: Chunk) -> Int32Array:
        """(instances of a chunk,) their indices in the scene."""
        if not self._rows:
            for index, found in enumerate(self._where):
                if found is not None:
                    rows = self._rows.setdefault(id(found[0]), np.zeros(len(found[0].placed), np.int32))
                    rows[found[1]] = index
        return self._rows[id(chunk)]

    def balls(self, indices: NDArray[np.int64] | None = None) -> tuple[Float64Array, Float64Array]:
        """Centers (n, 3) and radii (n,) of balls around instances, world space."""
        return self._bounds.balls(indices)

    def longest_edge(self, chunk: Chunk) -> float:
        """Of the triangles drawn for a chunk, world space, or a little more; meters."""
        matrices = np.array([item.instance.matrix for item in chunk.placed])
        lengths = np.array([self.facts.of(item.drawn).longest_edge for item in chunk.placed])
        return float((lengths * stretches_of(matrices)).max())

    def box_corners(self, indices: NDArray[Any] | Sequence[int]) -> Float64Array:
        """(n, 8, 3) corners of the boxes around instances, world space."""
        return self._bounds.corners(indices)

    def _follow_moved(self, placed: list[Placed], difference: Difference) -> Difference:
        """Know the same instances, some at other places."""
        self.placed = placed
        self._bounds.follow(placed, difference.elsewhere)
        self._unchecked.update(difference.elsewhere)
        self._move(difference.moved)
        self._deform(difference.deformed)
        return difference

    def _move(self, moved: Sequence[int]) -> None:
        self.counters["instances placed"] += len(moved)
        for chunk, rows in self._by_chunk(moved):
            chunk.move({row: self.placed[index] for row, index in rows.items()})
            self._boxes.grow(chunk, list(rows.values()))

    def _deform(self, deformed: Sequence[int]) -> None:
        self.counters["instances deformed"] += len(deformed)
        for chunk, rows in self._by_chunk(deformed):
            chunk.deform({row: self.placed[index] for row, index in rows.items()}, self.uploads)
            self._boxes.forget(chunk)
        if deformed:
            self._forget_meshes()

    def _by_chunk(self, indices: Iterable[int]) -> Iterable[tuple[Chunk, dict[int, int]]]:
        """Chunks of instances, and indices of these in the scene by those in the chunk."""
        found: dict[int, tuple[Chunk, dict[int, int]]] = {}
        for index in indices:
            chunk, row = self.place_of(index)
            found.setdefault(id(chunk), (chunk, {}))[1][row] = index
        return found.values()

    def _forget_meshes(self) -> None:
        """What is known of meshes that are gone."""
        assert self._followed is not None
        split = [item.drawn for item in self.placed if item.drawn is not item.mesh]
        meshes = [*self._followed[0].meshes, *split]
        self.facts.keep(meshes)
        self.uploads.keep(meshes)

    def _build(self, dirty: Iterable[int], stale: set[int]) -> Generator[None]:
        """Build the chunks of `dirty` instances anew, and those whose id is in `stale`."""
        dirty = set(dirty)
        stale = stale | {id(found[0]) for index in dirty if (found := self._where[index]) is not None}
        if not dirty and not stale:
            return
        self.revision += 1
        self._boxes.forget_all()
        self._rows.clear()
        self._sceneries.clear()
        self._seen = None
        self.chunks = [chunk for chunk in self.chunks if id(chunk) not in stale]
        loose = [index for index, found in enumerate(self._where) if found is None or id(found[0]) in stale]
        for kind in {self._kind(index) for index in loose}:
            yield from self._pack([index for index in loose if self._kind(index) == kind], kind)

    def _kind(self, index: int) -> tuple[int, bool]:
        """What may share a chunk."""
        item = self.placed[index]
        return (index + 1 if item.mirror else 0, item.instance.visible_glossy)

    def _pack(self, indices: list[int], kind: tuple[int, bool]) -> Generator[None]:
        """Put instances of one kind into new chunks, with those of a chunk that is half empty."""
        wanted = sum(len(self.placed[index].drawn.triangles) for index in indices)
        members: dict[int, list[int]] = {}
        packed = set(indices)
        for index, found in enumerate(self._where):
            if found is not None and index not in packed and self._kind(index) == kind:
                members.setdefault(id(found[0]), []).append(index)
        for chunk in list(self.chunks):
            if id(chunk) in members and chunk.triangle_count + wanted <= CHUNK_TRIANGLES:
                self.chunks.remove(chunk)
                indices = sorted(indices + members[id(chunk)])
                break
        sizes = [len(self.placed[index].drawn.triangles) for index in indices]
        for group in in_groups(indices, sizes, CHUNK_TRIANGLES):
            yield
            chunk = Chunk([self.placed[index] for index in group])
            self.chunks.append(chunk)
            for local, index in enumerate(group):
                self._where[index] = (chunk, local)
            self.counters["chunks built"] += 1

    def _split(self, index: int, sights: Sequence[Sight], finest: float) -> bool:
        """Split an instance for these mirrors; False where it is fine as it is."""
        item = self.placed[index]
        if (found := self.ahead.split(index, item, self._angles[index], sights, finest)) is None:
            return False
        self._draw(index, found[0], min(sight.angle for sight in sights), found[1])
        self.counters["meshes split"] += 1
        return found[0] is not item.drawn

    def _draw(self, index: int, drawn: MeshArrays, angle: float = np.inf, parents: Any = slice(None)) -> None:
        item = self.placed[index]
        self.placed[index] = replace(item, drawn=drawn, pieces=self.facts.of(item.mesh).pieces.triangle_piece[parents])
        self._angles[index] = np.inf if drawn is item.mesh else angle
