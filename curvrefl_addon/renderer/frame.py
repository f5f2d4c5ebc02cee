# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture, and what is behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..scene.arrays import Float32Array, Int32Array, SceneArrays
from .device.textures import read_texture
from .noise import Convergence
from .reflection import Reflection
from .shown.rays import ShownRays, read_ways
from .shown.shown import SubFrame
from .truth.shown_points import points_of_ways
from .truth.truth import MirrorTruth
from .vertices.solution import statistics

type ReadBack = Callable[[Reflection, SubFrame], dict[str, Any]]
"""Reads arrays of a sub-frame whose primary pass is drawn"""


class Frame:
    """One picture and what is behind it. Arrays are copies, float32, row 0 at the bottom.

    Surfaces are drawn when first asked for: until then the renderer must show the same scene.
    """

    def __init__(
        self,
        reflection: Reflection,
        color: Any,
        times_ms: dict[str, float],
        read: Callable[[Reflection, ReadBack], dict[str, Any]],
        scene: SceneArrays,
        convergence: Convergence | None = None,
        bounced_light: str = "",
    ) -> None:
        """`read` draws what the eye sees and reads what is asked of it; `scene`: what is shown, in the world."""
        self.reflection = reflection
        """What the mirrors show; the next frame of an animation may start from it"""
        self._read, self.scene = read, scene
        self.view = reflection.view.about(-reflection.origin)
        self.color_texture = color
        """RGBA32F, scene-linear"""
        self.times_ms = times_ms
        """bake, solve, draw, frame = solve + draw; bake and light (between surfaces) of when that was last found"""
        self.convergence = convergence
        """How many sub-frames are in it, and what is left of its error"""
        self.bounced_light = bounced_light
        """How light between surfaces was found, or why not"""
        self.warnings = reflection.warnings
        """One sentence each"""
        self.choice = None if reflection.choice is None else reflection.choice.as_report()
        """What `auto` has chosen, and why"""

    @cached_property
    def solve(self) -> dict[str, Any]:
        """Counts and iterations over all mirrors, as `report.json` has them."""
        return statistics(self.reflection.solutions)

    @cached_property
    def surfaces(self) -> dict[str, Float32Array]:
        """Surface buffers through the pixels' centers (h, w, 4): see `SurfaceBuffer`; keys seen_position, seen_normal,
        seen_color, reflected_position and, where vertices are solved, reflected_color. From an environment,
        reflected_position has the direction of the background, too, with w = 0.

        Raises RuntimeError where the renderer shows another state of the scene by now.
        """
        return self._read(self.reflection, read_surfaces)

    @cached_property
    def truth(self) -> MirrorTruth:
        """What the mirrors show at the pixels' centers by rays, whatever the methods that draw them. Raises as
        `surfaces`.
        """
        shown = tuple(ShownRays(one.mirror, replace(one.settings, method="exact")) for one in self.reflection.shown)
        ways = self._read(replace(self.reflection, shown=shown), read_all_ways)
        instances = {one.mirror.number: one.mirror.index for one in shown}
        return MirrorTruth(self.scene, points_of_ways(self.scene, self.view, ways, instances))

    def color(self) -> Float32Array:
        """(h, w, 4) scene-linear picture, anti-aliased."""
        return read_texture(self.color_texture)

    def mask(self) -> Int32Array:
        """(h, w) object_id of the reflector at the pixel's center, 0 elsewhere."""
        ids = np.rint(self.surfaces["seen_position"][..., 3]).astype(np.int32)
        return np.where(self.surfaces["seen_color"][..., 3] > 0.5, ids, 0)

    def reflector_position(self) -> Float32Array:
        """(h, w, 3) world point P seen at the pixel's center; meant for the pixels of `mask`."""
        return self.surfaces["seen_position"][..., :3]

    def reflected_position(self) -> Float32Array:
        """(h, w, 4) world point that the mirror shows there (w = 1), or the background's unit direction (w = 0)."""
        return self._reflected[0]

    def reflected_object(self) -> Int32Array:
        """(h, w) object_id of that point, 0 for the background."""
        return self._reflected[1]

    def iterations(self) -> Float32Array:
        """(h, w) solver iterations, interpolated over the reflected triangles."""
        if "reflected_color" not in self.surfaces:
            return np.zeros((self.view.height, self.view.width), np.float32)
        return self.surfaces["reflected_color"][..., 3]

    @cached_property
    def _reflected(self) -> tuple[Float32Array, Int32Array]:
        mask = self.mask() > 0
        seen, normal = self.surfaces["seen_position"][..., :3], self.surfaces["seen_normal"][..., :3]
        eye = self.view.eye
        to_eye = eye[:3] - seen * eye[3]
        to_eye /= np.maximum(np.linalg.norm(to_eye, axis=-1, keepdims=True), 1e-30)
        direction = 2.0 * (normal * to_eye).sum(-1, keepdims=True) * normal - to_eye
        hits = self.surfaces["reflected_position"]
        ids = np.where(mask, np.rint(hits[..., 3]), 0).astype(np.int32)
        position = np.zeros((*mask.shape, 4), np.float32)
        # Environment lookups say themselves in which direction they see the background.
        found = (hits[..., :3] != 0.0).any(axis=-1, keepdims=True)
        position[..., :3] = np.where(found, hits[..., :3], direction)
        position[..., 3] = ids > 0
        position[~mask] = 0.0
        return position, ids


def read_surfaces(reflection: Reflection, sub_frame: SubFrame) -> dict[str, Float32Array]:
    """What `Frame.surfaces` holds, of a sub-frame whose primary pass is drawn; waits for the GPU."""
    seen = sub_frame.targets.seen
    arrays = {
        "seen_position": read_texture(seen.position),
        "seen_normal": read_texture(seen.normal),
        "seen_color": read_texture(seen.color),
    }
    number = np.rint(arrays["seen_color"][..., 3]).astype(np.int32)
    groups = reflection.groups
    for kind, members in groups:
        here = np.isin(number, [shown.mirror.number for shown in members])
        for name, array in kind.read_back(members, sub_frame).items():
            if len(groups) == 1:
                arrays[name] = array
            else:
                arrays.setdefault(name, np.zeros_like(array))[here] = array[here]
    arrays.setdefault("reflected_position", np.zeros_like(arrays["seen_position"]))
    if reflection.origin.any():
        for name in ("seen_position", "reflected_position"):
            # (Without an object it is a direction.)
            arrays[name][..., :3] += np.where(arrays[name][..., 3:] > 0.0, reflection.origin, 0.0)
    return arrays


def read_all_ways(reflection: Reflection, sub_frame: SubFrame) -> dict[str, Any]:
    """As `read_ways`, of all mirrors, world space; nothing where there is none."""
    members = [shown for shown in reflection.shown if isinstance(shown, ShownRays)]
    if not members:
        return {}
    ways = read_ways(members, sub_frame)
    ways["seen_position"][..., :3] += reflection.origin
    return ways
