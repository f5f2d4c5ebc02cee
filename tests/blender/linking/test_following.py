# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A changed linking is read when Blender tells of it, and a renderer that follows it shows what a new one does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import EVERY_SET, SceneArrays
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from indirect.places import by_renderer, read
from linking.stage import build, link, plate, point

pytestmark = pytest.mark.usefixtures("gpu")
SMALL = (48, 36)


class Session:
    """A reader that is told what the scene's updates have changed, as viewports' is."""

    def __init__(self) -> None:
        self.reader = SceneReader()
        self.changes = Changes(everything=True)
        bpy.app.handlers.depsgraph_update_post.append(self._note)

    def _note(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self.changes.add(depsgraph.updates)

    def read(self) -> SceneArrays:
        scene: Any = bpy.context.scene
        bpy.context.view_layer.update()
        changes, self.changes = self.changes, Changes()
        return self.reader.read(bpy.context.evaluated_depsgraph_get(), scene, [scene.objects["mirror"]], changes)

    def end(self) -> None:
        bpy.app.handlers.depsgraph_update_post.remove(self._note)


@pytest.fixture
def session() -> Iterator[Session]:
    """Of a lamp and a plate that shines, both linked."""
    build(2)
    link(point(), "receiver", ("one", "floor"))
    link(plate(), "blocker", excluded=("one",))
    made = Session()
    made.read()
    yield made
    made.end()


def of_lamp() -> Any:
    return bpy.data.objects["point"].light_linking.receiver_collection


def another_receiver() -> None:
    of_lamp().objects.link(bpy.data.objects["two"])


def one_less() -> None:
    of_lamp().objects.unlink(bpy.data.objects["one"])


def excluded_instead() -> None:
    for item in of_lamp().collection_objects:
        item.light_linking.link_state = "EXCLUDE"


def a_child() -> None:
    child = bpy.data.collections.new("child")
    child.objects.link(bpy.data.objects["two"])
    of_lamp().children.link(child)


def no_receivers() -> None:
    bpy.data.objects["point"].light_linking.receiver_collection = None


def no_blockers() -> None:
    bpy.data.objects["shine"].light_linking.blocker_collection = None


def receivers_of_what_shines() -> None:
    link(bpy.data.objects["shine"], "receiver", ("two",))


def blockers_of_the_lamp() -> None:
    link(bpy.data.objects["point"], "blocker", excluded=("one",))


def no_links() -> None:
    no_receivers()
    no_blockers()


def painted() -> None:
    """What is linked changes in another way."""
    tree: Any = bpy.data.objects["one"].active_material.node_tree
    tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.1, 0.9, 0.1, 1.0)


def brighter() -> None:
    bpy.data.lights["point"].energy = 500.0


def moved() -> None:
    bpy.data.objects["one"].location.x -= 0.4


ACTS = [
    another_receiver,
    one_less,
    excluded_instead,
    a_child,
    no_receivers,
    no_blockers,
    receivers_of_what_shines,
    blockers_of_the_lamp,
    no_links,
    painted,
    brighter,
    moved,
]


@pytest.mark.parametrize("act", ACTS)
def test_following_is_as_starting_anew(session: Session, act: Callable[[], None]) -> None:
    """To the last bit."""
    before, view = session.read(), read(size=SMALL)[1]
    renderer = Renderer(before, Settings(method="auto", samples=4))
    was = by_renderer(renderer, view).picture
    act()
    renderer.update(session.read())
    found = by_renderer(renderer, view).picture
    renderer.free()
    fresh = Renderer(read(size=SMALL)[0], Settings(method="auto", samples=4))
    expected = by_renderer(fresh, view).picture
    fresh.free()
    assert np.abs(found - was).mean() > 1e-3 * was.mean()
    assert np.array_equal(found, expected)


def test_nothing_changes_by_itself(session: Session) -> None:
    """What is read again is the same, and so it is once a lamp was looked at."""
    before = session.read()
    session.changes.listing = True
    assert session.read() is before
    session.changes.objects = {obj.session_uid for obj in bpy.data.objects}
    again = session.read()
    assert again.lights is before.lights
    assert again.instances is before.instances
    assert again.materials is before.materials


def test_nothing_is_left_of_links_that_are_gone(session: Session) -> None:
    no_links()
    arrays = session.read()
    assert all(light.lights_on == light.blocked_by == EVERY_SET for light in arrays.lights)
    assert all(instance.shadow_set == 0 for instance in arrays.instances)
    assert all(
        material.light_set == 0 and material.shines_on == material.blocked_by == EVERY_SET
        for material in arrays.materials
    )
