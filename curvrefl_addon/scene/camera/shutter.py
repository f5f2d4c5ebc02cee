# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shutter: at which moments the sub-frames of a picture with motion blur show the scene, and the scene then."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import floor
from operator import is_
from typing import Any

import bpy
import numpy as np

from ..arrays import Float64Array, InstanceArrays, SceneArrays
from ..changes import Changes
from .sampling import scattered_strata
from .view import View

_STARTS = {"START": 0.0, "CENTER": -0.5, "END": -1.0}
_CURVE_STEPS = 256


@dataclass(frozen=True, slots=True)
class Moment:
    """What a sub-frame shows in place of what the frame itself does."""

    scene: SceneArrays
    view: View


type ReadMoment = Callable[[Changes], tuple[SceneArrays, View]]
"""What is there at the present time, of which only these changes are looked at"""


def shutter_times(scene: bpy.types.Scene, samples: int) -> Float64Array:
    """(samples,) frames after the present one at which sub-frames see the scene; each stands for as much light."""
    render = scene.render
    strata = scattered_strata(samples)
    curve = render.motion_blur_shutter_curve
    curve.initialize()
    places = np.linspace(0.0, 1.0, _CURVE_STEPS + 1)
    openness = np.array([max(curve.evaluate(curve.curves[0], place), 0.0) for place in places])
    let_in = np.concatenate([[0.0], np.cumsum(0.5 * (openness[1:] + openness[:-1]))])
    open_at = np.interp(strata, let_in / let_in[-1], places) if let_in[-1] > 0.0 else strata
    return render.motion_blur_shutter * (open_at + _STARTS[render.motion_blur_position])


def read_moments(
    scene: bpy.types.Scene,
    still: Moment,
    samples: int,
    read: ReadMoment,
    go_to: Callable[[int, float], None] | None = None,
    now: float | None = None,
) -> tuple[tuple[Moment, ...], tuple[str, ...]]:
    """What each of `samples` sub-frames shows of the scene, and what of it is not as in Cycles, one sentence each.

    No moments where the file has no motion blur or nothing moves. `still`: at the present frame. `go_to(frame,
    subframe)` shows the scene at another time, by `Scene.frame_set` if not given; the present one, `now` where that is
    not the scene's own, is shown again at the end. As in Cycles lamps, world and materials stay as at the frame, and so
    does what is there, whatever is shown or hidden meanwhile.
    """
    if not scene.render.use_motion_blur:
        return (), ()
    if samples == 1:
        return (), ("Motion blur is left out: it takes more than one sample.",)
    read_there = moments_at(scene, shutter_times(scene, samples), read, go_to, now)
    lights, world = still.scene.lights, still.scene.world
    found = tuple(
        Moment(_with_the_same(still.scene, replace(one.scene, lights=lights, world=world)), one.view)
        for one in read_there
    )
    if all(_is_same(moment, still) for moment in found):
        return (), ()
    return found, tuple(_untold(scene, still, found))


def moments_at(
    scene: bpy.types.Scene,
    times: Sequence[float] | Float64Array,
    read: ReadMoment,
    go_to: Callable[[int, float], None] | None = None,
    now: float | None = None,
) -> list[Moment]:
    """Places and shapes so many frames after the present one, which is shown again at the end. `go_to`, `now`: as for
    `read_moments`."""
    now = scene.frame_current + scene.frame_subframe if now is None else now
    go_to = go_to or (lambda frame, subframe: scene.frame_set(frame, subframe=subframe))
    moments: dict[int, Moment] = {}
    try:
        for index in np.argsort(times).tolist():
            frame = floor(now + times[index])
            go_to(frame, float(now + times[index] - frame))
            moments[index] = Moment(*read(_all_that_moves()))
    finally:
        go_to(floor(now), float(now - floor(now)))
    return [moments[index] for index in range(len(times))]


def _all_that_moves() -> Changes:
    """Places and shapes of all objects, but not what they are made of."""
    data: Any = bpy.data
    blocks = (data.objects, data.meshes, data.curves, data.metaballs)
    return Changes(instances=True, geometry={block.session_uid for group in blocks for block in group})


def _with_the_same(still: SceneArrays, moment: SceneArrays) -> SceneArrays:
    """The moment with the instances of the frame, those that are not there then as at the frame."""
    wanted, there = _numbered(still.instances), _numbered(moment.instances)
    if wanted.keys() == there.keys():
        return moment
    instances, meshes = [], [*moment.meshes]
    for key, instance in wanted.items():
        found = there.get(key)
        if found is None:
            found = replace(instance, mesh=len(meshes))
            meshes.append(still.meshes[instance.mesh])
        instances.append(found)
    return replace(
        moment,
        instances=tuple(instances),
        meshes=tuple(meshes),
        materials=still.materials,
        images=still.images,
        reflectors=still.reflectors,
    )


def _numbered(instances: Sequence[InstanceArrays]) -> dict[tuple[int, int], InstanceArrays]:
    """By object, and which of its instances it is."""
    counts: Counter[int] = Counter()
    found = {}
    for instance in instances:
        found[instance.object_id, counts[instance.object_id]] = instance
        counts[instance.object_id] += 1
    return found


def _is_same(one: Moment, other: Moment) -> bool:
    return (
        len(one.scene.instances) == len(other.scene.instances)
        and all(map(is_, one.scene.instances, other.scene.instances))
        and [mesh.signature for mesh in one.scene.meshes] == [mesh.signature for mesh in other.scene.meshes]
        and np.array_equal(one.view.world_to_clip, other.view.world_to_clip)
        and one.view.lens == other.view.lens
    )


def _untold(scene: bpy.types.Scene, still: Moment, found: tuple[Moment, ...]) -> list[str]:
    """What moves otherwise than in Cycles."""
    moving = {
        there.object_name
        for moment in found
        for here, there in zip(still.scene.instances, moment.scene.instances, strict=False)
        if here is not there
    }
    cycles: Any = getattr(scene, "cycles", None)
    sentences = [
        f'"{name}" is blurred by its motion, though its Motion Blur is off.'
        for name in sorted(moving)
        if name in scene.objects and not getattr(scene.objects[name], "cycles", cycles).use_motion_blur
    ]
    if cycles is not None and cycles.rolling_shutter_type != "NONE":
        sentences.append("The rolling shutter is left out: all rows of the picture are exposed at once.")
    return sentences
