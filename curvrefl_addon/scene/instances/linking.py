# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking: which objects a lamp, or one that shines, lights, and which cast shadows in its light.

As in Cycles: a collection with objects that are included is for these alone, one where all are excluded is for all
others. What is said of a collection in it goes for all that this holds, but what is said of an object itself counts
more. Objects that all emitters treat alike are a *set*; lights know bits of the sets that are theirs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..arrays import EVERY_SET, MOST_SETS
from ..names import listed
from ..programs.material_reader import MaterialReader
from ..reads import ShownInstance, object_of
from ..remarks import Remark
from .parts import uid_of_part

type Key = tuple[int, int, int]
"""(object, what instances it or 0, which of these)"""


@dataclass(frozen=True, slots=True)
class Linked:
    """What a collection says of objects."""

    states: Mapping[int, bool]
    """By `session_uid`, whether an object is included or excluded"""
    is_for_all: bool
    """But for those that are excluded: none is included"""

    def holds(self, uid: int) -> bool:
        """Whether light gets to an object, or it casts shadows."""
        return self.states.get(uid, self.is_for_all)


def linked_by(collection: Any) -> Linked:
    """What a receiver or blocker collection says."""
    states: dict[int, bool] = {}
    for child, about in zip(collection.children, collection.collection_children, strict=True):
        # (Of what is deeper Cycles asks nothing.)
        states |= dict.fromkeys(_held(child), about.light_linking.link_state == "INCLUDE")
    for obj, about in zip(collection.objects, collection.collection_objects, strict=True):
        states[obj.session_uid] = about.light_linking.link_state == "INCLUDE"
    return Linked(states, not any(states.values()))


class LightLinks:
    """Gives what is shown the sets that it is in, and lights theirs."""

    def __init__(self) -> None:
        self.remarks: tuple[Remark | str, ...] = ()
        """What is not followed"""
        self._are_known = False

    def follow(self, shown: Mapping[Key, ShownInstance], materials: MaterialReader) -> None:
        """Bring lights and instances up to date, in place. Costs nothing where there is no linking."""
        linking = {key: item for key, item in shown.items() if item.has_links}
        if not linking and not self._are_known:
            return
        of_light, of_shadow = _Sets(), _Sets()
        for key, item in linking.items():
            obj = object_of(uid_of_part(key[0]), item.name)
            if obj is not None:
                shines = item.light is not None or _shines(item, materials)
                of_light.add(key, obj.light_linking.receiver_collection, shines)
                of_shadow.add(key, obj.light_linking.blocker_collection, shines)
        for key, item in shown.items():
            if item.instance is not None:
                of_light.place(key, item.name)
                # (Rays to what shines have to meet that itself.)
                of_shadow.place(key, item.name, is_apart=of_shadow.is_shining(key))
        for key, item in shown.items():
            lights_on, blocked_by = of_light.bits_of(key), of_shadow.bits_of(key)
            if item.light is not None:
                if (item.light.lights_on, item.light.blocked_by) != (lights_on, blocked_by):
                    item.light = replace(item.light, lights_on=lights_on, blocked_by=blocked_by)
            elif item.instance is not None:
                light_set, shadow_set = of_light.number_of(key), of_shadow.number_of(key)
                if blocked_by != EVERY_SET:
                    blocked_by |= 1 << shadow_set
                made = tuple(materials.linked(index, light_set, lights_on, blocked_by) for index in item.materials)
                if (made, shadow_set) != (item.instance.materials, item.instance.shadow_set):
                    item.instance = replace(item.instance, materials=made, shadow_set=shadow_set)
        materials.drop_unused_copies()
        self._are_known = bool(linking)
        remarks: list[Remark | str] = [
            *of_light.too_many("lit as if no light linking named"),
            *of_shadow.too_many("in the way of light as if no shadow linking named"),
        ]
        for key, item in linking.items():
            if of_shadow.bits_of(key) != EVERY_SET and _has_body(item):
                remarks.append(f'In mirrors "{item.name}" is hidden by all objects, whatever its shadow linking.')
        self.remarks = tuple(remarks)


class _Sets:
    """Objects by what the collections of all that shines say of them."""

    def __init__(self) -> None:
        self._collections: dict[int, Linked] = {}
        self._shining: dict[int, int] = {}
        """By collection its place in what tells sets apart"""
        self._emitters: dict[Key, int] = {}
        """The collection of each that shines"""
        self._numbers: dict[tuple[tuple[bool, ...], int], int] = {}
        """Of sets"""
        self._places: dict[Key, int] = {}
        self._named: set[int] = set()
        """Objects that any collection names"""
        self._said: dict[int, tuple[bool, ...]] = {}
        """By object, once it was asked for"""
        self._too_many: dict[str, None] = {}

    def add(self, key: Key, collection: Any, shines: bool) -> None:
        """Know the collection of something."""
        if collection is None:
            return
        uid = collection.session_uid
        if uid not in self._collections:
            self._collections[uid] = linked_by(collection)
            self._named |= self._collections[uid].states.keys()
        if shines:
            self._shining.setdefault(uid, len(self._shining))
            self._emitters[key] = uid

    def is_shining(self, key: Key) -> bool:
        """Whether it shines, and has a collection."""
        return key in self._emitters

    def place(self, key: Key, name: str, is_apart: bool = False) -> None:
        """Find the set of an instance; `is_apart`: one that its object has for itself."""
        if not self._numbers:
            # (What no collection names is the first.)
            self._numbers[self._said_of(0), 0] = 0
        uid, parent = uid_of_part(key[0]), key[1]
        # As in Cycles what instances an object counts first, if any collection names it.
        asked = (self._said_of(parent if parent in self._named else uid), uid if is_apart else 0)
        if asked not in self._numbers and len(self._numbers) == MOST_SETS:
            self._too_many[name] = None
        else:
            self._places[key] = self._numbers.setdefault(asked, len(self._numbers))

    def number_of(self, key: Key) -> int:
        return self._places.get(key, 0)

    def bits_of(self, key: Key) -> int:
        """Of the sets that are for the light of something."""
        if key not in self._emitters:
            return EVERY_SET
        place = self._shining[self._emitters[key]]
        return EVERY_SET - sum(1 << number for (said, _), number in self._numbers.items() if not said[place])

    def too_many(self, what: str) -> Iterator[str]:
        """A sentence where there are more sets than can be told apart."""
        if self._too_many:
            yield f"There are too many groups of linked objects: {listed(self._too_many)} are {what} them."

    def _said_of(self, uid: int) -> tuple[bool, ...]:
        if uid not in self._named:
            # (All of these are alike.)
            uid = 0
        if uid not in self._said:
            self._said[uid] = tuple(self._collections[collection].holds(uid) for collection in self._shining)
        return self._said[uid]


def _held(collection: Any) -> Iterator[int]:
    """`session_uid` of all objects in a collection and those within."""
    for child in collection.children:
        yield from _held(child)
    for obj in collection.objects:
        yield obj.session_uid


def _shines(item: ShownInstance, materials: MaterialReader) -> bool:
    return any(materials.materials[index].may_be("emission") for index in item.materials)


def _has_body(item: ShownInstance) -> bool:
    """Whether mirrors show it shine."""
    light = item.light
    if light is None:
        return item.instance is not None and item.instance.visible_glossy
    return light.visible_glossy and (light.kind == "AREA" or max(light.radius, light.angle) > 0.0)
