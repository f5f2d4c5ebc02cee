# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Methods against Cycles and against Blender's fast engines, on one view of one scene.

Writes `report.json`, `report.html`, `reference.png`, METHOD.png, METHOD_error.png and PEER.png into a folder.
Pictures are as the file shows them (`as_shown`); errors are between scene-linear pictures through the Standard view.
They are moved there at the end: a comparison that fails leaves nothing.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import bpy

from ..errors import InputError
from ..optics.catalog import DEFAULT_COMPARED, METHODS
from ..output import checked_folder, folder_to_publish
from ..renderer.device.context import renderer_name
from ..renderer.renderer import Renderer
from ..renderer.settings import Settings, check_settings
from ..scene.arrays import SceneArrays
from ..scene.camera.film import on_film
from ..scene.camera.shutter import Moment
from ..scene.camera.view import View
from ..scene.materials.color_spaces import scene_to_rec709
from ..scene.opened.blend_file import camera_in_use, open_blend
from ..scene.opened.render_depsgraph import read_render_moments
from ..settings_table import LARGEST_SIDE, MOST_REFERENCE_SAMPLES, STILL_SAMPLES
from ..streams import readable
from .as_shown import save_as_shown
from .cycles_reference import LIGHTS, PEERS, render_peer, render_reference
from .direct_light import in_direct_light, mirrors_met
from .display import inverse_display_transform
from .geometry_reference import render_geometry
from .html import report_page
from .images import save_png
from .measured_frame import (
    Compared,
    Keep,
    MeasuredFrame,
    RendererLike,
    frame_geometry_error,
    image_error,
    measure_frame,
)
from .metrics import error_map, mask_mismatch, missing_flip

DEFAULT_PEERS = ("eevee", "cycles1", "cycles8")

type Progress = Callable[[str], None]

type MakeRenderer = Callable[[SceneArrays, str], RendererLike]
"""From a scene and the name of a method"""


@dataclass(frozen=True, slots=True)
class Comparison:
    """What to compare, checked: raises InputError for values out of range and unknown names."""

    methods: tuple[str, ...] = DEFAULT_COMPARED
    width: int = 640
    height: int = 480
    samples: int = 256
    light: str = "full"
    peers: tuple[str, ...] = DEFAULT_PEERS
    settings: Settings = field(default_factory=Settings)
    """Of our pictures; each method takes the place of theirs"""
    is_of_frames: bool = False
    """One of several: the noise of peers is another one in each frame, as in films"""

    def __post_init__(self) -> None:
        if not (1 <= self.width <= LARGEST_SIDE and 1 <= self.height <= LARGEST_SIDE):
            raise InputError(
                f"A resolution of {self.width}x{self.height} is out of range: choose 1 to {LARGEST_SIDE} pixels a side."
            )
        if not 1 <= self.samples <= MOST_REFERENCE_SAMPLES:
            raise InputError(f"{self.samples} samples are out of range: choose 1 to {MOST_REFERENCE_SAMPLES}.")
        check_settings(self.settings)
        if self.light not in LIGHTS:
            raise InputError(f"Unknown light '{self.light}': choose from {', '.join(LIGHTS)}.")
        if not self.methods:
            raise InputError(f"No method to compare: choose from {', '.join(METHODS)}.")
        for names, known, what in ((self.methods, METHODS, "method"), (self.peers, PEERS, "peer")):
            for name in names:
                if name not in known:
                    raise InputError(f"Unknown {what} '{name}': choose from {', '.join(known)}.")


def new_renderer(comparison: Comparison) -> MakeRenderer:
    """Makes the extension's renderers, with the comparison's settings."""
    settings = comparison.settings
    return lambda scene, method: Renderer(scene, replace(settings, method=method))


def compare_blend(
    path: Path | str,
    reflector_names: Sequence[str],
    methods: Sequence[str],
    width: int,
    height: int,
    samples: int,
    light: str,
    peers: Sequence[str],
    output: Path | str,
    camera: str | None = None,
    frame: int | None = None,
    progress: Progress | None = None,
    make_renderer: MakeRenderer | None = None,
) -> dict[str, Any]:
    """Open the .blend file at `path` and compare its picture; see `compare_open_scene`."""
    comparison = Comparison(tuple(dict.fromkeys(methods)), width, height, samples, light, tuple(dict.fromkeys(peers)))
    output = checked_folder(output)
    open_blend(Path(path))
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and view_layer is not None
    if frame is not None:
        scene.frame_set(frame)
    return compare_open_scene(
        scene,
        view_layer,
        reflector_names,
        comparison,
        output,
        scene_name=Path(path).name,
        camera=camera,
        progress=progress or (lambda _: None),
        make_renderer=make_renderer,
    )


