# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The color that nodes make, as far as it is a constant times a texture times vertex colors.

What nodes do to colors is done to the constant and to the texture's pixels alike. Formulas are those of Cycles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array
from ..color_spaces import luminance_weights
from .node_links import Source

type Pixels = NDArray[np.float32] | NDArray[np.float64]
type Change = Callable[[Pixels], Pixels]
"""From colors (..., 3) to colors of the same shape"""


class Texture(Protocol):
    """Pixels and whatever says where they go."""

    def colors(self) -> Float32Array:
        """(h, w, 3)"""

    def changed(self, change: Change) -> Self:
        """The texture with other colors."""


@dataclass(frozen=True, slots=True)
class NodeColor:
    """`factor` times texture times vertex colors."""

    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    texture: Any | None = None
    """A `Texture`"""
    vertex_colors: str | None = None
    """Name of the color attribute ("" for the default one), None for none"""

    @property
    def is_constant(self) -> bool:
        return self.texture is None and self.vertex_colors is None

    def mean(self) -> tuple[float, float, float]:
        """The nearest constant; vertex colors count as white."""
        if self.texture is None:
            return self.factor
        return _triple(np.asarray(self.factor) * self.texture.colors().reshape(-1, 3).mean(axis=0, dtype=np.float64))

    def scaled(self, by: tuple[float, float, float]) -> NodeColor:
        """Times a constant."""
        return replace(self, factor=_triple(np.multiply(self.factor, by)))


def gray(factor: float) -> NodeColor:
    """A constant gray."""
    return NodeColor((factor, factor, factor))


