# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs as the renderer gets them: no bpy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

UV, GEOMETRY, FACTOR, TANGENT = "UV", "GEOMETRY", "FACTOR", "TANGENT"
"""Kinds of attributes: a UV map ("": the one that renders use), any attribute by its name ("": the default color
attribute), the same as the one number that Cycles makes of it, (tangent, sign) of a UV map as Blender's own,
mikktspace's

What a mesh lacks is 0, and (0, 0, 0, 1) where it is asked for by a name."""


@dataclass(frozen=True, slots=True, order=True)
class Attribute:
    """What a program reads of the mesh that it is on, interpolated: four numbers."""

    kind: str
    name: str


@dataclass(frozen=True, slots=True)
class Shape:
    """What of a program is compiled: trees that differ in constants and images alone have the same."""

    text: str
    """GLSL: functions, then `void material_program(ShadingPoint s, inout Material m)`"""
    files: tuple[str, ...] = ()
    """What it includes"""
    attributes: int = 0
    """How many it reads"""
    channels: tuple[str, ...] = ()
    """Fields of the GLSL struct Material that it sets, in order"""
    needs: frozenset[str] = frozenset()
    """Defines: what of the ShadingPoint it reads that costs something (`shading_point.glsl`)"""


@dataclass(frozen=True, slots=True)
class ImageUse:
    """An image that a program looks up."""

    record: int
    """Of the program's parameters: the first of IMAGE_RECORDS that the renderer fills in"""
    image: int
    """Index into `SceneArrays.images`"""


IMAGE_RECORDS = 2
"""That say where an image is"""


@dataclass(frozen=True, slots=True)
class Program:
    """A shape with its parameters: what makes one material's surface."""

    shape: Shape
    records: NDArray[np.float32] = field(compare=False)
    """(n, 4) parameters"""
    attributes: tuple[Attribute, ...] = ()
    """Those numbered 0, 1, ... in the text"""
    images: tuple[ImageUse, ...] = ()
    instance_attributes: tuple[str, ...] = ()
    """Names of values of instances or objects, numbered likewise"""
    sampled: frozenset[str] = frozenset()
    """What its values depend on: see `builder.Builder.depend`"""
