# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame of a comparison over frames: its own report, and what it keeps for the report over all of them.

A frame knows nothing of those compared before it: the state of the scene one step before is read for each anew.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ...renderer.proofs.report import extension_version
from ...report.compare import Comparison, MakeRenderer, compare_open_scene
from ...report.geometry_reference import GeometryReference
from ...report.measured_frame import Compared, MeasuredFrame
from ...scene.arrays import Float32Array, SceneArrays
from ...scene.camera.view import View
from ...scene.materials.color_spaces import scene_to_rec709
from ...scene.opened.blend_file import find_camera
from ...scene.opened.render_depsgraph import read_render_scene
from ...streams import readable
from .kept import FAILED, REFERENCE, KeptFrame, Shown, save_kept
from .motion import Motion, motion_before, offsets


@dataclass(frozen=True, slots=True)
class Before:
    """The state of the scene one step before a frame."""

    frame: int
    camera: str = ""
    scene: SceneArrays | None = None
    view: View | None = None
    reason: str = ""
    """Why it could not be read"""


def made_with(
    file: Path, scene_name: str, reflectors: Sequence[str], camera: str | None, comparison: Comparison, step: int
) -> dict[str, Any]:
    """What all frames of a comparison have in common, for JSON: frames that differ in any of it are of another one."""
    with file.open("rb") as content:
        digest = hashlib.file_digest(content, "sha256").hexdigest()
    settings = {name: value for name, value in asdict(comparison.settings).items() if name != "method"}
    return {
        "file": readable(file.name),
        "sha256": digest,
        "scene": scene_name,
        "reflectors": list(reflectors),
        "camera": camera or "",
        "resolution": [comparison.width, comparison.height],
        "samples": comparison.samples,
        "light": comparison.light,
        "methods": list(comparison.methods),
        "peers": list(comparison.peers),
        "settings": settings,
        "step": step,
        "blender": bpy.app.version_string,
        "curvrefl": extension_version(),
    }


def compare_frame(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflectors: Sequence[str],
    comparison: Comparison,
    folder: Path,
    made: dict[str, Any],
    camera: str | None = None,
    progress: Callable[[str], None] = lambda _: None,
    make_renderer: MakeRenderer | None = None,
) -> dict[str, Any]:
    """Compare the open scene at its present frame, write report and what is kept into `folder`; returns the report.

    `made`: of `made_with`. Raises as `compare_steps`.
    """
    frame = scene.frame_current
    before = read_before(scene, view_layer, reflectors, comparison, camera, frame - made["step"])
    seen_by = find_camera(scene, camera).name

    def keep(compared: Compared) -> None:
        save_kept(compared.folder, kept_of(compared, frame, seen_by, before, made))

    return compare_open_scene(
        scene,
        view_layer,
        reflectors,
        replace(comparison, is_of_frames=True),
        folder,
        scene_name=made["file"],
        camera=camera,
        progress=progress,
        make_renderer=make_renderer,
        keep=keep,
    )


def read_before(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflectors: Sequence[str],
    comparison: Comparison,
    camera: str | None,
    frame: int,
) -> Before:
    """The scene as it is at another frame; the present one is shown again at the end."""
    now = scene.frame_current, scene.frame_subframe
    size = comparison.width, comparison.height
    try:
        scene.frame_set(frame)
        arrays, view = read_render_scene(scene, view_layer, reflectors, *size, camera)
        return Before(frame, find_camera(scene, camera).name, arrays, view)
    except InputError as error:
        # (A mirror without faces then, for one: the frame itself can be compared all the same.)
        return Before(frame, reason=str(error))
    finally:
        scene.frame_set(now[0], subframe=now[1])


def kept_of(compared: Compared, frame: int, camera: str, before: Before, made: dict[str, Any]) -> KeptFrame:
    """What is kept of a comparison."""
    truth, points = compared.truth, next(iter(compared.frames.values())).points
    assert points is not None, "whoever keeps something reads the first method's points"
    nowhere = np.full(truth.mask.shape, np.nan)
    motion = Motion(np.stack([nowhere, nowhere], axis=-1), nowhere)
    if before.scene is not None and before.view is not None:
        motion = motion_before(compared.scene, points, truth, before.scene, before.view)
    pictures = {REFERENCE: compared.reference}
    pictures |= {name: measured.color for name, measured in compared.frames.items()} | dict(compared.peers)
    shown = {}
    for name, measured in compared.frames.items():
        off = offsets(compared.scene, points, measured.mask, measured.reflected_position)
        shown[name] = Shown(_objects(measured, truth), off.astype(np.float32))
    return KeptFrame(
        frame=frame,
        made=made,
        camera=camera,
        before={"frame": before.frame, "camera": before.camera, "reason": before.reason},
        objects={item.object_id: item.object_name for item in compared.scene.instances},
        pictures={name: scene_to_rec709(picture)[..., :3] for name, picture in pictures.items()},
        mask=truth.mask,
        object=np.maximum(truth.reflected_object, 0),
        distance=_distance(truth),
        place=motion.place.astype(np.float32),
        distance_before=motion.distance.astype(np.float32),
        shown=shown,
    )


def _objects(measured: MeasuredFrame, truth: GeometryReference) -> Any:
    """(h, w) of `Shown`: over Cycles' mask of the mirrors, 0 elsewhere."""
    is_number = np.isfinite(measured.color).all(axis=-1) & np.isfinite(measured.reflected_position).all(axis=-1)
    works = is_number & (measured.mask != 0)
    return np.where(truth.mask == 0, 0, np.where(works, measured.reflected_object, FAILED)).astype(np.int32)


def _distance(truth: GeometryReference) -> Float32Array:
    there = truth.reflected_position
    far = np.linalg.norm(there[..., :3] - truth.reflector_position, axis=-1)
    return np.where(truth.valid, np.where(there[..., 3] > 0.5, far, np.inf), np.nan).astype(np.float32)
