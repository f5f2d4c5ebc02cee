# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file from a stranger: its scripts do not run, its paths are not written to, its counts are not taken."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import memory
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.scene.meshes.meshes import read_mesh
from small_scene import build_scene, saved

pytestmark = pytest.mark.usefixtures("gpu")

BALL = ("--reflector", "Mirror Ball")
VERBS = {
    "render": [*BALL, "--samples", "1", "--output"],
    "compare": [*BALL, "--method", "exact", "--samples", "1", "--peers", "none", "--output"],
    "bake": [*BALL, "--resolution", "16", "--output"],
}


def with_scripts(ball: bpy.types.Object, sign: Path) -> None:
    """A text that is registered as a module, with a handler, and a driver: all make files where they run."""
    text = bpy.data.texts.new("stranger.py")
    text.write(
        "import bpy, pathlib\n"
        f"pathlib.Path({str(sign)!r}, 'text').touch()\n"
        f"bpy.app.handlers.depsgraph_update_post.append(lambda *_: pathlib.Path({str(sign)!r}, 'handler').touch())\n"
    )
    text.use_module = True
    driver = ball.driver_add("location", 0).driver
    driver.type = "SCRIPTED"
    driver.expression = f"__import__('pathlib').Path({str(sign)!r}, 'driver').touch() or 0.0"


def with_paths(folder: Path) -> None:
    """Outputs of the file's own: its render path, a File Output node, a cache of particles on disk."""
    scene = bpy.context.scene
    scene.render.filepath = str(folder / "rendered")
    scene.render.use_file_extension = True
    tree = bpy.data.node_groups.new("compositing", "CompositorNodeTree")
    scene.compositing_node_group = tree
    scene.render.use_compositing = True
    layers = tree.nodes.new("CompositorNodeRLayers")
    file_output = tree.nodes.new("CompositorNodeOutputFile")
    file_output.directory = str(folder)
    file_output.file_name = "composited"
    file_output.file_output_items.new("RGBA", "Image")
    tree.links.new(layers.outputs["Image"], file_output.inputs["Image"])
    block = bpy.data.objects["Block"]
    block.modifiers.new("cloth", "CLOTH").point_cache.use_disk_cache = True
    block.modifiers["cloth"].point_cache.use_external = True
    block.modifiers["cloth"].point_cache.filepath = str(folder)


@pytest.mark.parametrize("verb", VERBS)
def test_its_scripts_do_not_run_and_its_paths_are_not_written(
    verb: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    sign = tmp_path / "sign"
    sign.mkdir()

    def change(ball: bpy.types.Object) -> None:
        with_scripts(ball, sign)
        with_paths(sign)

    path = saved(tmp_path, change)
    # (where it was made, its driver may run)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for made in sign.iterdir():
        made.unlink()
    output = tmp_path / "out" / ("x.png" if verb == "render" else "")
    assert cli.main([verb, str(path), *VERBS[verb], str(output)]) == 0, capfd.readouterr().err
    assert list(sign.iterdir()) == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["files", "out", "sign"]
    assert [path.name for path in path.parent.iterdir()] == ["scene.blend"]


def test_they_would_run_in_a_blender_that_trusts_it(tmp_path: Path) -> None:
    """What the test above leaves out: its scripts are such as run."""
    path = saved(tmp_path, lambda ball: with_scripts(ball, tmp_path))
    for name in ("text", "driver"):
        (tmp_path / name).unlink(missing_ok=True)
    bpy.ops.wm.open_mainfile(filepath=str(path), use_scripts=True)
    bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.clear()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert (tmp_path / "text").exists() and (tmp_path / "driver").exists()


def refused(code: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> str:
    err = capfd.readouterr().err
    assert (code, err.count("\n")) == (2, 1), err
    assert not (tmp_path / "out").exists()
    return err


def test_a_picture_that_is_too_large(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        render = bpy.context.scene.render
        render.resolution_x = render.resolution_y = 65536

    code = cli.main(["render", str(saved(tmp_path, change)), *VERBS["render"], str(tmp_path / "out" / "x.png")])
    said = refused(code, tmp_path, capfd)
    assert "65536x65536" in said and "--resolution" in said


def test_what_memory_does_not_hold(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = saved(tmp_path)
    monkeypatch.setattr(memory, "available_bytes", lambda: 100 << 20)
    given = ["render", str(path), *BALL, "--samples", "1", "--output", str(tmp_path / "out" / "x.png")]
    said = refused(cli.main([*given, "--resolution", "1000x1000"]), tmp_path, capfd)
    assert "1000x1000" in said and "0.1 are free" in said
    monkeypatch.setattr(memory, "available_bytes", lambda: 80 << 10)
    said = refused(cli.main([*given, "--resolution", "16x12"]), tmp_path, capfd)
    assert "The scene needs" in said and "hide objects" in said


def test_an_image_that_memory_does_not_hold(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def change(_ball: bpy.types.Object) -> None:
        giant = bpy.data.images.new("Giant", 16, 16)
        giant.generated_width = giant.generated_height = 65536
        painted = bpy.data.materials.new("painted")
        texture = painted.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = giant
        shader = painted.node_tree.nodes["Principled BSDF"]
        painted.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
        bpy.data.objects["Block"].data.materials.append(painted)

    if not memory.exceeds_memory(40 << 32):
        pytest.skip("this machine holds it, or does not tell")
    code = cli.main(["render", str(saved(tmp_path, change)), *VERBS["render"], str(tmp_path / "out" / "x.png")])
    err = capfd.readouterr().err
    assert code == 0 and "Giant" in err and "Memory" in err


def test_a_mesh_whose_faces_have_no_vertices(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    from curvrefl.curvrefl_addon.errors import InputError
    from curvrefl.curvrefl_addon.scene.reads import MeshNeeds

    ball = build_scene()
    corners = np.empty(len(ball.data.loops), np.int32)
    attribute = ball.data.attributes[".corner_vert"].data
    attribute.foreach_get("value", corners)
    ball.data.loop_triangles  # noqa: B018  (made while they are right)
    corners[7] = len(ball.data.vertices) + 5
    attribute.foreach_set("value", corners)
    try:
        with pytest.raises(InputError, match="damaged"):
            read_mesh(ball.data, MeshNeeds())
    finally:
        bpy.ops.wm.read_factory_settings(use_empty=True)


def test_a_renderer_takes_what_memory_holds() -> None:
    from curvrefl.curvrefl_addon.scene.extract import extract_scene

    ball = build_scene()
    arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), bpy.context.scene, [ball])
    Renderer(arrays).free()
