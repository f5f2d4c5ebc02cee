# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances by themselves: where their boxes are, how far their matrices stretch, what tells one from another."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import compress
from operator import attrgetter, is_not

import numpy as np
from numpy.typing import NDArray

from ...memory import require_memory
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays, SceneArrays
from .chunk import Placed
from .mesh_facts import MeshFactsCache
from .split import TOO_FINE
from .vertex_uploads import is_deformed

CORNERS = np.indices((2, 2, 2)).reshape(3, 8).T
"""(8, 3) which end of a box each of its corners has"""


@dataclass(slots=True)
class Difference:
    """What an update changed."""

    moved: list[int] = field(default_factory=list)
    """Indices of instances whose matrices alone changed, unless `structure`"""
    deformed: list[int] = field(default_factory=list)
    """And of those whose vertices are elsewhere in object space, their matrices too or not"""
    structure: bool = False
    """Instances came, went or changed in more than that"""

    @property
    def elsewhere(self) -> list[int]:
        """Indices of instances of either kind."""
        return self.moved + self.deformed


@dataclass(frozen=True, slots=True)
class Sight:
    """How finely a mirror needs its scenery split (see `split`)."""

    center: tuple[float, float, float]
    """Star center, world space"""
    angle: float
    own: int
    """Index of the mirror's instance"""


def corners_of_boxes(boxes: Float64Array, matrices: Float64Array) -> Float64Array:
    """(n, 8, 3) corners of boxes (n, 2, 3), lowest and highest corner, where matrices (n, 4, 4) put them."""
    corners = np.stack([boxes[:, CORNERS[:, axis], axis] for axis in range(3)], axis=-1)
    return np.einsum("nij,nkj->nki", matrices[:, :3, :3], corners) + matrices[:, None, :3, 3]


def box_around(points: Float64Array) -> Float64Array:
    """(8, 4) homogeneous corners of the box around points (n, 3)."""
    return np.column_stack([np.where(CORNERS, points.max(axis=0), points.min(axis=0)), np.ones(8)])


def estimated_bytes(scene: SceneArrays, with_rays: bool = False) -> int:
    """GPU memory that the meshes will take, about, before edges are split; `with_rays`: and their hierarchies."""
    sizes = [
        32 * len(mesh.positions) + 64 * len(mesh.corner_vertex) + 24 * len(mesh.triangles) for mesh in scene.meshes
    ]
    total = sum(sizes[instance.mesh] for instance in scene.instances)
    if with_rays:
        used = [scene.meshes[index] for index in {instance.mesh for instance in scene.instances}]
        # (a triangle's records, its share of the nodes, twice while the texture grows; corners)
        total += sum(200 * len(mesh.triangles) + 64 * len(mesh.corner_vertex) for mesh in used)
    return total


def require_room(scene: SceneArrays) -> None:
    """Raises InputError where the meshes of all instances are more than memory holds: drivers end a program for it."""
    require_memory(estimated_bytes(scene), "The scene", "hide objects, or make their meshes coarser")


def stretches_of(matrices: Float64Array) -> Float64Array:
    """(n,) the most that matrices (n, 4, 4) lengthen anything, or a little more; exact without shear."""
    linear = matrices[:, :3, :3]
    squared = np.abs(np.einsum("nki,nkj->nij", linear, linear))
    return np.sqrt(squared.sum(axis=2).max(axis=1))


def may_be_coarse(
    some: Sequence[Placed],
    indices: NDArray[np.int64],
    angles: Float64Array,
    balls: tuple[Float64Array, Float64Array],
    facts: MeshFactsCache,
    sight: Sight,
) -> NDArray[np.bool_]:
    """(n,) which instances may have an edge that is too long for a mirror, or are far too fine: by their balls (centers
    (n, 3), radii (n,)), longest edges, and the angles (n,) that they are split with. `indices`: theirs in the scene."""
    centers, radii = balls
    matrices = np.array([item.instance.matrix for item in some])
    edges = np.array([facts.of(item.drawn).longest_edge for item in some])
    nearest = np.maximum(np.linalg.norm(centers - sight.center, axis=1) - radii, 0.0)
    coarse = edges * stretches_of(matrices) > sight.angle * nearest
    fine = angles * TOO_FINE < sight.angle
    shown = (indices != sight.own) & np.array([item.instance.visible_glossy for item in some])
    return (coarse | fine) & shown


def instance_keys(instances: Iterable[InstanceArrays]) -> list[tuple[int, int]]:
    """(object_id, which of the object's instances) of each."""
    counts: dict[int, int] = {}
    keys = []
    for instance in instances:
        number = counts.get(instance.object_id, 0)
        counts[instance.object_id] = number + 1
        keys.append((instance.object_id, number))
    return keys


