# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes that absorb and do nothing else, the same everywhere."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import Float64Array
from ...materials.node_links import Source
from ..builder import Builder

type Absorption = tuple[float, float, float]


class _VariesError(Exception):
    """It is not the same everywhere."""


def read_absorption(b: Builder, source: Source) -> Absorption | None:
    """Per meter; None where a volume also scatters or shines, or varies. Cycles' own formulas of its volume nodes.

    `b`: a builder of its own, of which no program is made.
    """
    try:
        found = _absorption(b, source)
    except _VariesError:
        return None
    if found is None:
        return None
    if found.min() < 0.0:
        b.note("A volume {of} that brightens light is drawn as none.")
    red, green, blue = np.maximum(found, 0.0).tolist()
    return red, green, blue


def _absorption(b: Builder, source: Source) -> Float64Array | None:
    node: Any = source.node
    if node is None:
        return np.zeros(3)
    if node.type == "VOLUME_ABSORPTION":
        return (1.0 - _color(b, source, "Color")) * _density(b, source)
    if node.type == "VOLUME_SCATTER":
        return None if _has_any(b, source, "Color") and _density(b, source) else np.zeros(3)
    if node.type == "VOLUME_COEFFICIENTS":
        if _has_any(b, source, "Scatter Coefficients", "Emission Coefficients"):
            return None
        return _color(b, source, "Absorption Coefficients")
    if node.type == "PRINCIPLED_VOLUME":
        return _principled(b, source)
    if node.type in ("ADD_SHADER", "MIX_SHADER"):
        parts = [_absorption(b, source.input(name)) for name in ("Shader", "Shader_001")]
        first, second = parts
        if first is None or second is None:
            return None
        if node.type == "ADD_SHADER":
            return first + second
        factor = min(max(_number(b, source, "Fac"), 0.0), 1.0)
        return (1.0 - factor) * first + factor * second
    return None


def _principled(b: Builder, source: Source) -> Float64Array | None:
    density = _density(b, source)
    if _number(b, source, "Emission Strength") > 0.0 or _number(b, source, "Blackbody Intensity") > 0.0:
        return None
    if density == 0.0:
        return np.zeros(3)
    if _has_any(b, source, "Color"):
        return None
    kept = np.sqrt(np.maximum(_color(b, source, "Absorption Color"), 0.0))
    return np.asarray(np.maximum(1.0 - kept, 0.0) * density, np.float64)


def _density(b: Builder, source: Source) -> float:
    return max(_number(b, source, "Density"), 0.0)


def _has_any(b: Builder, source: Source, *names: str) -> bool:
    return any(np.any(_color(b, source, name)) for name in names)


def _number(b: Builder, source: Source, name: str) -> float:
    value = b.input(source, name, "float").constant
    if value is None:
        raise _VariesError
    return value[0]


def _color(b: Builder, source: Source, name: str) -> Float64Array:
    value = b.input(source, name, "color").constant
    if value is None:
        raise _VariesError
    return np.array(value, np.float64)
