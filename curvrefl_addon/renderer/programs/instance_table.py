# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs know of instances: a row of records for each instance of the scene (see `programs/instances.glsl`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...scene.arrays import Float32Array, InstanceArrays, SceneArrays
from ..device.record_regions import RecordRegions
from ..device.shaders import Piece

PLAIN_VALUES = 12
"""Records of an instance before those of values by name"""
MOST_RUNS = 8
"""More separate rows than these are uploaded with all that lies between"""
NEED = "PROGRAM_INSTANCE"


def instance_piece(names: Sequence[str]) -> Piece:
    """What `programs/instances.glsl` needs, in a scene whose programs ask for these `names`."""
    return Piece(
        samplers={"instance_table": "FLOAT_2D"}, defines={"INSTANCE_VALUES": PLAIN_VALUES + len(names), NEED: ""}
    )


def names_of(scene: SceneArrays) -> tuple[str, ...]:
    """All values that programs ask of instances by name, ascending: their numbers are those in this list."""
    programs = (material.program for material in scene.materials)
    return tuple(sorted({name for program in programs if program is not None for name in program.instance_attributes}))


def is_needed(scene: SceneArrays) -> bool:
    """Whether any program knows of instances."""
    programs = [material.program for material in scene.materials]
    return any(item is not None and (NEED in item.shape.needs or item.instance_attributes) for item in programs)


class InstanceTable:
    """The rows of one scene's instances on the GPU; row i is that of `SceneArrays.instances[i]`."""

    def __init__(self) -> None:
        self.names: tuple[str, ...] = ()
        """In the order of the scene's list"""
        self.counters = {"instance rows written": 0}
        self._regions = RecordRegions()
        self._instances: tuple[InstanceArrays, ...] = ()

    @property
    def piece(self) -> Piece:
        """What shaders need that read it."""
        return instance_piece(self.names)

    def bind(self, shader: Any) -> None:
        """Set what `piece` names on a bound shader."""
        shader.uniform_sampler("instance_table", self._regions.texture)

    def follow(self, scene: SceneArrays) -> None:
        """Show a state of the scene: only rows of instances that are not the same objects any more are written."""
        names = names_of(scene)
        before, self._instances = self._instances, scene.instances
        if names != self.names or len(before) != len(scene.instances):
            self.names = names
            self._regions = RecordRegions()
            if scene.instances:
                (start,) = self._regions.put([self._records(scene.instances)])
                assert start == 0, "the first region of a texture begins with it"
                self.counters["instance rows written"] += len(scene.instances)
            return
        pairs = zip(before, scene.instances, strict=True)
        changed = [row for row, (old, new) in enumerate(pairs) if old is not new]
        for first, last in _runs(changed):
            rows = scene.instances[first : last + 1]
            self._regions.replace((PLAIN_VALUES + len(names)) * first, self._records(rows))
            self.counters["instance rows written"] += len(rows)

    def _records(self, instances: Sequence[InstanceArrays]) -> Float32Array:
        """(rows * records, 4)"""
        count = len(instances)
        records = np.zeros((count, PLAIN_VALUES + len(self.names), 4), np.float32)
        matrices = np.array([item.matrix for item in instances])
        shifts = np.array([item.shift for item in instances])
        # Object space is that of the object, wherever the mesh has been moved to.
        to_world = matrices.copy()
        to_world[:, :3, 3] -= np.einsum("nij,nj->ni", matrices[:, :3, :3], shifts)
        records[:, 0:3] = to_world[:, :3]
        records[:, 3:6] = np.linalg.inv(to_world)[:, :3]
        records[:, 6] = [item.color for item in instances]
        records[:, 7, 0] = [item.random for item in instances]
        records[:, 7, 1] = [item.pass_index for item in instances]
        records[:, 8, :3] = [item.generated[0] for item in instances]
        records[:, 9, :3] = [item.generated[1] for item in instances]
        records[:, 10, :3] = [item.instancer_generated for item in instances]
        records[:, 11, :2] = [item.instancer_uv for item in instances]
        for row, item in enumerate(instances):
            values = dict(item.values)
            for number, name in enumerate(self.names, PLAIN_VALUES):
                if name in values:
                    records[row, number] = values[name]
        return records.reshape(-1, 4)


def _runs(rows: Sequence[int]) -> list[tuple[int, int]]:
    """First and last of rows, ascending, that lie side by side; all as one where there are many such."""
    runs: list[tuple[int, int]] = []
    for row in rows:
        if runs and runs[-1][1] + 1 == row:
            runs[-1] = (runs[-1][0], row)
        else:
            runs.append((row, row))
    return runs if len(runs) <= MOST_RUNS else [(runs[0][0], runs[-1][1])]
