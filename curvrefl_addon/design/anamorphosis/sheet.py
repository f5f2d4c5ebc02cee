# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet to print: an anamorphosis on a flat surface at its size, and where on it the mirror stands. Pure numpy."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...scene.arrays import Float64Array, SceneArrays
from ..ways import Ways
from .picture import Picture
from .placed import Anamorphosis, Placed
from .png_file import INCH, png_bytes

MILLIMETERS = 1000.0
FLAT = 1e-4
"""Of its size that a surface may be off a plane"""
BORDER = 8.0
"""Millimeters around what is on the sheet"""
MOST_PIXELS = 16384
"""Along a side"""
LINES = 10
"""Of the bent grid, along each side of the picture"""
JUST_ABOVE = 1e-3
"""Height above its lowest point, in parts of its size, at which the mirror's outline is taken"""
RULER = 50.0
"""Millimeters"""


@dataclass(frozen=True, slots=True)
class Paper:
    """How a sheet is printed."""

    dots_per_inch: float = 300.0
    width: float = 0.0
    """Millimeters of the sheet; 0: at true size"""
    meters: float = 1.0
    """Of a unit of the scene"""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A printed anamorphosis. Places in millimeters from its lower left corner."""

    size: Float64Array
    """(2,) width and height"""
    scale: float
    """Millimeters printed for each of the scene"""
    placed: Placed
    paper: Paper
    outline: tuple[Float64Array, ...]
    """(n, 2) each: the picture's edges, as far as they land on it"""
    grid: tuple[Float64Array, ...]
    """(n, 2) each: lines of the picture"""
    footprint: Float64Array
    """(m, 2, 2) ends of pieces of the mirror's outline just above the surface"""
    is_encoded: bool

    @property
    def footprint_size(self) -> Float64Array:
        """(2,) width and depth of the mirror where it stands, as printed."""
        return np.asarray(np.ptp(self.footprint.reshape(-1, 2), axis=0), np.float64)

    def png(self) -> bytes:
        """The picture alone, with its size."""
        from ...scene.camera.srgb import linear_to_srgb

        pixels = self.placed.pixels
        if not self.is_encoded:
            pixels = np.concatenate([linear_to_srgb(np.clip(pixels[..., :3], 0.0, 1.0)), pixels[..., 3:]], axis=2)
        return png_bytes(pixels, self.paper.dots_per_inch)

    def svg(self, name: str, with_picture: bool = True) -> str:
        """The sheet with lines to cut along, the mirror's outline, and a ruler to check the print by; instead of the
        picture lines of a grid where it is not wanted."""
        width, height = self.size
        parts = [
            '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
            f'width="{width:.3f}mm" height="{height:.3f}mm" viewBox="0 0 {width:.3f} {height:.3f}">',
            f"<title>{escape(name)}</title>",
        ]
        if with_picture:
            data = b64encode(self.png()).decode("ascii")
            box = f'x="0" y="0" width="{width:.3f}" height="{height:.3f}"'
            parts.append(
                f'<image id="picture" {box} preserveAspectRatio="none" xlink:href="data:image/png;base64,{data}"/>'
            )
        else:
            parts.append(_drawn("grid", self.grid, height, "#000", 0.2))
        parts.append(_drawn("cut", self.outline, height, "#d00000", 0.25, ' stroke-dasharray="2 1"'))
        parts.append(_drawn("mirror", list(self.footprint), height, "#0060d0", 0.35))
        y = height - 0.5 * BORDER
        ruler = np.array([[BORDER, height - y], [BORDER + min(RULER, width - 2.0 * BORDER), height - y]])
        parts.append(_drawn("ruler", [ruler], height, "#000", 0.3))
        across = f"{self.footprint_size[0]:.1f} x {self.footprint_size[1]:.1f} mm"
        text = f"{ruler[1, 0] - ruler[0, 0]:.0f} mm. Blue: the mirror, {across}. Red: cut here. This side to the eye."
        parts.append(f'<text x="{ruler[1, 0] + 2.0:.3f}" y="{y + 1.0:.3f}" font-size="3">{escape(text)}</text>')
        return "\n".join([*parts, "</svg>\n"])


