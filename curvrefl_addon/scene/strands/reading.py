# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points as meshes, without what cannot be drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..finite import LARGEST_LIGHT, LARGEST_PLACE, is_usable
from ..meshes.meshes import MeshNeeds, MeshReading
from .curves import strands_of_curves
from .particles import HairSystem, strands_of_particles
from .points import read_points
from .tubes import tubes


def is_strands_or_points(data: Any) -> bool:
    """Whether it is of a kind that is read here."""
    return isinstance(data, (bpy.types.Curves, bpy.types.PointCloud))


def has_no_faces(data: Any) -> bool:
    """Whether there is nothing of it to see."""
    if isinstance(data, bpy.types.Mesh):
        return len(data.polygons) == 0 and not data.is_editmode
    return len(data.points) == 0


def read_strands(source: bpy.types.Object | HairSystem, needs: MeshNeeds) -> MeshReading:
    """Of an evaluated object that is hair or points, or of a particle system; object space."""
    if isinstance(source, HairSystem):
        strands = strands_of_particles(source, needs.attributes)
    elif isinstance(source.data, bpy.types.PointCloud):
        return read_points(source.data, needs)
    else:
        strands = strands_of_curves(source.data, needs.attributes)
    if any(needs.hidden_slots):
        strands = strands.chosen(~np.array(needs.hidden_slots)[np.minimum(strands.slots, len(needs.hidden_slots) - 1)])
    dropped = 0
    if not (is_usable(strands.points, LARGEST_PLACE) and is_usable(strands.radii, LARGEST_PLACE)):
        # (Comparisons with what is not a number are not true.)
        good = (np.abs(strands.points) <= LARGEST_PLACE).all(axis=1) & (strands.radii <= LARGEST_PLACE)
        keep = np.logical_and.reduceat(good, strands.starts[:-1]) if len(strands.slots) else np.zeros(0, bool)
        dropped = 2 * int((strands.lengths[~keep] - 1).sum())
        strands = strands.chosen(keep)
    repaired: list[str] = []
    if not all(is_usable(values) for _, values in strands.layers):
        repaired.append("Attributes {of} that are not usable numbers are taken for 0.")
        layers = ((item, np.where(np.abs(values) <= LARGEST_LIGHT, values, 0.0)) for item, values in strands.layers)
        strands = replace(strands, layers=tuple((item, values.astype(np.float32)) for item, values in layers))
    return MeshReading(tubes(source.name, strands, needs.attributes), dropped, tuple(repaired))
