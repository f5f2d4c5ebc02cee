# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A tile of the board as programs see it: as the extension reads its mesh and its object."""

from __future__ import annotations

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.programs.instance_table import InstanceTable
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.instances.values import values_of_instance
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds, read_mesh
from curvrefl.curvrefl_addon.scene.programs.program import FACTOR, GEOMETRY, Program

from .stage import CAMERA_DISTANCE, CLIP_START, FRAME, place_on_tile

PLACE, POSITION, NORMAL, INCOMING, FIRST_ATTRIBUTE = range(5)
"""Quantities of corners; NORMAL says too whether it is a back's, INCOMING the ray's length"""


def corner_records(program: Program, tile: bpy.types.Object) -> np.ndarray:
    """(6 * quantities, 4): of the corners of both triangles."""
    evaluated = tile.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = read_mesh(evaluated.data, MeshNeeds(attributes=tuple(sorted(program.attributes)))).mesh
    matrix = np.array(tile.matrix_world)
    own = mesh.positions[mesh.corner_vertex]
    world = own @ matrix[:3, :3].T + matrix[:3, 3]
    # (Normals go with the inverse transposed.)
    normals = mesh.corner_normals @ np.linalg.inv(matrix[:3, :3])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    is_back = (normals @ np.array(FRAME.col[2])).sum() < 0.0
    quantities = [
        place_on_tile(tile, world),
        world,
        np.column_stack([-normals if is_back else normals, np.full(len(own), is_back)]),
        np.tile((*FRAME.col[2], CAMERA_DISTANCE - CLIP_START), (len(own), 1)),
    ]
    for attribute in program.attributes:
        if attribute in mesh.attributes and mesh.corner_attributes is not None:
            quantities.append(mesh.corner_attributes[:, mesh.attributes.index(attribute)])
        else:
            absent = (0.0, 0.0, 0.0, 1.0) if attribute.kind in (GEOMETRY, FACTOR) else (0.0,) * 4
            quantities.append(np.tile(absent, (len(own), 1)))
    records = np.zeros((len(quantities), 6, 4), np.float32)
    for row, values in zip(records, quantities, strict=True):
        row[:, : values.shape[1]] = values[mesh.triangles.ravel()]
    return records.reshape(-1, 4)


def instance_table(program: Program, tile: bpy.types.Object) -> InstanceTable:
    """Of the tile alone."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    # (What the depsgraph lists is there only while it is gone through.)
    asked = next(
        values_of_instance(item, [program], depsgraph.view_layer_eval)
        for item in depsgraph.object_instances
        if item.object.original == tile
    )
    shown = InstanceArrays("tile", 0, 0, np.array(tile.matrix_world), (0,), **asked)
    table = InstanceTable()
    table.follow(SceneArrays((), (shown,), (MaterialArrays("judged", program=program),), (), (), WorldArrays()))
    return table
