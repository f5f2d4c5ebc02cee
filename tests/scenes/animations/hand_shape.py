# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A right hand out of numbers: the surface round its bones, and how much each bone carries of it.

The palm is down, the fingers along X, the thumb towards Y; the wrist is the origin. Meters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from curvrefl.curvrefl_addon.demo.shapes import Shape
from curvrefl.curvrefl_addon.scene.arrays import Float64Array

CELL = 0.0034
"""Of the lattice that the surface is found on"""
SOFT_PALM, SOFT_FINGERS = 0.006, 0.0016
"""How far bones of the palm, and of fingers, flow into each other"""
BEND = 0.012
"""Half the length about a joint over which its two bones share the skin"""


@dataclass(frozen=True)
class Chain:
    """A finger with its bone in the palm, or the arm with the palm."""

    bones: tuple[str, ...]
    """Names, one for each stretch"""
    joints: Float64Array
    """(bones + 1, 3)"""
    radii: Float64Array
    """(bones + 1,)"""


def _chain(bones: tuple[str, ...], joints: list[tuple[float, float, float]], radii: list[float]) -> Chain:
    return Chain(bones, np.array(joints), np.array(radii))


def _finger(name: str, base: tuple[float, float, float], lengths: list[float], turn: float, radius: float) -> Chain:
    way = np.array([np.cos(turn), np.sin(turn), 0.0])
    joints = [(0.006, 0.5 * base[1], 0.0), base]
    joints += [tuple(np.array(base) + way * length) for length in np.cumsum(lengths)]
    radii = [0.0165, 0.0128, radius, 0.94 * radius, 0.8 * radius]
    return _chain(("palm", *(f"{name} {n}" for n in (1, 2, 3))), joints, radii)


FINGERS = (
    _finger("index", (0.094, 0.029, 0.001), [0.043, 0.026, 0.019], np.radians(6.0), 0.0092),
    _finger("middle", (0.098, 0.0085, 0.003), [0.047, 0.03, 0.02], np.radians(1.0), 0.0094),
    _finger("ring", (0.093, -0.0115, 0.001), [0.043, 0.027, 0.019], np.radians(-5.0), 0.0088),
    _finger("little", (0.084, -0.0305, -0.002), [0.034, 0.021, 0.016], np.radians(-12.0), 0.0078),
)
THUMB = _chain(
    ("palm", "thumb 1", "thumb 2", "thumb 3"),
    [
        (0.008, 0.018, -0.003),
        (0.026, 0.03, -0.009),
        (0.052, 0.051, -0.014),
        (0.08, 0.064, -0.015),
        (0.102, 0.07, -0.015),
    ],
    [0.016, 0.0168, 0.0128, 0.0108, 0.0088],
)
ARM = _chain(("arm", "palm"), [(-0.4, 0.0, 0.0), (0.0, 0.0, 0.0), (0.05, 0.0, 0.0)], [0.029, 0.0255, 0.0175])
CHAINS = (*FINGERS, THUMB, ARM)


def hand_shape() -> Shape:
    """The skin of the hand at rest; each arm's end is closed."""
    joints = np.concatenate([chain.joints for chain in CHAINS])
    low, high = joints.min(axis=0) - 0.045, joints.max(axis=0) + 0.045
    counts = np.ceil((high - low) / CELL).astype(int)
    axes = [low[k] + CELL * np.arange(counts[k]) for k in range(3)]
    lattice = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return _surface_net(_level(lattice.reshape(-1, 3)).reshape(tuple(counts)), low)


def weights(points: Float64Array) -> dict[str, Float64Array]:
    """For each bone what share (n,) it has of points (n, 3) of the skin at rest: 1 in all at each."""
    gaps = np.stack([_to_chain(points, chain)[0] for chain in CHAINS])
    nearest = gaps.argmin(axis=0)
    found: dict[str, Float64Array] = {}
    for number, chain in enumerate(CHAINS):
        mine = nearest == number
        along = _to_chain(points[mine], chain)[1]
        ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(chain.joints, axis=0), axis=1))])
        # How far each point is over each joint, from 0 before it to 1 behind it
        over = np.clip(0.5 + 0.5 * (along[:, None] - ends[None, 1:-1]) / BEND, 0.0, 1.0)
        over = np.column_stack([np.ones(len(along)), over, np.zeros(len(along))])
        for index, bone in enumerate(chain.bones):
            share = found.setdefault(bone, np.zeros(len(points)))
            share[mine] += over[:, index] - over[:, index + 1]
    return found


