# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator and the verb: what they leave in the file and on disk, and what they say of bad input."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.demo import anamorphosis as demo
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, mirror, start_empty_scene
from curvrefl.curvrefl_addon.demo.shapes import ball, plane
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = (160, 120)


@pytest.fixture
def extension(gpu: None) -> Iterator[None]:
    registration.register()
    yield
    registration.unregister()


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    path = tmp_path / "picture.png"
    path.write_bytes(png_bytes(demo.picture(64)))
    return path


def make(picture: Path, **more: Any) -> set[str]:
    given = {"filepath": str(picture), "mirror": demo.MIRROR, "surfaces": demo.PAPER, "size": 256, **more}
    return bpy.ops.curvrefl.make_anamorphosis(**given)


def refused(picture: Path, **more: Any) -> str:
    with pytest.raises(RuntimeError) as failed:
        make(picture, **more)
    return str(failed.value).removeprefix("Error: ").strip()


def texture_of(item: bpy.types.Object) -> Any:
    tree: Any = item.material_slots[-1].material.node_tree
    return next(node for node in tree.nodes if node.type == "TEX_IMAGE")


def test_an_image_and_a_material_are_made(extension: None, picture: Path) -> None:
    demo.build_anamorphosis("cylinder", *SIZE)
    mirror_object, paper = bpy.data.objects[demo.MIRROR], bpy.data.objects[demo.PAPER]
    # What is marked and what is selected is meant where nothing is named.
    mirror_object.curvrefl.is_mirror = True
    for item in bpy.context.scene.objects:
        item.select_set(item in (mirror_object, paper))
    assert make(picture, mirror="", surfaces="", material="EMISSION") == {"FINISHED"}
    texture = texture_of(paper)
    image = texture.image
    assert tuple(image.size) == (256, 256) and image.packed_file is not None
    assert (image.name, texture.extension) == (f"Anamorphosis {demo.PAPER}", "EXTEND")
    pixels = np.array(image.pixels[:]).reshape(256, 256, 4)
    assert 0.02 < (pixels[..., 3] > 0.5).mean() < 0.5 and pixels[pixels[..., 3] > 0.5][:, :3].std() > 0.1
    before = [slot.material for slot in paper.material_slots]
    assert make(picture, material="NONE") == {"FINISHED"}
    assert [slot.material for slot in paper.material_slots] == before


def test_the_viewport_sees_it_as_a_camera_at_its_place(extension: None, picture: Path) -> None:
    """The frame goes by the mirror's outline, so it is the same however long the lens is."""
    demo.build_anamorphosis("cylinder", *SIZE)
    window = bpy.context.window_manager.windows[0]
    area = next(item for item in window.screen.areas if item.type == "VIEW_3D")
    region = next(item for item in area.regions if item.type == "WINDOW")
    space: Any = area.spaces.active
    space.region_3d.view_matrix = bpy.context.scene.camera.matrix_world.inverted()
    space.region_3d.update()
    found = []
    with bpy.context.temp_override(window=window, area=area, region=region):
        for eye in ("CAMERA", "VIEW"):
            assert make(picture, eye=eye, material="NONE") == {"FINISHED"}
            image = [item for item in bpy.data.images if item.name.startswith("Anamorphosis")][-1]
            found.append(np.array(image.pixels[:]).reshape(256, 256, 4))
    assert found[0][..., 3].mean() > 0.02
    assert np.abs(found[0] - found[1]).mean() < 0.05 * found[0].mean()


def test_a_uv_map_shows_the_picture_itself(extension: None, picture: Path) -> None:
    """The map of a vertex is where the mirror shows it: the way from there ends at the vertex again."""
    demo.build_anamorphosis("cylinder", *SIZE)
    paper: Any = bpy.data.objects[demo.PAPER]
    assert make(picture, result="UVS", cuts=40) == {"FINISHED"}
    mesh = paper.data
    assert len(mesh.polygons) == 41**2 and texture_of(paper).extension == "CLIP"
    assert texture_of(paper).image.filepath == str(picture)
    shown = [face for face in mesh.polygons if face.material_index == 1]
    assert 100 < len(shown) < 1000
    layer = mesh.uv_layers["Anamorphosis"]
    places = np.array([layer.uv[loop].vector for face in shown for loop in face.loop_indices], np.float64)
    points = np.array([mesh.vertices[vertex].co for face in shown for vertex in face.vertices], np.float64)
    assert places.min() > -0.5 and places.max() < 1.5
    _assert_seen_at(picture, places, points, 1e-4)


