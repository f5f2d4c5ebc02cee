# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""For which rays an instance is there. Whether it is there at all the depsgraph says: a render's and a viewport's
differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy


@dataclass(frozen=True, slots=True)
class RayVisibility:
    """What of an instance sees it."""

    camera: bool
    diffuse: bool
    glossy: bool
    shadow: bool
    transmission: bool
    holdout: bool

    @property
    def any(self) -> bool:
        """Whether it can be in a picture at all."""
        return self.camera or self.glossy or self.shadow or self.transmission


def rays_of(instance: Any, view_layer: bpy.types.ViewLayer) -> RayVisibility:
    """Of a `DepsgraphObjectInstance`. For an instance, both its object and what makes it must be visible, as in Cycles.

    `view_layer`: the original, not an evaluated copy.
    """
    # (Evaluated ones: these switches may be animated.)
    objects = [instance.object]
    if instance.is_instance:
        objects.append(instance.parent)
    holder = objects[-1].original
    return RayVisibility(
        camera=all(obj.visible_camera for obj in objects) and not holder.indirect_only_get(view_layer=view_layer),
        diffuse=all(obj.visible_diffuse for obj in objects),
        glossy=all(obj.visible_glossy for obj in objects),
        shadow=all(obj.visible_shadow for obj in objects),
        transmission=all(obj.visible_transmission for obj in objects),
        holdout=bool(objects[-1].is_holdout or holder.holdout_get(view_layer=view_layer)),
    )
