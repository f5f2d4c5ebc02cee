# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the diagnostic views mean: their names, their colors, and the legend that says so."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..optics.catalog import METHODS, label_of
from ..scene.arrays import Float32Array, Float64Array
from ..settings_choices import CURVATURE_CHOICES, DIAGNOSTIC_CHOICES, LOCK_CHOICES

type Color = tuple[float, float, float]

MODES = {choice.name: (choice.label, choice.text) for choice in DIAGNOSTIC_CHOICES}
"""Label and tooltip of each view, by the name that `DiagnosticPass.add` takes"""

SOLVED_MODES = frozenset({"ITERATIONS", "STATUS", "ANGLE_ERROR", "METHOD"})
"""The views of what the mirror shows; the others need the mirror's surface alone"""
LAMP_MODES = frozenset({"LINES", "HIGHLIGHTS"})
"""Patterns of lamps along the axis"""
NORMAL_MODES = frozenset({"ISOPHOTES", "HIGHLIGHTS"})
"""Patterns of the normal, not of the reflected ray"""
PATTERN_MODES = frozenset({"ZEBRA", "ISOPHOTES"}) | LAMP_MODES
"""Stripes, bands and lamps"""
CURVATURES = {choice.name: choice.label for choice in CURVATURE_CHOICES}
ONE_SIDED = "STRONGEST"
"""The curvature that is never below 0"""

RAMP_TEXELS = 256
GOLDEN_RATIO = 0.618034
"""Turns from one hue to the next: no two of a row of such hues fall together"""
_METHOD_PALETTE: tuple[Color, ...] = (
    (0.010, 0.235, 0.520),
    (0.800, 0.330, 0.010),
    (0.020, 0.420, 0.190),
    (0.600, 0.110, 0.400),
    (0.090, 0.460, 0.800),
    (0.660, 0.080, 0.020),
    (0.860, 0.720, 0.060),
    (0.350, 0.350, 0.350),
    (0.040, 0.040, 0.040),
    (0.450, 0.300, 0.900),
    (0.750, 0.600, 0.480),
    (0.000, 0.620, 0.560),
    (0.900, 0.450, 0.620),
)
"""Told apart by lightness too, as people with color blindness need; in the order of the catalog"""


@dataclass(frozen=True, slots=True)
class DiagnosticColors:
    """Colors of the diagnostic views, scene-linear Rec.709."""

    converged: Color = (0.015, 0.360, 0.300)
    hidden: Color = (0.880, 0.560, 0.040)
    failed: Color = (0.900, 0.015, 0.060)
    background: Color = (0.045, 0.045, 0.050)
    """Where the mirror shows nothing but the world"""
    ramp: tuple[Color, ...] = (
        (0.040, 0.003, 0.103),
        (0.034, 0.064, 0.370),
        (0.011, 0.274, 0.378),
        (0.098, 0.609, 0.189),
        (0.995, 0.838, 0.047),
    )
    """From the least to the most; the default's steps are equally light (OKLab L 0.28, 0.44, 0.6, 0.76, 0.93)"""
    two_sided: tuple[Color, ...] = (
        (0.012, 0.050, 0.290),
        (0.120, 0.370, 0.730),
        (0.800, 0.800, 0.780),
        (0.760, 0.210, 0.060),
        (0.270, 0.010, 0.020),
    )
    """From the most below 0 over 0 to the most above"""


@dataclass(frozen=True, slots=True)
class DiagnosticOptions:
    """What the views can be set to."""

    iterations: tuple[float, float] = (0.0, 20.0)
    """Ends of the ramp"""
    angles: tuple[float, float] = (0.01, 10.0)
    """Ends of the logarithmic ramp, degrees"""
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """Direction that stripes and bands lie around and lamps run along"""
    lock: str = "WORLD"
    """Whose axes that is in: the "WORLD", each mirror's "OBJECT", or the "VIEW" (right, up, towards the eye)"""
    stripes: int = 16
    """White bands from one end of the axis to the other, and as many black ones"""
    lines: int = 6
    """Lamps around the axis"""
    line_width: float = 4.0
    """Of a lamp seen from the side, degrees"""
    softness: float = 0.0
    """Share of the narrower of a bright and a dark band over which one turns into the other"""
    transparency: float = 0.0
    """Of patterns and curvature"""
    curvature: str = "MEAN"
    """A name of CURVATURES"""
    curvature_range: float = 0.0
    """At the end of the colors, 1 / m (Gaussian: 1 / m^2); 0: found from the mirrors"""
    directions: bool = False
    """Strokes along the principal directions"""
    point_size: float = 4.0
    """Diameter of a vertex in the status view, pixels; 0 leaves the vertices out"""

    def __post_init__(self) -> None:
        """Raises InputError for ranges that are empty and counts that are none."""
        if not self.iterations[0] < self.iterations[1]:
            raise InputError("The range of iterations is empty: make its end larger than its start.")
        if not 0.0 < self.angles[0] < self.angles[1]:
            raise InputError("The range of angles is empty: start above 0 degrees and end above the start.")
        if self.stripes < 1 or self.lines < 1:
            raise InputError("There is nothing to show with no stripes or lines: choose 1 or more.")
        if not 0.0 < self.line_width < 360.0:
            raise InputError(f"A line light {self.line_width} degrees wide is out of range: choose between 0 and 360.")
        if not (0.0 <= self.softness <= 1.0 and 0.0 <= self.transparency <= 1.0):
            raise InputError("Softness and transparency go from 0 to 1.")
        if not 0.0 <= self.curvature_range < np.inf:
            raise InputError("The range of curvature is no number above 0: choose one, or 0 for an automatic one.")
        if self.curvature not in CURVATURES:
            raise InputError(f'There is no curvature "{self.curvature}": choose one of {", ".join(CURVATURES)}.')
        if self.lock not in [choice.name for choice in LOCK_CHOICES]:
            raise InputError(f'Patterns cannot be locked to "{self.lock}": choose WORLD, OBJECT or VIEW.')
        if not np.isfinite(self.axis).all() or np.linalg.norm(self.axis) == 0.0:
            raise InputError("The axis of the stripes has no direction: choose one that is not zero.")

    @property
    def axes(self) -> Float64Array:
        """(3, 3) orthonormal rows: the axis, and two across it from which angles around the axis are counted.

        The second row points up as far as the axis lets it, or along +Y for a vertical axis.
        """
        axis = np.asarray(self.axis, np.float64)
        axis = axis / np.linalg.norm(axis)
        up = np.array([0.0, 0.0, 1.0]) if abs(axis[2]) < 0.999 else np.array([0.0, 1.0, 0.0])
        across = np.cross(up, axis)
        across /= np.linalg.norm(across)
        return np.array([axis, np.cross(axis, across), across])


