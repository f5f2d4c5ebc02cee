# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What random trees are made of: nodes with the settings and the ranges of constants that they may have."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from .cases.colors import BLENDS
from .stage import MakeTree
from .trees import ACROSS, DAMP, GLOW, PAINT, PLACE, UP, UV, WIND, shader_node

LEAVES: Mapping[str, tuple[MakeTree, float]] = {
    "across": (ACROSS, 2.0),
    "up": (UP, 2.0),
    "damp": (DAMP, 1.0),
    "wind": (WIND, 1.6),
    "paint": (PAINT, 1.0),
    "glow": (GLOW, 1.6),
    "place": (PLACE, 2.0),
    "uv": (UV, 1.6),
    "generated": (shader_node("TexCoord", output="Generated"), 1.0),
    "normal": (shader_node("NewGeometry", output="Normal"), 1.0),
    "facing": (shader_node("LayerWeight", output="Facing"), 1.0),
    "random": (shader_node("ObjectInfo", output="Random"), 1.0),
}
"""What varies over a tile, with what it never exceeds"""
ROUGHLY_KNOWN: Mapping[str, float] = {"normal": 40.0, "facing": 80.0}
"""How much larger errors are there: Cycles packs normals into 32 bits"""


@dataclass(frozen=True, slots=True)
class Recipe:
    """A kind of node."""

    kind: str
    settings: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    gain: float = 2.0
    """How much steeper it makes its inputs at most"""
    bound: float = 1.0
    has_poles: bool = False
    has_steps: bool = False
    """Somewhere it jumps, or is too steep: only its first input is linked, to nothing flat"""
    is_flat: bool = False
    """Its values are the same over areas"""
    range: tuple[float, float] = (-1.5, 1.5)
    """Of constants"""
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """By input; what is linked there is brought into it too"""
    constants: frozenset[str] = frozenset()
    """Inputs that are never linked"""
    linked: frozenset[str] = frozenset()
    """Inputs that are always linked"""
    not_judged: frozenset[str] = frozenset()
    """Outputs that are left out"""
    may_be_muted: bool = True
    adjust: Callable[[Any, random.Random], None] | None = None


def _ramp(node: Any, chance: random.Random) -> None:
    ramp = node.color_ramp
    ramp.interpolation = chance.choice(("LINEAR", "EASE", "CARDINAL", "B_SPLINE"))
    for element in ramp.elements:
        element.color = [chance.random() for _ in range(4)]
    ramp.elements.new(chance.uniform(0.2, 0.8)).color = [chance.random() for _ in range(4)]


def _curve(node: Any, chance: random.Random) -> None:
    for curve in node.mapping.curves:
        curve.points.new(chance.uniform(0.3, 0.7), chance.random())
    node.mapping.update()


