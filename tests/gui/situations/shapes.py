# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes that a mirror or a mesh should not have."""

from __future__ import annotations

from collections.abc import Callable

import bmesh
import bpy
from situations.opened_file import CAUSED, Steps, block, mirror, opened, situation


def changed_mesh(item: bpy.types.Object, change: Callable[[bmesh.types.BMesh], None]) -> None:
    faces = bmesh.new()
    faces.from_mesh(item.data)
    change(faces)
    faces.to_mesh(item.data)
    faces.free()
    item.data.update()


def cut_in_half(faces: bmesh.types.BMesh) -> None:
    bmesh.ops.delete(faces, geom=[vertex for vertex in faces.verts if vertex.co.z < 0.0], context="VERTS")


def grown_fin(faces: bmesh.types.BMesh) -> None:
    """A third face at an edge."""
    faces.edges.ensure_lookup_table()
    one, other = faces.edges[0].verts
    faces.faces.new((one, other, faces.verts.new(one.co * 1.5)))


@situation
def mirror_open() -> Steps:
    bpy.context.scene.curvrefl.method = "secant_star"
    changed_mesh(mirror(), cut_in_half)
    yield CAUSED
    yield from opened()


@situation
def mirror_open_under_rays() -> Steps:
    bpy.context.scene.curvrefl.method = "exact"
    changed_mesh(mirror(), cut_in_half)
    yield CAUSED
    yield from opened()


@situation
def mirror_not_manifold() -> Steps:
    changed_mesh(mirror(), grown_fin)
    yield CAUSED
    yield from opened()


@situation
def scenery_open_and_not_manifold() -> Steps:
    changed_mesh(block(), grown_fin)
    changed_mesh(block(), cut_in_half)
    yield CAUSED


@situation
def scenery_scaled_negative() -> Steps:
    block().scale = (-1.0, 1.0, 1.0)
    yield CAUSED


@situation
def mirror_scaled_negative() -> Steps:
    mirror().scale = (-1.0, 1.0, 1.0)
    yield CAUSED


@situation
def mirror_scaled_to_nothing() -> Steps:
    mirror().scale = (0.0, 0.0, 0.0)
    yield CAUSED
    mirror().scale = (1.0, 1.0, 1.0)


def with_nan(item: bpy.types.Object) -> None:
    # (of an infinity Blender makes the largest number, which is finite)
    item.data.vertices[0].co = (float("nan"), 0.0, 0.0)
    item.data.vertices[1].co = (0.0, float("nan"), 0.0)
    item.data.update()


@situation
def scenery_with_nan() -> Steps:
    with_nan(block())
    yield CAUSED
    yield from opened()


@situation
def mirror_with_nan() -> Steps:
    with_nan(mirror())
    yield CAUSED
    yield from opened()