def method_color(name: str) -> Color:
    """The catalog method's own color; hues that lie apart follow where the palette ends."""
    place = list(METHODS).index(name)
    if place < len(_METHOD_PALETTE):
        return _METHOD_PALETTE[place]
    return colorsys.hsv_to_rgb(place * GOLDEN_RATIO % 1.0, 0.75, 0.55)


def ramp_colors(stops: Sequence[Color], count: int = RAMP_TEXELS) -> Float32Array:
    """(count, 3) scene-linear colors from the first stop to the last, evenly spaced to the eye between stops.

    Interpolated in OKLab (Björn Ottosson, "A perceptual color space for image processing", 2020).
    """
    lab = np.cbrt(np.asarray(stops, np.float64) @ _RGB_TO_LMS.T) @ _LMS_TO_LAB.T
    where = np.linspace(0.0, len(stops) - 1.0, count)
    between = np.stack([np.interp(where, np.arange(len(stops)), channel) for channel in lab.T], axis=1)
    rgb = (between @ np.linalg.inv(_LMS_TO_LAB).T) ** 3 @ np.linalg.inv(_RGB_TO_LMS).T
    return np.maximum(rgb, 0.0).astype(np.float32)


def curvature_ramp(options: DiagnosticOptions, colors: DiagnosticColors) -> tuple[Color, ...]:
    """Stops of the colors of the curvature that is asked for."""
    return colors.ramp if options.curvature == ONE_SIDED else colors.two_sided


def rounded_up(value: float) -> float:
    """The next number with one or two digits that reads well on a scale; 1 for 0."""
    if not value > 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    steps = power * np.array([1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0])
    return float(steps[np.searchsorted(steps, value * (1.0 - 1e-6))])


_RGB_TO_LMS = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LMS_TO_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


@dataclass(frozen=True, slots=True)
class Legend:
    """What the colors of a view say; scene-linear colors."""

    title: str
    swatches: tuple[tuple[Color, str], ...] = ()
    ramp: tuple[Color, ...] = ()
    """Stops from left to right, or empty"""
    ticks: tuple[tuple[float, str], ...] = ()
    """Place along the ramp from 0 to 1, and what it says"""


def legend_of(
    mode: str,
    colors: DiagnosticColors,
    options: DiagnosticOptions,
    methods: Sequence[str] = (),
    curvature_end: float = 1.0,
) -> Legend | None:
    """The legend of a view; None for stripes, bands and lamps, which say nothing in color.

    `methods` are the catalog names that the mirrors are drawn with, `curvature_end` is what the last color stands for.
    """
    if mode == "CURVATURE":
        unit = "1/m²" if options.curvature == "GAUSSIAN" else "1/m"
        start = 0.0 if options.curvature == ONE_SIDED else -curvature_end
        marks = tuple((part, f"{start + part * (curvature_end - start):.3g}") for part in (0.0, 0.25, 0.5, 0.75, 1.0))
        return Legend(f"{CURVATURES[options.curvature]} Curvature, {unit}", (), curvature_ramp(options, colors), marks)
    background = (colors.background, "Background")
    if mode == "ITERATIONS":
        low, high = options.iterations
        ticks = tuple((part, f"{low + part * (high - low):g}") for part in (0.0, 0.25, 0.5, 0.75))
        return Legend("Solver Iterations", (background,), colors.ramp, (*ticks, (1.0, f"{high:g}+")))
    if mode == "ANGLE_ERROR":
        low, high = np.log10(options.angles)
        decades = [value for value in range(int(np.ceil(low - 1e-9)), int(np.floor(high + 1e-9)) + 1)]
        marks = tuple(((value - low) / (high - low), f"{10.0**value:g}°") for value in decades)
        return Legend("Angle Error", (), colors.ramp, marks)
    if mode == "STATUS":
        vertices = (
            (colors.converged, "Reflected"),
            (colors.hidden, "Hidden by the Mirror"),
            (colors.failed, "Not Found"),
        )
        return Legend("Vertex Status", (*vertices, background))
    if mode == "METHOD":
        used = tuple((method_color(name), label_of(name)) for name in METHODS if name in methods)
        return Legend("Method", (*used, background))
    return None
