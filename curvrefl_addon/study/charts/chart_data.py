# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time against error: every method at every value of the setting that trades one for the other, and the peers.

One mark is one method with one value on one scene. Pictures are judged as in `compare`, by one reference that all
marks of a scene share; vertices by the oracle (`vertex_accuracy`).
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace

import bpy

from ...errors import InputError
from ...optics.catalog import METHODS, Method
from ...renderer.renderer import Renderer
from ...renderer.settings import Settings
from ...report.compare import Comparison
from ...report.cycles_reference import Still, render_peer, render_reference
from ...report.direct_light import in_direct_light, mirrors_met
from ...report.geometry_reference import GeometryReference, render_geometry
from ...report.measured_frame import frame_geometry_error, image_error, measure_frame, measure_times
from ...report.metrics import missing_flip
from ...scene.arrays import SceneArrays
from ...scene.camera.view import View
from ...scene.opened.render_depsgraph import read_render_scene
from ..solvers.solver_table import settings_of
from ..solvers.vertex_accuracy import VertexTruth
from .chart_marks import Mark

FRAMES = 2
"""Timed in each of two rounds through all methods"""
BLURRED = "Depth of field and motion blur are left out, on all sides: methods are charted by sharp pictures."
PEER_REPEATS, PEER_SECONDS = 3, 2.0
"""A peer is timed again while it has taken less: one that needs half a minute once is timed once"""


def sweep(name: str, sub_frames: Sequence[int] = ()) -> Iterator[tuple[Settings, float, bool]]:
    """Settings, value and whether it is the default, for the values that the method's entry in the catalog names; or
    for these numbers of sub-frames, if any: in full light they are what a picture gets better by."""
    for count in sub_frames:
        yield Settings(method=name, samples=count), count, count == Settings().samples
    if sub_frames:
        return
    method = METHODS[name]
    default = default_value(method)
    for value in method.sweep[1]:
        yield settings_of(method, name, value), value, value == default


def default_value(method: Method) -> float:
    """Of the setting that is varied; where 0 stands for the method's own, that."""
    return float(getattr(Settings(), method.sweep[0])) or float(method.steps)


def step_count(comparison: Comparison, sub_frames: Sequence[int] = ()) -> int:
    """How many steps `scene_steps` has."""
    return 4 + 2 * sum(len(list(sweep(name, sub_frames))) for name in comparison.methods) + len(comparison.peers)


def scene_steps(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflector_names: Sequence[str],
    comparison: Comparison,
    scene_name: str,
    sub_frames: Sequence[int] = (),
) -> Generator[str, None, tuple[list[Mark], list[str]]]:
    """Measure the open scene at its frame through its camera; yields before each of at most `step_count` steps.

    Returns the marks and warnings, one sentence each. A method that refuses a reflector has one mark with the reason.
    Raises InputError for what is wrong with the scene itself; RenderCanceledError where the user stops a render.
    """
    yield "Reading the scene"
    arrays, view = read_render_scene(scene, view_layer, reflector_names, comparison.width, comparison.height)
    is_blurred = scene.render.use_motion_blur or view.lens is not None
    view = replace(view, lens=None)
    if comparison.light == "direct":
        arrays = in_direct_light(arrays)
    vertex_truth = VertexTruth(arrays, view)
    warnings = [*vertex_truth.warnings, *filter(None, [missing_flip(), BLURRED if is_blurred else ""])]

    try:
        marks = yield from _marks(scene, view_layer, arrays, view, comparison, scene_name, vertex_truth, sub_frames)
    finally:
        vertex_truth.free()
    return marks, warnings


def _marks(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    arrays: SceneArrays,
    view: View,
    comparison: Comparison,
    scene_name: str,
    vertex_truth: VertexTruth,
    sub_frames: Sequence[int],
) -> Generator[str, None, list[Mark]]:
    width, height = comparison.width, comparison.height
    yield "Tracing the mirrors' geometry in Cycles"
    object_ids = {instance.object_name: instance.object_id for instance in arrays.instances}
    geometry = render_geometry(scene, view_layer, width, height, object_ids, arrays.reflectors)
    if not geometry.mask.any():
        raise InputError(f"No reflector is in view of the camera of {scene_name}: turn the camera, or name others.")
    yield f"Rendering the reference in Cycles with {comparison.samples} samples"
    bounces = mirrors_met(arrays, comparison.settings.bounces)
    reference = render_reference(
        scene, view_layer, width, height, comparison.samples, comparison.light, bounces, sharp=True
    )
    yield "Looking for all reflection points of the vertices"
    vertex_truth.prepare()

    marks: list[Mark] = []
    used: dict[int, Settings] = {}
    for name in comparison.methods:
        for settings, value, is_default in sweep(name, sub_frames):
            setting = "sub-frames" if sub_frames else settings.entry.sweep[0]
            settings = replace(settings, bounces=comparison.settings.bounces)
            yield f"Rendering {name}, {setting} {value:g}"
            mark = Mark(scene_name, name, setting, value, is_default)
            try:
                mark = _measured(mark, settings, arrays, view, reference, geometry, vertex_truth)
            except InputError as error:
                marks.append(Mark(scene_name, name, reason=str(error)))
                break
            used[len(marks)] = settings
            marks.append(mark)
    # All once more, the last first: what else the machine does at one time would count against single methods.
    for index, settings in reversed(used.items()):
        mark = marks[index]
        yield f"Timing {mark.name}, {mark.setting} {mark.value:g} once more"
        marks[index] = _timed_again(mark, settings, arrays, view, vertex_truth)
    mask = geometry.mask != 0
    for peer in comparison.peers:
        yield f"Rendering the peer {peer}"
        still = render_peer(
            scene, view_layer, peer, width, height, comparison.light, PEER_REPEATS, PEER_SECONDS, bounces, True
        )
        error = image_error(still.pixels, reference.pixels, mask)
        samples = peer.removeprefix("cycles")
        engine = ("cycles", "samples", float(samples)) if samples.isdigit() else (peer, "", None)
        marks.append(
            Mark(
                scene_name,
                *engine,
                is_peer=True,
                times={"frame": still.timing},
                flip=error["flip"],
                psnr=error["psnr"],
            )
        )
    return marks


def _measured(
    mark: Mark,
    settings: Settings,
    arrays: SceneArrays,
    view: View,
    reference: Still,
    geometry: GeometryReference,
    vertex_truth: VertexTruth,
) -> Mark:
    # A renderer of its own: how finely edges are split depends on what was asked for before.
    frame = measure_frame(Renderer(arrays, settings), view, FRAMES)
    image = image_error(frame.color, reference.pixels, geometry.mask != 0)
    shown = frame_geometry_error(frame, geometry)
    angle = shown["angle_deg"]
    solves = settings.entry.solves_vertices
    return Mark(
        mark.scene,
        mark.name,
        mark.setting,
        mark.value,
        mark.is_default,
        times=frame.times,
        flip=image["flip"],
        psnr=image["psnr"],
        angle_deg=(angle["median"], angle["p95"], angle["p99"]),
        wrong_object=shown["wrong_object"],
        vertices=vertex_truth.measure(settings) if solves else None,
    )


def _timed_again(mark: Mark, settings: Settings, arrays: SceneArrays, view: View, vertex_truth: VertexTruth) -> Mark:
    more = measure_times(Renderer(arrays, settings), view, FRAMES)
    return replace(
        mark,
        times={name: timing.joined(more[name]) for name, timing in mark.times.items()},
        vertices=None if mark.vertices is None else vertex_truth.time_again(mark.vertices, settings),
    )
