# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene's updates may have changed of its picture, gathered until the next read."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import bpy

_NO_SURFACE = {"CAMERA", "SPEAKER", "LIGHT_PROBE"}
"""Kinds of objects that no picture shows; a camera is only another view"""


@dataclass
class Changes:
    """Sets hold `session_uid`s of original data-blocks."""

    everything: bool = False
    frame: bool = False
    """Another frame of the same file: all but images, with nothing listed"""
    instances: bool = False
    """Instances have to be gone through, whoever they are"""
    listing: bool = False
    """Someone may have come, gone or been hidden, or it was only a selection"""
    objects: set[int] = field(default_factory=set)
    """Moved, or their visibility or materials changed, but not their geometry"""
    shading: set[int] = field(default_factory=set)
    """Those of `objects` of which more than their place may have changed"""
    geometry: set[int] = field(default_factory=set)
    """Objects and meshes"""
    materials: set[int] = field(default_factory=set)
    all_materials: bool = False
    images: set[int] = field(default_factory=set)
    world: bool = False

    def __bool__(self) -> bool:
        return (
            self.everything
            or self.frame
            or self.instances
            or self.listing
            or self.all_materials
            or self.world
            or bool(self.objects or self.geometry or self.materials or self.images)
        )

    def add(self, updates: Iterable[bpy.types.DepsgraphUpdate]) -> None:
        """Of a depsgraph, in a handler after its update."""
        for update in updates:
            changed = update.id.original
            uid = changed.session_uid
            if isinstance(changed, bpy.types.Object):
                self._add_object(changed, update)
            elif isinstance(changed, bpy.types.Material):
                self.materials.add(uid)
            elif isinstance(changed, bpy.types.NodeTree):
                # The trees of materials, worlds and lamps come with their owners; a group may be used anywhere.
                if not changed.is_embedded_data and changed.type == "SHADER":
                    self.all_materials = self.world = self.instances = True
            elif isinstance(changed, bpy.types.World):
                self.world = True
            elif isinstance(changed, bpy.types.Image):
                self.images.add(uid)
            elif isinstance(changed, bpy.types.Light):
                self.instances = True
            elif isinstance(changed, (bpy.types.Scene, bpy.types.Collection)):
                self.listing = True
            elif update.is_updated_geometry:
                self.geometry.add(uid)

    def _add_object(self, changed: bpy.types.Object, update: bpy.types.DepsgraphUpdate) -> None:
        if changed.type in _NO_SURFACE:
            return
        if update.is_updated_geometry:
            self.geometry.add(changed.session_uid)
            return
        # Listed without any flag: renamed, for one.
        self.objects.add(changed.session_uid)
        if update.is_updated_shading:
            self.shading.add(changed.session_uid)