def compare_open_scene(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflector_names: Sequence[str],
    comparison: Comparison,
    output: Path | str,
    scene_name: str | None = None,
    camera: str | None = None,
    progress: Progress = lambda _: None,
    make_renderer: MakeRenderer | None = None,
    keep: Keep | None = None,
) -> dict[str, Any]:
    """Take all of `compare_steps` and return the report; `progress` is told of each step."""
    steps = compare_steps(
        scene, view_layer, reflector_names, comparison, output, scene_name, camera, make_renderer, keep
    )
    while True:
        try:
            progress(next(steps).label)
        except StopIteration as end:
            return end.value


@dataclass(frozen=True, slots=True)
class Step:
    """What a comparison does next."""

    label: str
    done: float
    """Share of all steps that is done, 0..1"""


def compare_steps(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflector_names: Sequence[str],
    comparison: Comparison,
    output: Path | str,
    scene_name: str | None = None,
    camera: str | None = None,
    make_renderer: MakeRenderer | None = None,
    keep: Keep | None = None,
) -> Generator[Step, None, dict[str, Any]]:
    """Compare the open scene at its current frame and write the report into the folder `output`; returns the report.

    Yields before each step; closed between two of them it leaves no report, and the scene as it was, as it also does
    at its end. A number that has no pixels to come from is None, and so is the PSNR of equal pictures. A method that
    cannot show these reflectors is left out, with a warning, while another one can. `warnings` is in the report only
    where there are any. Image errors are over Cycles' mask of the mirrors. `keep` is called before the report is
    written.

    Raises InputError for what the user can change: see `Comparison`, the scene's own conditions (camera,
    reflectors), an output folder that cannot be written; RenderCanceledError where the user stops a render.
    """
    output = checked_folder(output)
    settings = replace(comparison.settings, film_transparent=scene.render.film_transparent)
    # A blur of few sub-frames would be as many ghosts.
    blur_samples = max(settings.samples, STILL_SAMPLES)
    count = 4 + len(comparison.methods) + len(comparison.peers) + (keep is not None)
    with camera_in_use(scene, camera):
        yield Step("Reading the scene", 0.0)
        start = time.perf_counter()
        still, moments, untold = read_render_moments(
            scene,
            view_layer,
            reflector_names,
            comparison.width,
            comparison.height,
            blur_samples,
            camera,
        )
        extract_ms = 1e3 * (time.perf_counter() - start)
        if (moments or still.view.lens is not None) and settings.samples < blur_samples:
            settings = replace(settings, samples=blur_samples)
            untold = (*untold, f"Depth of field and motion blur take {blur_samples} sub-frames here, and their time.")
        comparison = replace(comparison, settings=settings)
        arrays = replace(still.scene, warnings=(*still.scene.warnings, *untold))
        if comparison.light == "direct":
            arrays = in_direct_light(arrays)
            moments = tuple(replace(moment, scene=in_direct_light(moment.scene)) for moment in moments)
        with folder_to_publish(output) as folder:
            run = _run(
                scene,
                view_layer,
                arrays,
                still.view,
                moments,
                comparison,
                extract_ms,
                folder,
                make_renderer or new_renderer(comparison),
                keep,
            )
            done = 1
            while True:
                try:
                    label = next(run)
                except StopIteration as end:
                    report, mismatch = end.value
                    break
                yield Step(label, done / count)
                done += 1
            report = {
                "scene": scene_name or readable(Path(bpy.data.filepath).name) or scene.name,
                "reflectors": list(reflector_names),
                **report,
            }
            text = json.dumps(report, indent=1, allow_nan=False)
            (folder / "report.html").write_text(report_page(report, mismatch), encoding="utf-8")
            (folder / "report.json").write_text(text + "\n", encoding="utf-8")
    yield Step("Wrote report.html", 1.0)
    return report


