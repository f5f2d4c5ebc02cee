# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which instances are there, and for which rays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy


@dataclass(frozen=True, slots=True)
class RayVisibility:
    """What of an instance sees it."""

    camera: bool
    diffuse: bool
    glossy: bool
    shadow: bool
    holdout: bool

    @property
    def any(self) -> bool:
        """Whether it can be in a picture at all."""
        return self.camera or self.glossy or self.shadow


class Visibility:
    """The view layer's and the objects' switches.

    What the viewport hides is not among a viewport depsgraph's instances; what only renders hide is, so that is
    looked up here.
    """

    def __init__(self, view_layer: bpy.types.ViewLayer, for_render: bool) -> None:
        """`view_layer`: the original, not an evaluated copy."""
        self._view_layer = view_layer
        self._for_render = for_render
        self._rendered: set[int] = set()
        self._rendered_in: dict[int, set[int]] = {}
        if for_render:
            self._add_layer(view_layer.layer_collection, False)

    def is_there(self, instance: Any) -> bool:
        """Whether a `DepsgraphObjectInstance` is to be drawn."""
        obj = instance.object.original
        if not instance.show_self:
            return False
        if not self._for_render:
            return True
        if obj.hide_render:
            return False
        if not instance.is_instance:
            shown = obj.show_instancer_for_render or not obj.is_instancer
            return bool(shown and obj.as_pointer() in self._rendered)
        parent = instance.parent.original
        if parent.hide_render or parent.as_pointer() not in self._rendered:
            return False
        collection = parent.instance_collection if parent.instance_type == "COLLECTION" else None
        if collection is None or not _holds(collection, obj):
            # Instances of geometry nodes, of vertices or of faces: the object's own switch has been looked at.
            return True
        return obj.as_pointer() in self._collection(collection)

    def rays(self, instance: Any) -> RayVisibility:
        """For an instance, both its object and what makes the instance must be visible, as in Cycles."""
        objects = [instance.object.original]
        if instance.is_instance:
            objects.append(instance.parent.original)
        holder = objects[-1]
        return RayVisibility(
            camera=all(obj.visible_camera for obj in objects)
            and not holder.indirect_only_get(view_layer=self._view_layer),
            diffuse=all(obj.visible_diffuse for obj in objects),
            glossy=all(obj.visible_glossy for obj in objects),
            shadow=all(obj.visible_shadow for obj in objects),
            holdout=bool(holder.is_holdout or holder.holdout_get(view_layer=self._view_layer)),
        )

    def _add_layer(self, layer: bpy.types.LayerCollection, hidden: bool) -> None:
        hidden = hidden or layer.collection.hide_render
        if hidden:
            return
        if not layer.exclude:
            self._rendered.update(obj.as_pointer() for obj in layer.collection.objects)
        for child in layer.children:
            self._add_layer(child, hidden)

    def _collection(self, collection: bpy.types.Collection) -> set[int]:
        key = collection.as_pointer()
        if key not in self._rendered_in:
            self._rendered_in[key] = _rendered_objects(collection)
        return self._rendered_in[key]


def _rendered_objects(collection: bpy.types.Collection) -> set[int]:
    """Pointers of the objects that a render of an instance of `collection` shows."""
    found = {obj.as_pointer() for obj in collection.objects}
    for child in collection.children:
        if not child.hide_render:
            found |= _rendered_objects(child)
    return found


def _holds(collection: bpy.types.Collection, obj: bpy.types.Object) -> bool:
    return obj.name in collection.all_objects