class ColorReader:
    """Evaluates color inputs of one node tree's nodes."""

    def __init__(self, read_texture: Callable[[Source], NodeColor | None], notes: list[str]) -> None:
        """`read_texture` gives the color of texture nodes (None: cannot). `notes` gets what was not understood."""
        self._read_texture = read_texture
        self._notes = notes

    def color(self, source: Source) -> NodeColor:
        """The color at the end of the links `source`."""
        node = source.node
        if node is None:
            return _plain(getattr(source.socket, "default_value", 0.0))
        if node.mute:
            return gray(0.0)
        if node.type in ("RGB", "VALUE"):
            return _plain(source.socket.default_value)
        if node.type == "VERTEX_COLOR" and source.socket.name == "Color":
            return NodeColor(vertex_colors=node.layer_name)
        if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY" and source.socket.name == "Color":
            return NodeColor(vertex_colors=node.attribute_name)
        if node.type.startswith("TEX_"):
            texture = self._read_texture(source)
            if texture is not None:
                return texture
        if node.type == "MIX" and node.data_type == "RGBA":
            return self._mix(source, "Factor_Float", "A_Color", "B_Color")
        if node.type == "MIX" and node.data_type == "FLOAT":
            return self._mix(source, "Factor_Float", "A_Float", "B_Float")
        if node.type == "MIX_RGB":
            return self._mix(source, "Fac", "Color1", "Color2")
        if node.type == "MATH":
            return self._math(source)
        change = self._change(source)
        if change is not None:
            return self._changed(self.color(source.input("Color")), change, node)
        if node.type == "VALTORGB":
            return self._ramp(source)
        return self._guess(source)

    def number(self, source: Source, what: str) -> float:
        """The value at the end of the links; a texture's mean, with a note about `what`."""
        color = self.color(source)
        if not color.is_constant:
            self._notes.append(f"its {what} varies, the mean is used")
        return _luminance(color.mean())

    def _mix(self, source: Source, factor_name: str, a_name: str, b_name: str) -> NodeColor:
        node = source.node
        assert node is not None
        factor = self.number(source.input(factor_name), "mix factor")
        if getattr(node, "clamp_factor", True):
            factor = min(max(factor, 0.0), 1.0)
        blend = getattr(node, "blend_type", "MIX")
        a = self.color(source.input(a_name))
        if factor == 0.0:
            return a
        b = self.color(source.input(b_name))
        if blend == "MIX" and factor == 1.0:
            return b
        operation = _BLENDS.get(blend)
        if operation is None:
            self._notes.append(f"the blending {blend.lower()} of its colors is drawn as a mix")
            operation = _BLENDS["MIX"]
        result: NodeColor | None = None
        if a.is_constant and b.is_constant:
            result = NodeColor(_triple(operation(np.array(a.factor), np.array(b.factor), factor)))
        elif blend == "MULTIPLY":
            result = self._product(a, b, factor)
        elif b.is_constant and a.vertex_colors is None:
            result = self._changed(a, lambda pixels: operation(pixels, np.array(b.factor), factor), node)
        elif a.is_constant and b.vertex_colors is None:
            result = self._changed(b, lambda pixels: operation(np.array(a.factor), pixels, factor), node)
        if result is None:
            self._notes.append("two textures are mixed, the stronger one is drawn")
            result = b if factor > 0.5 else a
        return result

    def _product(self, a: NodeColor, b: NodeColor, factor: float) -> NodeColor | None:
        """a * (1 - factor + factor * b)."""
        if b.is_constant:
            return a.scaled(_triple(1.0 - factor + factor * np.array(b.factor)))
        if factor == 1.0:
            both_textures = a.texture is not None and b.texture is not None
            if both_textures or (a.vertex_colors is not None and b.vertex_colors is not None):
                return None
            return NodeColor(
                _triple(np.multiply(a.factor, b.factor)),
                a.texture if a.texture is not None else b.texture,
                a.vertex_colors if a.vertex_colors is not None else b.vertex_colors,
            )
        if a.is_constant and b.vertex_colors is None:
            return _apply(b, lambda pixels: np.array(a.factor) * (1.0 - factor + factor * pixels))
        return None

    def _change(self, source: Source) -> Change | None:
        """What a node does to the color at its input "Color"."""
        node = source.node
        assert node is not None

        def value(name: str) -> float:
            return self.number(source.input(name), name.lower())

        if node.type == "GAMMA":
            exponent = value("Gamma")
            return lambda c: np.where(c > 0.0, np.maximum(c, 0.0) ** exponent, c)
        if node.type == "INVERT":
            factor = value("Fac")
            return lambda c: c + factor * (1.0 - 2.0 * c)
        if node.type == "BRIGHTCONTRAST":
            bright, contrast = value("Bright"), value("Contrast")
            return lambda c: np.maximum((1.0 + contrast) * c + bright - 0.5 * contrast, 0.0)
        if node.type == "HUE_SAT":
            hue, saturation, brightness = value("Hue"), value("Saturation"), value("Value")
            factor = value("Fac")
            return lambda c: (1.0 - factor) * c + factor * _hue_saturation_value(c, hue, saturation, brightness)
        if node.type == "RGBTOBW":
            return lambda c: np.repeat((c @ luminance_weights())[..., None], 3, axis=-1)
        return None

    def _changed(self, color: NodeColor, change: Change, node: Any) -> NodeColor:
        if color.vertex_colors is not None:
            self._notes.append(f'node "{node.name}" has no effect on vertex colors')
            return color
        return _apply(color, change)

    def _math(self, source: Source) -> NodeColor:
        node = source.node
        assert node is not None
        operation = _MATH.get(node.operation)
        inputs = [self.color(source.input(name)) for name in ("Value", "Value_001")]
        if operation is None or not all(color.is_constant for color in inputs):
            self._notes.append(f'node "{node.name}" is left out')
            return inputs[0]
        a, b = (_luminance(color.factor) for color in inputs)
        result = float(operation(np.float64(a), np.float64(b)))
        return gray(min(max(result, 0.0), 1.0) if node.use_clamp else result)

    def _ramp(self, source: Source) -> NodeColor:
        node = source.node
        assert node is not None
        steps = 256
        table = np.array([node.color_ramp.evaluate(i / (steps - 1))[:3] for i in range(steps)])

        def ramp(colors: Pixels) -> Pixels:
            place = np.clip(colors @ luminance_weights(), 0.0, 1.0) * (steps - 1)
            return np.stack([np.interp(place, np.arange(steps), table[:, k]) for k in range(3)], axis=-1)

        factor = source.input("Fac")
        if factor.node is not None and factor.node.type.startswith("TEX_") and self._read_texture(factor) is None:
            self._notes.append(f'the mean of node "{node.name}" stands for it')
            return NodeColor(_triple(table.mean(axis=0)))
        return self._changed(self.color(factor), ramp, node)

    def _guess(self, source: Source) -> NodeColor:
        """The nearest constant of a node that is not understood."""
        node = source.node
        assert node is not None
        if node.type == "TEX_CHECKER":
            ends = [self.color(source.input(name)).mean() for name in ("Color1", "Color2")]
            constant = NodeColor(_triple(np.mean(ends, axis=0)))
        else:
            through = next((socket for socket in node.inputs if socket.type == "RGBA"), None)
            constant = gray(0.5) if through is None else NodeColor(self.color(source.input(through.identifier)).mean())
        self._notes.append(f'node "{node.name}" is drawn as one color')
        return constant


