# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The view layers of a film: the one that is filmed, and its double in which the mirrors are held out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

HELD_OUT = "Curvrefl Held Out"
OF_LAYERS = (
    "material_override",
    "world_override",
    "samples",
    "pass_alpha_threshold",
    "use_solid",
    "use_sky",
    "use_ao",
    "use_strand",
    "use_volumes",
    "use_motion_blur",
    "use_grease_pencil",
)
"""What the double has of the layer: all that its picture depends on"""
OF_COLLECTIONS = ("exclude", "holdout", "indirect_only", "hide_viewport")


def filmed_layer(scene: bpy.types.Scene) -> bpy.types.ViewLayer:
    """The first that is rendered, which is also the one that a background set shows."""
    layers = [layer for layer in scene.view_layers if not layer.curvrefl.is_held_out]
    return next((layer for layer in layers if layer.use), layers[0])


def held_out_layer(scene: bpy.types.Scene) -> bpy.types.ViewLayer | None:
    """The double, where there is one."""
    return next((layer for layer in scene.view_layers if layer.curvrefl.is_held_out), None)


def make_held_out_layer(scene: bpy.types.Scene) -> bpy.types.ViewLayer:
    """A new double; `follow_layer` makes it like the layer."""
    layer = scene.view_layers.new(HELD_OUT)
    layer.curvrefl.is_held_out = True
    for item in layer.bl_rna.properties:
        if item.identifier.startswith("use_pass_") and not item.is_readonly:
            set_value(layer, item.identifier, item.identifier == "use_pass_combined")
    set_value(layer, "use_freestyle", False)
    return layer


def follow_layer(scene: bpy.types.Scene, mirrors: bpy.types.Collection) -> None:
    """Make the double like the layer, with the collection of the mirrors held out; other layers leave that out."""
    double = held_out_layer(scene)
    assert double is not None, "a film has a second view layer"
    layer = filmed_layer(scene)
    for name in OF_LAYERS:
        set_value(double, name, getattr(layer, name))
    set_value(double, "use", True)
    for other in scene.view_layers:
        for item in _all(other.layer_collection):
            if item.collection == mirrors:
                set_value(item, "exclude", other != double)
                set_value(item, "holdout", other == double)
    _follow_collection(layer.layer_collection, double.layer_collection, mirrors)


def set_value(owner: Any, name: str, value: Any) -> None:
    """Set a property that has another value: what is set is evaluated anew."""
    if getattr(owner, name) != value:
        setattr(owner, name, value)


def _follow_collection(
    one: bpy.types.LayerCollection, other: bpy.types.LayerCollection, mirrors: bpy.types.Collection
) -> None:
    """Flags of a collection in a view layer, and of those in it; to exclude one sets those in it, so from above."""
    if one.collection == mirrors:
        return
    for name in OF_COLLECTIONS:
        set_value(other, name, getattr(one, name))
    for child, copy in zip(one.children, other.children, strict=True):
        _follow_collection(child, copy, mirrors)


def _all(item: bpy.types.LayerCollection) -> Iterator[bpy.types.LayerCollection]:
    yield item
    for child in item.children:
        yield from _all(child)
