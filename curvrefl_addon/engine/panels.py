# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels whose settings the engine follows, shown where it is chosen."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

LIKE = "BLENDER_RENDER"
"""Blender's panels that are for every engine name it"""
LEFT_OUT = (
    "DATA_PT_light",
    "DATA_PT_area",
    "DATA_PT_falloff_curve",
    "RENDER_PT_stereoscopy",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
)
"""Those of them whose settings are of no use to it"""
OF_EEVEE = (
    "DATA_PT_EEVEE_light",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "MATERIAL_PT_preview",
    "WORLD_PT_preview",
)
"""What only names EEVEE and is for every engine that knows Blender's shaders"""


def add(engine: str) -> None:
    """Show them with `engine`."""
    for panel in _panels():
        panel.COMPAT_ENGINES.add(engine)


def remove(engine: str) -> None:
    """As before."""
    for panel in _panels():
        panel.COMPAT_ENGINES.discard(engine)


def _panels() -> Iterator[Any]:
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in OF_EEVEE or (LIKE in engines and panel.__name__ not in LEFT_OUT):
            yield panel
