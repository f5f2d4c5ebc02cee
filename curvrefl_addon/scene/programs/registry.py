# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All nodes that programs know, by their type: the tables of the files in `nodes`."""

from __future__ import annotations

from collections.abc import Mapping

from .builder import Handler
from .nodes import images, noise, patterns, photometry, skies, strands, voronoi
from .nodes.values import bumps, colors, numbers, parts, places, plain, ramps, surface, vectors

HANDLERS: Mapping[str, Handler] = {
    **images.NODES,
    **noise.NODES,
    **patterns.NODES,
    **voronoi.NODES,
    **skies.NODES,
    **photometry.NODES,
    **strands.NODES,
    **numbers.NODES,
    **vectors.NODES,
    **colors.NODES,
    **ramps.NODES,
    **places.NODES,
    **surface.NODES,
    **bumps.NODES,
    **plain.NODES,
    **parts.NODES,
}
