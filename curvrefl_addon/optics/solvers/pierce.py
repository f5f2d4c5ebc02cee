# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the segment from the eye to a vertex first enters a star-shaped reflector.

A vertex behind the reflector has no reflection. The inverse search of Estalella et al. (2005, section 4.3; 2006,
section 3.4) gives it a place all the same, so that a triangle with one such vertex can be drawn: the condition of
their search, the bisector of the eye and of the vertex mirrored in the tangent plane, holds where the segment from
the eye to the vertex enters the reflector, and that point can be marched for.
"""

from __future__ import annotations

import numpy as np

from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit

MARCH_STEPS = 24
BISECTIONS = 14


def pierce(surface: RadialSurface, eye: Float64Array, vertices: Float64Array) -> tuple[np.ndarray, Float64Array]:
    """Whether the segment enters the reflector (n,), and the first point where it does (n, 3).

    eye (4,) homogeneous, vertices (n, 3), relative to the star center. The part of the segment inside the bounding
    sphere is marched in MARCH_STEPS equal steps: a fold thinner than a step is not found. Points (n, 3) mean
    nothing where nothing is pierced.
    """
    if len(vertices) == 0:
        return np.zeros(0, bool), np.zeros((0, 3))
    bound = surface.bound
    direction = unit(vertices * eye[3] - eye[:3])
    # Distances along the segment, measured from the vertex back towards the eye.
    nearest = np.einsum("ij,ij->i", vertices, direction)
    miss2 = np.einsum("ij,ij->i", vertices, vertices) - nearest**2
    half = np.sqrt(np.maximum(bound**2 - miss2, 0.0))
    last = np.maximum(nearest - half, 0.0)
    first = np.minimum(nearest + half, np.linalg.norm(eye[:3] - vertices, axis=1) if eye[3] else np.inf)

    def height(back: Float64Array) -> Float64Array:
        points = vertices - back[:, None] * direction
        length = np.linalg.norm(points, axis=1)
        # The star center itself has no direction; any will do, it is inside.
        points[length == 0.0] = (0.0, 0.0, 1.0)
        return length - surface.radius(unit(points))[0]

    outside, inside = first.copy(), first.copy()
    found = np.zeros(len(vertices), bool)
    crosses = (miss2 < bound**2) & (first > last)
    for step in range(1, MARCH_STEPS + 1):
        back = first + (last - first) * step / MARCH_STEPS
        enters = crosses & ~found & (height(back) < 0.0)
        inside[enters] = back[enters]
        found |= enters
        outside = np.where(crosses & ~found, back, outside)
    for _ in range(BISECTIONS):
        middle = 0.5 * (outside + inside)
        under = height(middle) < 0.0
        inside = np.where(under, middle, inside)
        outside = np.where(under, outside, middle)
    return found, vertices - outside[:, None] * direction
