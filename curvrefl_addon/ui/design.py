# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of what goes from a mirror back to the scene."""

from __future__ import annotations

from typing import Any

import bpy

ANAMORPHOSES = (
    ("IMAGE", "Anamorphosis as Image", "IMAGE_DATA"),
    ("UVS", "Anamorphosis as UV Map", "UV"),
    ("MESH", "Anamorphosis as Mesh", "MESH_GRID"),
    ("PRINT", "Print Anamorphosis", "FILE_IMAGE"),
)
"""What the operator makes, what its button says, and its icon"""


class CURVREFL_PT_design(bpy.types.Panel):
    """What a mirror is to show, and what has to be where for that"""

    bl_label = "Design"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Curvrefl"
    bl_parent_id = "CURVREFL_PT_main"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender's own convention)

    def draw(self, _context: bpy.types.Context) -> None:
        column: Any = self.layout.column()
        for result, text, icon in ANAMORPHOSES:
            column.operator("curvrefl.make_anamorphosis", text=text, icon=icon).result = result


CLASSES = (CURVREFL_PT_design,)
