# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of objects and scenes, saved in the .blend file, and the switch, which is not."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from math import pi
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from ..options import QUALITY, SETTINGS_VERSION, current_options
from .choices import ENVIRONMENT_ITEMS, FRESNEL_ITEMS, METHOD_ITEMS, MOTION_ITEMS, SHOW_ITEMS


def _is_switched(_self: Any, context: bpy.types.Context) -> None:
    from ..viewport import handlers as viewport

    enabled = context.window_manager.curvrefl_enabled
    if enabled:
        use_defaults()
    viewport.switch(enabled)


def _mirrors_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from ..viewport import handlers as viewport

    viewport.mirrors_changed()


def _settings_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from ..viewport import handlers as viewport

    viewport.settings_changed()


def _is_panorama(_self: Any, image: bpy.types.Image) -> bool:
    return image.source in {"FILE", "GENERATED"} and image.type != "RENDER_RESULT"


class CurvreflObject(bpy.types.PropertyGroup):
    """Settings of one object"""

    is_mirror: BoolProperty(  # type: ignore[valid-type]
        name="Mirror",
        description="Show what this object reflects. It needs a material that reflects, and a shape that is seen whole "
        "from a point inside",
        default=False,
        update=_mirrors_changed,
    )
    override: BoolProperty(  # type: ignore[valid-type]
        name="Override Material",
        description="Reflect as set here, whatever the object's materials are",
        default=False,
        update=_mirrors_changed,
    )
    fresnel: EnumProperty(  # type: ignore[valid-type]
        name="Fresnel",
        description="How much is reflected at which angle",
        items=FRESNEL_ITEMS,
        default="METAL",
        update=_mirrors_changed,
    )
    tint: FloatVectorProperty(  # type: ignore[valid-type]
        name="Tint",
        description="Color of the reflection",
        subtype="COLOR",
        default=(1.0, 1.0, 1.0),
        min=0.0,
        max=1.0,
        update=_mirrors_changed,
    )
    ior: FloatProperty(  # type: ignore[valid-type]
        name="IOR",
        description="Index of refraction: 1.5 is glass or varnish",
        default=1.5,
        min=1.0,
        max=4.0,
        update=_mirrors_changed,
    )


class CurvreflScene(bpy.types.PropertyGroup):
    """Settings of one scene"""

    method: EnumProperty(  # type: ignore[valid-type]
        name="Method",
        description="How reflections are found",
        items=METHOD_ITEMS,
        default="auto",
        update=_settings_changed,
    )
    pixel_tolerance: FloatProperty(  # type: ignore[valid-type]
        name="Tolerance",
        description="Largest error of a reflected edge in pixels; smaller is slower",
        subtype="PIXEL",
        default=0.5,
        min=0.05,
        max=20.0,
        update=_settings_changed,
    )
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples",
        description="Pictures that are averaged against jagged edges while the view rests",
        default=8,
        min=1,
        max=64,
        update=_settings_changed,
    )
    bounces: IntProperty(  # type: ignore[valid-type]
        name="Bounces",
        description="Mirrors seen in mirrors, and in themselves, one after the other",
        default=4,
        min=1,
        max=32,
        update=_settings_changed,
    )
    map_resolution: IntProperty(  # type: ignore[valid-type]
        name="Map Size",
        description="Texels along an edge of the cube map that a mirror is baked into; more for finer shapes",
        default=128,
        min=16,
        max=1024,
        update=_settings_changed,
    )
    motion_resolution: EnumProperty(  # type: ignore[valid-type]
        name="While Moving",
        description="Resolution of the reflections while the view or the scene moves",
        items=MOTION_ITEMS,
        default="HALF",
        update=_settings_changed,
    )
    environment: EnumProperty(  # type: ignore[valid-type]
        name="Environment",
        description="What lights the reflected scene and stands behind it",
        items=ENVIRONMENT_ITEMS,
        default="VIEWPORT",
        update=_settings_changed,
    )
    environment_image: PointerProperty(  # type: ignore[valid-type]
        name="Image",
        description="Equirectangular image around the scene",
        type=bpy.types.Image,
        poll=_is_panorama,
        update=_settings_changed,
    )
    environment_strength: FloatProperty(  # type: ignore[valid-type]
        name="Strength",
        description="Brightness of the image",
        default=1.0,
        min=0.0,
        soft_max=10.0,
        update=_settings_changed,
    )
    environment_rotation: FloatProperty(  # type: ignore[valid-type]
        name="Rotation",
        description="Turn of the image around the vertical axis",
        subtype="ANGLE",
        default=0.0,
        soft_min=-pi,
        soft_max=pi,
        update=_settings_changed,
    )
    show: EnumProperty(  # type: ignore[valid-type]
        name="Show",
        description="What is drawn on the mirrors",
        items=SHOW_ITEMS,
        default="REFLECTION",
        update=_settings_changed,
    )
    stripe_count: IntProperty(  # type: ignore[valid-type]
        name="Count",
        description="Number of stripes or line lights",
        default=12,
        min=1,
        max=256,
        update=_settings_changed,
    )
    stripe_direction: FloatVectorProperty(  # type: ignore[valid-type]
        name="Direction",
        description="Axis that the stripes lie around and the line lights run along",
        subtype="DIRECTION",
        default=(0.0, 0.0, 1.0),
        update=_settings_changed,
    )
    version: IntProperty(options={"HIDDEN"}, default=0)  # type: ignore[valid-type]


CLASSES = (CurvreflObject, CurvreflScene)


def use_defaults() -> None:
    """Give scenes that were never used with the extension the settings of the preferences."""
    chosen = current_options()
    for scene in bpy.data.scenes:
        settings = scene.curvrefl
        if settings.version or not scene.is_editable:
            continue
        for name in QUALITY:
            if not settings.is_property_set(name):
                setattr(settings, name, getattr(chosen, name))
        settings.version = SETTINGS_VERSION


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
