# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What collections say of objects, of collections in them and of instances, as in Cycles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_object
from curvrefl.curvrefl_addon.demo.shapes import box
from curvrefl.curvrefl_addon.scene.instances.linking import linked_by
from indirect.places import add_box, gray, matte, read
from linking.stage import build, judge, link, point, sun

pytestmark = pytest.mark.usefixtures("gpu")


def collection_of(name: str, *objects: str) -> Any:
    """Objects by their names."""
    made = bpy.data.collections.new(name)
    for each in objects:
        made.objects.link(bpy.data.objects[each])
    return made


def child(parent: Any, name: str, state: str, *objects: str) -> Any:
    """Another collection in a collection."""
    made = collection_of(name, *objects)
    parent.children.link(made)
    parent.collection_children[len(parent.collection_children) - 1].light_linking.link_state = state
    return made


def nested() -> None:
    """A collection in one that is excluded, which says that it is included: that counts for nothing."""
    top = link(point(), "receiver")
    outer = child(top, "outer", "EXCLUDE", "two")
    child(outer, "inner", "INCLUDE", "one")


def object_over_child() -> None:
    """An object that is excluded by itself in spite of the collection which includes it."""
    top = link(point(), "receiver", excluded=("one",))
    child(top, "some", "INCLUDE", "one", "two", "floor")


def later_child_over_earlier() -> None:
    top = link(point(), "receiver")
    child(top, "some", "INCLUDE", "one", "two", "floor")
    child(top, "others", "EXCLUDE", "two")


def instanced(name: str, x: float) -> Any:
    """An empty that shows a cube, which is in no scene itself."""
    members = bpy.data.collections.get("members")
    if members is None:
        members = bpy.data.collections.new("members")
        cube = add_object("cube", box((0.7, 0.7, 0.7)), matte((0.3, 0.8, 0.3)), location=(0.0, 0.0, 0.35))
        bpy.context.scene.collection.objects.unlink(cube)
        members.objects.link(cube)
    made = bpy.data.objects.new(name, None)
    made.instance_type, made.instance_collection = "COLLECTION", members
    made.location = (x, -1.3, 0.0)
    bpy.context.scene.collection.objects.link(made)
    return made


def cube_that_is_instanced() -> None:
    """Both that show it are lit."""
    instanced("left", -0.6)
    instanced("right", 0.6)
    link(point(), "receiver", ("cube", "two"))


def instancer() -> None:
    """One of those that show the same cube."""
    instanced("left", -0.6)
    instanced("right", 0.6)
    link(point(), "receiver", ("left", "floor"))


def instancer_over_cube() -> None:
    """What shows it counts before the cube itself."""
    instanced("left", -0.6)
    instanced("right", 0.6)
    link(point(), "receiver", ("cube", "floor"), ("right",))


def instancer_as_blocker() -> None:
    instanced("left", -0.6)
    instanced("right", 0.6)
    link(sun(), "blocker", ("right",))


def lamp_in_an_instance() -> None:
    """A lamp keeps its links where it is instanced."""
    lamp = point()
    members = collection_of("lamps", lamp.name)
    bpy.context.scene.collection.objects.unlink(lamp)
    link(lamp, "receiver", ("floor", "one"))
    shown = bpy.data.objects.new("lamps", None)
    shown.instance_type, shown.instance_collection = "COLLECTION", members
    bpy.context.scene.collection.objects.link(shown)


def seen_in_the_mirror_alone() -> None:
    """Over all that the camera sees: a thing that its lamp leaves out, and one that it lights."""
    add_box("left out", (-2.0, -2.4, 3.1), (-0.1, 1.6, 3.2), matte(gray(0.9)))
    add_box("lit", (0.1, -2.4, 3.1), (2.0, 1.6, 3.2), matte(gray(0.9)))
    link(point(), "receiver", excluded=("left out",))


@pytest.mark.parametrize(
    "act",
    [
        nested,
        object_over_child,
        later_child_over_earlier,
        cube_that_is_instanced,
        instancer,
        instancer_over_cube,
        instancer_as_blocker,
        lamp_in_an_instance,
        seen_in_the_mirror_alone,
    ],
)
def test_collections_as_cycles(act: Callable[[], None]) -> None:
    build()
    act()
    judge(method="exact").agrees()


def test_what_a_collection_says() -> None:
    build()
    top = collection_of("top", "one")
    inner = child(child(top, "outer", "EXCLUDE", "two"), "inner", "INCLUDE", "floor")
    uid = {name: bpy.data.objects[name].session_uid for name in ("one", "two", "floor", "mirror")}
    said = linked_by(top)
    assert {name: said.holds(number) for name, number in uid.items()} == {
        "one": True,
        "two": False,
        "floor": False,
        "mirror": False,
    }
    assert linked_by(inner).holds(uid["floor"])
    assert not linked_by(inner).holds(uid["one"])
    assert linked_by(bpy.data.collections.new("empty")).holds(uid["one"])


def test_too_many_sets_are_said() -> None:
    """Each of many things has a lamp of its own."""
    build()
    for number in range(24):
        add_box(f"thing {number}", (-3, -3, 0), (-2.9, -2.9, 0.1), matte(gray(0.5)))
        lamp = point()
        lamp.name = f"lamp {number}"
        link(lamp, "receiver", (f"thing {number}",))
    arrays, _ = read()
    assert arrays.warnings == (
        'There are too many groups of linked objects: "thing 19", "thing 20", "thing 21" and 2 more are lit as if no '
        "light linking named them.",
    )
    sets = {item.object_name: arrays.light_set_of(item) for item in arrays.instances}
    assert sorted(sets.values()) == [0] * 9 + list(range(1, 20))
