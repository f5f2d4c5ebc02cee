# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A map of caustics: patches of what throws light, followed to where they land, as lists of pieces of light."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float32Array, Float64Array, SceneArrays
from ..rays.ray_scene import RayScene
from ..surfaces.surface_buffer import SEEN_THROUGH
from .casters import Casters
from .corner_paths import AT_ONCE, CORNER_RECORDS, CornerPaths, Throw
from .lists import records_of
from .patches import LampPoint, Patches, Points, patches_of, to_lamp
from .pieces import Landed, Pieces, joined_pieces, pieces_of

MOST_PARTED = 1.0
"""Quarters of parted patches over all that are asked for: more are left as they are"""


@dataclass(frozen=True, slots=True)
class CausticMap:
    """Light of one point of each lamp."""

    records: Float32Array
    """See `lists.records_of`"""
    patches: int
    pieces: int


def thrown(
    scene: SceneArrays,
    casters: Casters,
    lamps: list[LampPoint],
    paths: CornerPaths,
    throw: Throw,
    wanted: int,
    rounds: int,
) -> Generator[None, None, CausticMap]:
    """A map with about so many patches, in steps. Those that are parted where they land are quartered, so many
    `rounds`."""
    patches = patches_of(casters, lamps, wanted, throw.turn, not throw.by_chance)
    found: list[Pieces] = []
    count = 0
    for turn in range(rounds + 1):
        if patches.count == 0:
            break
        if throw.by_chance:
            # (Corners that patches share would have to go one way in all of them.)
            patches = patches.parted()
        there = yield from _followed(scene, casters, lamps, patches, paths, throw)
        count += patches.count
        yield
        is_parted = there.is_parted
        # (Where most are parted there is no edge to be found.)
        if turn == rounds or 4 * np.count_nonzero(is_parted) > MOST_PARTED * max(wanted, patches.count):
            is_parted[:] = False
        facing = _cosines(casters, lamps, patches)
        whole = ~is_parted
        sizes = _sizes(casters, patches)[whole]
        found.append(pieces_of(there.of(whole), (patches.areas * facing)[whole], sizes))
        yield
        patches = patches.quartered(is_parted)
    pieces = joined_pieces(found)
    yield
    return CausticMap(records_of(pieces), count, pieces.count)


def _followed(
    scene: SceneArrays,
    casters: Casters,
    lamps: list[LampPoint],
    patches: Patches,
    paths: CornerPaths,
    throw: Throw,
) -> Generator[None, None, Landed]:
    """Where the corners of patches land."""
    read: list[list[Float32Array]] = []
    # (Corners of a patch that go by chance have the same place in three pictures, and the same chance.)
    part = min(AT_ONCE, patches.count) if throw.by_chance else AT_ONCE
    starts = range(0, patches.points.count, patches.count) if throw.by_chance else (0,)
    ends = [*starts, patches.points.count][1:]
    for start, end in zip(starts, ends, strict=True):
        for first in range(start, end, part):
            some = patches.points.of(slice(first, min(first + part, end)))
            yield from paths.follow(throw, _corners(scene, casters, lamps, some, throw.around.rays))
            read.append(paths.read(some.count))
            yield
    columns = [np.concatenate([one[k] for one in read]).astype(np.float64) for k in range(4)]
    place, normal, way, power = (column[patches.corners] for column in columns)
    return Landed(place[..., :3], place[..., 3], normal[..., :3], way[..., :3], power[..., :3], way[..., 3])


def _sizes(casters: Casters, patches: Patches) -> Float64Array:
    """(n, 2) the longest side of each patch, and its height over that."""
    ends = np.einsum("nkw,nwc->nkc", patches.weights, casters.corners[patches.triangles])
    longest = np.linalg.norm(np.roll(ends, -1, axis=1) - ends, axis=2).max(axis=1)
    area = np.linalg.norm(np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0]), axis=1)
    return np.stack([longest, area / np.maximum(longest, 1e-300)], axis=1)


def _cosines(casters: Casters, lamps: list[LampPoint], patches: Patches) -> Float64Array:
    """(n,) of patches to the light of their lamps."""
    middles = np.einsum("nkw,nwc->nc", patches.weights, casters.corners[patches.triangles]) / 3.0
    cosines = np.zeros(patches.count)
    for number, (_, place) in enumerate(lamps):
        mine = np.flatnonzero(patches.lamps == number)
        way, _ = to_lamp(middles[mine], place)
        cosine = np.einsum("nc,nc->n", way, casters.facing[patches.triangles[mine]])
        is_closed = casters.is_closed[patches.triangles[mine]]
        cosines[mine] = np.where(is_closed, np.maximum(cosine, 0.0), np.abs(cosine))
    return cosines


def _corners(
    scene: SceneArrays, casters: Casters, lamps: list[LampPoint], points: Points, rays: RayScene
) -> Float32Array:
    """(m, CORNER_RECORDS, 4) records of `lit_corners.frag.glsl`."""
    chosen = points.triangles
    records = np.zeros((points.count, CORNER_RECORDS, 4), np.float32)
    places = np.einsum("nw,nwc->nc", points.weights, casters.corners[chosen])
    normals = unit(np.einsum("nw,nwc->nc", points.weights, casters.normals[chosen]))
    side = np.ones(points.count)
    for number, (_, place) in enumerate(lamps):
        mine = np.flatnonzero(points.lamps == number)
        way, _ = to_lamp(places[mine], place)
        side[mine] = np.where(np.einsum("nc,nc->n", way, casters.facing[chosen[mine]]) < 0.0, -1.0, 1.0)
    # (What is closed is lit from without alone.)
    side = np.where(casters.is_closed[chosen], 1.0, side)
    mirrors = casters.mirrors[chosen]
    light_sets = np.array([material.light_set for material in scene.materials])
    records[:, 0, :3], records[:, 0, 3] = places, points.lamps
    records[:, 1, :3] = side[:, None] * normals
    records[:, 1, 3] = casters.materials[chosen] + np.where(side < 0.0, 0.25, 0.0)
    records[:, 2, :3], records[:, 2, 3] = side[:, None] * casters.facing[chosen], casters.objects[chosen]
    records[:, 3, 0] = np.where(mirrors > 0, mirrors, SEEN_THROUGH)
    records[:, 3, 1] = light_sets[casters.materials[chosen]]
    for index in np.unique(casters.instances[chosen]).tolist():
        mine = np.flatnonzero(casters.instances[chosen] == index)
        number, order = rays.numbers_of(index)
        records[mine, 4, 0] = number
        records[mine, 4, 1] = order[casters.triangles[chosen[mine]]]
        records[mine, 4, 2:] = points.weights[mine, 1:]
    return records