def others(before: Sequence[InstanceArrays], after: Sequence[InstanceArrays]) -> list[int]:
    """Indices of instances that are other objects than `before`, as many."""
    return list(compress(range(len(after)), map(is_not, before, after)))


type Numbered = tuple[SceneArrays, dict[int, int]]
"""A scene, and its mirrors' numbers by their instances"""


@dataclass(frozen=True, slots=True)
class Elsewhere:
    """What is not where it was."""

    moved: list[int]
    """Indices of instances whose matrices are others, unless `deformed`"""
    deformed: list[int]
    """And of those that show a mesh which has deformed"""
    meshes: list[tuple[MeshArrays, MeshArrays]]
    """These meshes as they were and as they are"""


def things_elsewhere(before: Numbered, after: Numbered) -> Elsewhere | None:
    """None where more than places has changed."""
    (old, old_numbers), (new, numbers) = before, after
    if len(old.instances) != len(new.instances) or len(old.meshes) != len(new.meshes) or old_numbers != numbers:
        return None
    shapes: dict[int, tuple[MeshArrays, MeshArrays]] = {}
    if old.meshes is not new.meshes:
        pairs = enumerate(zip(old.meshes, new.meshes, strict=True))
        shapes = {index: (one, other) for index, (one, other) in pairs if one is not other}
    found = others(old.instances, new.instances)
    if any(not is_deformed(*pair) for pair in shapes.values()) or any(
        _all_but_place(old.instances[index]) != _all_but_place(new.instances[index]) for index in found
    ):
        return None
    deformed = [index for index, item in enumerate(new.instances) if item.mesh in shapes] if shapes else []
    return Elsewhere(
        [index for index in found if new.instances[index].mesh not in shapes], deformed, [*shapes.values()]
    )


_FOR_BATCHES = ("materials", "visible_camera", "visible_glossy", "visible_shadow", "holdout", "shadow_set")
_for_batches = attrgetter(*_FOR_BATCHES)
"""What an instance's batches are made of beside its mesh"""
_all_but_place = attrgetter("object_id", "mesh", "visible_transmission", *_FOR_BATCHES)
"""And its records, beside its matrix"""


def placed_elsewhere(
    placed: Sequence[Placed], before: Numbered, after: Numbered, facts: MeshFactsCache
) -> tuple[list[Placed], Difference] | None:
    """What was `placed` before, at other places; None where more has changed, or parts of split edges would have to
    follow a mesh that deforms."""
    found = things_elsewhere(before, after)
    if found is None or any(placed[index].drawn is not placed[index].mesh for index in found.deformed):
        return None
    scene, result = after[0], [*placed]
    for index in found.moved:
        result[index] = replace(placed[index], instance=scene.instances[index])
    for index in found.deformed:
        result[index] = deformed_item(placed[index], scene, index, placed[index].mirror, facts)
    return result, Difference(found.moved, found.deformed)


def deformed_item(known: Placed, scene: SceneArrays, index: int, number: int, facts: MeshFactsCache) -> Placed:
    """The instance `index` of a scene, which was `known` before its mesh had the vertices elsewhere; its mirror's
    `number`."""
    instance = scene.instances[index]
    mesh = scene.meshes[instance.mesh]
    return Placed(instance, mesh, mesh, facts.deform(known.mesh, mesh).pieces.triangle_piece, number)


def matched(placed: Sequence[Placed], instances: Sequence[InstanceArrays]) -> list[int | None]:
    """For each instance the index of the one that was `placed` before."""
    if len(placed) == len(instances):
        differ = [item.instance is not new for item, new in zip(placed, instances, strict=True)]
        if not any(differ) or all(
            placed[index].instance.object_id == instances[index].object_id for index in np.flatnonzero(differ).tolist()
        ):
            return list(range(len(instances)))
    before = {key: index for index, key in enumerate(instance_keys(item.instance for item in placed))}
    return [before.get(key) for key in instance_keys(instances)]


def differs_in_place_only(known: Placed, instance: InstanceArrays, number: int) -> bool:
    is_same = _for_batches(known.instance) == _for_batches(instance)
    return is_same and bool(known.mirror) == bool(number)


def differs_in_vertices_only(known: Placed, instance: InstanceArrays, mesh: MeshArrays, number: int) -> bool:
    """Whether its mesh has its vertices elsewhere now, and it may be at another place. (Parts of split edges cannot
    follow.)"""
    is_whole = known.drawn is known.mesh and is_deformed(known.mesh, mesh)
    return is_whole and differs_in_place_only(known, instance, number)


def in_groups(items: Sequence[int], sizes: Sequence[int], enough: int) -> Iterator[list[int]]:
    """The items in turn, each group as soon as its sizes add up to `enough`."""
    group: list[int] = []
    total = 0
    for item, size in zip(items, sizes, strict=True):
        group.append(item)
        total += size
        if total >= enough:
            yield group
            group, total = [], 0
    if group:
        yield group
