# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of which something is not drawn, and the button that bakes what they look like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import bpy

from ..scene.programs.looks import look_of, may_help
from ..scene.remarks import of_one
from .messages import draw_message

MOST_LISTED = 8
"""Materials"""


def draw_looks(layout: Any, remarks: Mapping[str, Sequence[str]], context: bpy.types.Context) -> None:
    """`remarks`: causes by the name of the material."""
    for name in list(remarks)[:MOST_LISTED]:
        column = layout.column(align=True)
        for cause in remarks[name]:
            draw_message(column, of_one(cause, name), context)
        if any(map(may_help, remarks[name])) or _is_out_of_date(name):
            column.operator("curvrefl.bake_look", icon="RENDER_STILL").material = name
    if len(remarks) > MOST_LISTED:
        layout.label(text=f"and {len(remarks) - MOST_LISTED} more materials")
    material = context.object.active_material if context.object is not None else None
    if material is not None and look_of(material) is not None:
        row = layout.row(align=True)
        row.label(text=f"{material.name} is drawn by its baked look", icon="MATERIAL")
        row.operator("curvrefl.forget_look", text="", icon="X").material = material.name


def _is_out_of_date(name: str) -> bool:
    material = bpy.data.materials.get(name)
    look = look_of(material) if material is not None else None
    return look is not None and not look.is_current
