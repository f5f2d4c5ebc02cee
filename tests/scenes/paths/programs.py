# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials with programs, and meshes with what these read, made by hand: as `scene.programs` makes them of nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.scene.arrays import ImageSource, MaterialArrays, MeshArrays
from curvrefl.curvrefl_addon.scene.programs.program import (
    GEOMETRY,
    IMAGE_RECORDS,
    UV,
    Attribute,
    ImageUse,
    Program,
    Shape,
)

UV_MAP, COLORS = Attribute(UV, ""), Attribute(GEOMETRY, "")
"""The default UV map and color attribute"""


def source_of(name: str, values: np.ndarray) -> ImageSource:
    """An image (h, w, 4) of bytes or floats, row 0 at the bottom, that is scene-linear."""
    height, width = values.shape[:2]
    is_bytes = values.dtype == np.uint8
    is_opaque = bool((values[..., 3] == (255 if is_bytes else 1)).all())
    limits = (0.0, 1.0) if is_bytes else (float(values.min()), float(values.max()))
    return ImageSource(name, width, height, is_bytes, False, is_opaque, limits, lambda: values)


@dataclass(frozen=True)
class Looked:
    """How an image is looked up."""

    image: int = 0
    """Index into `SceneArrays.images`"""
    extension: str = "REPEAT"
    is_nearest: bool = False


def _program(lines: str, channel: str, attributes: tuple[Attribute, ...], looked: Looked | None) -> Program:
    text = f"void material_program(ShadingPoint s, inout Material m)\n{{\n{lines}}}\n"
    files = () if looked is None else ("nodes/images.glsl",)
    needs: frozenset[str] = frozenset() if looked is None else frozenset({"PROGRAM_IMAGES"})
    return Program(
        Shape(text, files, len(attributes), (channel,), needs),
        np.zeros((0 if looked is None else IMAGE_RECORDS, 4), np.float32),
        attributes,
        () if looked is None else (ImageUse(0, looked.image),),
    )


def _value(looked: Looked) -> str:
    kind = "closest" if looked.is_nearest else "linear"
    return f"image_lookup_{kind}(s, 0, s.attributes[0].xy, IMAGE_{looked.extension}, false)"


def painted(material: MaterialArrays, looked: Looked | None = None, with_colors: bool = False) -> MaterialArrays:
    """Its base color is multiplied with an image on the UV map, and with the color attribute."""
    attributes = (*((UV_MAP,) if looked else ()), *((COLORS,) if with_colors else ()))
    lines = "" if looked is None else f"  m.base_color *= {_value(looked)}.rgb;\n"
    if with_colors:
        lines += f"  m.base_color *= s.attributes[{len(attributes) - 1}].rgb;\n"
    return replace(material, program=_program(lines, "base_color", attributes, looked))


def cut_out(
    material: MaterialArrays, looked: Looked | None = None, threshold: float | None = None, **more: Any
) -> MaterialArrays:
    """Its alpha is that of an image on the UV map, or whether that is above a threshold."""
    looked = looked or Looked()
    value = f"{_value(looked)}.w"
    if threshold is not None:
        value = f"{value} > {threshold!r} ? 1.0 : 0.0"
    program = _program(f"  m.alpha = {value};\n", "alpha", (UV_MAP,), looked)
    return replace(material, program=program, ranges=(("alpha", 0.0, 1.0),), **more)


def with_attributes(mesh: MeshArrays, **values: np.ndarray) -> MeshArrays:
    """`uv` (corners, 2) and `colors` (corners, 4) of a mesh."""
    names = {"uv": UV_MAP, "colors": COLORS}
    held = np.zeros((len(mesh.corner_vertex), len(values), 4), np.float32)
    for number, rows in enumerate(values.values()):
        held[:, number, : rows.shape[1]] = rows
    uv = values.get("uv")
    return replace(
        mesh,
        corner_uv=None if uv is None else uv.astype(np.float32),
        attributes=tuple(names[name] for name in values),
        corner_attributes=held,
    )
