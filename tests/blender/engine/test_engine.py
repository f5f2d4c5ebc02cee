# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders by the engine: the verb's pixels, Blender's colors, borders, films, view layers, and what it refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.engine import engine as engine_module
from curvrefl.curvrefl_addon.engine.area import area_of
from curvrefl.curvrefl_addon.engine.session import RenderSession
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffers_made
from rendered import HEIGHT, WIDTH, channels, mark, pixels, render
from small_scene import build_scene

pytestmark = pytest.mark.usefixtures("extension")
BALL = "Mirror Ball"


@pytest.fixture
def scene(extension: None) -> bpy.types.Scene:
    build_scene()
    mark(bpy.context.scene, BALL)
    return bpy.context.scene


def verb(folder: Path, suffix: str, *arguments: str) -> Path:
    """What the verb makes of the open scene."""
    file, output = folder / "scene.blend", folder / f"verb{suffix}"
    bpy.ops.wm.save_as_mainfile(filepath=str(file), check_existing=False)
    assert cli.main(["render", str(file), "--reflector", BALL, *arguments, "--output", str(output)]) == 0
    return output


def test_the_verb_renders_what_f12_does(scene: bpy.types.Scene, tmp_path: Path) -> None:
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.exposure = 0.5
    f12, exr = render(tmp_path / "f12.png", "PNG"), render(tmp_path / "f12.exr")
    scene.render.engine = "CYCLES"
    assert f12.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    np.testing.assert_array_equal(pixels(verb(tmp_path, ".png")), pixels(f12))
    linear = pixels(verb(tmp_path, ".exr"))
    np.testing.assert_array_equal(linear, pixels(exr))
    assert linear[..., :3].std() > 0.01
    other = pixels(verb(tmp_path, ".exr", "--samples", "1"))
    assert not np.array_equal(other, linear), "the argument is followed"
    bpy.context.scene.curvrefl.method = "environment_cube"
    of_file = pixels(verb(tmp_path, ".exr"))
    assert not np.array_equal(of_file, linear), "the file's own settings are"
    np.testing.assert_array_equal(pixels(verb(tmp_path, ".exr", "--method", "auto")), linear)


def test_colors_are_as_blender_shows_them(scene: bpy.types.Scene, tmp_path: Path) -> None:
    scene.render.dither_intensity = 0.0
    linear = render(tmp_path / "linear.exr")
    shown = {}
    for transform in ("Standard", "AgX"):
        scene.view_settings.view_transform = transform
        shown[transform] = pixels(render(tmp_path / f"{transform}.png", "PNG"))
        image = bpy.data.images.load(str(linear))
        image.save_render(str(tmp_path / "saved.png"), scene=scene)
        bpy.data.images.remove(image)
        np.testing.assert_array_equal(shown[transform], pixels(tmp_path / "saved.png"))
    assert np.abs(shown["AgX"] - shown["Standard"]).max() > 0.05
    scene.cycles.film_exposure = 2.0
    np.testing.assert_allclose(
        pixels(render(tmp_path / "twice.exr"))[..., :3], 2.0 * pixels(linear)[..., :3], rtol=1e-6
    )


@pytest.mark.parametrize("is_cropped", [False, True])
def test_a_border(scene: bpy.types.Scene, tmp_path: Path, is_cropped: bool) -> None:
    whole = pixels(render(tmp_path / "whole.exr"))
    borders = scene.render
    borders.use_border, borders.use_crop_to_border = True, is_cropped
    borders.border_min_x, borders.border_max_x = 0.3, 0.77
    borders.border_min_y, borders.border_max_y = 0.21, 0.6
    area = area_of(borders)
    part = pixels(render(tmp_path / "part.exr"))
    rows = slice(HEIGHT - area.y - area.height, HEIGHT - area.y)
    columns = slice(area.x, area.x + area.width)
    if not is_cropped:
        assert part.shape == whole.shape
        outside = part.copy()
        outside[rows, columns] = 0.0
        assert not outside.any()
        part = part[rows, columns]
    assert part.shape == (area.height, area.width, 4)
    # (Shadows of the sky are sampled in a pattern of two by two pixels, which begins at the border.)
    assert (np.abs(part - whole[rows, columns]).max(axis=2) > 0.01).mean() < 0.02
    passes = verb(tmp_path, ".exr", "--passes", "color,object").with_name("verb_object.exr")
    found = channels(passes)["R"]
    assert found.shape == (HEIGHT, WIDTH) and not found[: rows.start].any()


