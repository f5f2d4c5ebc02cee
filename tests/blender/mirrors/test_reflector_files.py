# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked reflectors survive the way through files bit for bit; damaged files are told from good ones."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_files import DESCRIPTION, load, save
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_map import ReflectorMap, Spread
from curvrefl.curvrefl_addon.scene.exr_files import save_exr

SIZE = 12


def a_map(seed: int = 0) -> ReflectorMap:
    """Random values of every size, with the zeros, ones and negative values in alpha that image files like to spoil."""
    rng = np.random.default_rng(seed)

    def cube() -> np.ndarray:
        values = rng.normal(size=(6, SIZE, SIZE, 4)) * 10.0 ** rng.uniform(-20, 20, (6, SIZE, SIZE, 1))
        values[..., 3] = rng.choice([0.0, 1.0, -0.5, 3e4, 1e-12], size=values.shape[:3])
        return values.astype(np.float32)

    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    world_to_map = np.eye(4)
    world_to_map[:3, :3], world_to_map[:3, 3] = turn, rng.normal(size=3)
    return ReflectorMap(
        object_name='Kettle "№ 1"',
        resolution=SIZE,
        world_to_map=world_to_map,
        center_name="origin",
        radial=cube(),
        positions=cube(),
        normals=cube(),
        r_min=0.1,
        r_max=1.0 / 3.0,
        multiple_hits=0.01,
        holes=1e-5,
        grazing=0.0,
        radius_error=Spread(1e-6, 2e-5, 3e-3),
        normal_error_degrees=Spread(0.1, 0.2, 0.3),
        error_points=rng.normal(size=(100, 4)).astype(np.float32),
        warnings=("One.", "Two."),
    )


def assert_equal(one: ReflectorMap, other: ReflectorMap) -> None:
    for field in fields(ReflectorMap):
        first, second = getattr(one, field.name), getattr(other, field.name)
        if isinstance(first, np.ndarray):
            assert first.dtype == second.dtype
            np.testing.assert_array_equal(first, second)
        else:
            assert type(first) is type(second) and first == second


@pytest.mark.parametrize("depth", ["16", "32"])
def test_every_bit_survives(tmp_path: Path, depth: str) -> None:
    """Whatever the scene's own output settings are."""
    scene = bpy.context.scene
    assert scene is not None
    settings = scene.render.image_settings
    settings.media_type = "IMAGE"
    settings.file_format = "OPEN_EXR"
    settings.color_depth = depth
    settings.exr_codec = "DWAA"
    images = len(bpy.data.images)
    save(a_map(), tmp_path / "new" / "folder")
    assert_equal(load(tmp_path / "new" / "folder"), a_map())
    assert len(bpy.data.images) == images


def test_a_map_without_error_points_replaces_one_with_some(tmp_path: Path) -> None:
    save(a_map(1), tmp_path)
    bare = replace(a_map(2), error_points=np.zeros((0, 4), np.float32))
    save(bare, tmp_path)
    assert_equal(load(tmp_path), bare)


def rewritten(change: Callable[[dict], object]) -> Callable[[Path], object]:
    def apply(folder: Path) -> None:
        description = json.loads((folder / DESCRIPTION).read_text(encoding="utf-8"))
        change(description)
        (folder / DESCRIPTION).write_text(json.dumps(description), encoding="utf-8")

    return apply


def cut_short(name: str) -> Callable[[Path], object]:
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:200])


DAMAGES: dict[str, Callable[[Path], object]] = {
    "no description": lambda folder: (folder / DESCRIPTION).unlink(),
    "description cut short": cut_short(DESCRIPTION),
    "description not text": lambda folder: (folder / DESCRIPTION).write_bytes(b"\xff\xfe\x00"),
    "description of something else": lambda folder: (folder / DESCRIPTION).write_text("[1, 2]"),
    "no version": rewritten(lambda d: d.pop("version")),
    "newer version": rewritten(lambda d: d.update(version=99)),
    "radius missing": rewritten(lambda d: d.pop("r_max")),
    "radius no number": rewritten(lambda d: d.update(r_max="wide")),
    "something more": rewritten(lambda d: d.update(color="red")),
    "matrix stretches": rewritten(lambda d: d.update(world_to_map=(2.0 * np.eye(4)).tolist())),
    "matrix too small": rewritten(lambda d: d.update(world_to_map=[[1.0]])),
    "resolution of another map": rewritten(lambda d: d.update(resolution=SIZE + 1)),
    "resolution zero": rewritten(lambda d: d.update(resolution=0)),
    "no radial map": lambda folder: (folder / "radial.exr").unlink(),
    "radial map cut short": cut_short("radial.exr"),
    "normals not an image": lambda folder: (folder / "normals.exr").write_text("no image"),
    "positions of another size": lambda folder: save_exr(folder / "positions.exr", np.zeros((4, 4, 4), np.float32)),
    "radial map not finite": lambda folder: save_exr(
        folder / "radial.exr", np.full((6 * SIZE, SIZE, 4), np.nan, np.float32)
    ),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_files_are_refused(damage: str, tmp_path: Path) -> None:
    save(a_map(), tmp_path)
    DAMAGES[damage](tmp_path)
    with pytest.raises(InputError) as caught:
        load(tmp_path)
    message = str(caught.value)
    assert str(tmp_path) in message and "bake" in message and "\n" not in message


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no baked reflector"):
        load(tmp_path / "nowhere")


def test_a_folder_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileExistsError):
        save(a_map(), tmp_path / "file")
