# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps of all kinds and shapes, in all places."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import DARK, add_lamp, stage


def lit(kind: str, place: tuple[float, float, float] = (1.5, -3.0, 3.0), energy: float = 300.0, **more: Any) -> Any:
    """The usual things in the dark, with one lamp, whose light goes no further: in the dark even that little shows."""
    stage(sky=DARK, sun=0.0).cycles.diffuse_bounces = 0
    return add_lamp(kind, place, energy, **more)


@awkward("a small point lamp")
def point(folder: Path) -> None:
    lit("POINT", shadow_soft_size=0.02)


@awkward("a large point lamp: soft shadows")
def point_large(folder: Path) -> None:
    lit("POINT", shadow_soft_size=1.0)


@awkward("a point lamp without a size")
def point_zero(folder: Path) -> None:
    lit("POINT", shadow_soft_size=0.0)


@awkward("a point lamp with soft falloff, within reach of things")
def point_soft_falloff(folder: Path) -> None:
    lit("POINT", (0.9, -1.9, 0.9), 60.0, shadow_soft_size=0.6, use_soft_falloff=True)


@awkward("a lamp that the camera sees")
def lamp_visible_to_camera(folder: Path) -> None:
    lit("POINT", (-1.6, 1.0, 2.2), 200.0, shadow_soft_size=0.5).visible_camera = True


@awkward("a lamp that the camera does not see, as is the default")
def lamp_invisible_to_camera(folder: Path) -> None:
    lit("AREA", (-1.6, 1.0, 2.2), 200.0, target=(0.0, -4.0, 1.0), size=1.2).visible_camera = False


@awkward("a spot with a hard edge")
def spot_hard(folder: Path) -> None:
    lit("SPOT", energy=1500.0, spot_size=0.6, spot_blend=0.0, shadow_soft_size=0.02)


@awkward("a spot with a soft edge")
def spot_blend(folder: Path) -> None:
    lit("SPOT", energy=1500.0, spot_size=0.9, spot_blend=1.0, shadow_soft_size=0.02)


@awkward("a spot of nearly a half space")
def spot_wide(folder: Path) -> None:
    lit("SPOT", energy=600.0, spot_size=3.1, spot_blend=0.1, shadow_soft_size=0.02)


@awkward("a large spot")
def spot_large(folder: Path) -> None:
    lit("SPOT", energy=1500.0, spot_size=0.7, spot_blend=0.2, shadow_soft_size=0.5)


@awkward("a spot scaled unevenly: an oval cone", words=("cone",))
def spot_scaled(folder: Path) -> None:
    lit("SPOT", energy=1500.0, spot_size=0.7, spot_blend=0.0, shadow_soft_size=0.02).scale = (2.0, 0.6, 1.0)


@awkward("a square area lamp")
def area_square(folder: Path) -> None:
    lit("AREA", shape="SQUARE", size=1.0)


@awkward("a long area lamp")
def area_rectangle(folder: Path) -> None:
    lit("AREA", shape="RECTANGLE", size=3.0, size_y=0.1)


@awkward("a disk area lamp")
def area_disk(folder: Path) -> None:
    lit("AREA", shape="DISK", size=1.5)


@awkward("an oval area lamp")
def area_ellipse(folder: Path) -> None:
    lit("AREA", shape="ELLIPSE", size=2.0, size_y=0.5)


@awkward("an area lamp with a narrow spread", words=("spread",))
def area_spread(folder: Path) -> None:
    lit("AREA", shape="SQUARE", size=0.5, spread=0.6)


@awkward("an area lamp with a spread so narrow that few of its places light a point", words=("spread",))
def area_spread_narrow(folder: Path) -> None:
    lit("AREA", shape="SQUARE", size=1.0, spread=0.4)


@awkward("an area lamp that stands in the floor")
def area_low(folder: Path) -> None:
    lit("AREA", (1.6, -2.6, 0.4), 120.0, target=(0.0, 0.0, 0.6), shape="RECTANGLE", size=0.5, size_y=0.8)


@awkward("an area lamp seen from behind, and in the mirror")
def area_from_behind(folder: Path) -> None:
    lit("AREA", (0.0, -2.5, 1.6), 100.0, target=(0.0, 0.0, 1.0), shape="SQUARE", size=0.6)


@awkward("an area lamp mirrored by its scale")
def area_mirrored(folder: Path) -> None:
    lit("AREA", shape="SQUARE", size=1.0).scale = (-1.0, 1.0, 1.0)


@awkward("an area lamp turned to shine away by a scale of -1 along Z")
def area_flipped(folder: Path) -> None:
    lit("AREA", shape="SQUARE", size=1.0).scale = (1.0, 1.0, -1.0)


@awkward("a sun without a size")
def sun_zero(folder: Path) -> None:
    lit("SUN", energy=3.0, angle=0.0)


@awkward("a sun of ten degrees")
def sun_wide(folder: Path) -> None:
    lit("SUN", energy=3.0, angle=np.radians(10.0))


@awkward("a sun of ninety degrees")
def sun_huge(folder: Path) -> None:
    lit("SUN", energy=3.0, angle=np.radians(90.0))


@awkward("a sun at the horizon")
def sun_low(folder: Path) -> None:
    lit("SUN", (3.0, -2.5, 0.35), 4.0, target=(0.0, 0.0, 0.0))


@awkward("a sun from below")
def sun_below(folder: Path) -> None:
    lit("SUN", (3.0, -2.5, -2.0), 4.0, target=(0.0, 0.0, 0.0))


@awkward("three suns of different colors")
def suns(folder: Path) -> None:
    lit("SUN", energy=2.0, color=(1.0, 0.3, 0.2))
    add_lamp("SUN", (-2.0, -2.0, 3.0), 2.0, color=(0.2, 1.0, 0.3))
    add_lamp("SUN", (0.0, 2.0, 3.0), 2.0, color=(0.3, 0.4, 1.0))


@awkward("forty lamps", words=("lamps are used",))
def many_lamps(folder: Path) -> None:
    stage(sky=DARK, sun=0.0)
    rng = np.random.default_rng(3)
    for angle in np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False):
        color = rng.uniform(0.1, 1.0, 3).tolist()
        add_lamp("POINT", (2.6 * np.cos(angle), 2.6 * np.sin(angle), 1.0), 8.0, color=color, shadow_soft_size=0.05)
