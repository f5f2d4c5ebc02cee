# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport holds of a scene: any number of mirrors that come and go, messages, and nothing left over."""

from __future__ import annotations

import gc
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.diagnostics.colors import Legend
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.options import current_options
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.geometry.chunk import Chunk
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.viewport import handlers
from curvrefl.curvrefl_addon.viewport.region import RegionPicture
from scenes.views import look_at
from viewport.shown_session import Session, mark

pytestmark = pytest.mark.usefixtures("gpu")


def test_mirrors_come_and_go(session: Session) -> None:
    assert session.mirrors() == ["Mirror"]
    mark(session, "Other")
    assert session.mirrors() == ["Mirror", "Other"]
    assert session.scene.counters["maps baked"] == 2
    bpy.data.objects["Other"].name = "Second"
    assert session.mirrors() == ["Mirror", "Second"]
    copy = bpy.data.objects["Second"].copy()
    bpy.context.scene.collection.objects.link(copy)
    copy.name = "Third"
    copy.location.y = 5.0
    assert session.mirrors() == ["Mirror", "Second", "Third"]
    copy.hide_set(True)
    assert session.mirrors() == ["Mirror", "Second"]
    copy.hide_set(False)
    assert session.mirrors() == ["Mirror", "Second", "Third"]
    bpy.data.objects.remove(copy)
    assert session.mirrors() == ["Mirror", "Second"]
    mark(session, "Mirror", False)
    assert session.mirrors() == ["Second"]
    mark(session, "Second", False)
    assert session.draw() is None
    assert session.scene.messages == []
    assert not session.scene.renderers, "without a mirror nothing is kept"


def test_what_moves_a_mirror_moves_its_map(session: Session) -> None:
    renderer = session.draw()
    assert renderer is not None
    holder = bpy.data.objects.new("Holder", None)
    bpy.context.scene.collection.objects.link(holder)
    bpy.data.objects["Mirror"].parent = holder
    session.draw()
    holder.location.z = 3.0
    again = session.draw()
    assert again is renderer
    shape = renderer.mirrors[0].shape(renderer.settings.map_resolution)
    np.testing.assert_allclose(shape.center, [0.0, 0.0, 3.0], atol=1e-6)
    assert session.scene.counters["maps baked"] == 1
    bpy.data.objects["Mirror"].scale.x = 2.0
    session.draw()
    assert session.scene.counters["maps baked"] == 2


