# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2020 Blender Authors (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture's single scattering: a port of `sky_single_scattering.cpp` of Cycles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

type Array = NDArray[np.float64]

WIDTH, HEIGHT = 512, 256
"""Of the table of a sky"""
_RAYLEIGH_SCALE, _MIE_SCALE = 8e3, 1.2e3
_MIE_COEFFICIENT = 2e-5
_MIE_G = 0.76
_EARTH_RADIUS, _ATMOSPHERE_RADIUS = 6360e3, 6420e3
_STEPS = 32
_STEP_LAMBDA = 20.0
# By wavelength, 380 to 780 nm: irradiance of the sun (W/m2/nm), scattering by air and absorption by ozone (1/m).
_IRRADIANCE = np.array(
    (
        *(1.45756829855593, 1.5659630555973838, 1.6514844906767046, 1.7149624273720931, 1.7579798380502054),
        *(1.7825640788592454, 1.7909510847583856, 1.7854155013341066, 1.7681555486430685, 1.741220696472504),
        *(1.7064712716494368, 1.6655608745273989, 1.6199343724245185, 1.5708359736889208, 1.5193233505930548),
        *(1.466284949652144, 1.4124585274017245, 1.358449619703841, 1.3047491384473928, 1.2517496327261082),
        1.1997599875542062,
    )
)
_RAYLEIGH = 1e-5 * np.array(
    (
        *(5.424820087636473, 4.418549866505454, 3.635151910165377, 3.017929012024763, 2.526320226989157),
        *(2.130859310621843, 1.809838025320633, 1.547057129129042, 1.33028497733685, 1.150184784075764),
        *(0.999557429990163, 0.872799973630707, 0.765513700977967, 0.674217203751443, 0.596134125832052),
        *(0.52903459806581, 0.471115687557433, 0.420910481110487, 0.377218381260133, 0.33905125547728),
        0.305591531679811,
    )
)
_OZONE = 1e-6 * np.array(
    (
        *(0.00325126849861, 0.00585395365047, 0.01977191155085, 0.07309568762914, 0.20084561514287),
        *(0.40383958096161, 0.63551335912363, 0.96707041180970, 1.54797400424410, 2.09038647223331),
        *(2.46128056164565, 2.73551299461512, 2.15125863128643, 1.59051840791988, 1.12356197979857),
        *(0.73527551487574, 0.46450130357806, 0.33096079921048, 0.22512612292678, 0.14879129266490),
        0.16828623364192,
    )
)
_XYZ = np.array(
    (
        *((0.001368, 3.9e-05, 0.006450001), (0.01431, 0.000396, 0.06785001), (0.13438, 0.004, 0.6456)),
        *((0.34828, 0.023, 1.74706), (0.2908, 0.06, 1.6692), (0.09564, 0.13902, 0.8129501)),
        *((0.0049, 0.323, 0.272), (0.06327, 0.71, 0.07824999), (0.2904, 0.954, 0.0203)),
        *((0.5945, 0.995, 0.0039), (0.9163, 0.87, 0.001650001), (1.0622, 0.631, 0.0008)),
        *((0.8544499, 0.381, 0.00019), (0.4479, 0.175, 2e-05), (0.1649, 0.061, 0.0)),
        *((0.04677, 0.017, 0.0), (0.01135916, 0.004102, 0.0), (0.002899327, 0.001047, 0.0)),
        *((0.0006900786, 0.0002492, 0.0), (0.0001661505, 6e-05, 0.0), (4.150994e-05, 1.499e-05, 0.0)),
    )
)
# Gauss-Laguerre, scaled so that the last node is still within the atmosphere.
_NODES = (
    *(0.006811185292, 0.03614807107, 0.09004346519, 0.1706680068),
    *(0.2818362161, 0.4303406404, 0.6296271457, 0.9145252695),
)
_WEIGHTS = (
    *(0.01750893642, 0.04135477391, 0.06678839063, 0.09507698807),
    *(0.1283416365, 0.1707430204, 0.2327233347, 0.3562490486),
)