def _assert_seen_at(picture: Path, places: np.ndarray, points: np.ndarray, tolerance: float) -> None:
    """Lines of sight through places of the picture end at these points."""
    from curvrefl.curvrefl_addon.design.anamorphosis.making import begin
    from curvrefl.curvrefl_addon.design.anamorphosis.picture_frame import FrameChoice, ways_of_picture
    from curvrefl.curvrefl_addon.design.anamorphosis.results import read_picture
    from curvrefl.curvrefl_addon.design.stage import read_stage

    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    stage = read_stage(scene, view_layer, [demo.MIRROR], [demo.PAPER], None, SIZE)
    making = begin(stage, read_picture(picture)[1], FrameChoice(), fineness=16)
    ways = ways_of_picture(making.ways, stage.view, making.anamorphosis.frame, places)
    # (A ray in some thousands slips between two triangles of the mirror.)
    off = np.percentile(np.linalg.norm(ways.end - points, axis=1), 99.5)
    assert off < tolerance * np.ptp(points, axis=0).max()


def test_a_grid_lies_on_the_paper(extension: None, picture: Path) -> None:
    demo.build_anamorphosis("cylinder", *SIZE)
    assert make(picture, result="MESH", columns=12, clearance=0.001) == {"FINISHED"}
    item: Any = bpy.data.objects["Anamorphosis"]
    assert len(item.data.vertices) == 13**2 and len(item.data.polygons) == 12**2
    points = np.array([vertex.co for vertex in item.data.vertices])
    assert 1e-5 < points[:, 2].min() <= points[:, 2].max() <= 0.001 + 1e-6
    # It is seen from above: towards the mirror.
    assert min(face.normal.z for face in item.data.polygons) > 0.9
    layer = item.data.uv_layers.active
    corner = {loop.vertex_index: layer.uv[loop.index].vector for loop in item.data.loops}
    places = np.array([corner[number] for number in range(len(points))], np.float64)
    flat = points * [1.0, 1.0, 0.0]
    # (As far off as the rays go on while they fall by a millimeter.)
    _assert_seen_at(picture, places, flat, 0.02)


def test_by_a_plane_mirror_an_object_stands_as_its_image(extension: None, picture: Path) -> None:
    start_empty_scene(*SIZE)
    sheet = add_object(demo.MIRROR, plane((4.0, 4.0), (8, 8)), mirror("Chrome"), rotation=(0.5 * np.pi, 0.0, 0.0))
    assert sheet.name == demo.MIRROR
    thing: Any = add_object("Thing", ball(0.3, 12), location=(0.1, 0.7, 0.05))
    thing.hide_render = True
    add_camera((0.2, -3.0, 0.4), (0.0, 0.0, 0.0), lens=50.0)
    assert make(picture, result="MESH", surfaces="", source="Thing", stands="DEPTH") == {"FINISHED"}
    bent: Any = bpy.data.objects["Thing bent"]
    own = np.array([thing.matrix_world @ vertex.co for vertex in thing.data.vertices])
    found = np.array([vertex.co for vertex in bent.data.vertices])
    np.testing.assert_allclose(found, own * [1.0, -1.0, 1.0], atol=2e-5)
    middle = found.mean(axis=0)
    faces = [face for face in bent.data.polygons if face.area > 1e-4]
    assert all(np.dot(np.array(face.normal), np.array(face.center) - middle) > 0.0 for face in faces)


def test_prints_are_as_large_as_in_the_scene(extension: None, picture: Path, tmp_path: Path) -> None:
    from PIL import Image

    demo.build_anamorphosis("cylinder", *SIZE)
    folder = tmp_path / "prints"
    assert make(picture, result="PRINT", folder=str(folder), dpi=100.0) == {"FINISHED"}
    assert sorted(path.name for path in folder.iterdir()) == ["Paper_grid.svg", "Paper_print.png", "Paper_print.svg"]
    svg = (folder / "Paper_grid.svg").read_text(encoding="utf-8")
    size = re.search(r'width="([\d.]+)mm" height="([\d.]+)mm"', svg)
    assert size is not None
    width, height = map(float, size.groups())
    with Image.open(folder / "Paper_print.png") as opened:
        np.testing.assert_allclose(opened.size, np.array([width, height]) / 25.4 * 100.0, atol=0.01)
        np.testing.assert_allclose(opened.info["dpi"], 100.0, rtol=1e-4)
        pixels = np.asarray(opened)[::-1]
    # The mirror's outline is a circle of 80 mm, and the picture is the same as on the file's own paper.
    outline = np.array([[float(number) for number in pair.split(",")] for pair in _path(svg, "mirror")])
    np.testing.assert_allclose(np.ptp(outline, axis=0), 80.0, atol=0.05)
    middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
    np.testing.assert_allclose(np.linalg.norm(outline - middle, axis=1), 40.0, atol=0.05)
    cut = np.array([[float(number) for number in pair.split(",")] for pair in _path(svg, "cut")])
    assert np.linalg.norm(cut - middle, axis=1).min() > 40.0
    assert pixels[..., 3].any() and "data:image/png" in (folder / "Paper_print.svg").read_text(encoding="utf-8")
    assert make(picture, result="PRINT", folder=str(folder), dpi=50.0, print_width=100.0) == {"FINISHED"}
    half = (folder / "Paper_grid.svg").read_text(encoding="utf-8")
    assert re.search(r'width="(99|100)\.\d+mm"', half)
    assert "fewer dots per inch" in refused(picture, result="PRINT", folder=str(folder), dpi=2400.0, print_width=900.0)


