# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair of particle systems as strands, as many and as finely as the viewport shows or renders have it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from ..arrays import Float32Array
from ..programs.program import UV, Attribute
from .strands import Strands, ways


@dataclass(frozen=True, slots=True)
class HairSystem:
    """One of an evaluated object."""

    obj: Any
    modifier: Any
    number: int
    """Among the object's modifiers"""
    is_render: bool

    @property
    def system(self) -> Any:
        return self.modifier.particle_system

    @property
    def address(self) -> int:
        return int(self.system.as_pointer())

    @property
    def slot(self) -> int:
        """Of its material."""
        return max(int(self.system.settings.material) - 1, 0)

    @property
    def name(self) -> str:
        return f"{self.obj.name} {self.system.name}"


def hair_systems(instance: Any, view_layer: Any, is_render: bool) -> Iterator[HairSystem]:
    """Those that a `DepsgraphObjectInstance` shows as strands; `is_render`: of a depsgraph for renders."""
    obj = instance.object
    if not instance.show_particles or not len(obj.particle_systems) or not view_layer.use_strand:
        return
    shown = "show_render" if is_render else "show_viewport"
    for number, modifier in enumerate(obj.modifiers):
        if modifier.type == "PARTICLE_SYSTEM" and getattr(modifier, shown):
            settings = modifier.particle_system.settings
            if settings.type == "HAIR" and settings.render_type == "PATH":
                yield HairSystem(obj, modifier, number, is_render)


def strands_of_particles(hair: HairSystem, wanted: Sequence[Attribute]) -> Strands:
    """Object space."""
    system, settings = hair.system, hair.system.settings
    parents, children = len(system.particles), len(system.child_particles)
    if not hair.is_render:
        children = int(children * settings.display_percentage / 100.0)
    has_children = settings.child_type != "NONE" and children > 0
    first, last = (parents if has_children else 0), parents + children
    count = max(last - first, 0)
    steps = (1 << (settings.render_step if hair.is_render else settings.display_step)) + 1
    if settings.kink == "SPIRAL":
        steps += settings.kink_extra_steps
    # (One call for each point, 1.6 microseconds: particles give their keys in no faster way.)
    place, obj = system.co_hair, hair.obj
    found = chain.from_iterable(
        place(object=obj, particle_no=number, step=step) for number in range(first, last) for step in range(steps)
    )
    points = np.fromiter(found, np.float32, 3 * count * steps).reshape(-1, 3)
    to_object = np.linalg.inv(np.array(obj.matrix_world, np.float64))
    points = (points @ to_object[:3, :3].T + to_object[:3, 3]).astype(np.float32)
    strands = Strands(
        points,
        np.zeros(len(points), np.float32),
        np.arange(count + 1, dtype=np.int64) * steps,
        np.zeros(count, np.int32),
        tuple(_coordinates(hair, wanted, first, last)),
    )
    return with_radii(strands, settings)


def with_radii(strands: Strands, settings: Any) -> Strands:
    """As thick as a particle system's settings say."""
    along, length = ways(strands)
    whole = np.repeat(length, strands.lengths)
    rest = 1.0 - np.divide(along, whole, out=np.zeros_like(along), where=whole > 0.0).astype(np.float64)
    shape = settings.shape
    if shape != 0.0:
        rest = np.maximum(rest, 0.0) ** (1.0 + shape if shape < 0.0 else 1.0 / max(1.0 - shape, 1e-6))
    root, tip = (0.5 * settings.radius_scale * part for part in (settings.root_radius, settings.tip_radius))
    radii = (rest * (root - tip) + tip).astype(np.float32)
    if settings.use_close_tip:
        radii[strands.starts[1:] - 1] = 0.0
    return replace(strands, radii=radii)


def _coordinates(
    hair: HairSystem, wanted: Sequence[Attribute], first: int, last: int
) -> Iterator[tuple[Attribute, Float32Array]]:
    """(strands, 2) those of the UV maps of the emitter that are asked for, at the roots."""
    maps = list(hair.obj.data.uv_layers)
    particles = list(hair.system.particles)
    for attribute in wanted:
        if attribute.kind != UV:
            continue
        name = attribute.name
        number = next((i for i, item in enumerate(maps) if (item.name == name if name else item.active_render)), None)
        if number is None:
            continue
        found = hair.system.uv_on_emitter
        values = [
            found(modifier=hair.modifier, particle=particles[min(i, len(particles) - 1)], particle_no=i, uv_no=number)
            for i in range(first, last)
        ]
        yield attribute, np.array(values, np.float32).reshape(-1, 2)
