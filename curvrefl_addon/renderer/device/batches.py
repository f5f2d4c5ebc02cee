# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches: what is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gpu
import numpy as np

from .context import gpu_cache


@gpu_cache
def full_screen_triangle() -> Any:
    """Batch with one attribute `pos` (vec2) that covers the whole target."""
    return vertex_batch({"pos": np.array([[-1, -1], [3, -1], [-1, 3]], np.float32)})


def vertex_batch(attributes: Mapping[str, np.ndarray], triangles: np.ndarray | None = None) -> Any:
    """Triangles of vertices with attributes (n, 2..4) of floats: those of indices (m, 3), or three vertices each."""
    layout = gpu.types.GPUVertFormat()
    for name, values in attributes.items():
        layout.attr_add(id=name, comp_type="F32", len=values.shape[1], fetch_mode="FLOAT")
    vertices = gpu.types.GPUVertBuf(format=layout, len=len(next(iter(attributes.values()))))
    for name, values in attributes.items():
        vertices.attr_fill(name, np.ascontiguousarray(values, np.float32))
    if triangles is None:
        return gpu.types.GPUBatch(type="TRIS", buf=vertices)
    return gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=_elements(triangles))


def indexed_batch(triangles: np.ndarray) -> Any:
    """Attribute-less batch of (n, 3) indices; the vertex shader fetches its record by gl_VertexID."""
    vertices = gpu.types.GPUVertBuf(format=gpu.types.GPUVertFormat(), len=int(triangles.max()) + 1)
    return gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=_elements(triangles))


def by_material(triangles: np.ndarray, material: np.ndarray) -> tuple[tuple[int, Any], ...]:
    """Batches of triangles (n, 3), whose materials are (n,)."""
    if len(triangles) == 0:
        return ()
    if (material == material[0]).all():
        return ((int(material[0]), indexed_batch(triangles)),)
    order = np.argsort(material, kind="stable")
    materials, starts = np.unique(material[order], return_index=True)
    groups = np.split(order, starts[1:])
    return tuple(
        (int(number), indexed_batch(triangles[group])) for number, group in zip(materials, groups, strict=True)
    )


def bare_batch(count: int, kind: str = "TRIS") -> Any:
    """Attribute-less batch of so many vertices, for TRIS or POINTS."""
    vertices = gpu.types.GPUVertBuf(format=gpu.types.GPUVertFormat(), len=count)
    return gpu.types.GPUBatch(type=kind, buf=vertices)


def _elements(triangles: np.ndarray) -> Any:
    return gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(triangles, np.int32))
