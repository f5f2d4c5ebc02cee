# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The GLSL side of a uniform block, told from the numpy dtype that Python fills: one truth for both."""

from __future__ import annotations

import numpy as np

_SCALARS = {"f4": "float", "i4": "int"}
_VECTORS = {"f4": "vec", "i4": "ivec"}
_ALIGNMENTS = {1: 4, 2: 8, 3: 16, 4: 16}


def glsl_struct(name: str, block: np.dtype) -> str:
    """GLSL declaration of struct `name` with the fields of a structured dtype.

    Fields are float32 or int32: scalars, vectors of 2 to 4, or (4, 4) float matrices (transposed by the caller). Raises
    ValueError where std140 would lay the block out in another way than numpy does.
    """
    assert block.names is not None
    members = []
    for field in block.names:
        item, offset = block.fields[field][:2]  # type: ignore[index]
        kind, shape = item.base.str[1:], item.shape
        size = shape[0] if shape else 1
        if kind not in _SCALARS or len(shape) > 2 or (len(shape) == 2 and (kind, shape) != ("f4", (4, 4))):
            raise ValueError(f"Field {field} of block {name} is of a type that no uniform block holds: {item}.")
        if size not in _ALIGNMENTS or offset % _ALIGNMENTS[size]:
            raise ValueError(f"Field {field} of block {name} is out of place for std140: put larger fields first.")
        word = "mat4" if len(shape) == 2 else f"{_VECTORS[kind]}{size}" if shape else _SCALARS[kind]
        members.append(f"{word} {field};")
    if block.itemsize % 16:
        raise ValueError(f"Block {name} ends within a vec4: pad it to a multiple of 16 bytes.")
    return f"struct {name} {{ {' '.join(members)} }};"