def sky_table(elevation: float, altitude: float, air: float, aerosol: float, ozone: float) -> Array:
    """(HEIGHT, WIDTH / 2, 3) XYZ of the sky by elevation and azimuth from the sun's other side to the sun's."""
    half_height, half_width = HEIGHT // 2, WIDTH // 2
    start = _EARTH_RADIUS + min(max(altitude, 1.0), 59999.0)
    latitude = 0.5 * np.pi * (np.arange(half_height) / half_height) ** 2
    longitude = 2.0 * np.pi / WIDTH * np.arange(half_width) - np.pi
    upwards, flat = np.sin(latitude), np.cos(latitude)
    to_end = _to_atmosphere(start, upwards)
    step = to_end / _STEPS
    sun_flat, sun_up = np.cos(elevation), np.sin(elevation)
    # (directions, 1 or half_width)
    across = flat[:, None] * np.cos(longitude)
    cosine = across * sun_flat + (upwards * sun_up)[:, None]
    rayleigh = 0.1875 / np.pi * (1.0 + cosine**2)
    g2 = _MIE_G**2
    mie = 3.0 * (1.0 - g2) * (1.0 + cosine**2) / (8.0 * np.pi * (2.0 + g2) * (1.0 + g2 - 2.0 * _MIE_G * cosine) ** 1.5)
    scale = np.array((air, aerosol, ozone))
    found = np.zeros((half_height, half_width, 3), np.float32)
    weights = (_IRRADIANCE[:, None] * _XYZ * _STEP_LAMBDA).astype(np.float32)
    extinction = np.stack([_RAYLEIGH, np.full(len(_RAYLEIGH), 1.11 * _MIE_COEFFICIENT), _OZONE]).astype(np.float32)
    depth = np.zeros((half_height, 3))
    for index in range(_STEPS):
        along = (index + 0.5) * step
        radius = np.sqrt(start**2 + 2.0 * start * along * upwards + along**2)
        density = scale * _densities(radius - _EARTH_RADIUS)
        depth = depth + step[:, None] * density
        # Cosine of the sun's zenith distance there.
        sun = (along[:, None] * cosine + start * sun_up) / radius[:, None]
        light = scale * _optical_depth(np.broadcast_to(radius[:, None], sun.shape), sun)
        is_lit = ~_meets_earth(radius[:, None], along[:, None] * across, (start + along * upwards)[:, None], elevation)
        total = (depth[:, None, :] + light).astype(np.float32)
        dimmed = np.exp(-(total.reshape(-1, 3) @ extinction)).reshape(*sun.shape, -1)
        dimmed *= (is_lit * step[:, None])[..., None].astype(np.float32)
        by_air = dimmed @ (_RAYLEIGH[:, None].astype(np.float32) * weights)
        by_dust = dimmed @ (np.float32(_MIE_COEFFICIENT) * weights)
        found += (density[:, None, :1] * rayleigh[..., None]).astype(np.float32) * by_air
        found += (density[:, None, 1:2] * mie[..., None]).astype(np.float32) * by_dust
    below = np.sin(0.5 * np.pi * (np.arange(half_height) / half_height - 1.0) ** 2)
    fade = np.where(below < 0.4, np.maximum(1.0 - 2.5 * below, 0.0) ** 3, 0.0)
    return np.concatenate([fade[:, None, None] * found[:1], found]).astype(np.float64)


def sun_ends(elevation: float, size: float, altitude: float, air: float, aerosol: float) -> tuple[Array, Array]:
    """XYZ (3,) of the radiance of a sun of this angular diameter at its lowest and its highest point."""
    start = _EARTH_RADIUS + min(max(altitude, 1.0), 59999.0)
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(0.5 * size))
    if elevation + 0.5 * size <= 0.0:
        return np.zeros(3), np.zeros(3)
    ends = []
    for place in (elevation - 0.5 * size, elevation + 0.5 * size):
        depth = _optical_depth(np.array([start]), np.array([np.sin(max(place, 0.0))]))[0]
        lost = _RAYLEIGH * depth[0] * air + 1.11 * _MIE_COEFFICIENT * depth[1] * aerosol
        ends.append(_STEP_LAMBDA * (_IRRADIANCE * np.exp(-lost) / solid_angle) @ _XYZ)
    return ends[0], ends[1]


def _densities(height: Array) -> Array:
    """(..., 3) of air, aerosol and ozone at heights (...) in meters, as a share of the densest."""
    ozone = np.maximum(0.0, 1.0 - np.abs(height - 25000.0) / 15000.0)
    return np.stack([np.exp(-height / _RAYLEIGH_SCALE), np.exp(-height / _MIE_SCALE), ozone], axis=-1)


def _to_atmosphere(radius: Array | float, cosine: Array) -> Array:
    """Distance to the atmosphere's end from a radius in a direction at this cosine to the zenith."""
    along = radius * cosine
    return np.sqrt(along**2 + _ATMOSPHERE_RADIUS**2 - np.square(radius)) - along


def _optical_depth(radius: Array, cosine: Array) -> Array:
    """(..., 3) from radii (...) in directions at these cosines to the zenith."""
    length = _to_atmosphere(radius, cosine)
    result = np.zeros((*length.shape, 3))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        along = node * length
        result += weight * _densities(np.sqrt(radius**2 + along * (2.0 * radius * cosine + along)) - _EARTH_RADIUS)
    return result * length[..., None]


def _meets_earth(radius: Array, across: Array, up: Array, elevation: float) -> Array:
    """Whether a ray to the sun meets the earth: `across` and `up` of its start, towards the sun and to the zenith."""
    if elevation >= 0.0:
        return np.zeros(np.broadcast(radius, across, up).shape, bool)
    along = across * np.cos(elevation) + up * np.sin(elevation)
    return along**2 - radius**2 + _EARTH_RADIUS**2 >= 0.0
