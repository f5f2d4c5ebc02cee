# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convexity of meshes whose shape is known."""

from __future__ import annotations

from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid
from curvrefl.curvrefl_addon.renderer.geometry.convexity import is_convex
from scenes.mirror_room import radial_mesh


def test_ellipsoid_is_convex() -> None:
    assert is_convex(radial_mesh(Ellipsoid(1.0, 0.5, 0.25), 64))


def test_bumpy_is_not() -> None:
    assert not is_convex(radial_mesh(Bumpy(0.3), 64))