def _run(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    arrays: SceneArrays,
    view: View,
    moments: Sequence[Moment],
    comparison: Comparison,
    extract_ms: float,
    folder: Path,
    make_renderer: MakeRenderer,
    keep: Keep | None,
) -> Generator[str, None, tuple[dict[str, Any], dict[str, float | None]]]:
    """All numbers of the report but its names, and per method the mismatch of masks; pictures go into `folder`.

    Yields what comes next.
    """
    width, height = comparison.width, comparison.height
    frames: dict[str, MeasuredFrame] = {}
    refused: dict[str, str] = {}
    for method in comparison.methods:
        # Ours come first: what is wrong with a reflector shows before minutes of Cycles.
        yield f"Rendering {method}"
        try:
            renderer, reads_points = make_renderer(arrays, method), keep is not None and not frames
            frames[method] = measure_frame(renderer, view, moments=moments, reads_points=reads_points)
        except InputError as error:
            refused[method] = str(error)
    if not frames:
        raise InputError(next(iter(refused.values())))

    yield "Tracing the mirrors' geometry in Cycles"
    object_ids = {instance.object_name: instance.object_id for instance in arrays.instances}
    truth = render_geometry(scene, view_layer, width, height, object_ids, arrays.reflectors)
    mask = truth.mask != 0
    yield f"Rendering the reference in Cycles with {comparison.samples} samples"
    bounces = mirrors_met(arrays, comparison.settings.bounces)
    reference = render_reference(scene, view_layer, width, height, comparison.samples, comparison.light, bounces)
    save_as_shown(folder / "reference.png", on_film(reference.pixels, scene), scene)

    methods, mismatch = {}, {}
    warnings = [f"Without {method}: {reason}" for method, reason in refused.items()]
    warnings += dict.fromkeys(warning for frame in frames.values() for warning in frame.warnings)
    if not mask.any():
        warnings.append("No reflector is in view: there are no mirror pixels to compare.")
    if missing := missing_flip():
        warnings.append(missing)
    for method, frame in frames.items():
        save_as_shown(folder / f"{method}.png", on_film(frame.color, scene), scene)
        found, right = scene_to_rec709(frame.color), scene_to_rec709(reference.pixels)
        difference = inverse_display_transform(error_map(found, right))
        save_png(folder / f"{method}_error.png", difference)
        known: dict[str, Any] = {
            "image": image_error(frame.color, reference.pixels, mask),
            "geometry": frame_geometry_error(frame, truth),
            "time_ms": {"extract": extract_ms, **frame.times_ms},
            "solve": frame.solve,
        }
        told = {"choice": frame.choice, "bounced_light": frame.bounced_light}
        known |= {name: value for name, value in told.items() if value}
        if frame.convergence is not None:
            known |= {"sub_frames": frame.convergence.done, "noise": frame.convergence.noise}
        methods[method] = known
        mismatch[method] = mask_mismatch(frame.mask, truth.mask)

    peers, pictures = {}, {}
    for peer in comparison.peers:
        yield f"Rendering the peer {peer}"
        is_animated = comparison.is_of_frames
        still = render_peer(
            scene, view_layer, peer, width, height, comparison.light, bounces=bounces, is_animated=is_animated
        )
        pictures[peer] = still.pixels
        # (EEVEE's film has no exposure.)
        save_as_shown(folder / f"{peer}.png", still.pixels if peer == "eevee" else on_film(still.pixels, scene), scene)
        peers[peer] = {
            "image": image_error(still.pixels, reference.pixels, mask),
            "time_ms": 1e3 * still.seconds,
        }

    if keep is not None:
        yield "Keeping what frames are compared by"
        keep(Compared(arrays, view, truth, reference.pixels, frames, pictures, folder))
    report: dict[str, Any] = {
        "resolution": [width, height],
        "blender": ".".join(str(part) for part in bpy.app.version),
        "gpu": renderer_name(),
        "reference": {
            "engine": "CYCLES",
            "samples": comparison.samples,
            "light": comparison.light,
            "time_s": reference.seconds,
        },
        "mask_pixels": int(mask.sum()),
        "methods": methods,
        "peers": peers,
    }
    if warnings:
        report["warnings"] = warnings
    return report, mismatch
