# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes in files: layers of a multilayer file by Blender's names, a file for each by the verb, and the reader."""

from __future__ import annotations

import json
import runpy
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.command import cli, verbs
from curvrefl.curvrefl_addon.engine.passes import OF_MIRRORS, PASSES
from rendered import HEIGHT, WIDTH, channels, mark, open_image_io, render
from small_scene import build_scene

pytestmark = pytest.mark.usefixtures("extension")
BALL, BLOCK = "Mirror Ball", "Block"
NAMES = tuple(name for name in verbs.PASSES if name != "color")
READER = Path(__file__).resolve().parents[3] / "examples" / "read_passes.py"


def saved(folder: Path) -> Path:
    """The small scene with the block from 0 to 1 in its UV map, as a file."""
    build_scene()
    mark(bpy.context.scene, BALL)
    path = folder / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path


def test_the_verb_knows_all_passes_of_mirrors() -> None:
    assert set(NAMES) == set(OF_MIRRORS)


def test_a_multilayer_file_by_verb_and_by_f12(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, output = saved(tmp_path), tmp_path / "layers.exr"
    given = ("--reflector", BALL, "--passes", ",".join(NAMES), "--samples", "1", "--multilayer")
    assert cli.main(["render", str(file), *given, "--output", str(output)]) == 0
    assert [path.name for path in tmp_path.iterdir() if path.suffix == ".exr"] == [output.name]
    found = channels(output)
    layer = bpy.context.view_layer.name
    wanted = {f"{layer}.Combined.{channel}" for channel in "RGBA"}
    wanted |= {f"{layer}.{item.name}.{c}" for item in PASSES if item.read is not None for c in item.channels}
    assert set(found) == wanted
    assert not any(getattr(bpy.context.view_layer.curvrefl, item.setting) for item in PASSES)
    for item in PASSES:
        setattr(bpy.context.view_layer.curvrefl, item.setting, item.read is not None)
    bpy.context.scene.curvrefl.render_samples = 1
    f12 = channels(render(tmp_path / "f12.exr", "OPEN_EXR_MULTILAYER"))
    assert set(f12) == wanted
    for name, values in found.items():
        np.testing.assert_array_equal(values, f12[name], err_msg=name)
    open_image_io()
    reader = runpy.run_path(str(READER))
    passes, metadata = reader["read_passes"](output)
    assert set(passes) == {name.rpartition(".")[0] for name in wanted}
    uv = passes[f"{layer}.UV"]
    assert uv.shape == (HEIGHT, WIDTH, 3)
    for index, channel in enumerate("UVA"):
        np.testing.assert_array_equal(uv[..., index], found[f"{layer}.UV.{channel}"])
    names = reader["object_names"](metadata)
    assert sorted(names.values()) == sorted([BALL, BLOCK])
    shows_block = passes[f"{layer}.Object"] == {title: number for number, title in names.items()}[BLOCK]
    assert shows_block.sum() > 5
    # The block has Blender's map of a cube: all of it from 0 to 1, and here the ball has one, too.
    assert (uv[shows_block][:, 2] == 1.0).all() and (uv[shows_block] >= 0.0).all() and (uv[shows_block] <= 1.0).all()
    on_ball = passes[f"{layer}.Mirror ID"] == {title: number for number, title in names.items()}[BALL]
    np.testing.assert_array_equal(on_ball, passes[f"{layer}.Depth"] > 0.0)
    reader["main"](str(output))
    said = capsys.readouterr().out
    assert f"{layer}.Path Length" in said and any(line.endswith(BLOCK) for line in said.splitlines())


def test_single_files_hold_the_same_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, output = saved(tmp_path), tmp_path / "one.exr"
    given = ("--reflector", BALL, "--passes", "depth,uv,mirror_id", "--samples", "1")
    assert cli.main(["render", str(file), *given, "--output", str(output)]) == 0
    assert {path.name for path in tmp_path.glob("*.exr")} == {"one_depth.exr", "one_uv.exr", "one_mirror_id.exr"}
    assert any(line.startswith("object ") and line.endswith(BALL) for line in capsys.readouterr().out.splitlines())
    depth = channels(tmp_path / "one_depth.exr")["R"]
    assert 4.9 < depth[depth > 0.0].min() < 12.0
    assert cli.main(["render", str(file), *given, "--multilayer", "--output", str(tmp_path / "no.png")]) == 2
    assert "must end in .exr" in capsys.readouterr().err


def test_a_pass_that_is_not_asked_for_is_not_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from curvrefl.curvrefl_addon.renderer import frame

    made: list[int] = []
    monkeypatch.setattr(frame, "read_all_ways", lambda *_: made.append(1) or {})
    file = saved(tmp_path)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    bpy.context.view_layer.curvrefl.use_pass_object = True
    found = channels(render(tmp_path / "plain.exr", "OPEN_EXR_MULTILAYER"))
    assert not made and f"{bpy.context.view_layer.name}.Depth.Z" not in found
    bpy.context.view_layer.curvrefl.use_pass_depth = True
    render(tmp_path / "plain.exr", "OPEN_EXR_MULTILAYER")
    assert made == [1]
    parts = open_image_io().ImageBuf(str(tmp_path / "plain.exr"), 0, 0).spec().extra_attribs
    told = {item.name: item.value for item in parts}
    assert json.loads(told[f"curvrefl.{bpy.context.view_layer.name}.objects"])


def test_vectors_are_of_the_frames_before_and_after(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The block goes to the right, faster later; the ball shows it smaller, on its right side, going the same way."""
    file, output = saved(tmp_path), tmp_path / "moving.exr"
    block = bpy.data.objects[BLOCK]
    for frame, place in ((4, 1.8), (5, 2.0), (6, 2.4)):
        block.location.x = place
        block.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=str(file), check_existing=False)
    given = ("--reflector", BALL, "--frame", "5", "--passes", "vector,object,images", "--samples", "1", "--multilayer")
    assert cli.main(["render", str(file), *given, "--output", str(output)]) == 0
    assert bpy.context.scene.frame_current == 5
    found = {name.partition(".")[2]: values for name, values in channels(output).items()}
    shows_block = found["Object.X"] == 2
    assert shows_block.sum() > 5
    before, after = found["Vector.X"][shows_block], found["Vector.Z"][shows_block]
    # As Cycles has it: before less now, now less after. (What goes along its own reflected ray stands still.)
    assert np.median(before) < -0.1 and before.max() < 0.05 and after.max() < 0.05
    assert after.min() < before.min() < -0.2, "it goes faster later"
    assert np.abs(found["Vector.X"][~shows_block]).max() < 1e-3, "all else stands still"
    np.testing.assert_array_equal(found["Images.X"][shows_block], 1.0)
    assert "Vector" not in capsys.readouterr().err
