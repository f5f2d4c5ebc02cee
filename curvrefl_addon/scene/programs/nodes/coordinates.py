# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where textures are looked up: their input "Vector" or what stands for it, through the mapping that the nodes hold."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...materials.node_links import Source
from ..builder import Builder
from ..expression import Expression
from ..program import UV

type Coordinates = Literal["GENERATED", "UV"]

_LEAST_SCALE = 1e-5
"""Of a mapping that is inverted, as in Cycles"""
_AXES = ("X", "Y", "Z")


def texture_vector(b: Builder, source: Source, default: Coordinates = "GENERATED") -> Expression:
    """Coordinates of the texture node; `default`: where nothing is plugged into "Vector"."""
    if b.is_linked(source, "Vector"):
        vector = b.input(source, "Vector", "vector")
    else:
        vector = generated(b) if default == "GENERATED" else uv(b)
    return _mapped(b, vector, getattr(source.node, "texture_mapping", None))


def generated(b: Builder) -> Expression:
    """Coordinates from 0 to 1 in the object's texture space; of a world the direction."""
    b.depend("position")
    if b.is_world:
        return Expression("s.position", "vector")
    b.depend("generated")
    b.need("PROGRAM_INSTANCE")
    b.include("programs/instances.glsl")
    text = "to_object(s, s.position) * instance_record(s, 8).xyz + instance_record(s, 9).xyz"
    return b.shared(("generated",), lambda: b.made("vector", text))


def uv(b: Builder) -> Expression:
    """Coordinates of the UV map that renders use; a world has none."""
    if b.is_world:
        return b.parameter(0.0, 0.0, 0.0)
    return Expression(f"vec3({b.attribute(UV, '').text}.xy, 0.0)", "vector")


def _mapped(b: Builder, vector: Expression, mapping: Any) -> Expression:
    """Moved, turned and scaled by the node's own mapping, which scripts and old files set."""
    if mapping is None:
        return vector
    matrix = mapping_matrix(mapping)
    if np.array_equal(matrix, np.eye(4)[:3]):
        return vector
    # Each row is used once, the vector three times.
    vector = b.made("vector", vector.text)
    first = b.table(matrix)
    parts = ", ".join(f"dot(P({first + row}), vec4({vector.text}, 1.0))" for row in range(3))
    text = f"vec3({parts})"
    if mapping.vector_type == "NORMAL":
        text = f"normalize({text})"
    return b.made("vector", text)


def mapping_matrix(mapping: Any) -> NDArray[np.float64]:
    """(3, 4) of a `bpy.types.TexMapping`: the axes are chosen first, then come scale, rotation and translation. (Its
    minimum and maximum are Blender's internal renderer's: Cycles leaves them out.)"""
    kind = mapping.vector_type
    scale = np.array(mapping.scale, np.float64)
    if kind in ("TEXTURE", "NORMAL"):
        scale = np.where(np.abs(scale) < _LEAST_SCALE, np.where(scale < 0.0, -1.0, 1.0) * _LEAST_SCALE, scale)
    linear = np.array(mapping.rotation.to_matrix(), np.float64) @ np.diag(scale)
    place = np.array(mapping.translation, np.float64)
    if kind == "TEXTURE":
        linear = np.linalg.inv(linear)
        place = -linear @ place
    elif kind == "NORMAL":
        linear = np.linalg.inv(linear).T
    if kind in ("VECTOR", "NORMAL"):
        place = np.zeros(3)
    chosen = np.zeros((3, 3))
    for row, axis in enumerate((mapping.mapping_x, mapping.mapping_y, mapping.mapping_z)):
        if axis != "NONE":
            chosen[row, _AXES.index(axis)] = 1.0
    return np.column_stack([linear @ chosen, place])


def node_key(source: Source, what: str) -> tuple[object, ...]:
    """For `Builder.shared`: something that several outputs of the source's node need."""
    return (what, source.socket.node.as_pointer(), *(group.as_pointer() for group in source.groups))


def place(b: Builder, source: Source, dimensions: int, vector: str, scale: str = "1.0") -> Expression:
    """Where a texture of 1 to 4 dimensions is looked up, W being the only or the last of them: four numbers, those not
    in use 0. `vector`, `scale`: GLSL."""
    w = b.input(source, "W", "float").text if dimensions in (1, 4) else "0.0"
    numbers = {1: f"{w}, 0.0, 0.0, 0.0", 2: f"{vector}.xy, 0.0, 0.0"}.get(dimensions, f"{vector}, {w}")
    return b.made("vec4", f"vec4({numbers}) * {scale}")