def _to_chain(points: Float64Array, chain: Chain) -> tuple[Float64Array, Float64Array]:
    """(n,) distances from points (n, 3) to the skin of one chain alone, and how far along it its nearest places are."""
    best, where, start = np.full(len(points), np.inf), np.zeros(len(points)), 0.0
    for index in range(len(chain.bones)):
        a, b = chain.joints[index], chain.joints[index + 1]
        length = float(np.linalg.norm(b - a))
        t = np.clip((points - a) @ (b - a) / length**2, 0.0, 1.0)
        radius = chain.radii[index] + t * (chain.radii[index + 1] - chain.radii[index])
        gap = np.linalg.norm(points - a - t[:, None] * (b - a), axis=1) - radius
        nearer = gap < best
        best[nearer] = gap[nearer]
        where[nearer] = start + t[nearer] * length
        start += length
    return best, where


def _level(points: Float64Array) -> Float64Array:
    """(n,) distance to the skin, negative inside: bones flow into each other, in the palm more than between fingers."""
    palm, fingers = [], []
    for chain in CHAINS:
        for index, bone in enumerate(chain.bones):
            part = Chain((bone,), chain.joints[index : index + 2], chain.radii[index : index + 2])
            group = fingers if bone[-1].isdigit() and bone != "thumb 1" else palm
            group.append(_to_chain(points, part)[0])
    return _joined([_joined(palm, SOFT_PALM), _joined(fingers, SOFT_FINGERS)], 0.5 * (SOFT_PALM + SOFT_FINGERS))


def _joined(levels: list[Float64Array], soft: float) -> Float64Array:
    stacked = np.stack(levels)
    least = stacked.min(axis=0)
    return least - soft * np.log(np.exp(-(stacked - least) / soft).sum(axis=0))


def _surface_net(level: Float64Array, low: Float64Array) -> Shape:
    """The surface where a lattice (x, y, z) of levels is 0: a point in each cell that it crosses, the mean of where it
    crosses the cell's edges, and a quad about each such edge (naive surface nets, Gibson 1998)."""
    inside = level < 0.0
    cells = tuple(n - 1 for n in level.shape)
    total, count = np.zeros((*cells, 3)), np.zeros(cells)
    corners = [np.array([i, j, k]) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

    def at(array: np.ndarray, corner: np.ndarray) -> np.ndarray:
        i, j, k = corner
        return array[i : i + cells[0], j : j + cells[1], k : k + cells[2]]

    for start in corners:
        for axis in range(3):
            if start[axis]:
                continue
            end = start + np.eye(3, dtype=int)[axis]
            a, b = at(level, start), at(level, end)
            crosses = (a < 0.0) != (b < 0.0)
            t = np.where(crosses, a / np.where(crosses, a - b, 1.0), 0.0)
            place = np.broadcast_to(start.astype(float), (*cells, 3)).copy()
            place[..., axis] += t
            total += np.where(crosses[..., None], place, 0.0)
            count += crosses
    used = count > 0
    number = np.full(cells, -1)
    number[used] = np.arange(int(used.sum()))
    index = np.stack(np.nonzero(used), axis=1)
    positions = low + CELL * (index + total[used] / count[used][:, None])
    quads: list[np.ndarray] = []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        a = np.moveaxis(inside, axis, 0)[:-1]
        b = np.moveaxis(inside, axis, 0)[1:]
        edge = np.moveaxis(a != b, 0, axis)
        where = np.stack(np.nonzero(edge), axis=1)
        where = where[(where[:, first] > 0) & (where[:, second] > 0)]
        where = where[(where[:, first] < cells[first]) & (where[:, second] < cells[second])]
        around = []
        for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
            cell = where.copy()
            cell[:, first] -= di
            cell[:, second] -= dj
            around.append(number[tuple(cell.T)])
        loop = np.stack(around, axis=1)
        outward = inside[tuple(where.T)]
        quads.append(np.where(outward[:, None], loop, loop[:, ::-1]))
    return Shape(positions, tuple(map(tuple, np.concatenate(quads).tolist())))
