# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sub-frames that look from elsewhere than the frame does: through a place on the lens, at a moment of the shutter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ..scene.camera.shutter import Moment
from .noise import Convergence, NoiseMeter
from .reflection import Reflection
from .shown.rays import ShownRays
from .surfaces.canvas import Canvas

if TYPE_CHECKING:
    from .renderer import Renderer


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
) -> tuple[Reflection, Convergence]:
    """Add all sub-frames to a picture, each at its moment; returns what the mirrors show at the frame itself, `still`,
    and how far the picture has come: sub-frames end early where the settings have a limit of noise.

    The renderer shows that scene before and after. `mirrors_alone` and what follows as for `Renderer.render`.
    """
    samples = renderer.settings.samples
    shown = reflection
    meter = NoiseMeter(canvas, samples, 1.0 / samples)
    limit = renderer.settings.noise_limit
    for index in range(samples):
        if before_sub_frame is not None:
            before_sub_frame(meter.convergence)
        if moments:
            renderer.update(moments[index].scene)
            shown = renderer.reflect(moments[index].view, last=shown, at_rest=True)
        renderer.add_sub_frame(canvas, shown, index, 1.0 / samples, mirrors_only)
        if mirrors_alone is not None:
            renderer.add_sub_frame(mirrors_alone, shown, index, 1.0 / samples, mirrors_only=True)
        meter.look(index + 1)
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
