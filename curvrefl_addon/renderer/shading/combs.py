# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature combs: planes cut the mirrors, and teeth across each section say how much it bends there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.meshes.sections import Section, sections
from ...scene.arrays import Float64Array
from ..mirrors.mirror import Mirror
from .curvature import PERCENTILE, Curvatures, PlacedCurvature

SHARE = 0.2
"""Of the largest mirror's size: how long teeth are at a scale of 1"""
LONGEST = 2.5
"""Times that: longer teeth are cut off"""
SECTION, TOOTH, ENVELOPE = (0.95, 0.95, 0.95, 1.0), (0.16, 0.72, 0.66, 0.9), (1.0, 0.62, 0.1, 1.0)
CUT_OFF = (0.95, 0.12, 0.25, 0.9)
"""sRGB and alpha"""
AWAY = -0.2
"""Cosine of the angle between a normal and the way to the eye below which a side looks away"""
BEHIND = 0.2
"""Share of their alpha that is left of teeth there"""


@dataclass(frozen=True, slots=True)
class CombOptions:
    """What is cut, and how it is shown."""

    plane: str = "OBJECT"
    """Whose axes and origin the plane has: each mirror's "OBJECT", the "WORLD", or the "CURSOR" """
    axis: str = "X"
    """Which of the axes it is across"""
    offset: float = 0.0
    """How far along that axis it is moved, meters"""
    teeth: int = 150
    """Of each section"""
    scale: float = 1.0
    cursor: tuple[float, ...] = tuple(np.eye(4).ravel().tolist())
    """Matrix of the 3D cursor, row by row"""


@dataclass(frozen=True, slots=True)
class Comb:
    """A section of a mirror. World space."""

    mirror: str
    """Name of the object"""
    section: Section
    tips: Float64Array
    """(n, 3) ends of the teeth, NaN where there is no curvature"""
    is_cut: NDArray[np.bool_]
    """(n,) of teeth that would be longer"""


