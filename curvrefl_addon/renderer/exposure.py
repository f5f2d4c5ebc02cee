# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sub-frames that look from elsewhere than the frame does: through a place on the lens, at a moment of the shutter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ..scene.camera.sampling import is_progressive
from ..scene.camera.shutter import Moment
from .noise import Convergence, NoiseMeter
from .reflection import Reflection
from .reuse.earlier import with_earlier
from .reuse.kept_frame import KeptFrame, keep_frame
from .shown.rays import ShownRays
from .shown.shown import SubFrame
from .surfaces.canvas import Canvas

if TYPE_CHECKING:
    from .frame import Frame
    from .renderer import Renderer


@dataclass(frozen=True, slots=True)
class Turn:
    """Which of the settings' sub-frames a frame has, where it and the frames before it have them all together."""

    number: int
    """Of the frame; `count` of them one after the other have other sub-frames each"""
    count: int

    def sub_frames(self, samples: int) -> range:
        """As many in each turn, as evenly spread as all."""
        turn, each = self.number % self.count, samples // self.count
        if is_progressive(samples):
            return range(turn * each, (turn + 1) * each)
        return range(turn, each * self.count, self.count)


ALL = Turn(0, 1)
"""Every frame has all"""


def through_lens(renderer: Renderer, reflection: Reflection, index: int) -> Reflection:
    """What the mirrors show from where sub-frame `index` looks: found again where it depends on the eye."""
    lens = reflection.view.lens
    if lens is None:
        return reflection
    view = reflection.view.through(*lens.points(renderer.settings.samples)[index])
    if all(kind is ShownRays for kind, _ in reflection.groups):
        return replace(reflection, view=view)
    return renderer.reflect(view.about(-reflection.origin), last=reflection, at_rest=True)


def expose(
    renderer: Renderer,
    canvas: Canvas,
    reflection: Reflection,
    still: Moment,
    moments: Sequence[Moment] = (),
    mirrors_alone: Canvas | None = None,
    before_sub_frame: Callable[[Convergence], None] | None = None,
    mirrors_only: bool = False,
    turn: Turn = ALL,
) -> tuple[Reflection, Convergence]:
    """Add all sub-frames of a `turn` to a picture, each at its moment; returns what the mirrors show at the frame
    itself, `still`, and how far the picture has come: sub-frames end early where the settings have a limit of noise.

    The renderer shows that scene before and after. `mirrors_alone` and what follows as for `Renderer.render`.
    """
    indices = turn.sub_frames(renderer.settings.samples)
    samples = len(indices)
    shown = reflection
    meter = NoiseMeter(canvas, samples, 1.0 / samples)
    limit = renderer.settings.noise_limit
    for number, index in enumerate(indices):
        if before_sub_frame is not None:
            before_sub_frame(meter.convergence)
        if moments:
            renderer.update(moments[number].scene)
            shown = renderer.reflect(moments[number].view, last=shown, at_rest=True)
        renderer.add_sub_frame(canvas, shown, index, 1.0 / samples, mirrors_only)
        if mirrors_alone is not None:
            renderer.add_sub_frame(mirrors_alone, shown, index, 1.0 / samples, mirrors_only=True)
        meter.look(number + 1)
        if meter.convergence.is_enough(limit):
            break
    done = meter.convergence.done
    if done < samples:
        for picture in (canvas, mirrors_alone):
            if picture is not None:
                picture.scale(samples / done)
    if moments:
        renderer.update(still.scene)
        reflection = renderer.reflect(still.view, last=shown, at_rest=True)
    return reflection, meter.convergence


def with_frames_before(
    renderer: Renderer, frame: Frame, mirrors_alone: Canvas | None, earlier: Sequence[KeptFrame]
) -> tuple[Canvas, Canvas | None, KeptFrame]:
    """The picture that the renderer has drawn last and `mirrors_alone` with those of earlier frames (see
    `reuse.earlier`), and the frame as later ones need it."""
    picture = Canvas(frame.color_texture)

    def read(reflection: Reflection, sub_frame: SubFrame) -> dict[str, Any]:
        kept = keep_frame(frame.scene, reflection.origin, sub_frame, reflection.groups, picture, mirrors_alone)
        return {"kept": kept, "with earlier": with_earlier(kept, sub_frame.targets.seen, earlier)}

    sharp = replace(frame.reflection, view=replace(frame.reflection.view, lens=None))
    found = renderer.surfaces_of(sharp, read)
    whole, alone, _ = found["with earlier"]
    return whole, alone, found["kept"]
