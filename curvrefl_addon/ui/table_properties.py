# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties, made from the table of settings."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from ..setting import Setting

_SUBTYPES = {"pixels": "PIXEL", "radians": "ANGLE", "color": "COLOR", "direction": "DIRECTION", "meters": "DISTANCE"}
"""By unit"""
_SMALLEST = 1e-6
"""How far above a least value that is not taken itself sliders begin"""


def properties_of(
    settings: Iterable[Setting], update: Callable[[Any, Any], None] | None = None, of_new_scenes: bool = False
) -> dict[str, Any]:
    """Annotations of a property group.

    `update` is called after a change. `of_new_scenes`: the tooltips say that it is what new scenes start with.
    """
    return {item.name: property_of(item, update, of_new_scenes=of_new_scenes) for item in settings}


def property_of(
    item: Setting,
    update: Callable[[Any, Any], None] | None = None,
    *,
    of_new_scenes: bool = False,
    **changed: Any,
) -> Any:
    """The property of one setting; `changed` are Blender's own keywords that are otherwise here."""
    text = f"In new scenes: {item.text[0].lower()}{item.text[1:]}" if of_new_scenes else item.text
    keywords: dict[str, Any] = {"name": item.label, "description": text}
    if update is not None:
        keywords["update"] = update
    if item.start is None:
        return PointerProperty(type=bpy.types.Image, poll=_is_panorama, **(keywords | changed))
    keywords["default"] = item.start
    if isinstance(item.start, bool):
        return BoolProperty(**(keywords | changed))
    if item.choices:
        keywords["items"] = [(choice.name, choice.label, choice.text) for choice in item.choices]
        return EnumProperty(**(keywords | changed))
    keywords |= _range(item)
    if item.unit in _SUBTYPES:
        keywords["subtype"] = _SUBTYPES[item.unit]
    kind: Any = {int: IntProperty, float: FloatProperty, tuple: FloatVectorProperty}[type(item.start)]
    return kind(**(keywords | changed))


def _range(item: Setting) -> dict[str, Any]:
    least, most = item.hard
    ends = {
        "min": least + _SMALLEST if least is not None and item.above else least,
        "max": most,
        "soft_min": item.soft[0],
        "soft_max": item.soft[1],
        # Blender counts steps of floats in hundredths, and has none of whole numbers.
        "step": None if item.step is None or isinstance(item.start, int) else round(100.0 * item.step),
    }
    return {name: value for name, value in ends.items() if value is not None}


def _is_panorama(_self: Any, image: bpy.types.Image) -> bool:
    return image.source in {"FILE", "GENERATED"} and image.type != "RENDER_RESULT"
