# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture, with all its models."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from ...arrays import Float64Array
from ...materials.color_spaces import xyz_to_scene
from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression
from ..skies import daylight, multiple_scattering, single_scattering
from .coordinates import texture_vector

LEAST_SIZE = 0.0005
"""Of the sun's disc, radians: as in Cycles"""


def sky_texture(b: Builder, source: Source) -> Expression:
    """Radiance by direction."""
    node = source.node
    assert node is not None
    vector = texture_vector(b, source)
    apart = b.is_world and is_plain(b, source)
    first = b.table(xyz_to_scene(np.eye(3)).T)
    kind = node.sky_type
    if kind in ("PREETHAM", "HOSEK_WILKIE"):
        x, y, z = node.sun_direction.normalized()
        theta = float(np.arccos(np.clip(z, -1.0, 1.0)))
        if kind == "PREETHAM":
            numbers = daylight.preetham(theta, node.turbidity)
        else:
            numbers = daylight.hosek_wilkie(theta, node.turbidity, node.ground_albedo)
            theta = min(theta, 0.5 * np.pi)
        b.record(theta, float(np.arctan2(x, y)))
        b.table(numbers)
        function = "sky_preetham" if kind == "PREETHAM" else "sky_hosek"
        return b.call("color", function, f"s.records + {first}", vector, file="nodes/sky.glsl", low=0.0)
    elevation, rotation = sun_angles(node)
    size = max(float(node.sun_size), LEAST_SIZE)
    air, aerosol, ozone = (float(v) for v in (node.air_density, node.aerosol_density, node.ozone_density))
    altitude = float(node.altitude)
    if kind == "SINGLE_SCATTERING":
        lowest, highest = single_scattering.sun_ends(elevation, size, altitude, air, aerosol)
    else:
        lowest, highest = multiple_scattering.sun_ends(elevation, size, altitude, air, aerosol, ozone)
    b.record(elevation, rotation, size if node.sun_disc else -1.0, node.sun_intensity)
    b.record(*lowest, -multiple_scattering.horizon(altitude))
    b.record(*highest)
    b.table(_table(kind, elevation, altitude, air, aerosol, ozone))
    return b.call("color", "sky_scattered", f"s.records + {first}", vector, apart, file="nodes/sky.glsl", low=0.0)


def is_plain(b: Builder, source: Source) -> bool:
    """Whether a world's sky is looked up by the direction itself."""
    return not b.is_linked(source, "Vector") and texture_vector(b, source).text == "s.position"


def sun_angles(node: Any) -> tuple[float, float]:
    """Elevation from -pi/2 to pi/2 and rotation of the sun, as `SkyTextureNode::simplify_settings` of Cycles."""
    elevation = float(np.fmod(node.sun_elevation, 2.0 * np.pi))
    rotation = float(node.sun_rotation)
    if abs(elevation) >= np.pi:
        elevation -= float(np.copysign(2.0 * np.pi, elevation))
    if abs(elevation) >= 0.5 * np.pi:
        elevation = float(np.copysign(np.pi, elevation)) - elevation
        rotation += np.pi
    return elevation, 2.0 * np.pi - rotation % (2.0 * np.pi)


@lru_cache(maxsize=4)
def _table(kind: str, elevation: float, altitude: float, air: float, aerosol: float, ozone: float) -> Float64Array:
    make = single_scattering if kind == "SINGLE_SCATTERING" else multiple_scattering
    return make.sky_table(elevation, altitude, air, aerosol, ozone).reshape(-1, 3)


NODES: Mapping[str, Handler] = {"TEX_SKY": sky_texture}
