# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the eye sees directly, with which each sub-frame begins."""

from __future__ import annotations

from .indirect.gather_shaders import LANES
from .indirect.indirect import Means
from .reflection import Reflection
from .settings import Settings
from .shown.shown import Stage, SubFrame
from .shown.targets import Targets
from .surfaces.by_size import BySize
from .surfaces.primary import depths_of, draw_primary
from .surfaces.view_block import view_block
from .surfaces.windows import Window


def draw_seen(
    stage: Stage,
    pool: BySize[Targets],
    reflection: Reflection,
    settings: Settings,
    window: Window | None = None,
    everywhere: bool = False,
    index: int = 0,
    of_meshes: bool = False,
) -> SubFrame:
    """Draw it from where the reflection's view looks, in `window` alone if given, but `everywhere` if asked for.

    `index`: number of the sub-frame. `of_meshes`: the mirrors' normals are those of their meshes, whatever shows them.
    """
    view, geometry = reflection.view, stage.geometry
    targets, shadows = pool.of(view.width, view.height), reflection.ray_shadows(stage.rays)
    uniforms = view_block(view)
    gathers = None
    # (Few rays would be noise: patches alone are calm.)
    if reflection.at_rest and settings.samples >= LANES:
        gathers = stage.indirect.gathering(Means(stage.rays, stage.materials, stage.lighting, uniforms), index)
    sub_frame = SubFrame(stage, view, uniforms, targets, window, shadows, index, gathers)
    mirrors = [shown.mirror for shown in reflection.shown if shown.has_reliefs]
    if of_meshes:
        mirrors = []
    elif not reflection.shown and not settings.entry.solves_vertices:
        mirrors = list(stage.mirrors)
    followed = {id(geometry.of_instance(mirror.index)[0]) for mirror in mirrors}
    # (Reflection points are those of the smooth surface.)
    smooth = {id(geometry.of_instance(mirror.index)[0]) for mirror in stage.mirrors} - followed
    draw_primary(
        targets.seen,
        geometry.seen(view),
        stage.materials,
        sub_frame.uniforms,
        None if everywhere else window,
        lambda chunk: geometry.hidden_faces(chunk, view),
        is_followed=lambda chunk: id(chunk) in followed,
        is_smooth=lambda chunk: id(chunk) in smooth,
        depths=depths_of(view),
        mirrored=view.is_mirrored,
        has_paths=stage.tracer is not None,
        sub_frame=index,
    )
    return sub_frame