def test_a_sequence_follows_the_frame(session: Session, tmp_path: Path) -> None:
    for frame in (1, 2):
        one = bpy.data.images.new("one", 2, 2)
        one.pixels.foreach_set(np.tile(np.array([frame / 2.0, 0.0, 0.0, 1.0], np.float32), 4))
        one.filepath_raw, one.file_format = str(tmp_path / f"wave_{frame:03}.png"), "PNG"
        one.save()
    image = bpy.data.images.load(str(tmp_path / "wave_001.png"))
    image.source = "SEQUENCE"
    paint = bpy.data.materials.new("paint")
    bpy.data.objects["Other"].data.materials.append(paint)
    texture = paint.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.image_user.frame_duration, texture.image_user.use_auto_refresh = 2, True
    paint.node_tree.links.new(texture.outputs["Color"], paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    seen = []
    for frame in (1, 2, 2):
        bpy.context.scene.frame_set(frame)
        renderer = session.draw()
        assert renderer is not None
        seen.append(float(renderer.scene.images[0].read()[0, 0, 0]))
    assert seen == [128.0, 255.0, 255.0]
    # (One read of each, and none where nothing changed.)
    assert session.scene.counters["images read"] == 2


def test_linked_mirrors_and_scenery(session: Session, tmp_path: Path) -> None:
    library = tmp_path / "library.blend"
    bpy.data.objects["Other"].curvrefl.is_mirror = True
    bpy.data.libraries.write(str(library), {bpy.data.objects["Other"]})
    bpy.data.objects.remove(bpy.data.objects["Other"])
    assert session.mirrors() == ["Mirror"]
    with bpy.data.libraries.load(str(library), link=True) as (_there, here):
        here.objects = ["Other"]
    bpy.context.scene.collection.objects.link(bpy.data.objects["Other"])
    assert session.mirrors() == ["Mirror", "Other"]


def test_a_mirror_that_is_only_instanced(session: Session) -> None:
    group = bpy.data.collections.new("library")
    mirror = bpy.data.objects["Mirror"]
    for place in (0.0, 5.0):
        holder = bpy.data.objects.new("Place", None)
        holder.instance_type, holder.instance_collection = "COLLECTION", group
        holder.location.x = place
        bpy.context.scene.collection.objects.link(holder)
    for collection in mirror.users_collection:
        collection.objects.unlink(mirror)
    group.objects.link(mirror)
    assert session.mirrors() == ["Mirror", "Mirror"]
    assert session.scene.messages == []


def test_a_shape_that_cannot_be_a_mirror_is_named_until_it_can(session: Session) -> None:
    bpy.ops.mesh.primitive_torus_add(location=(0.0, 5.0, 0.0))
    bpy.context.object.name = "Ring"
    mark(session, "Ring")
    assert session.mirrors() == ["Mirror"]
    assert len(session.scene.messages) == 1 and '"Ring"' in session.scene.messages[0]
    baked = session.scene.counters["maps baked"]
    bpy.data.objects["Ball"].location.z = 1.0
    assert session.mirrors() == ["Mirror"]
    assert session.scene.counters["maps baked"] == baked, "what was refused is not tried again for nothing"
    assert len(session.scene.messages) == 1
    bpy.data.objects["Ring"].data = bpy.data.objects["Ball"].data
    assert session.mirrors() == ["Mirror", "Ring"]
    assert session.scene.messages == []


NESTED = 'Copy of "Mirror", "Other"'
"""A name that quotes those of other mirrors"""


def test_a_mirror_without_faces_is_told_from_those_that_its_name_quotes(session: Session) -> None:
    bpy.data.objects["Ball"].name = NESTED
    for name in ("Other", NESTED):
        mark(session, name)
    bpy.data.objects[NESTED].data = bpy.data.meshes.new("Empty")
    assert session.mirrors() == ["Mirror", "Other"]
    assert len(session.scene.messages) == 1 and f'"{NESTED}" has no faces' in session.scene.messages[0]
    bpy.data.objects[NESTED].data = bpy.data.objects["Other"].data
    assert session.mirrors() == [NESTED, "Mirror", "Other"]
    assert session.scene.messages == []


@pytest.mark.parametrize("method", ["secant_star", "secant_uv"])
def test_a_shape_without_map_is_told_from_those_that_its_name_quotes(session: Session, method: str) -> None:
    session.settings = Settings(method=method, samples=1, map_resolution=32)
    if method == "secant_uv":
        for name in ("Mirror", "Other"):
            bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
            ball = bpy.context.object
            bpy.data.objects[name].data = ball.data
            bpy.data.objects.remove(ball)
        bpy.data.objects["Ball"].data.uv_layers.remove(bpy.data.objects["Ball"].data.uv_layers[0])
        bpy.data.objects["Ball"].name = NESTED
    else:
        bpy.ops.mesh.primitive_torus_add(location=(0.0, 5.0, 0.0))
        bpy.context.object.name = NESTED
    for name in ("Other", NESTED):
        mark(session, name)
    assert session.mirrors() == ["Mirror", "Other"]
    assert len(session.scene.messages) == 1 and f'"{NESTED}"' in session.scene.messages[0]


@pytest.mark.parametrize("method", ["auto", "secant_star"])
def test_the_legend_names_the_methods_of_the_picture(
    session: Session, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = bpy.context.scene.curvrefl
    settings.method, settings.show = method, "METHOD"
    bpy.data.objects["Ball"].location = (2.0, -2.0, 0.0)
    session.settings = Settings(method=method, samples=1, map_resolution=32)
    renderer = session.draw()
    assert renderer is not None
    picture = RegionPicture(session.scene, renderer)
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 60, 60, np.radians(30))
    picture.advance(view, settings, current_options(), 0.0, False, {})
    region = SimpleNamespace(as_pointer=lambda: 1)
    drawn: list[Legend] = []
    monkeypatch.setattr(handlers, "draw_legend", lambda legend, _context: drawn.append(legend))
    monkeypatch.setattr(handlers.state, "pictures", {1: picture})
    handlers._draw_legend(SimpleNamespace(scene=bpy.context.scene, region=region))  # type: ignore[arg-type]
    assert picture._canvas is not None and picture._reflection is not None
    shown = read_texture(picture._canvas.texture)
    choice = picture._reflection.choice
    used = choice.mirrors[0].method if choice is not None else method
    assert used != "auto"
    (color, label), (background, _) = drawn[0].swatches
    assert label == METHODS[used].label
    # (shaded a little by the shape of what is shown)
    colored = shown[(shown[..., 3] == 1.0) & (np.abs(shown[..., :3] - background).max(axis=-1) > 1e-3), :3]
    assert len(colored) > 5
    np.testing.assert_allclose(
        colored / np.linalg.norm(colored, axis=-1, keepdims=True),
        np.broadcast_to(color / np.linalg.norm(color), colored.shape),
        atol=1e-3,
    )


def test_only_mirror_is_refused(session: Session) -> None:
    bpy.data.meshes[bpy.data.objects["Mirror"].data.name].clear_geometry()
    assert session.draw() is None
    assert '"Mirror" has no faces' in session.scene.messages[0]
    bpy.data.objects["Mirror"].data = bpy.data.objects["Ball"].data
    assert session.mirrors() == ["Mirror"]
    assert session.scene.messages == []


def test_memory_limit(session: Session) -> None:
    assert session.draw(cap=1000) is None
    assert "MB" in session.scene.messages[0]
    session.scene.mirrors_changed()
    assert session.draw() is not None


def test_override_changes_the_mirror_alone(session: Session) -> None:
    view = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 60, 60, np.radians(30))
    before = session.draw()
    assert before is not None
    plain = before.render(view).color()
    settings = bpy.data.objects["Mirror"].curvrefl
    settings.override, settings.tint, settings.fresnel = True, (1.0, 0.0, 0.0), "CONSTANT"
    session.scene.mirrors_changed()
    renderer = session.draw()
    assert renderer is before
    frame = renderer.render(view)
    red = frame.color()
    inner = frame.mask() > 0
    assert inner.sum() > 200
    assert red[inner][:, 1:3].max() < 1e-4 < 0.04 < red[inner][:, 0].mean()
    assert np.abs(red[~inner] - plain[~inner]).mean() < 1e-3
    settings.override = False
    session.scene.mirrors_changed()
    again = session.draw()
    assert again is before
    np.testing.assert_allclose(again.render(view).color(), plain, atol=1e-5)