UNIT = (0.0, 1.0)
SCALE = {"Scale": (0.3, 1.5), "Detail": (0.0, 2.0), "Roughness": (0.2, 0.8), "Lacunarity": (1.5, 2.2)}
DIMENSIONS = ("1D", "2D", "3D", "4D")
VECTOR = frozenset({"Vector"})
SMOOTH = ("SINE", "COSINE", "ABSOLUTE", "ARCTANGENT", "TANH", "RADIANS")
TWO = ("ADD", "SUBTRACT", "MULTIPLY", "MINIMUM", "MAXIMUM", "MULTIPLY_ADD", "SMOOTH_MIN", "SMOOTH_MAX")
POLES = ("DIVIDE", "POWER", "SQRT", "EXPONENT", "SINH", "TANGENT", "COSH", "INVERSE_SQRT")
STEPS = ("LESS_THAN", "GREATER_THAN", "FLOOR", "CEIL", "ROUND", "SIGN", "SNAP", "TRUNC", "FRACT", "MODULO", "PINGPONG")
RECIPES: Sequence[Recipe] = (
    Recipe("Math", {"operation": SMOOTH}, bound=4.0),
    Recipe("Math", {"operation": TWO, "use_clamp": (False, False, True)}, bound=20.0, gain=4.0),
    Recipe("Math", {"operation": POLES}, has_poles=True, gain=12.0),
    Recipe("Math", {"operation": ("LOGARITHM",)}, has_poles=True, has_steps=True, gain=12.0),
    Recipe("Math", {"operation": STEPS}, has_steps=True, is_flat=True, bound=6.0),
    Recipe(
        "VectorMath",
        {"operation": ("ADD", "SUBTRACT", "MULTIPLY", "MULTIPLY_ADD", "CROSS_PRODUCT")},
        bound=34.0,
        gain=8.0,
    ),
    Recipe("VectorMath", {"operation": ("SINE", "COSINE", "ABSOLUTE", "MINIMUM", "MAXIMUM")}, bound=4.0),
    Recipe("VectorMath", {"operation": ("DOT_PRODUCT", "LENGTH", "DISTANCE")}, bound=48.0, gain=12.0),
    Recipe("VectorMath", {"operation": ("DIVIDE", "PROJECT", "POWER", "TANGENT")}, has_poles=True, gain=12.0),
    Recipe("VectorMath", {"operation": ("FLOOR", "SNAP", "FRACTION", "WRAP")}, has_steps=True, is_flat=True, bound=6.0),
    Recipe("Clamp", {"clamp_type": ("MINMAX", "RANGE")}, bound=4.0, is_flat=True),
    Recipe(
        "MapRange",
        {"interpolation_type": ("LINEAR", "SMOOTHSTEP", "SMOOTHERSTEP"), "data_type": ("FLOAT", "FLOAT_VECTOR")},
        bound=4.0,
        gain=4.0,
        is_flat=True,
        constants=frozenset({"From Min", "From Max"}),
        ranges={"From Min": (-1.5, -0.5), "From Max": (0.5, 1.5)},
    ),
    Recipe(
        "Mix",
        {
            "data_type": ("RGBA",),
            "blend_type": [
                name for name in BLENDS if name not in ("HUE", "SATURATION", "COLOR", "DIVIDE", "BURN", "DODGE")
            ],
        },
        bound=24.0,
        gain=8.0,
        range=UNIT,
    ),
    Recipe(
        "Mix",
        {"data_type": ("RGBA",), "blend_type": ("DIVIDE", "BURN", "DODGE")},
        has_poles=True,
        gain=12.0,
        range=UNIT,
    ),
    Recipe("Mix", {"data_type": ("FLOAT", "VECTOR"), "factor_mode": ("UNIFORM", "NON_UNIFORM")}, bound=12.0, gain=4.0),
    Recipe("BrightContrast", bound=20.0, gain=6.0, range=UNIT),
    Recipe("Gamma", has_poles=True, gain=8.0, ranges={"Gamma": (0.4, 2.2)}),
    Recipe("Invert", bound=9.0, gain=3.0, range=UNIT),
    Recipe("RGBCurve", bound=3.0, gain=6.0, range=UNIT, adjust=_curve),
    Recipe("FloatCurve", bound=3.0, gain=6.0, range=UNIT, adjust=_curve),
    Recipe("ValToRGB", bound=1.5, gain=12.0, is_flat=True, adjust=_ramp),
    Recipe("SeparateXYZ", bound=4.0),
    Recipe("SeparateColor", {"mode": ("RGB",)}, bound=4.0),
    Recipe("CombineXYZ", bound=4.0),
    Recipe("CombineColor", {"mode": ("RGB", "HSV", "HSL")}, bound=16.0, gain=8.0, range=UNIT),
    Recipe("RGBToBW", bound=4.0),
    Recipe("Mapping", {"vector_type": ("POINT", "VECTOR")}, bound=30.0, gain=8.0, constants=frozenset({"Rotation"})),
    Recipe(
        "VectorRotate",
        {"rotation_type": ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"), "invert": (False, True)},
        bound=16.0,
        gain=10.0,
        constants=frozenset({"Axis"}),
    ),
    Recipe(
        "VectorTransform",
        {"vector_type": ("POINT", "VECTOR"), "convert_from": ("WORLD", "OBJECT", "CAMERA")},
        bound=40.0,
    ),
    Recipe(
        "TexNoise",
        {
            "noise_dimensions": DIMENSIONS,
            "noise_type": ("FBM", "MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"),
        },
        gain=24.0,
        bound=8.0,
        ranges={**SCALE, "Distortion": (0.0, 0.5), "Offset": UNIT, "Gain": UNIT},
        linked=VECTOR,
    ),
    Recipe(
        "TexVoronoi",
        {
            "voronoi_dimensions": DIMENSIONS[:3],
            "feature": ("F1", "F2", "SMOOTH_F1"),
            "distance": ("EUCLIDEAN", "MANHATTAN"),
        },
        gain=16.0,
        bound=6.0,
        has_steps=True,
        ranges={**SCALE, "Smoothness": UNIT, "Randomness": UNIT},
        linked=VECTOR,
        not_judged=frozenset({"Color", "Position", "W"}),
    ),
    Recipe(
        "TexWave",
        {"wave_type": ("BANDS", "RINGS"), "wave_profile": ("SIN", "TRI")},
        gain=40.0,
        ranges={
            "Scale": (0.1, 0.5),
            "Distortion": UNIT,
            "Detail": UNIT,
            "Detail Scale": UNIT,
            "Detail Roughness": UNIT,
        },
        linked=VECTOR,
    ),
    Recipe("TexMagic", gain=30.0, ranges={"Scale": (0.2, 0.6), "Distortion": (0.1, 1.0)}, linked=VECTOR),
    Recipe(
        "TexGradient",
        {"gradient_type": ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL")},
        is_flat=True,
        linked=VECTOR,
    ),
    Recipe("TexChecker", bound=4.0, has_steps=True, is_flat=True, ranges={"Scale": (0.5, 3.0)}, linked=VECTOR),
    Recipe(
        "TexBrick",
        bound=4.0,
        has_steps=True,
        is_flat=True,
        ranges={
            "Scale": (0.5, 2.0),
            "Mortar Size": (0.01, 0.1),
            "Mortar Smooth": UNIT,
            "Bias": UNIT,
            "Brick Width": (0.3, 0.8),
            "Row Height": (0.2, 0.4),
        },
        constants=frozenset({"Mortar Size", "Mortar Smooth", "Brick Width", "Row Height"}),
        gain=30.0,
        linked=VECTOR,
    ),
    Recipe("Fresnel", ranges={"IOR": (1.1, 2.5)}, constants=frozenset({"Normal"}), gain=4.0, may_be_muted=False),
    Recipe("LayerWeight", ranges={"Blend": (0.1, 0.9)}, constants=frozenset({"Normal"}), gain=4.0, may_be_muted=False),
)