@dataclass(frozen=True, slots=True)
class CombSet:
    """Of all mirrors."""

    combs: tuple[Comb, ...]
    length: float
    """Of a tooth for a curvature of 1 / m, meters"""

    def rows(self) -> list[tuple[str, str]]:
        """Label and value, for a panel."""
        if not self.combs:
            return [("Sections", "none: the plane cuts no mirror")]
        each = np.concatenate([comb.section.curvature for comb in self.combs])
        rows = [("Sections", str(len(self.combs)))]
        if np.isfinite(each).any():
            low, high = float(np.nanmin(each)), float(np.nanmax(each))
            rows += [("Curvature", f"{low:.4g} to {high:.4g} 1/m"), ("Smallest Radius", _radius(max(-low, high)))]
            rows.append(("1 cm of a Tooth", f"{0.01 / self.length:.3g} 1/m"))
        if missing := int(np.isnan(each).sum()):
            rows.append(("Left Out", f"{missing} points where the plane only touches"))
        if cut := sum(int(comb.is_cut.sum()) for comb in self.combs):
            rows.append(("Cut Off", f"{cut} teeth, in red"))
        return rows

    def segments(self, eye: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Lines (n, 2, 3) and their colors (n, 4) as seen from the homogeneous `eye` (4,)."""
        lines, colors = [np.zeros((0, 2, 3))], [np.zeros((0, 4))]
        for comb in self.combs:
            points, tips = comb.section.points, comb.tips
            to_eye = eye[:3] - eye[3] * points
            away = (to_eye * comb.section.outwards).sum(axis=1) < AWAY * np.linalg.norm(to_eye, axis=1)
            after = np.roll(np.arange(len(points)), -1)
            if not comb.section.is_closed:
                after[-1] = len(points) - 1
            whole = ~comb.is_cut
            for start, end, color, kept in (
                (points, points[after], SECTION, True),
                (points, tips, TOOTH, whole),
                (points, tips, CUT_OFF, comb.is_cut),
                (tips, tips[after], ENVELOPE, whole & whole[after]),
            ):
                kept = kept & np.isfinite(start).all(axis=1) & np.isfinite(end).all(axis=1)
                colored = np.tile(color, (len(start), 1))
                colored[away, 3] *= BEHIND
                lines.append(np.stack([start, end], axis=1)[kept])
                colors.append(colored[kept])
        return np.concatenate(lines), np.concatenate(colors)


class Combs:
    """Of a scene's mirrors, found when they are asked for and kept until something is not as before."""

    def __init__(self, curvatures: Curvatures) -> None:
        self._curvatures = curvatures
        self._key: tuple[list[PlacedCurvature], CombOptions, bytes] | None = None
        self._found = CombSet((), 1.0)

    def of(self, mirrors: Sequence[Mirror], options: CombOptions, origin: Float64Array) -> CombSet | None:
        """None while the mirrors' curvature is not known. `origin` (3,): where in the world theirs is."""
        known = self._curvatures.known_of(mirrors)
        if known is None:
            return None
        # (Held, so that no other instance gets the address of one.)
        key = (known, options, origin.tobytes())
        if self._key is not None and key[1:] == self._key[1:] and _are_same(known, self._key[0]):
            return self._found
        found: list[tuple[str, Section]] = []
        size = 0.0
        for mirror, placed in zip(mirrors, known, strict=True):
            curvature, turn = placed.curvature, placed.turn
            place = placed.instance.matrix[:3, 3] + origin
            point, across = _plane(options, turn, place)
            # (In the axes of the stretched mesh.)
            cut = sections(
                curvature.positions,
                curvature.normals,
                curvature.tensors,
                curvature.triangles,
                turn.T @ (point - place),
                turn.T @ across,
            )
            even = (section.resampled(options.teeth) for section in cut)
            found += [(mirror.object_name, _placed(section, turn, place)) for section in even]
            size = max(size, float(np.linalg.norm(np.ptp(curvature.positions, axis=0))))
        self._found = _toothed(found, options.scale * SHARE * size)
        self._key = key
        return self._found


def _are_same(some: Sequence[PlacedCurvature], others: Sequence[PlacedCurvature]) -> bool:
    return len(some) == len(others) and all(one is other for one, other in zip(some, others, strict=True))


def _plane(options: CombOptions, turn: Float64Array, place: Float64Array) -> tuple[Float64Array, Float64Array]:
    """A point (3,) of the plane and the unit vector (3,) across it, of a mirror that is turned and placed so."""
    cursor = np.array(options.cursor).reshape(4, 4)
    axes, point = {
        "OBJECT": (turn, place),
        "WORLD": (np.eye(3), np.zeros(3)),
        "CURSOR": (cursor[:3, :3], cursor[:3, 3]),
    }[options.plane]
    across = axes[:, "XYZ".index(options.axis)]
    across = across / np.linalg.norm(across)
    return point + options.offset * across, across


def _placed(section: Section, turn: Float64Array, place: Float64Array) -> Section:
    return Section(section.points @ turn.T + place, section.outwards @ turn.T, section.curvature, section.is_closed)


def _toothed(found: Sequence[tuple[str, Section]], longest: float) -> CombSet:
    """With teeth of which nineteen of twenty are shorter than that."""
    each = np.concatenate([np.zeros(0), *(np.abs(section.curvature) for _, section in found)])
    each = each[np.isfinite(each)]
    end = float(np.percentile(each, PERCENTILE)) if len(each) else 0.0
    length = longest / end if end * longest > 0.0 else 1.0
    combs = []
    for name, section in found:
        reach = length * section.curvature
        cut = np.clip(reach, -LONGEST * longest, LONGEST * longest)
        combs.append(Comb(name, section, section.points + cut[:, None] * section.outwards, np.abs(reach) > np.abs(cut)))
    return CombSet(tuple(combs), length)


def _radius(curvature: float) -> str:
    return f"{1.0 / curvature:.4g} m" if curvature > 0.0 else "none"