def _path(svg: str, name: str) -> list[str]:
    found = re.search(rf'id="{name}" d="([^"]*)"', svg)
    assert found is not None
    return re.findall(r"-?[\d.]+,-?[\d.]+", found[1])


def test_bad_input_is_one_sentence(extension: None, picture: Path, tmp_path: Path) -> None:
    demo.build_anamorphosis("cylinder", *SIZE)
    assert refused(picture, filepath=str(tmp_path / "none.png")).startswith("There is no picture")
    (tmp_path / "text.png").write_text("no picture", encoding="utf-8")
    assert "no picture that Blender can read" in refused(picture, filepath=str(tmp_path / "text.png"))
    assert "did you mean" in refused(picture, mirror="Mirrors")
    assert "No mirror is chosen" in refused(picture, mirror="")
    bpy.ops.object.select_all(action="DESELECT")
    assert "No surface is chosen" in refused(picture, surfaces="")
    assert "is the mirror" in refused(picture, surfaces=demo.MIRROR)
    assert 'no UV map "Other"' in refused(picture, uv_map="Other")
    paper: Any = bpy.data.objects[demo.PAPER]
    paper.location.z = -3.0
    assert "Nothing of the picture lands" in refused(picture, material="NONE")
    paper.location.z = 0.0
    paper.data.uv_layers.remove(paper.data.uv_layers[0])
    assert "has no UV map: unwrap it" in refused(picture)
    paper.modifiers.new("Bend", "SIMPLE_DEFORM")
    assert "modifiers or shape keys" in refused(picture, result="UVS")
    paper.modifiers.clear()
    bpy.context.scene.camera.rotation_euler = (0.0, 0.0, 0.0)
    assert "is not seen" in refused(picture, result="UVS")
    bpy.context.scene.camera = None
    assert "no camera" in refused(picture, result="UVS")
    assert "no 3D viewport" in refused(picture, result="UVS", eye="VIEW")


def test_what_is_not_flat_is_not_printed(extension: None, picture: Path, tmp_path: Path) -> None:
    demo.build_anamorphosis("sphere", *SIZE)
    assert "is not flat" in refused(picture, result="PRINT", folder=str(tmp_path), scale=0.4)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["picture.png"]


def test_the_verb_writes_images_and_prints(picture: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    demo.build_anamorphosis("cylinder", *SIZE)
    file, output = tmp_path / "scene.blend", tmp_path / "out"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    given = ["anamorphosis", str(file), "--mirror", demo.MIRROR, "--surface", demo.PAPER, "--picture", str(picture)]
    capfd.readouterr()
    assert cli.main([*given, "--size", "256", "--print", "--dpi", "40", "--output", str(output)]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert re.match(r'^100\.0 % of the picture is on "Paper"\.\nThe sheet of "Paper" is [\d.]+ x [\d.]+ mm', out)
    assert sorted(path.name for path in output.iterdir()) == [
        "Paper.png",
        "Paper_grid.svg",
        "Paper_print.png",
        "Paper_print.svg",
    ]
    assert cli.main([*given, "--fit", "round", "--output", str(tmp_path / "other")]) == 2
    assert capfd.readouterr().err == 'curvrefl: There is no fit "round": choose from inside, cover, stretch.\n'
    assert cli.main([*given, "--rectangle", "0.9,0.9,0.1", "--output", str(tmp_path / "other")]) == 2
    assert "is not 4 numbers" in capfd.readouterr().err
    assert not (tmp_path / "other").exists()
