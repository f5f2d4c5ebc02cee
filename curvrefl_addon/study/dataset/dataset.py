# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the data set: for each scene the .blend file, a description, meshes, references of what the mirrors show in
float64, and a picture by Cycles.

What is there and whole is not made again; a scene is there whole or as it was.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...errors import InputError
from ...output import folder_to_publish, write_whole
from ...renderer.truth.truth import MirrorTruth
from ...report.cycles_reference import render_reference
from ...report.images import save_exr
from ...scene.arrays import Float32Array, SceneArrays
from ...scene.camera.view import View
from ...scene.extract import SceneReader
from ...scene.opened.blend_file import open_blend
from ...scene.opened.render_depsgraph import read_render_scene
from .exr_layers import save_layers
from .files import REPORT, VERSION, description, mesh_file, sums_of, whole_report, write_ply
from .float64_rays import Float64Rays
from .scenes import SCENES, Entry

BLEND, DESCRIPTION, PASSES, CYCLES = "scene.blend", "scene.json", "passes.exr", "cycles.exr"
INDEX = "dataset.json"
LAYER = "ViewLayer"
EXACT = (DESCRIPTION, PASSES)
"""The same bytes again on the same machine, as meshes; Cycles' picture and the .blend file are not"""


@dataclass(frozen=True, slots=True)
class Size:
    """What pictures are made of."""

    width: int = 640
    height: int = 480
    samples: int = 1024
    """Of Cycles"""


def chosen_scenes(names: Sequence[str]) -> dict[str, Entry]:
    """Those of these names, or all. Raises InputError for one that there is not."""
    for name in names:
        if name not in SCENES:
            raise InputError(f'There is no scene "{name}" in the data set: choose from {", ".join(SCENES)}.')
    return {name: SCENES[name] for name in SCENES if not names or name in names}


def make_dataset(names: Sequence[str], size: Size, folder: Path, say: Callable[[str], None]) -> list[str]:
    """Make these scenes, or all, each in a folder of its name, and the index of all that are there; returns which were
    made. Raises InputError for unknown names and for what cannot be written."""
    made = []
    for name, entry in chosen_scenes(names).items():
        report = whole_report(folder / name)
        if report is not None and report["made"] == _made(size):
            say(f"{name}: is there")
            continue
        _make_scene(name, entry, size, folder / name, lambda text, name=name: say(f"{name}: {text}"))
        made.append(name)
    found = {name: whole_report(folder / name) for name in SCENES}
    index = {
        "dataset": "curvrefl",
        "version": VERSION,
        "scenes": {name: {"text": SCENES[name].text, **report} for name, report in found.items() if report is not None},
    }
    write_whole(folder / INDEX, json.dumps(index, indent=1) + "\n")
    return made


def references(scene: SceneArrays, view: View, say: Callable[[str], None]) -> dict[str, Float32Array]:
    """Channels (h, w) by name of what the mirrors show by rays in float64, row 0 at the bottom; 0 where no mirror is
    seen."""
    truth = MirrorTruth(scene, Float64Rays(scene).points(view, say))
    points = truth.points
    numbers = np.array([0, *(item.object_id for item in scene.instances)], np.float64)
    pictures = {
        "Position.XYZW": truth.picture(points.shown),
        "Mirror Position.XYZ": truth.picture(points.seen),
        "Mirror Normal.XYZ": truth.picture(points.facing),
        "Object.X": truth.picture(numbers[points.instance + 1]),
        "Mirror ID.X": truth.mirror_id(),
        "Normal.XYZ": truth.normal(),
        "UV.UVA": truth.uv(),
        "Depth.Z": truth.depth(),
        "Distance.X": truth.distance(),
        "Path Length.X": truth.path_length(),
        "Incidence.X": truth.incidence(),
    }
    channels = {}
    for title, picture in pictures.items():
        name, _, letters = title.partition(".")
        parts = picture[..., None] if picture.ndim == 2 else picture
        for number, letter in enumerate(letters):
            channels[f"{LAYER}.{name}.{letter}"] = np.ascontiguousarray(parts[..., number])
    return channels


def _make_scene(name: str, entry: Entry, size: Size, folder: Path, say: Callable[[str], None]) -> None:
    with folder_to_publish(folder) as part:
        say("building")
        path = part / BLEND
        entry.build(path)
        if not path.is_file():
            bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, check_existing=False)
        # (As anybody else would find it.)
        open_blend(path)
        scene, view_layer = bpy.context.scene, bpy.context.view_layer
        assert scene is not None and view_layer is not None, "an open file has a scene"
        reader = SceneReader()
        reader.reads_uv = True
        arrays, view = read_render_scene(scene, view_layer, entry.mirrors, size.width, size.height, reader=reader)
        for number in sorted({item.mesh for item in arrays.instances}):
            write_ply(part / mesh_file(number), arrays.meshes[number])
        channels = references(arrays, view, say)
        names = json.dumps({item.object_id: item.object_name for item in arrays.instances})
        save_layers(part / PASSES, channels, {f"curvrefl.{LAYER}.objects": names})
        say(f"Cycles, {size.samples} samples")
        still = render_reference(scene, view_layer, size.width, size.height, size.samples, "full", sharp=True)
        save_exr(part / CYCLES, still.pixels)
        rendered = {"samples": size.samples, "version": bpy.app.version_string, "light": "full", "device": "CPU"}
        formulas = {mirror: entry.surface for mirror in entry.mirrors}
        told = description(name, entry.text, arrays, view, formulas, rendered)
        (part / DESCRIPTION).write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
        report: dict[str, Any] = {"made": _made(size), "mirrors": list(entry.mirrors), "sha256": sums_of(part)}
        (part / REPORT).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def _made(size: Size) -> dict[str, Any]:
    """What makes one scene another one."""
    return {"version": VERSION, "width": size.width, "height": size.height, "samples": size.samples}
