# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes that absorb and do nothing else."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import Float64Array
from ..node_color import triple
from ..node_links import Source
from .inputs import Inputs


def read_absorption(source: Source, inputs: Inputs) -> tuple[float, float, float] | None:
    """Per meter; None where a volume also scatters or shines. Cycles' own formulas of its volume nodes."""
    found = _absorption(source, inputs)
    if found is None:
        return None
    if found.min() < 0.0:
        inputs.notes.always.append("A volume {of} that brightens light is drawn as none.")
    return triple(np.maximum(found, 0.0))


def _absorption(source: Source, inputs: Inputs) -> Float64Array | None:
    node: Any = source.node
    if node is None:
        return np.zeros(3)
    if node.type == "VOLUME_ABSORPTION":
        return (1.0 - np.array(inputs.constant(source, "Color"))) * _density(source, inputs)
    if node.type == "VOLUME_SCATTER":
        return None if np.any(inputs.constant(source, "Color")) and _density(source, inputs) else np.zeros(3)
    if node.type == "VOLUME_COEFFICIENTS":
        if _has_any(source, inputs, "Scatter Coefficients", "Emission Coefficients"):
            return None
        return np.array(inputs.constant(source, "Absorption Coefficients"))
    if node.type == "PRINCIPLED_VOLUME":
        return _principled(source, inputs)
    if node.type in ("ADD_SHADER", "MIX_SHADER"):
        parts = [_absorption(source.input(name), inputs) for name in ("Shader", "Shader_001")]
        first, second = parts
        if first is None or second is None:
            return None
        if node.type == "ADD_SHADER":
            return first + second
        factor = inputs.within(source, "Fac", 0.0, 1.0)
        return (1.0 - factor) * first + factor * second
    return None


def _principled(source: Source, inputs: Inputs) -> Float64Array | None:
    density = _density(source, inputs)
    if inputs.number(source, "Emission Strength") > 0.0 or inputs.number(source, "Blackbody Intensity") > 0.0:
        return None
    if density == 0.0:
        return np.zeros(3)
    if _has_any(source, inputs, "Color"):
        return None
    kept = np.sqrt(np.maximum(inputs.constant(source, "Absorption Color"), 0.0))
    return np.maximum(1.0 - kept, 0.0) * density


def _density(source: Source, inputs: Inputs) -> float:
    return max(inputs.number(source, "Density"), 0.0)


def _has_any(source: Source, inputs: Inputs, *names: str) -> bool:
    return any(np.any(inputs.constant(source, name)) for name in names)
