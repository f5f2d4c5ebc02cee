# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that is switched on is opened over redraws: little in each, mirrors seen from the first on, nothing left over
and the same picture in the end. Without any time each redraw takes the least that gets on."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.gpu_caches import clear_gpu_caches
from curvrefl.curvrefl_addon.options import current_options
from curvrefl.curvrefl_addon.renderer.device import shaders
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.viewport.light import ViewportLight
from curvrefl.curvrefl_addon.viewport.opening import FORGOTTEN_SECONDS
from curvrefl.curvrefl_addon.viewport.region import RegionPicture
from curvrefl.curvrefl_addon.viewport.shown_scene import Look
from scenes.views import look_at
from viewport.shown_session import CAP, PLAIN, Session

pytestmark = pytest.mark.usefixtures("gpu")
SIZE = 64
MOST_REDRAWS = 300


def eye() -> View:
    return look_at(np.array([0.0, -6.0, 1.5]), np.zeros(3), SIZE, SIZE, np.radians(40))


def soon(session: Session, look: Look = PLAIN, seconds: float = 0.0) -> Renderer | None:
    bpy.context.view_layer.update()
    return session.scene.renderer_soon(bpy.context, look, session.settings, CAP, CAP, eye(), seconds)


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Labels of shaders, as they are compiled; none is known at first."""
    clear_gpu_caches()
    labels: list[str] = []
    declare = shaders._add_declarations

    def noted(info: Any, label: str, pieces: Any) -> Any:
        labels.append(label)
        return declare(info, label, pieces)

    monkeypatch.setattr(shaders, "_add_declarations", noted)
    yield labels


def crowd(count: int) -> None:
    """More objects, each with a mesh of its own."""
    for number in range(count):
        bpy.ops.mesh.primitive_cube_add(size=0.4, location=(number - 0.5 * count, 3.0, 0.0))
        bpy.context.object.name = f"Cube {number}"


@pytest.mark.parametrize("method", ["exact", "auto", "secant_star", "environment_cube"])
def test_little_is_made_in_each_redraw_and_all_in_the_end(
    session: Session, compiled: list[str], method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    session.settings = Settings(method=method, samples=1, map_resolution=32)
    crowd(5)
    reads, made, said = [], [], []
    for _ in range(MOST_REDRAWS):
        compiled.clear()
        before = session.scene.counters.get("meshes read", 0)
        renderer = soon(session)
        reads.append(session.scene.counters["meshes read"] - before)
        made.append(list(compiled))
        if renderer is not None:
            break
        said.append(session.scene.progress)
    assert renderer is not None and session.scene.progress == ""
    # The mirror's and one more, then one in each.
    assert max(reads) <= 2 and sum(reads) == 8
    assert len(said) > 10 and all(said), "something is always said"
    assert "6 objects to read" in said and any("shader" in text for text in said)
    # What is waited for is a shader, and that alone is made next.
    waited = [text.removeprefix("the shader ") for text in said]
    one = [labels == [text] for text, labels, whole in zip(waited, made[1:], said, strict=False) if text != whole]
    assert len(one) >= 4 and all(one)
    assert max(len(labels) for labels in made[1:]) <= 3
    # What has been rehearsed is there when it is drawn.
    compiled.clear()
    picture = RegionPicture(session.scene, renderer)
    picture.advance(eye(), bpy.context.scene.curvrefl, current_options(), 0.0, False, {})
    assert compiled == [] and picture.pixels()[..., 3].max() == 1.0


def test_a_scene_opened_in_steps_is_drawn_bit_for_bit_as_one_opened_at_once(session: Session) -> None:
    crowd(3)
    renderer = None
    while renderer is None:
        renderer = soon(session)
    while renderer.is_loading:
        renderer.load_some(0.0)
    opened = renderer.render(eye()).color()
    at_once = Renderer(renderer.scene, session.settings)
    np.testing.assert_array_equal(at_once.render(eye()).color(), opened)
    at_once.free()


def test_the_first_redraw_shows_mirrors(session: Session) -> None:
    assert soon(session) is None
    assert session.scene.sketch is not None
    texture = empty_texture(SIZE, SIZE)
    target = frame_buffer(texture)
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
    session.scene.sketch.show(eye(), target, (0, 0, SIZE, SIZE))
    shown = read_texture(texture)[..., 3] > 0.5
    rows, columns = np.nonzero(shown)
    # The ball in the middle of the view, of radius 1 m seen from 6.2 m.
    radius = 0.5 * SIZE / np.tan(np.radians(20)) * np.tan(np.arcsin(1.0 / np.hypot(6.0, 1.5)))
    assert abs(rows.mean() - 0.5 * SIZE) < 1.0 and abs(columns.mean() - 0.5 * SIZE) < 1.0
    assert 0.8 < shown.sum() / (np.pi * radius**2) < 1.1


def test_what_changes_meanwhile_is_shown(session: Session) -> None:
    crowd(4)
    soon(session)
    bpy.data.objects["Cube 0"].location.z = 2.0
    soon(session)
    for _ in range(4):
        assert soon(session) is None
    bpy.data.objects["Cube 3"].location.z = 1.0
    bpy.data.objects.remove(bpy.data.objects["Cube 1"])
    for _ in range(MOST_REDRAWS):
        if (renderer := soon(session)) is not None:
            break
    assert renderer is not None
    places = {item.object_name: item.matrix[2, 3] for item in renderer.scene.instances}
    assert places["Cube 0"] == 2.0 and places["Cube 3"] == 1.0 and "Cube 1" not in places
    assert len(places) == 6


def test_a_look_that_nobody_wants_any_more_is_let_go(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    dim = Look(ViewportLight(scene_lights=False))
    for _ in range(4):
        assert soon(session, dim) is None
    now = [FORGOTTEN_SECONDS + 1e6]
    monkeypatch.setattr("curvrefl.curvrefl_addon.viewport.shown_scene.perf_counter", lambda: now[0])
    for _ in range(MOST_REDRAWS):
        if soon(session) is not None:
            break
    assert list(session.scene.renderers) == [PLAIN]
    assert session.scene.progress == "" and session.scene.sketch is None


@pytest.mark.parametrize("redraws", [1, 5, 9])
def test_a_scene_that_is_left_while_it_opens_leaves_nothing(session: Session, redraws: int) -> None:
    crowd(3)
    for _ in range(redraws):
        assert soon(session) is None
    session.scene.free()
    gc.collect()
    assert not [item for item in gc.get_objects() if type(item).__name__ in ("Chunk", "Renderer", "Lighting")]


def test_removing_the_mirror_lets_its_renderer_go(session: Session) -> None:
    while (renderer := soon(session)) is None:
        pass
    gone = weakref.ref(renderer)
    del renderer
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    session.scene.mirrors_changed()
    assert soon(session) is None and session.scene.sketch is None and session.scene.progress == ""
    gc.collect()
    assert gone() is None


def test_too_large_a_scene_is_told_in_a_sentence_and_read_no_further(session: Session) -> None:
    crowd(6)
    bpy.context.view_layer.update()
    for _ in range(3):
        found = session.scene.renderer_soon(bpy.context, PLAIN, session.settings, 1000, CAP, eye(), 0.0)
        assert found is None and session.scene.sketch is None
    assert len(session.scene.messages) == 1 and "MB" in session.scene.messages[0]
    assert session.scene.counters["meshes read"] <= 2
