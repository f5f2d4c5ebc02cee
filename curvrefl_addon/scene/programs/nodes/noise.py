# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise, White Noise and Gabor Texture."""

from __future__ import annotations

from collections.abc import Mapping

from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression
from .coordinates import node_key, place, texture_vector

_NOISE = "nodes/noise.glsl"
_GABOR = "nodes/gabor.glsl"
_HASH = "nodes/texture_hash.glsl"

_KINDS_WITH = {
    "Offset": ("HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"),
    "Gain": ("HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL"),
}
"""Inputs that not all kinds of noise have"""
_COLOR_SEEDS = {
    1: ("NOISE_LINE_SEEDS.y", "NOISE_LINE_SEEDS.z"),
    2: ("NOISE_SEED_2", "NOISE_SEED_3"),
    3: ("NOISE_SEED_3", "NOISE_SEED_4"),
    4: ("NOISE_SEED_4", "NOISE_SEED_5"),
}
"""Of green and blue, by dimensions"""


def _noise(b: Builder, source: Source) -> Expression:
    factor, octaves = _noise_octaves(b, source)
    if source.socket.identifier == "Fac":
        return factor
    seeds = _COLOR_SEEDS[_dimensions(source)]

    def color() -> Expression:
        rest = ", ".join(octaves.format(f" + {seed}") for seed in seeds)
        return b.made("color", f"vec3({factor.text}, {rest})")

    return b.shared(node_key(source, "color"), color)


def _noise_octaves(b: Builder, source: Source) -> tuple[Expression, str]:
    """The factor, and a call that gives it at a place that is `{}` away."""
    node = source.node
    dimensions = _dimensions(source)
    b.include(_NOISE)

    def at() -> Expression:
        vector = "" if dimensions == 1 else texture_vector(b, source).text
        start = place(b, source, dimensions, vector, b.input(source, "Scale", "float").text)
        if b.constant_of(source, "Distortion") == (0.0,):
            return start
        return b.call("vec4", "noise_distorted", start, dimensions, b.input(source, "Distortion", "float"))

    where = b.shared(node_key(source, "place"), at).text
    kind = node.noise_type
    detail, roughness, lacunarity, offset, gain = (
        b.input(source, name, "float").text if kind in _KINDS_WITH.get(name, (kind,)) else "0.0"
        for name in ("Detail", "Roughness", "Lacunarity", "Offset", "Gain")
    )
    name = f"noise_{kind.lower()}{'_normalized' if kind == 'FBM' and node.normalize else ''}"
    numbers = f"clamp({detail}, 0.0, 15.0), max({roughness}, 0.0), {lacunarity}, {offset}, {gain}"
    call = f"{name}({where}{{}}, {dimensions}, {numbers})"
    return b.shared(node_key(source, "factor"), lambda: b.made("float", call.format(""))), call


def _white_noise(b: Builder, source: Source) -> Expression:
    dimensions = _dimensions(source)
    vector = "" if dimensions == 1 else b.input(source, "Vector", "vector").text
    where = b.shared(node_key(source, "place"), lambda: place(b, source, dimensions, vector)).text
    key = where + {1: ".x", 2: ".xy", 3: ".xyz", 4: ""}[dimensions]
    if source.socket.identifier == "Value":
        return b.call("float", "hash_unit", key, file=_HASH, low=0.0, high=1.0)
    return b.call("color", "hash_color", key, file=_HASH, low=0.0, high=1.0)


def _gabor(b: Builder, source: Source) -> Expression:
    name = source.socket.identifier.lower()
    phasor = b.shared(node_key(source, "phasor"), lambda: _gabor_phasor(b, source))
    bounds = {"phase": (0.0, 1.0), "intensity": (0.0, float("inf"))}.get(name, (-float("inf"), float("inf")))
    return b.call("float", f"gabor_{name}", phasor, file=_GABOR, low=bounds[0], high=bounds[1])


def _gabor_phasor(b: Builder, source: Source) -> Expression:
    """(cosine, sine, what they are divided by)"""
    is_flat = source.node.gabor_type == "2D"
    vector, scale = texture_vector(b, source).text, b.input(source, "Scale", "float").text
    turned = b.input(source, f"Orientation {source.node.gabor_type}", "float" if is_flat else "vector")
    return b.call(
        "vector",
        "gabor_plane" if is_flat else "gabor_space",
        f"{vector}{'.xy' if is_flat else ''} * {scale}",
        b.input(source, "Frequency", "float"),
        b.input(source, "Anisotropy", "float"),
        turned,
        file=_GABOR,
    )


def _dimensions(source: Source) -> int:
    return int(source.socket.node.noise_dimensions[0])


NODES: Mapping[str, Handler] = {"TEX_NOISE": _noise, "TEX_WHITE_NOISE": _white_noise, "TEX_GABOR": _gabor}
