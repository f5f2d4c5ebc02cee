# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a surface is there: alpha, by images and thresholds, and mixes with transparent shaders."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import Float64Array
from ..node_color import NodeColor, gray, triple
from ..node_links import Source
from .conductors import reflectances
from .inputs import Inputs
from .surface import Surface, clear, folded, within

ALMOST_ALL = float(np.nextafter(np.float32(1.0), np.float32(0.0)))


@dataclass(frozen=True, slots=True)
class Coverage:
    """A share from 0 to 1, of a constant or an image."""

    share: NodeColor
    """A gray; with a threshold any number"""
    threshold: float | None = None
    """What is above it counts as 1, else as 0: also between pixels"""
    is_inverted: bool = False
    """The other way round"""

    @property
    def is_nothing(self) -> bool:
        return self.share == gray(0.0) and self.threshold is None

    @property
    def is_all(self) -> bool:
        return self.share == gray(1.0) and self.threshold is None

    @property
    def is_constant(self) -> bool:
        return self.share.is_constant


def read_coverage(source: Source, inputs: Inputs) -> Coverage:
    """Of what is plugged into an alpha or a mix factor. Comparisons that come last become a threshold."""
    found = _compared(source, inputs) or _by_angle(source, inputs)
    if found is None:
        value = inputs.fine.value(source)
        found = Coverage(inputs.without_paint(value, "alpha"))
    return _settled(found)


def flipped(coverage: Coverage, inputs: Inputs) -> Coverage:
    """1 - coverage."""
    if coverage.threshold is not None:
        return replace(coverage, is_inverted=not coverage.is_inverted)
    return Coverage(inputs.fine.made(lambda share: 1.0 - share, coverage.share))


def covered(surface: Surface, coverage: Coverage) -> Surface:
    """A surface without alpha of its own, there in part."""
    if coverage.is_nothing:
        return clear()
    made = surface.with_scalar("alpha", coverage.share)
    alpha = made.rest.alpha
    if not coverage.is_constant:
        # (It has holes, whatever the mean of what is compared.)
        alpha = min(alpha, ALMOST_ALL)
    threshold = -1.0 if coverage.threshold is None else coverage.threshold
    rest = replace(made.rest, alpha=alpha, alpha_threshold=threshold, alpha_inverted=coverage.is_inverted)
    return replace(made, rest=rest)


def coverage_of(surface: Surface) -> Coverage:
    """What `covered` was given."""
    rest = surface.rest
    share = surface.textures.get("alpha", gray(rest.alpha))
    return Coverage(share, None if rest.alpha_threshold < 0.0 else rest.alpha_threshold, rest.alpha_inverted)


def mixed_with_clear(first: Surface, second: Surface, factor: Coverage, inputs: Inputs) -> Surface | None:
    """Of two surfaces the second by a share of `factor`; None where neither is clear."""
    if second.is_clear:
        first, second, factor = second, first, flipped(factor, inputs)
    if not first.is_clear:
        return None
    own = coverage_of(second)
    whole = factor if own.is_all else own if factor.is_all else _product(factor, own, inputs)
    tint, other = first.rest.transparent_tint, second.rest.transparent_tint
    if not own.is_all and other != tint:
        share, there = _mean(factor), _mean(own)
        if not (factor.is_constant and own.is_constant):
            inputs.notes.always.append("The tints of transparency {of} are drawn as one.")
        through = (1.0 - share) * np.array(tint) + share * (1.0 - there) * np.array(other)
        left = 1.0 - share * there
        tint = triple(through / left) if left > 0.0 else tint
    if whole.is_nothing:
        return clear(tint)
    made = covered(second, whole)
    return replace(made, rest=replace(made.rest, transparent_tint=tint))


