# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs read of objects and instances, as Cycles finds it; looked at only where a program asks for it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import bpy
import numpy as np

from ..meshes.attributes import PARTS, values_of
from ..meshes.program_attributes import generated_of
from ..programs.program import Program

OBJECT, INSTANCER, VIEW_LAYER = "OBJECT:", "INSTANCER:", "VIEW_LAYER:"
"""Before the names of values: whose they are, as the Attribute node's types"""
NEED = "PROGRAM_INSTANCE"
"""Of programs that know of instances"""
NO_ID = 0x7FFFFFFF
"""In what tells instances apart: no level"""
type Four = tuple[float, float, float, float]


def values_of_instance(instance: Any, programs: Sequence[Program], view_layer: Any) -> dict[str, Any]:
    """Fields of InstanceArrays, of a `DepsgraphObjectInstance`, that `programs` of its materials need: maybe none."""
    if not any(NEED in program.shape.needs or program.instance_attributes for program in programs):
        return {}
    obj = instance.object
    scale, offset = generated_of(obj.data) if isinstance(obj.data, bpy.types.Mesh) else (np.ones(3), np.zeros(3))
    names = sorted({name for program in programs for name in program.instance_attributes})
    fields: dict[str, Any] = {
        "color": tuple(obj.color),
        "random": random_of(instance),
        "pass_index": obj.pass_index,
        "generated": (tuple(scale.tolist()), tuple(offset.tolist())),
        "values": tuple((name, _value(instance, name, view_layer)) for name in names),
    }
    if instance.is_instance:
        fields["instancer_generated"] = tuple(0.5 * part - 0.5 for part in instance.orco)
        fields["instancer_uv"] = tuple(instance.uv)
    return fields


def comparable(fields: dict[str, Any]) -> tuple[Any, ...]:
    """What tells two such apart."""
    return tuple(fields.values())


def random_of(instance: Any) -> float:
    """Cycles' number of an instance from 0 to 1: Blender's own, or one by the object's name."""
    number = instance.random_id & 0xFFFFFFFF if instance.is_instance else _hashed(_of_name(instance.object.name))
    return float(np.float32(number) * np.float32(1.0 / 0xFFFFFFFF))


def _of_name(name: str) -> int:
    result = 0
    for byte in name.encode():
        result = (result * 37 + byte) & 0xFFFFFFFF
    return result


def _hashed(number: int) -> int:
    """Cycles' hash_uint2(number, 0)."""
    mask = 0xFFFFFFFF

    def turned(value: int, by: int) -> int:
        return (value << by | value >> (32 - by)) & mask

    start = (0xDEADBEEF + (2 << 2) + 13) & mask
    a, b, c = (start + number) & mask, start, start
    c = ((c ^ b) - turned(b, 14)) & mask
    a = ((a ^ c) - turned(c, 11)) & mask
    b = ((b ^ a) - turned(a, 25)) & mask
    c = ((c ^ b) - turned(b, 16)) & mask
    a = ((a ^ c) - turned(c, 4)) & mask
    b = ((b ^ a) - turned(a, 14)) & mask
    return ((c ^ b) - turned(b, 24)) & mask


def _value(instance: Any, name: str, view_layer: Any) -> Four:
    """By a name of a program; zeros where nobody has it."""
    owners: Iterable[Any] = ()
    if name.startswith(VIEW_LAYER):
        plain = name.removeprefix(VIEW_LAYER)
        scene = view_layer.id_data
        owners = (view_layer, scene, scene.world)
    elif name.startswith(INSTANCER):
        plain = name.removeprefix(INSTANCER)
        if instance.is_instance:
            found = _of_geometry_nodes(instance, plain)
            if found is not None:
                return found
            system = instance.particle_system
            owners = (system.settings if system is not None else None, instance.parent)
        owners = (*owners, instance.object, instance.object.data)
    else:
        plain = name.removeprefix(OBJECT)
        owners = (instance.object, instance.object.data)
    for owner in owners:
        if owner is not None and (found := _property(owner, plain)) is not None:
            return found
    return (0.0, 0.0, 0.0, 0.0)


def _property(owner: Any, name: str) -> Four | None:
    """Of a data-block: its own property of that name, else the one at that path."""
    value = owner.get(name) if hasattr(owner, "get") else None
    if value is None:
        try:
            value = owner.path_resolve(name)
        except (ValueError, AttributeError):
            return None
    return _four(value)


def _four(value: Any) -> Four | None:
    """Numbers as four; None of what is no number."""
    if isinstance(value, (int, float)):
        return (float(value), float(value), float(value), 1.0)
    try:
        parts = [float(part) for part in value]
    except (TypeError, ValueError):
        return None
    if isinstance(value, str) or not 1 <= len(parts) <= 4:
        return None
    padded = [*parts, 0.0, 0.0, 0.0][:3]
    return (padded[0], padded[1], padded[2], parts[3] if len(parts) == 4 else 1.0)


def _of_geometry_nodes(instance: Any, name: str) -> Four | None:
    """The attribute of the innermost instance that has it."""
    found = None
    for points, index in _levels(instance):
        attribute = points.attributes.get(name)
        if attribute is not None and attribute.data_type in PARTS:
            found = _four(values_of(attribute)[index].tolist())
            if found is not None and PARTS[attribute.data_type][1] == 1:
                found = (found[0], found[0], found[0], 1.0)
    return found


def _levels(instance: Any) -> Iterator[tuple[Any, int]]:
    """From the outermost: (point cloud of instances, number in it) that an instance has come by."""
    numbers = [number for number in reversed(instance.persistent_id) if number != NO_ID]
    owner: Any = instance.parent
    for number in numbers:
        if isinstance(owner, bpy.types.Object):
            if owner.instance_type == "COLLECTION" and owner.instance_collection is not None:
                members = owner.instance_collection.all_objects
                owner = members[number] if number < len(members) else None
                continue
            owner = bpy.types.GeometrySet.from_evaluated_object(owner) if owner.is_evaluated else None
        elif isinstance(owner, bpy.types.Collection):
            owner = owner.all_objects[number] if number < len(owner.all_objects) else None
            continue
        points = None if owner is None else owner.instances_pointcloud()
        if points is None or number >= len(points.points):
            return
        yield points, number
        references = owner.instance_references()
        places = np.empty(len(points.points), np.int32)
        points.attributes[".reference_index"].data.foreach_get("value", places)
        owner = references[places[number]] if 0 <= places[number] < len(references) else None