def _plain(value: Any) -> NodeColor:
    """Of a socket's default value: a number, a vector or a color with alpha."""
    if isinstance(value, int | float):
        return gray(float(value))
    return NodeColor(_triple(value[:3]))


def _triple(values: Any) -> tuple[float, float, float]:
    r, g, b = (float(value) for value in values)
    return r, g, b


def _luminance(color: tuple[float, float, float]) -> float:
    """Exact for a gray."""
    return color[0] if color[0] == color[1] == color[2] else float(np.dot(color, luminance_weights()))


def _apply(color: NodeColor, change: Change) -> NodeColor:
    factor = np.array(color.factor)
    if color.texture is None:
        return NodeColor(_triple(change(factor)))
    return NodeColor(texture=color.texture.changed(lambda pixels: change(pixels * factor)))


_BLENDS: dict[str, Callable[[Any, Any, float], Any]] = {
    "MIX": lambda a, b, f: a * (1.0 - f) + b * f,
    "MULTIPLY": lambda a, b, f: a * (1.0 - f + f * b),
    "ADD": lambda a, b, f: a + f * b,
    "SUBTRACT": lambda a, b, f: a - f * b,
    "SCREEN": lambda a, b, f: 1.0 - (1.0 - f + f * (1.0 - b)) * (1.0 - a),
    "DARKEN": lambda a, b, f: a * (1.0 - f) + np.minimum(a, b) * f,
    "LIGHTEN": lambda a, b, f: a * (1.0 - f) + np.maximum(a, b) * f,
    "DIFFERENCE": lambda a, b, f: a * (1.0 - f) + np.abs(a - b) * f,
}

_MATH: dict[str, Callable[[np.float64, np.float64], np.float64]] = {
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": lambda a, b: a / b if b != 0.0 else np.float64(0.0),
    "POWER": lambda a, b: np.power(a, b) if a > 0.0 else np.float64(0.0),
    "MINIMUM": lambda a, b: np.minimum(a, b),
    "MAXIMUM": lambda a, b: np.maximum(a, b),
}


def _hue_saturation_value(colors: Pixels, hue: float, saturation: float, brightness: float) -> Pixels:
    """Cycles' Hue/Saturation/Value node: `hue` 0.5 leaves it, the others are factors."""
    high, low = colors.max(axis=-1), colors.min(axis=-1)
    span = high - low
    safe = np.where(span > 0.0, span, 1.0)
    r, g, b = (colors[..., k] for k in range(3))
    turn = np.where(r == high, (g - b) / safe, np.where(g == high, 2.0 + (b - r) / safe, 4.0 + (r - g) / safe)) / 6.0
    turn = np.where(span > 0.0, turn, 0.0) + hue + 0.5
    strength = np.clip(np.where(high > 0.0, span / np.where(high > 0.0, high, 1.0), 0.0) * saturation, 0.0, 1.0)
    value = high * brightness
    channels = []
    for offset in (0.0, 2.0 / 3.0, 1.0 / 3.0):
        place = np.mod(turn + offset, 1.0) * 6.0
        channels.append(value * (1.0 - strength * (1.0 - np.clip(np.abs(place - 3.0) - 1.0, 0.0, 1.0))))
    return np.maximum(np.stack(channels, axis=-1), 0.0)
