# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a unit of each kind of work costs: the table that ships, and the one that counts in this process."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from math import isfinite


@dataclass(frozen=True, slots=True)
class Costs:
    """Microseconds; for a choice only their proportions count."""

    pixel_by_ray: float
    """Of following the ray of a mirror pixel beyond that of shading it, which all ways have"""
    pixel_by_ray_per_doubling: float
    """What each doubling of the triangles adds to that"""
    layer_drawn: float
    """Of a mirror pixel for each layer of solved triangles drawn onto it"""
    pixel_cleared: float
    """Of a pixel of the whole view, which solved triangles need empty targets for"""
    triangle_drawn: float
    """Of a solved triangle drawn, per sub-frame"""
    vertex_solved: float
    """Of a vertex whose reflection point is solved, by the method that `auto` solves with"""
    edges_asked: float
    """What asking whether a vertex' edges leave their chords adds to it in a still: solutions are read back for that,
    and midpoints solved"""
    solve_begun: float
    """Of a mirror's solve and draw before the first vertex: programs are bound, results waited for"""
    pixel_shaded: float
    """Of shading a mirror pixel under a plain world. All ways have it, so that no choice depends on it."""

    def __post_init__(self) -> None:
        """Raises ValueError for what cannot be a cost."""
        for name, value in asdict(self).items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value < 0.0:
                raise ValueError(f"{name} is no cost: {value!r}")
        if self.pixel_by_ray + self.pixel_by_ray_per_doubling <= 0.0:
            raise ValueError("rays cannot be free")


NAMES = tuple(field.name for field in fields(Costs))
SHIPPED = Costs(
    pixel_by_ray=0.030,
    pixel_by_ray_per_doubling=0.010,
    layer_drawn=0.015,
    pixel_cleared=0.0,
    triangle_drawn=0.66,
    vertex_solved=0.85,
    edges_asked=1.45,
    solve_begun=1500.0,
    pixel_shaded=0.2,
)
"""Fitted on the processor time of a software driver on two cores (`docs/figures.md`); clearing is in the other units"""


@dataclass
class _Used:
    costs: Costs = SHIPPED


_used = _Used()


def costs_in_use() -> Costs:
    """Those that `auto` counts with."""
    return _used.costs


def use_costs(costs: Costs) -> None:
    """Have `auto` count with these from now on: a process has one device."""
    _used.costs = costs
