# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror whose pixels follow their own reflected rays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from ...scene.arrays import Float32Array
from ..device.textures import read_texture
from ..rays.paths import IN_THE_OPEN, Bounce, Enclosing
from ..rays.ray_instances import OWN_RANGE
from ..settings import Settings
from ..shading.features import RayShadows
from ..surfaces.canvas import Canvas
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.windows import union
from ..tracing.tracer import PathTracer
from .shown import Light, Shown, SubFrame, chosen_mirrors


@dataclass(frozen=True)
class ShownRays(Shown):
    """Rays, from mirror to mirror."""

    @classmethod
    def draw(cls, members: Sequence[Self], sub_frame: SubFrame, of_positions: bool = False) -> SurfaceBuffer:
        return next(_bounces(members, sub_frame, 1)).path

    @classmethod
    def add_light(cls, members: Sequence[Self], sub_frame: SubFrame, light: Light) -> None:
        stage = sub_frame.stage
        if stage.tracer is not None and light.calm is None:
            _trace(stage.tracer, members, sub_frame, light)
            return
        most = _most_bounces(members, sub_frame)
        at_once = most > 1 and light.calm is None and sub_frame.gathers is None and _go_on_at_once(members, sub_frame)
        most_hits = most if at_once else 1
        bounces = _bounces(members, sub_frame, 1 if at_once else most, chosen=light.chosen, most_hits=most_hits)
        first = next(bounces)
        seen, uniforms = sub_frame.targets.seen, sub_frame.uniforms
        calm = None if light.calm is None else sub_frame.targets.calm_mirrors()
        if calm is not None:
            calm.begin(seen, first.path, stage.materials, uniforms, first.window)
        stage.shade.add(
            light.canvas,
            seen,
            first.path,
            uniforms,
            light.weight,
            sub_frame.window,
            later=bounces if first.goes_on else None,
            shadows=_shadows(members, sub_frame),
            chosen=light.chosen,
            with_others=light.with_others,
            film_transparent=light.film_transparent,
            shown_apart=None if calm is None else calm.sharp,
            gathers=sub_frame.gathers if calm is None else None,
            most_hits=most_hits,
        )
        if calm is not None:
            history = light.calm if sub_frame.index == 0 else None
            calm.add(light.canvas, light.weight, seen, stage.materials, sub_frame.view, uniforms, first.window, history)

    @classmethod
    def read_back(cls, members: Sequence[Self], sub_frame: SubFrame) -> dict[str, Float32Array]:
        path = next(_bounces(members, sub_frame, 1, keeps_ways=True)).path
        color = read_texture(path.color)
        color[..., 3] = read_texture(path.direction)[..., 3]
        return {"reflected_position": read_texture(path.position), "reflected_color": color}


def read_ways(members: Sequence[ShownRays], sub_frame: SubFrame) -> dict[str, Any]:
    """Where the rays off the mirrors get to through the pixels' centers.

    Of mirrors' pixels alone, elsewhere undefined: `seen_position`, `seen_normal`, `seen_color`, and `shown_position`,
    `shown_normal`, `shown_color` of the first surface that is met, (h, w, 4) as `SurfaceBuffer` and `PathBuffer` have
    them; `hit` (h, w, 4), the index of its instance in the scene, of the triangle in its mesh, and the weights of the
    second and third corner, float64; `way` (h, w), meters from the mirror over all further mirrors that are followed to
    the first surface that is none, float64, infinite where that is the background.
    """
    seen = sub_frame.targets.seen
    found: dict[str, Any] = {
        f"seen_{name}": read_texture(getattr(seen, name)) for name in ("position", "normal", "color")
    }
    numbers = [shown.mirror.number for shown in members]
    goes_on = np.isin(np.rint(found["seen_color"][..., 3]), numbers)
    place = found["seen_position"][..., :3].astype(np.float64)
    way = np.zeros(goes_on.shape)
    most = _most_bounces(members, sub_frame)
    for bounce in _bounces(members, sub_frame, most, keeps_ways=True, keeps_hits=True):
        position, color = read_texture(bounce.path.position), read_texture(bounce.path.color)
        if "hit" not in found:
            found |= {"shown_position": position, "shown_color": color}
            found["shown_normal"] = read_texture(bounce.path.normal)
            found["hit"] = np.zeros((*goes_on.shape, 4))
            is_met = goes_on & (position[..., 3] > 0.5)
            packed = read_texture(bounce.path.hits)[is_met]
            found["hit"][is_met] = np.column_stack([*sub_frame.stage.rays().known(packed), packed[:, 2:]])
        is_met = goes_on & (position[..., 3] > 0.5)
        way[goes_on & ~is_met] = np.inf
        way[is_met] += np.linalg.norm(position[is_met][:, :3] - place[is_met], axis=1)
        place[is_met] = position[is_met][:, :3]
        goes_on = is_met & (color[..., 3] > 0.5)
        if not goes_on.any():
            break
    found["way"] = way
    return found


def steps(members: Sequence[ShownRays], sub_frame: SubFrame) -> Iterator[Bounce]:
    """What sharp rays off the mirrors that the eye sees hit, then rays off the mirrors among that, and so on, as far as
    mirrors are followed; each is drawn when it is asked for."""
    yield from _bounces(members, sub_frame, _most_bounces(members, sub_frame))


