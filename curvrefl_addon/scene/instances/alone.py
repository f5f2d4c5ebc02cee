# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects are read by themselves when a scene has changed, as nothing else can be another for it."""

from __future__ import annotations

from collections.abc import Mapping, Set

import bpy

from ..changes import Changes
from ..reads import ShownInstance, object_of
from .parts import SHOWN

_SHAPE_OTHERS = ("ARMATURE", "CAMERA", "EMPTY", "LATTICE")
"""Types of objects that show nothing: what they deform is listed as well"""
type Shown = Mapping[tuple[int, int, int], ShownInstance]
"""See `SceneReader`"""


def objects_alone(
    changes: Changes, shown: Shown, instancers: Set[int], meshes: Set[int]
) -> list[tuple[int, bpy.types.Object]] | None:
    """The changed objects with their `session_uid`, where it is enough to look at these; None where all instances have
    to be gone through. `meshes`: numbers of those that are to be read again."""
    if not instancers.isdisjoint(changes.objects | changes.geometry):
        return None
    found: list[tuple[int, bpy.types.Object]] = []
    for uid in changes.objects - changes.geometry:
        known = shown.get((uid, 0, 0))
        obj = object_of(uid, "" if known is None else known.name)
        if obj is None:
            return None
        if known is not None:
            found.append((uid, obj))
        elif uid in changes.shading and obj.type in SHOWN:
            return None
    if not changes.geometry:
        return found
    others = {key for key, item in shown.items() if item.instance is not None and item.instance.mesh in meshes}
    for uid in changes.geometry:
        known = shown.get((uid, 0, 0))
        obj = object_of(uid, "" if known is None else known.name)
        if obj is None or obj.type in _SHAPE_OTHERS:
            # (Of a mesh or a key those are listed, too, that show it.)
            continue
        if known is None or known.instance is None or not _shows_itself(obj):
            return None
        found.append((uid, obj))
        others.discard((uid, 0, 0))
    return None if others else found


def _shows_itself(obj: bpy.types.Object) -> bool:
    """Whether all that an object can show is its own mesh, whatever becomes of that."""
    is_plain = obj.type == "MESH" and obj.instance_type == "NONE" and len(obj.particle_systems) == 0
    return is_plain and all(modifier.type != "NODES" for modifier in obj.modifiers)
