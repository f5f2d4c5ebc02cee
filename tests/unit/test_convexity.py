# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convexity of meshes whose shape is known."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy", reason="renderer.geometry imports Blender's gpu module")

from curvrefl.curvrefl_addon.optics.radial_surfaces import Bumpy, Ellipsoid, RadialSurface
from curvrefl.curvrefl_addon.renderer.convexity import is_convex
from curvrefl.curvrefl_addon.renderer.geometry import WorldGeometry
from scenes.mirror_room import radial_mesh


def geometry(surface: RadialSurface) -> WorldGeometry:
    shape = radial_mesh(surface, 64)
    count = len(shape.positions)
    return WorldGeometry(
        positions=shape.positions,
        position_object=np.ones(count, np.int32),
        corner_position=shape.corner_vertex,
        corner_normals=shape.corner_normals,
        corner_uv=np.zeros((count, 2), np.float32),
        corner_color=None,
        triangles=shape.triangles,
        triangle_material=np.zeros(len(shape.triangles), np.int32),
    )


def test_ellipsoid_is_convex() -> None:
    assert is_convex(geometry(Ellipsoid(1.0, 0.5, 0.25)))


def test_bumpy_is_not() -> None:
    assert not is_convex(geometry(Bumpy(0.3)))