def _compared(source: Source, inputs: Inputs) -> Coverage | None:
    """Of a comparison with a constant, or of 1 minus one; None for anything else."""
    node: Any = source.node
    if node is None or node.type != "MATH":
        return None
    if node.operation == "SUBTRACT":
        if not inputs.is_at(source, "Value", 1.0):
            return None
        inner = _compared(source.input("Value_001"), inputs)
        return None if inner is None else flipped(inner, inputs)
    if node.operation not in ("GREATER_THAN", "LESS_THAN", "ROUND"):
        return None
    value = inputs.without_paint(inputs.fine.value(source.input("Value")), "alpha")
    if node.operation == "ROUND":
        return Coverage(value, _below(0.5))
    limit = inputs.without_paint(inputs.fine.value(source.input("Value_001")), "alpha")
    is_less = node.operation == "LESS_THAN"
    if value.is_constant:
        value, limit, is_less = limit, value, not is_less
    if not limit.is_constant:
        return None
    # a < b is the same as not a > what comes next below b.
    threshold = _below(limit.factor[0]) if is_less else float(np.float32(limit.factor[0]))
    return Coverage(value, threshold, is_less)


def _by_angle(source: Source, inputs: Inputs) -> Coverage | None:
    """The mean over all directions of what changes with the angle, with a note; None for anything else."""
    node: Any = source.node
    if node is None or node.type not in ("FRESNEL", "LAYER_WEIGHT"):
        return None
    cosines: Float64Array = np.linspace(0.5 / 256.0, 255.5 / 256.0, 256)
    if node.type == "FRESNEL":
        shares = _fresnel(max(inputs.number(source, "IOR"), 1e-5), cosines)
    else:
        blend = inputs.within(source, "Blend", 0.0, 1.0 - 1e-5)
        if source.socket.identifier == "Fresnel":
            shares = _fresnel(1.0 / (1.0 - blend), cosines)
        else:
            exponent = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
            shares = np.asarray(1.0 - cosines**exponent, np.float64)
    inputs.notes.always.append("Mixed shaders {of} are mixed alike at all angles.")
    return Coverage(gray(float(np.average(shares, weights=cosines))))


def _fresnel(ior: float, cosines: Float64Array) -> Float64Array:
    """Reflectance of a dielectric."""
    return reflectances(np.full(3, ior), np.zeros(3), cosines)[:, 0]


def _below(value: float) -> float:
    """The next lower number in single precision."""
    return float(np.nextafter(np.float32(value), np.float32(-np.inf)))


def _settled(coverage: Coverage) -> Coverage:
    """Without a texture and a threshold where they change nothing."""
    share = folded(coverage.share)
    threshold = coverage.threshold
    if threshold is None:
        return Coverage(gray(within(share.factor[0], 0.0, 1.0)) if share.is_constant else share)
    low, high = _range(share)
    if low > threshold or high <= threshold:
        return Coverage(gray(float((low > threshold) != coverage.is_inverted)))
    if threshold < 0.0:
        # (Arrays have thresholds from 0 up.)
        return Coverage(_stepped(replace(coverage, share=share)))
    return replace(coverage, share=share)


def _range(share: NodeColor) -> tuple[float, float]:
    if share.texture is None:
        return share.factor[0], share.factor[0]
    pixels = share.texture.colors()
    ends = (float(pixels.min()) * share.factor[0], float(pixels.max()) * share.factor[0])
    return min(ends), max(ends)


def _stepped(coverage: Coverage) -> NodeColor:
    """The share with its threshold applied to each pixel."""
    threshold, inverted = coverage.threshold, coverage.is_inverted
    if threshold is None or coverage.share.texture is None:
        return coverage.share
    factor = coverage.share.factor[0]
    change: Any = lambda pixels: ((pixels * np.float32(factor) > threshold) != inverted).astype(np.float32)  # noqa: E731
    return NodeColor(texture=coverage.share.texture.changed(change))


def _product(first: Coverage, second: Coverage, inputs: Inputs) -> Coverage:
    shares = [inputs.fine.made(lambda share: np.clip(share, 0.0, 1.0), _stepped(item)) for item in (first, second)]
    return _settled(Coverage(inputs.fine.made(lambda a, b: a * b, *shares)))


def _mean(coverage: Coverage) -> float:
    return within(_stepped(coverage).mean()[0], 0.0, 1.0)
