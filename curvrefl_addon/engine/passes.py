# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Render passes: what a view layer has beside the picture, for the compositor and for multilayer files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..scene.arrays import Float32Array

if TYPE_CHECKING:
    from ..renderer.frame import Frame

COMBINED = "Combined"
MIRROR = "Mirror"
UV = "UV"
VECTOR = "Vector"
IMAGES = "Images"
SLOW = {IMAGES, VECTOR}
"""Passes that are searched for on the processor"""
NUMBERED = ("Object", "Mirror ID")
"""Passes with numbers of objects"""


@dataclass(frozen=True, slots=True)
class Pass:
    """One that a view layer may have; `setting` switches it on in `ViewLayer.curvrefl`."""

    name: str
    channels: str
    """A letter each"""
    kind: Literal["VALUE", "VECTOR", "COLOR"]
    """Blender's word for what the numbers are"""
    setting: str
    read: Callable[[Frame], Float32Array] | None = None
    """(h, w) or (h, w, channels); None for the picture of the mirrors alone, which is drawn on its own"""

    def pixels(self, frame: Frame) -> Float32Array:
        """(h, w) or (h, w, channels) of a frame."""
        assert self.read is not None, "the picture of the mirrors alone is drawn on its own"
        return self.read(frame)


PASSES = (
    Pass(MIRROR, "RGBA", "COLOR", "use_pass_mirror"),
    Pass("Position", "XYZW", "VECTOR", "use_pass_position", lambda frame: frame.reflected_position()),
    Pass("Object", "X", "VALUE", "use_pass_object", lambda frame: frame.reflected_object().astype(np.float32)),
    Pass("Iterations", "X", "VALUE", "use_pass_iterations", lambda frame: frame.iterations()),
    Pass("Normal", "XYZ", "VECTOR", "use_pass_normal", lambda frame: frame.truth.normal()),
    Pass("Albedo", "RGB", "COLOR", "use_pass_albedo", lambda frame: frame.truth.albedo()),
    Pass("Depth", "Z", "VALUE", "use_pass_depth", lambda frame: frame.truth.depth()),
    Pass("Distance", "X", "VALUE", "use_pass_distance", lambda frame: frame.truth.distance()),
    Pass("Path Length", "X", "VALUE", "use_pass_path_length", lambda frame: frame.truth.path_length()),
    Pass(UV, "UVA", "VECTOR", "use_pass_uv", lambda frame: frame.truth.uv()),
    Pass("Incidence", "X", "VALUE", "use_pass_incidence", lambda frame: frame.truth.incidence()),
    Pass(IMAGES, "X", "VALUE", "use_pass_images", lambda frame: frame.truth.images()),
    Pass(VECTOR, "XYZW", "VECTOR", "use_pass_vector", lambda frame: frame.truth.vector()),
    Pass("Mirror ID", "X", "VALUE", "use_pass_mirror_id", lambda frame: frame.truth.mirror_id()),
)
"""In the order of a file's layers. Names and channels are Blender's own where it has such a pass"""


OF_MIRRORS = {item.name.lower().replace(" ", "_"): item for item in PASSES if item.read is not None}
"""What the mirrors show, by the names that verbs have for it"""


def passes_of(view_layer: Any) -> list[Pass]:
    """Those that are switched on."""
    return [item for item in PASSES if getattr(view_layer.curvrefl, item.setting)]


def fill(layer: Any, name: str, pixels: Float32Array) -> None:
    """Write (h, w) or (h, w, channels) into a pass of a render result's layer."""
    layer.passes[name].rect.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
