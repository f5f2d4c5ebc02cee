# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is in a scene and not in its arrays: volumes, strokes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from .remarks import Remark
from .visibility import rays_of

UNSEEN = {
    "VOLUME": "Volumes {of} are not shown.",
    "GREASEPENCIL": "Grease pencil strokes {of} are not shown.",
}
"""By type of object"""
WIDEST_FILTER = 3.0
"""Pixels of Cycles' filter, which is 1.5 wide by default, up to which the picture looks as sharp"""


def of_view_layer(view_layer: bpy.types.ViewLayer) -> Iterator[Remark | str]:
    """What pictures of a whole view layer lack; the original layer, not an evaluated one."""
    if not view_layer.use_solid:
        yield f'View layer "{view_layer.name}" leaves out solid surfaces: they are shown all the same.'
    # Cycles is an add-on, and may be off.
    cycles: Any = getattr(view_layer.id_data, "cycles", None)
    if cycles is not None and cycles.sample_clamp_direct > 0.0:
        yield "The clamping of direct light, a setting of Cycles, is not followed."
    if cycles is not None and cycles.use_fast_gi:
        yield "Fast global illumination, a setting of Cycles, is not followed: light bounces as without."
    if cycles is not None and cycles.pixel_filter_type != "BOX" and cycles.filter_width > WIDEST_FILTER:
        yield f"The pixel filter of {cycles.filter_width:.3g} pixels is not followed: pictures are sharper than that."


def unseen(instance: Any, view_layer: bpy.types.ViewLayer) -> Iterator[Remark]:
    """Of a `DepsgraphObjectInstance`."""
    obj = instance.object
    if instance.show_self and obj.type in UNSEEN and rays_of(instance, view_layer).any:
        yield Remark(UNSEEN[obj.type], "object", obj.original.name)
