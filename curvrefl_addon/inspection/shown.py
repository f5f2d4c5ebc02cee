# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Combs and checked joints in the 3D viewports."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..options import current_options
from ..pacing.pieces import OutOfTime, paced
from ..renderer.renderer import Renderer
from ..renderer.shading.combs import CombSet
from ..renderer.shading.diagnostic_legend import draw_legend
from ..scene.camera.view import View
from .chosen import combs_of
from .joints import CheckedJoints
from .lines import draw_combs, draw_joints, joint_legend

_combs: list[CombSet] = []
"""Those drawn last"""


def show_combs(renderer: Renderer, scene: bpy.types.Scene, view: View, seconds: float) -> bool:
    """Draw them, in a POST_VIEW handler; False while the mirrors' curvature is not known, with which it goes on for
    about so long."""
    curvatures = renderer.diagnostics.curvatures
    try:
        with paced(seconds):
            curvatures.prepare(renderer.mirrors)
    except OutOfTime:
        return False
    found = renderer.diagnostics.combs.of(renderer.mirrors, combs_of(scene), renderer.placement.origin)
    assert found is not None, "it is prepared"
    _combs[:] = [found]
    draw_combs(found, view.eye)
    return True


def comb_rows() -> list[tuple[str, str]]:
    """Of the combs drawn last, for the panel."""
    return _combs[0].rows() if _combs else []


def forget_combs() -> None:
    """None are drawn any more."""
    _combs.clear()


_shown: list[CheckedJoints] = []
_stale: list[bool] = []
_handlers: list[Any] = []


def show_joints(checked: CheckedJoints) -> None:
    """Draw checked edges in all 3D viewports, in place of the last ones."""
    clear_joints()
    _shown.append(checked)
    space = bpy.types.SpaceView3D
    _handlers.append(space.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW"))
    _handlers.append(space.draw_handler_add(_draw_legend, (), "WINDOW", "POST_PIXEL"))
    bpy.app.handlers.load_pre.append(_forget)
    bpy.app.handlers.depsgraph_update_post.append(_note)


def shown_joints() -> CheckedJoints | None:
    """What was checked last, until it is cleared."""
    return _shown[0] if _shown else None


def joints_are_stale() -> bool:
    """What was checked has changed since, so that it is not drawn any more."""
    return bool(_stale)


def clear_joints() -> None:
    """Draw none any more."""
    _shown.clear()
    _stale.clear()
    while _handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_handlers.pop(), "WINDOW")
    for handlers, function in (
        (bpy.app.handlers.load_pre, _forget),
        (bpy.app.handlers.depsgraph_update_post, _note),
    ):
        if function in handlers:
            handlers.remove(function)


@persistent
def _forget(*_arguments: Any) -> None:
    clear_joints()


@persistent
def _note(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not _shown or _stale:
        return
    names = _shown[0].objects
    for update in depsgraph.updates:
        if update.is_updated_geometry or update.is_updated_transform:
            item = update.id.original
            if isinstance(item, bpy.types.Object) and item.name in names:
                _stale.append(True)
                return


def _draw() -> None:
    data = bpy.context.region_data
    if data is None or _stale:
        return
    # (The eye alone: the matrices are the handler's.)
    place = data.view_matrix.inverted()
    eye = [*place.col[2][:3], 0.0] if data.view_perspective == "ORTHO" else [*place.translation, 1.0]
    for checked in _shown:
        draw_joints(checked, current_options().colors, np.array(eye))


def _draw_legend() -> None:
    if _shown and not _stale:
        draw_legend(joint_legend(_shown[0], current_options().colors), bpy.context, at_left=True)
