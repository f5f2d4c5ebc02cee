# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror, two cubes and lamps that are linked, and how far a picture is from Cycles'."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object
from curvrefl.curvrefl_addon.demo.shapes import plane
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from indirect.places import MIRROR, add_box, add_mirror, by_cycles, gray, matte, read, start, world_of
from lighting.room import add_lamp, blocks

SIZE = (128, 96)
OFF = 0.03
"""Of the screen's range: blocks that differ by more count"""


def build(bounces: int = 0, world: float = 0.05) -> None:
    """Two cubes on a floor before a mirror ball, and a dim world; a lamp is missing."""
    start(bounces)
    world_of(gray(world))
    add_object("floor", plane((8.0, 8.0)), matte(gray(0.6)))
    add_box("one", (-1.9, -0.6, 0.0), (-1.0, 0.3, 0.9), matte((0.8, 0.3, 0.2)))
    add_box("two", (1.0, -0.6, 0.0), (1.9, 0.3, 0.9), matte((0.2, 0.4, 0.8)))
    add_mirror(0.9, (0.0, 1.2, 0.9))
    add_camera((0.0, -5.5, 2.6), (0.0, 0.3, 0.6), 40.0)


def point(**values: Any) -> Any:
    """The lamp before the cubes."""
    return add_lamp("POINT", (0.2, -2.2, 2.2), 250.0, **{"shadow_soft_size": 0.1, **values})


def sun(**values: Any) -> Any:
    """A sun from the left, in whose light cubes cast long shadows."""
    made = add_lamp("SUN", (-3.0, -1.0, 2.0), 2.0, **{"angle": 0.02, **values})
    made.rotation_euler = (0.3, -0.9, 0.0)
    return made


def plate() -> Any:
    """It shines down from over the cubes."""
    return add_object("shine", plane((0.8, 0.8)), matte(gray(0.0), gray(12.0)), location=(0.0, -1.0, 2.4))


def link(emitter: Any, kind: str, included: tuple[str, ...] = (), excluded: tuple[str, ...] = ()) -> Any:
    """Give something a receiver or blocker collection."""
    made = bpy.data.collections.new(f"{kind} of {emitter.name}")
    for names, state in ((included, "INCLUDE"), (excluded, "EXCLUDE")):
        for name in names:
            made.objects.link(bpy.data.objects[name])
            made.collection_objects[len(made.collection_objects) - 1].light_linking.link_state = state
    setattr(emitter.light_linking, f"{kind}_collection", made)
    return made


@dataclass(frozen=True)
class Judged:
    """Two pictures (h, w, 3), scene-linear."""

    ours: np.ndarray
    cycles: np.ndarray
    unlinked: np.ndarray
    """Ours without any links"""
    warnings: tuple[str, ...]
    features: frozenset[str]

    def agrees(self, most: float = 0.01, mean: float = 0.01, shows: bool = True) -> None:
        """With Cycles, in all but a few blocks; nothing is said but what mirrors leave out of shadow linking. `shows`:
        without links it would not."""
        assert all("In mirrors" in sentence and "shadow linking" in sentence for sentence in self.warnings)
        assert self.share_off <= most
        assert abs(self.mean_off) <= mean
        assert not shows or self.share_off_unlinked > 2.0 * self.share_off + 0.004

    @property
    def share_off(self) -> float:
        """Share of blocks of 4 by 4 pixels that the screen shows otherwise."""
        return float((np.abs(blocks(self.ours) - blocks(self.cycles)).max(axis=-1) > OFF).mean())

    @property
    def share_off_unlinked(self) -> float:
        """The same of a picture that knows no links."""
        return float((np.abs(blocks(self.unlinked) - blocks(self.cycles)).max(axis=-1) > OFF).mean())

    @property
    def mean_off(self) -> float:
        """Of all light that a screen shows, what is too much or too little."""
        return float(self.ours.clip(0.0, 1.0).mean() / self.cycles.clip(0.0, 1.0).mean() - 1.0)


def judge(
    samples: int = 16, of_cycles: int = 96, method: str = "auto", mirrors: Sequence[str] = (MIRROR,), **settings: Any
) -> Judged:
    """The open scene by both; its links are gone then."""
    chosen = Settings(method=method, samples=samples, **settings)
    picture, warnings, features = _ours(chosen, mirrors)
    cycles = by_cycles(of_cycles, SIZE)
    for obj in bpy.data.objects:
        obj.light_linking.receiver_collection = obj.light_linking.blocker_collection = None
    unlinked, _, _ = _ours(Settings(method="exact", samples=4), mirrors)
    found = Judged(picture, cycles, unlinked, warnings, features)
    print(
        f"off {found.share_off:.4f} mean {found.mean_off:+.4f} unlinked off {found.share_off_unlinked:.4f}",
        chosen.method,
        warnings,
    )
    return found


def _ours(settings: Settings, mirrors: Sequence[str]) -> tuple[np.ndarray, tuple[str, ...], frozenset[str]]:
    arrays, view = read(mirrors, SIZE)
    renderer = Renderer(arrays, settings)
    frame = renderer.render(view)
    picture = frame.color()[..., :3]
    features = renderer._appearance.lighting.features
    renderer.free()
    return picture, frame.warnings, features