def sheet_of(
    anamorphosis: Anamorphosis,
    scene: SceneArrays,
    object_id: int,
    name: str,
    eye: Float64Array,
    picture: Picture,
    paper: Paper,
) -> Sheet:
    """The part of a flat surface, by its object_id and `name`, that shows the picture. `eye` (3,): where that is seen
    from; the sheet's lower side is towards it.

    Raises InputError where the surface shows nothing, is not flat there, or the sheet is too large.
    """
    here = anamorphosis.on(object_id)
    within = here & anamorphosis.within
    if within.sum() < 3:
        raise InputError(f'Nothing of the picture lands on "{name}": choose another surface, or move the frame.')
    plane = _plane_of(anamorphosis.ways.end[within], eye, name)
    flat = plane.flattened(anamorphosis.ways.end)
    feet = _footprint(scene, anamorphosis.mirrors, plane)
    ends = np.concatenate([flat[within], feet.reshape(-1, 2)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    scale = MILLIMETERS * paper.meters
    if paper.width:
        if paper.width <= 2.0 * BORDER:
            raise InputError(f"A sheet of {paper.width:g} mm has no room: make it wider than {2.0 * BORDER:g} mm.")
        scale = (paper.width - 2.0 * BORDER) / float(high[0] - low[0])
    size = (high - low) * scale + 2.0 * BORDER
    width, height = (int(np.ceil(side / MILLIMETERS / INCH * paper.dots_per_inch)) for side in size.tolist())
    if max(width, height) > MOST_PIXELS:
        raise InputError(
            f"The sheet of {size[0]:.0f} x {size[1]:.0f} mm has {width} x {height} pixels, "
            f"more than {MOST_PIXELS} a side: choose a width of the print, or fewer dots per inch."
        )
    places = (flat - low) * scale + BORDER
    # (Whole pixels: the sheet grows by less than one.)
    size = np.array([width, height]) / paper.dots_per_inch * INCH * MILLIMETERS

    def to_image(ways: Ways) -> Float64Array:
        return np.asarray(((plane.flattened(ways.end) - low) * scale + BORDER) / size, np.float64)

    placed = anamorphosis.placed(object_id, to_image, width, height, picture)
    lattice, known = places.reshape(*anamorphosis.shape, 2), here.reshape(anamorphosis.shape)
    return Sheet(
        size,
        scale / (MILLIMETERS * paper.meters),
        placed,
        paper,
        tuple(_lines(anamorphosis, lattice, known, 1)),
        tuple(_lines(anamorphosis, lattice, known, LINES)),
        (feet - low) * scale + BORDER,
        picture.is_encoded,
    )


@dataclass(frozen=True, slots=True)
class _Plane:
    origin: Float64Array
    axes: Float64Array
    """(3, 3) rows: along the sheet, up the sheet (away from the eye), towards the side that is seen"""

    def flattened(self, points: Float64Array) -> Float64Array:
        return np.asarray((points - self.origin) @ self.axes[:2].T, np.float64)

    def heights(self, points: Float64Array) -> Float64Array:
        return np.asarray((points - self.origin) @ self.axes[2], np.float64)


def _plane_of(points: Float64Array, eye: Float64Array, name: str) -> _Plane:
    middle = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - middle, full_matrices=False)
    normal = axes[2] * (1.0 if (eye - middle) @ axes[2] >= 0.0 else -1.0)
    if np.abs((points - middle) @ normal).max() > FLAT * np.ptp(points, axis=0).max():
        raise InputError(f'"{name}" is not flat where the picture is: only flat surfaces can be printed.')
    away = middle - eye
    away = away - (away @ normal) * normal
    length = np.linalg.norm(away)
    up = away / length if length > 1e-9 * extents[0] else axes[1]
    return _Plane(middle, np.stack([np.cross(up, normal), up, normal]))


def _footprint(scene: SceneArrays, mirrors: set[int], plane: _Plane) -> Float64Array:
    """(m, 2, 2) where the mirrors' triangles cross a plane just above the lowest of their points."""
    corners = []
    for item in scene.instances:
        if item.object_id in mirrors:
            mesh = scene.meshes[item.mesh]
            positions = mesh.positions.astype(np.float64) @ item.matrix[:3, :3].T + item.matrix[:3, 3]
            corners.append(positions[mesh.corner_vertex[mesh.triangles]])
    found = []
    for triangles in corners:
        heights = plane.heights(triangles)
        heights = heights - (
            heights.min() + JUST_ABOVE * max(float(np.ptp(triangles.reshape(-1, 3), axis=0).max()), 1e-30)
        )
        flat = plane.flattened(triangles)
        above = heights > 0.0
        ends = []
        for k in range(3):
            other = (k + 1) % 3
            crosses = above[:, k] != above[:, other]
            share = heights[:, k] / np.where(crosses, heights[:, k] - heights[:, other], 1.0)
            point = flat[:, k] + share[:, None] * (flat[:, other] - flat[:, k])
            ends.append(np.where(crosses[:, None], point, np.nan))
        crossed = np.stack(ends, axis=1)
        some = np.isfinite(crossed[..., 0]).sum(axis=1) == 2
        pair = crossed[some]
        found.append(pair[np.isfinite(pair[..., 0])].reshape(-1, 2, 2))
    return np.concatenate(found)


def _lines(
    anamorphosis: Anamorphosis, places: Float64Array, known: NDArray[np.bool_], parts: int
) -> list[Float64Array]:
    """Lines of the picture that part it so many times along each side, its edges included."""
    found = []
    rows, columns = anamorphosis.lines(parts)
    first_row, last_row, first_column, last_column = rows[0], rows[-1], columns[0], columns[-1]
    for row in rows:
        some = slice(first_column, last_column + 1)
        found += _runs(places[row, some], known[row, some])
    for column in columns:
        some = slice(first_row, last_row + 1)
        found += _runs(places[some, column], known[some, column])
    return found


def _runs(line: Float64Array, known: NDArray[np.bool_]) -> list[Float64Array]:
    """Pieces of a line between places that are not known."""
    ends = np.flatnonzero(np.diff(np.concatenate([[0], known.astype(np.int8), [0]])))
    return [line[start:end] for start, end in ends.reshape(-1, 2).tolist() if end - start > 1]


def _drawn(
    name: str,
    lines: tuple[Float64Array, ...] | list[Float64Array],
    height: float,
    color: str,
    width: float,
    more: str = "",
) -> str:
    """A group with a path of these lines; SVG has its origin at the upper left."""
    path = " ".join(
        "M" + " L".join(f"{x:.3f},{height - y:.3f}" for x, y in line.tolist()) for line in lines if len(line)
    )
    return f'<path id="{name}" d="{path}" fill="none" stroke="{color}" stroke-width="{width}"{more}/>'