def test_a_transparent_film(scene: bpy.types.Scene, tmp_path: Path) -> None:
    opaque = pixels(render(tmp_path / "opaque.exr"))
    scene.render.film_transparent = True
    clear = pixels(render(tmp_path / "clear.exr"))
    assert (opaque[..., 3] == 1.0).all()
    assert not clear[0, 0].any()
    np.testing.assert_allclose(clear[HEIGHT // 2, WIDTH // 2], opaque[HEIGHT // 2, WIDTH // 2], rtol=1e-5)
    rim = (clear[..., 3] > 0.0) & (clear[..., 3] < 1.0)
    assert rim.sum() > 10
    over = clear[..., :3] + (1.0 - clear[..., 3:]) * opaque[0, 0, :3]
    assert np.abs(over - opaque[..., :3]).max() < 1e-3, "the world behind it is the opaque picture"


def test_size_and_pixel_aspect(scene: bpy.types.Scene, tmp_path: Path) -> None:
    scene.render.resolution_percentage = 50
    scene.render.pixel_aspect_x = 2.0
    small = pixels(render(tmp_path / "small.exr"))
    assert small.shape == (HEIGHT // 2, WIDTH // 2, 4)
    scene.render.film_transparent = True
    alpha = pixels(render(tmp_path / "small.exr"))[:, : WIDTH // 4, 3]
    # Half of the ball, which is as high as it is wide on pixels twice as wide.
    tall, wide = (alpha.max(axis=1) > 0.5).sum(), 2 * (alpha.max(axis=0) > 0.5).sum()
    assert wide == pytest.approx(tall / 2, abs=1)


def test_view_layers_and_passes(scene: bpy.types.Scene, tmp_path: Path) -> None:
    first = bpy.context.view_layer
    second = scene.view_layers.new("without the block")
    group = bpy.data.collections.new("block")
    scene.collection.children.link(group)
    block = bpy.data.objects["Block"]
    scene.collection.objects.unlink(block)
    group.objects.link(block)
    second.layer_collection.children["block"].exclude = True
    for name in ("mirror", "position", "object"):
        setattr(first.curvrefl, f"use_pass_{name}", True)
    found = channels(render(tmp_path / "layers.exr", "OPEN_EXR_MULTILAYER"))
    assert {name for name in found if name.startswith(second.name)} == {f"{second.name}.Combined.{c}" for c in "RGBA"}
    of_first = {name.removeprefix(f"{first.name}.") for name in found if name.startswith(first.name)}
    expected = {f"{kind}.{c}" for kind in ("Combined", "Mirror") for c in "RGBA"}
    assert of_first == expected | {f"Position.{c}" for c in "XYZW"} | {"Object.X"}
    differs = np.abs(found[f"{first.name}.Combined.R"] - found[f"{second.name}.Combined.R"]) > 0.05
    assert 10 < differs.sum() < differs.size / 2
    # The mirrors alone, with their coverage: within the ball they are the picture.
    alpha = found[f"{first.name}.Mirror.A"]
    inside = alpha > 0.999
    assert 50 < inside.sum() < inside.size / 2 and not alpha[0, 0]
    for color in "RGB":
        np.testing.assert_allclose(
            found[f"{first.name}.Mirror.{color}"][inside],
            found[f"{first.name}.Combined.{color}"][inside],
            atol=1e-5,
        )
    # Where the ball shows the block, a point of it.
    shown = found[f"{first.name}.Object.X"] > 0.0
    points = np.stack([found[f"{first.name}.Position.{c}"][shown] for c in "XYZW"], axis=-1)
    assert shown.sum() > 5
    assert (points[:, 3] == 1.0).all()
    assert (np.abs(points[:, :3] - (2.0, -1.0, 0.0)) < 0.51).all()


def test_an_animation_with_passes_through_the_compositor(scene: bpy.types.Scene, tmp_path: Path) -> None:
    """The mirror's pass in place of the picture; frames that change differ, and a mesh that stays is not read into
    another object."""
    ball = bpy.data.objects[BALL]
    scene.frame_start, scene.frame_end = 1, 20
    for frame, place in ((1, -1.0), (20, 1.0)):
        ball.location.x = place
        ball.keyframe_insert("location", frame=frame)
    world = scene.world.node_tree
    color = world.nodes["Background"].inputs["Color"]
    for frame, gray in ((1, 0.0), (20, 1.0)):
        color.default_value = (gray, gray, gray, 1.0)
        color.keyframe_insert("default_value", frame=frame)
    bpy.context.view_layer.curvrefl.use_pass_mirror = True
    tree = bpy.data.node_groups.new("compositor", "CompositorNodeTree")
    scene.compositing_node_group = tree
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    layers, end = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(layers.outputs["Mirror"], end.inputs[0])
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    scene.render.filepath = str(tmp_path / "frame_")
    sessions: list[RenderSession] = []
    updated: list[tuple[Any, ...]] = []

    def look(*_arguments: Any) -> None:
        (session,) = engine_module._state.sessions.values()
        assert session._renderer is not None and session._arrays is not None
        sessions.append(session)
        updated.append((session._renderer, *(mesh for mesh in session._arrays.meshes)))

    bpy.app.handlers.render_post.append(look)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(look)
    frames = [pixels(tmp_path / f"frame_{number:04d}.exr") for number in range(1, 21)]
    coverage = [frame[..., 3] for frame in frames]
    middles = [(cover * np.arange(WIDTH)).sum() / cover.sum() for cover in coverage]
    assert (np.diff(middles) > 0.0).all(), "the ball goes to the right"
    light = [frame[..., :3].max() for frame in frames]
    assert (np.diff(light) > 0.0).all(), "the sky gets lighter"
    assert len(set(map(id, sessions))) == 1 and all(len(state) == len(updated[0]) for state in updated)
    assert all(one is other for state in updated for one, other in zip(state, updated[0], strict=True))
    assert engine_module._state.sessions == {}, "what is kept is let go at the end"
    assert frame_buffers_made() == 0, "and frame buffers while their context is there"


def test_a_render_that_is_stopped(scene: bpy.types.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def stops(_engine: Any) -> bool:
        asked.append(1)
        return len(asked) > 2

    monkeypatch.setattr(engine_module, "is_stopped", stops)
    delivered: list[int] = []
    monkeypatch.setattr(engine_module, "fill", lambda *_arguments: delivered.append(1))
    bpy.ops.render.render()
    assert len(asked) == 3 and not delivered
    monkeypatch.undo()
    assert pixels(render(tmp_path / "again.exr"))[..., 3].all()


def test_without_a_mirror_it_says_so_and_draws_the_rest(
    scene: bpy.types.Scene, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.data.objects[BALL].curvrefl.is_mirror = False
    scene.view_layers.new("another")
    picture = pixels(render(tmp_path / "picture.exr"))
    assert picture[..., :3].std() > 0.01
    assert "".join(capfd.readouterr()).count("No object is marked as a mirror") == 1


def test_a_marked_object_that_cannot_be_a_mirror_is_said(
    scene: bpy.types.Scene, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.data.objects["Block"].curvrefl.is_mirror = True
    bpy.data.objects["Block"].scale = (1.0, 1.0, 0.0)
    assert pixels(render(tmp_path / "picture.exr"))[..., 3].all()
    assert "".join(capfd.readouterr()).count('"Block" is flattened') == 1


@pytest.mark.parametrize(("problem", "said"), [("panorama", "panoramic"), ("stereo", "Stereoscopy"), ("fault", "torn")])
def test_what_cannot_be_rendered_is_an_error_and_no_file(
    scene: bpy.types.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, problem: str, said: str
) -> None:
    scene.view_layers.new("another")
    if problem == "panorama":
        scene.camera.data.type = "PANO"
    elif problem == "stereo":
        scene.render.use_multiview = True
    else:

        def torn(*_arguments: Any, **_keywords: Any) -> None:
            raise RuntimeError("torn apart")

        monkeypatch.setattr(RenderSession, "draw", torn)
    with pytest.raises(RuntimeError, match=said) as caught:
        render(tmp_path / "none.exr")
    assert str(caught.value).count(said) == 1
    assert list(tmp_path.iterdir()) == []
    assert engine_module._state.sessions == {}
