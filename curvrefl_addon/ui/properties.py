# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of objects and scenes, saved in the .blend file, and the switch, which is not."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from ..optics.catalogue import METHODS


def _is_switched(_self: Any, context: bpy.types.Context) -> None:
    from .. import viewport

    viewport.switch(context.window_manager.curvrefl_enabled)


def _needs_redraw(_self: Any, _context: bpy.types.Context | None) -> None:
    from .. import viewport

    viewport.forget_scene()


class CurvreflObject(bpy.types.PropertyGroup):
    """Settings of one object"""

    is_mirror: BoolProperty(  # type: ignore[valid-type]
        name="Mirror",
        description="Show what this object reflects. It needs a material that reflects, and a shape that is seen whole "
        "from a point inside",
        default=False,
        update=_needs_redraw,
    )


class CurvreflScene(bpy.types.PropertyGroup):
    """Settings of one scene"""

    method: EnumProperty(  # type: ignore[valid-type]
        name="Method",
        description="How reflections are found",
        items=[(name, method.label, f"{method.source}. Assumes: {method.assumes}") for name, method in METHODS.items()],
        default="secant_star",
        update=_needs_redraw,
    )
    pixel_tolerance: FloatProperty(  # type: ignore[valid-type]
        name="Tolerance",
        description="Largest error of a reflected edge in pixels; smaller is slower",
        subtype="PIXEL",
        default=0.5,
        min=0.05,
        max=20.0,
        update=_needs_redraw,
    )
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples",
        description="Pictures that are averaged against jagged edges while the view rests",
        default=8,
        min=1,
        max=64,
        update=_needs_redraw,
    )


CLASSES = (CurvreflObject, CurvreflScene)


def add() -> None:
    """Attach the groups to Blender's types; the classes are registered."""
    bpy.types.Object.curvrefl = PointerProperty(type=CurvreflObject)
    bpy.types.Scene.curvrefl = PointerProperty(type=CurvreflScene)
    bpy.types.WindowManager.curvrefl_enabled = BoolProperty(
        name="Curved Reflections",
        description="Show what the mirrors reflect in all 3D viewports",
        default=False,
        options={"SKIP_SAVE"},
        update=_is_switched,
    )


def remove() -> None:
    """Detach them again."""
    for owner, name in (
        (bpy.types.Object, "curvrefl"),
        (bpy.types.Scene, "curvrefl"),
        (bpy.types.WindowManager, "curvrefl_enabled"),
    ):
        if hasattr(owner, name):
            delattr(owner, name)