def _trace(tracer: PathTracer, members: Sequence[ShownRays], sub_frame: SubFrame, light: Light) -> None:
    """By paths: first what stops the light, then one sample of what does not."""
    stage, seen = sub_frame.stage, sub_frame.targets.seen
    mirrors_only = sub_frame.window is not None or not light.with_others
    shadows = _shadows(members, sub_frame)
    if not mirrors_only:
        stage.shade.add(
            light.canvas,
            seen,
            None,
            sub_frame.uniforms,
            light.weight,
            shadows=shadows,
            chosen=chosen_mirrors([], len(stage.mirrors)),
            film_transparent=light.film_transparent,
            gathers=sub_frame.gathers,
        )
    sees_through = tracer.sees_through and not mirrors_only
    window = sub_frame.window if sees_through else union([shown.mirror.window(sub_frame.view) for shown in members])
    tracer.add(
        light.canvas,
        light.weight,
        seen,
        stage.rays(),
        sub_frame.uniforms,
        window,
        sub_frame.index,
        members[0].settings.bounces,
        light.chosen,
        sees_through,
        _may_meet_another(members, sub_frame),
        shadows,
        light.film_transparent,
        sub_frame.gathers,
    )


def trace_seen_through(
    tracer: PathTracer, sub_frame: SubFrame, canvas: Canvas, weight: float, settings: Settings
) -> None:
    """Where mirrors do not follow rays: what the eye sees of surfaces that do not stop the light."""
    tracer.add(
        canvas,
        weight,
        sub_frame.targets.seen,
        sub_frame.stage.rays(),
        sub_frame.uniforms,
        None,
        sub_frame.index,
        settings.bounces,
        chosen_mirrors([], len(sub_frame.stage.mirrors)),
        shadows=sub_frame.shadows,
        film_transparent=settings.film_transparent,
        gathers=sub_frame.gathers,
    )


def _shadows(members: Sequence[ShownRays], sub_frame: SubFrame) -> RayShadows | None:
    """Of lamps also where they are asked for."""
    if not members[0].settings.shadow_rays:
        return sub_frame.shadows
    if sub_frame.shadows is not None:
        return replace(sub_frame.shadows, of_lamps=True)
    return RayShadows(sub_frame.stage.rays(), of_lamps=True, of_world=False, everywhere=False)


def _most_bounces(members: Sequence[ShownRays], sub_frame: SubFrame) -> int:
    """Mirrors that a ray can meet one after the other."""
    # (One more than are followed shows what shines by itself.)
    return _followed(members, sub_frame) + 1 if _may_meet_another(members, sub_frame) else 1


def _may_meet_another(members: Sequence[ShownRays], sub_frame: SubFrame) -> bool:
    """Whether a ray off a mirror may meet one."""
    mirrors = sub_frame.stage.mirrors
    return (
        len(mirrors) > 1
        or any(not mirror.facts.never_sees_itself for mirror in mirrors)
        or _enclosing(members, sub_frame) != IN_THE_OPEN
    )


def _go_on_at_once(members: Sequence[ShownRays], sub_frame: SubFrame) -> bool:
    """Whether rays off mirrors need no pass for each mirror that they meet."""
    if _enclosing(members, sub_frame) != IN_THE_OPEN:
        return False
    stage = sub_frame.stage
    corners = stage.geometry.box_corners([mirror.index for mirror in stage.mirrors])
    return stage.shade.lights_ends_alone(corners.min(axis=(0, 1)), corners.max(axis=(0, 1)))


def _followed(members: Sequence[ShownRays], sub_frame: SubFrame) -> int:
    """Mirrors one after the other that show what they reflect, as far as the file goes."""
    return min(members[0].settings.bounces, sub_frame.stage.shade.mirror_bounces)


def _enclosing(members: Sequence[ShownRays], sub_frame: SubFrame) -> Enclosing:
    """The mirror that holds the eye; of several, one in the other, the smallest, which hides the others."""
    shapes = [(shown.mirror, shown.mirror.shape()) for shown in members]
    holding = [(shape.bound, mirror.number) for mirror, shape in shapes if mirror.holds_eye(sub_frame.view, shape)]
    if not holding:
        return IN_THE_OPEN
    bound, number = min(holding)
    return (float(number), 2.0 * OWN_RANGE * bound)


def _bounces(
    members: Sequence[ShownRays],
    sub_frame: SubFrame,
    most: int,
    keeps_ways: bool = False,
    chosen: Any = None,
    most_hits: int = 1,
    keeps_hits: bool = False,
) -> Iterator[Bounce]:
    """What rays off the mirrors that the eye sees hit, then rays off the mirrors among that, and so on.

    Each is drawn when it is asked for, into buffers that the next but one uses again. With `keeps_ways` the buffers
    tell all they can, also of the last step. `chosen`: see `Light`; `most_hits`: as for `PathBuffer.follow`, where
    there is one bounce, as `keeps_hits`.
    """
    stage, targets, view = sub_frame.stage, sub_frame.targets, sub_frame.view
    seen: SurfaceBuffer = targets.seen
    enclosing = _enclosing(members, sub_frame)
    window = union([shown.mirror.window(view) for shown in members])
    for number in range(most):
        path = targets.path(number)
        goes_on = number + 1 < most
        path.follow(
            seen,
            stage.rays(),
            stage.materials,
            sub_frame.uniforms,
            window,
            enclosing,
            goes_on or keeps_ways,
            chosen=chosen if number == 0 else None,
            turn=(sub_frame.index, number + 1),
            most_hits=most_hits,
            keeps_hits=keeps_hits,
        )
        yield Bounce(seen, path, window, goes_on, number >= _followed(members, sub_frame))
        seen = path
