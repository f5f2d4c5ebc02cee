# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a range are those that are rendered alone, whatever changes in between; and Cycles shows the same places.

By the verb, by an animation of the engine's, which keeps its renderer from frame to frame, and by previews, which do so
too: all are the same bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.command import cli
from curvrefl.curvrefl_addon.report.geometry_reference import render_geometry
from curvrefl.curvrefl_addon.report.images import load_exr
from ranges.changing_scenes import COLORS, FRAMES, SCENES
from small_scene import SIZE, build_scene

pytestmark = pytest.mark.usefixtures("gpu")

SAMPLES = 2
NEAR = 0.02
"""Between places that mirrors show in Cycles and here, in the scene's units: half a pixel and more"""


@pytest.fixture(autouse=True)
def _extension() -> Iterator[None]:
    registration.register()
    yield
    registration.unregister()


def saved(name: str, folder: Path) -> tuple[Path, str]:
    """The file of a scene, and its mirrors."""
    build_scene()
    for change in SCENES[name]:
        change(folder)
    mirrors = [obj for obj in bpy.context.scene.objects if obj.name in ("Mirror Ball", "Second")]
    for mirror in mirrors:
        mirror.curvrefl.is_mirror = True
    scene: Any = bpy.context.scene
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.curvrefl.render_samples = SAMPLES
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    scene.render.filepath = str(folder / "animation_")
    scene.render.engine = "CURVREFL"
    path = folder / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path, ",".join(mirror.name for mirror in mirrors)


def rendered(file: Path, mirrors: str, name: str, frames: str) -> None:
    given = ["--reflector", mirrors, "--samples", str(SAMPLES), "--passes", "color,position", "--frames", frames]
    assert cli.main(["render", str(file), *given, "--output", str(file.parent / f"{name}_#.exr")]) == 0


@pytest.mark.parametrize("name", SCENES)
def test_each_frame_is_what_it_is_alone(name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file, mirrors = saved(name, tmp_path)
    for frame in FRAMES:
        rendered(file, mirrors, "alone", str(frame))
    rendered(file, mirrors, "range", "1-3")
    errors = capfd.readouterr().err
    assert ("is hidden or not in the scene in some frames" in errors) is (name == "visibility in motion"), errors
    bpy.ops.wm.open_mainfile(filepath=str(file))
    bpy.ops.render.render(animation=True)
    bpy.ops.curvrefl.save_preview(filepath=str(tmp_path / "previews_#.exr"), animation=True, samples=SAMPLES)
    alone = [load_exr(tmp_path / f"alone_{frame}.exr") for frame in FRAMES]
    assert not any(np.array_equal(one, other) for one, other in pairwise(alone))
    for frame, picture in zip(FRAMES, alone, strict=True):
        for other in (f"range_{frame}", f"animation_{frame:04d}", f"previews_{frame}"):
            assert np.array_equal(load_exr(tmp_path / f"{other}.exr"), picture), (frame, other)
        one, other = (load_exr(tmp_path / f"{way}_{frame}_position.exr") for way in ("alone", "range"))
        assert np.array_equal(one, other), frame
        if "images" in name:
            assert (picture[..., :3] == np.array(COLORS[frame - 1], np.float32)).all(axis=-1).any(), frame
    shown_in_cycles(FRAMES[-1], mirrors.split(","), load_exr(tmp_path / f"alone_{FRAMES[-1]}_position.exr"))


def shown_in_cycles(frame: int, mirrors: list[str], position: np.ndarray) -> None:
    """`position`: what mirrors show at the frame, of which an edge or two may be Cycles' otherwise."""
    scene: Any = bpy.context.scene
    scene.frame_set(frame)
    scene.render.use_motion_blur = False
    ids = {obj.name: number for number, obj in enumerate(scene.objects, 1) if obj.type == "MESH"}
    there = [ids[name] for name in mirrors if not scene.objects[name].hide_render]
    found = render_geometry(scene, bpy.context.view_layer, *SIZE, ids, there)
    valid = found.valid & (found.mask > 0)
    is_near = np.linalg.norm(found.reflected_position - position, axis=-1) < NEAR
    assert valid.sum() > 50 and is_near[valid].mean() > 0.97, is_near[valid].mean()
    assert (found.reflected_position[valid][:, 3] == 1.0).any(), "nothing is mirrored"