def alive(kind: type) -> int:
    gc.collect()
    return sum(isinstance(item, kind) for item in gc.get_objects())


def test_an_hour_of_work_leaves_nothing_over(session: Session) -> None:
    """Edits, moves, new and deleted objects: what is alive is what is shown."""
    mark(session, "Other")
    session.draw()
    before = alive(Chunk), alive(Mirror)
    rng = np.random.default_rng(1)
    for turn in range(60):
        ball = bpy.data.objects["Ball"]
        ball.location.x += 0.01
        if turn % 5 == 0:
            ball.data.vertices[0].co.z += 0.01
            ball.data.update()
        if turn % 7 == 0:
            bpy.data.objects["Other"].data.vertices[0].co.z += 0.01
            bpy.data.objects["Other"].data.update()
        if turn % 6 == 0:
            bpy.ops.mesh.primitive_cube_add(location=rng.uniform(-5, 5, 3))
            bpy.context.object.name = f"cube {turn}"
        if turn % 6 == 3:
            bpy.data.objects.remove(bpy.data.objects[f"cube {turn - 3}"])
        session.draw()
    renderer = session.draw()
    assert renderer is not None
    assert alive(Chunk) == len(renderer.geometry.chunks) <= before[0] + 1
    assert alive(Mirror) == before[1] == 2
    assert alive(Renderer) == 1
    session.scene.free()
    del renderer
    assert (alive(Chunk), alive(Mirror), alive(Renderer)) == (0, 0, 0)
