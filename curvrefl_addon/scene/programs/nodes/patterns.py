# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wave, Magic, Brick, Checker and Gradient Texture."""

from __future__ import annotations

from collections.abc import Mapping

from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression
from .coordinates import node_key, texture_vector

_FILE = "nodes/patterns.glsl"
_BANDS = {
    "X": "vec3(20.0, 0.0, 0.0)",
    "Y": "vec3(0.0, 20.0, 0.0)",
    "Z": "vec3(0.0, 0.0, 20.0)",
    "DIAGONAL": "vec3(10.0)",
}
"""What bands grow by along each axis"""
_RINGS = {"X": ".yz", "Y": ".xz", "Z": ".xy", "SPHERICAL": ""}
"""Which coordinates the distance of rings is of"""
_MOST_OCTAVES = 15.0
"""Of a wave's distortion: Cycles takes what is plugged in as it is, the node itself no more"""


def _wave(b: Builder, source: Source) -> Expression:
    return b.shared(node_key(source, "wave"), lambda: _wave_factor(b, source))


def _wave_factor(b: Builder, source: Source) -> Expression:
    node = source.node
    b.include(_FILE)
    p = b.call("vector", "pattern_place", _scaled(b, source)).text
    if node.wave_type == "BANDS":
        along = f"dot({p}, {_BANDS[node.bands_direction]})"
    else:
        along = f"20.0 * length({p}{_RINGS[node.rings_direction]})"
    along += f" + {b.input(source, 'Phase Offset', 'float').text}"
    if b.constant_of(source, "Distortion") != (0.0,):
        distortion, detail, scale, roughness = (
            b.input(source, name, "float").text for name in ("Distortion", "Detail", "Detail Scale", "Detail Roughness")
        )
        b.include("nodes/noise.glsl")
        noise = (
            f"noise_fbm_normalized(vec4({p} * {scale}, 0.0), 3, min({detail}, {_MOST_OCTAVES}), {roughness}, 2.0, "
            "0.0, 0.0)"
        )
        along += f" + {distortion} * (2.0 * {noise} - 1.0)"
    return b.call("float", f"wave_{node.wave_profile.lower()}", along, low=0.0, high=1.0)


def _magic(b: Builder, source: Source) -> Expression:
    def color() -> Expression:
        vector, scale, distortion = texture_vector(b, source), *_numbers(b, source, "Scale", "Distortion")
        return b.call("color", "magic_color", vector, scale, distortion, source.node.turbulence_depth, file=_FILE)

    found = b.shared(node_key(source, "magic"), color)
    if source.socket.identifier == "Color":
        return found
    # The mean of the three, as of a vector.
    return b.as_kind(Expression(found.text, "vector", None, found.low, found.high), "float")


def _brick(b: Builder, source: Source) -> Expression:
    # (Two numbers in four.)
    shares = b.shared(node_key(source, "brick"), lambda: _brick_shares(b, source)).text
    if source.socket.identifier == "Fac":
        return Expression(f"{shares}.y", "float", None, 0.0, 1.0)
    colors = [b.input(source, name, "color") for name in ("Color1", "Color2", "Mortar")]
    low, high = min(color.low for color in colors), max(color.high for color in colors)
    return b.call("color", "brick_color", f"{shares}.xy", *colors, low=low, high=high)


def _brick_shares(b: Builder, source: Source) -> Expression:
    node = source.node
    names = ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    rows = b.record(node.offset, node.offset_frequency, node.squash, node.squash_frequency)
    arguments = ", ".join([_scaled(b, source), *(number.text for number in _numbers(b, source, *names)), f"P({rows})"])
    b.include(_FILE)
    return b.made("vec4", f"vec4(brick_shares({arguments}), 0.0, 0.0)")


def _checker(b: Builder, source: Source) -> Expression:
    factor = b.shared(
        node_key(source, "checker"),
        lambda: b.call("float", "checker_factor", _scaled(b, source), file=_FILE, low=0.0, high=1.0),
    )
    if source.socket.identifier == "Fac":
        return factor
    first, second = (b.input(source, name, "color") for name in ("Color1", "Color2"))
    low, high = min(first.low, second.low), max(first.high, second.high)
    return b.made("color", f"{factor.text} == 1.0 ? {first.text} : {second.text}", low, high)


def _gradient(b: Builder, source: Source) -> Expression:
    name = f"gradient_{source.node.gradient_type.lower()}"
    return b.shared(
        node_key(source, "gradient"),
        lambda: b.call("float", name, texture_vector(b, source), file=_FILE, low=0.0, high=1.0),
    )


def _scaled(b: Builder, source: Source) -> str:
    return f"{texture_vector(b, source).text} * {b.input(source, 'Scale', 'float').text}"


def _numbers(b: Builder, source: Source, *names: str) -> list[Expression]:
    return [b.input(source, name, "float") for name in names]


NODES: Mapping[str, Handler] = {
    "TEX_WAVE": _wave,
    "TEX_MAGIC": _magic,
    "TEX_BRICK": _brick,
    "TEX_CHECKER": _checker,
    "TEX_GRADIENT": _gradient,
}
