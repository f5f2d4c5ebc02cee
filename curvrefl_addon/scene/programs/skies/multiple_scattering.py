# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2022 Fernando García Liñán, 2011-2025 Blender Authors (MIT)
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture's multiple scattering: a port of `sky_multiple_scattering.cpp` of Cycles, by four wavelengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .single_scattering import HEIGHT, WIDTH

type Array = NDArray[np.float64]

_GROUND_ALBEDO = 0.3
_G = 0.8
_EARTH_RADIUS, _THICKNESS = 6371.0, 100.0
_ATMOSPHERE_RADIUS = _EARTH_RADIUS + _THICKNESS
_STEPS = 64
_COLUMNS, _ROWS = 256, 64
"""Of the table of transmittances"""
_IRRADIANCE = np.array((1.679, 1.828, 1.986, 1.307))
_MOLECULES = np.array((6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2))
_OZONE = np.array((3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27)) * 334.5
_AEROSOL_ABSORPTION = np.array((2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23))
_AEROSOL_SCATTERING = np.array((1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22))
_AEROSOL_DENSITY, _AEROSOL_BACKGROUND, _AEROSOL_SCALE = 1.3681e20, 2e6, 0.73
_XYZ = np.array(
    (
        (53.386917738564668023, 22.981337506691024754, 0.0),
        (43.904844466369358263, 71.347795700053393866, 0.102506867965741307),
        (1.6137278251608962005, 18.422960591455485011, 31.742921188390805758),
        (20.762668673810577145, 2.3614213523314368527, 110.48009643252140334),
    )
)


def sky_table(elevation: float, altitude: float, air: float, aerosol: float, ozone: float) -> Array:
    """(HEIGHT, WIDTH / 2, 3) XYZ of the sky by elevation and azimuth from the sun's other side to the sun's."""
    amounts = (air, aerosol, ozone)
    table = _transmittances(amounts).astype(np.float32)
    start = _EARTH_RADIUS + min(max(altitude, 1.0), 99999.0) / 1000.0
    level = (np.arange(HEIGHT) + 0.5) / HEIGHT * 2.0 - 1.0
    rise = np.copysign(level**2, level) * 0.5 * np.pi
    azimuth = 2.0 * np.pi * (np.arange(WIDTH // 2) + 0.5) / WIDTH
    upwards, flat = np.sin(rise), np.cos(rise)
    ground = _to_sphere(start, upwards, _EARTH_RADIUS)
    length = np.where(ground < 0.0, _to_sphere(start, upwards, _ATMOSPHERE_RADIUS), ground)
    sun_up = np.cos(0.5 * np.pi - elevation)
    sun_flat = -np.sqrt(1.0 - sun_up**2)
    across = flat[:, None] * np.cos(azimuth)
    cosine = -(across * sun_flat + (upwards * sun_up)[:, None])
    by_molecules = (3.0 / (16.0 * np.pi) * (1.0 + cosine**2)).astype(np.float32)
    spread = 1.0 + _G**2 + 2.0 * _G * cosine
    by_aerosol = (0.25 / np.pi * (1.0 - _G**2) / (spread * np.sqrt(spread))).astype(np.float32)
    step = length / _STEPS
    found = np.zeros((HEIGHT, WIDTH // 2, 4), np.float32)
    left = np.ones((HEIGHT, 4))
    for index in range(_STEPS):
        along = (index + 0.5) * step
        radius = np.sqrt(start**2 + 2.0 * start * along * upwards + along**2)
        height = np.maximum(radius - _EARTH_RADIUS, 0.0)
        sun = ((along[:, None] * -cosine + start * sun_up) / radius[:, None]).astype(np.float32)
        aerosol_absorbed, aerosol_scattered, molecules_absorbed, molecules_scattered = _coefficients(height, amounts)
        lost = aerosol_absorbed + aerosol_scattered + molecules_absorbed + molecules_scattered
        passed = np.exp(-step[:, None] * lost)
        share = left * (1.0 - passed) / np.maximum(lost, 1e-7) * _IRRADIANCE
        to_sun = _looked_up(table, sun, height / _THICKNESS)
        more = _multiple(table, sun, height / _THICKNESS, radius)
        found += (share * molecules_scattered).astype(np.float32)[:, None] * (by_molecules[..., None] * to_sun + more)
        found += (share * aerosol_scattered).astype(np.float32)[:, None] * (by_aerosol[..., None] * to_sun + more)
        left *= passed
    return found.astype(np.float64) @ _XYZ


def sun_ends(
    elevation: float, size: float, altitude: float, air: float, aerosol: float, ozone: float
) -> tuple[Array, Array]:
    """XYZ (3,) of the radiance of a sun of this angular diameter at its lowest and its highest point."""
    height = min(max(altitude, 1.0), 99999.0) / 1000.0
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(0.5 * size))
    places = np.sin([elevation - 0.5 * size, elevation + 0.5 * size])
    passed = _transmittance(np.full(2, _EARTH_RADIUS + height), places, (air, aerosol, ozone))
    ends = (_IRRADIANCE * passed / solid_angle) @ _XYZ
    return ends[0], ends[1]


def horizon(altitude: float) -> float:
    """How far below the horizon the earth begins at an altitude in meters, radians."""
    return float(0.5 * np.pi - np.arcsin(_EARTH_RADIUS / (_EARTH_RADIUS + altitude / 1000.0)))


def _coefficients(height: Array, amounts: tuple[float, float, float]) -> tuple[Array, Array, Array, Array]:
    """(..., 4) each at heights (...) in km: absorption and scattering by aerosol, the same by molecules."""
    air, aerosol, ozone = amounts
    density = _AEROSOL_DENSITY * np.exp(-height / _AEROSOL_SCALE) + _AEROSOL_BACKGROUND
    density = (density * aerosol)[..., None]
    log_height = np.log(np.maximum(height, 1e-4))
    molecules = 3.78547397e20 * np.exp(-((log_height - 3.22261) ** 2) * 5.55555555 - log_height)
    scattered = np.exp(-0.07771971 * height**1.16364243)
    return (
        _AEROSOL_ABSORPTION * density,
        _AEROSOL_SCATTERING * density,
        _OZONE * (molecules * ozone)[..., None],
        _MOLECULES * (scattered * air)[..., None],
    )


def _to_sphere(radius: float | Array, cosine: Array, sphere: float) -> Array:
    """Distance from a radius to a sphere about the earth's middle, at these cosines to the zenith; -1: none."""
    b = radius * cosine
    c = np.square(radius) - sphere**2
    d = b**2 - c
    root = np.sqrt(np.maximum(d, 0.0))
    distance = np.where(d >= b**2, -b + root, -b - root)
    return np.where(((c > 0.0) & (b > 0.0)) | (d < 0.0), -1.0, distance)


def _transmittance(radius: Array, cosine: Array, amounts: tuple[float, float, float]) -> Array:
    """(..., 4) from radii to the sun at these cosines to the zenith."""
    step = _to_sphere(radius, cosine, _ATMOSPHERE_RADIUS) / _STEPS
    depth = np.zeros((*step.shape, 4))
    for index in range(_STEPS):
        along = (index + 0.5) * step
        height = np.sqrt(radius**2 + 2.0 * radius * along * cosine + along**2) - _EARTH_RADIUS
        depth += sum(_coefficients(np.maximum(height, 0.0), amounts)) * step[..., None]
    return np.exp(-depth)


def _transmittances(amounts: tuple[float, float, float]) -> Array:
    """(_ROWS, _COLUMNS, 4) by height and by the sun's cosine to the zenith."""
    cosine = np.arange(_COLUMNS) / (_COLUMNS - 1.0) * 2.0 - 1.0
    radius = _EARTH_RADIUS + np.arange(_ROWS) / (_ROWS - 1.0) * _THICKNESS
    radii, cosines = np.broadcast_arrays(radius[:, None], cosine)
    return _transmittance(radii, cosines, amounts)


def _looked_up(table: np.ndarray, sun: np.ndarray, height: Array) -> np.ndarray:
    """(rows, columns, 4) transmittance to the sun, whose cosine is (rows, columns), at heights (rows,) of 0 to 1."""
    y = (_ROWS - 1.0) * np.clip(height, 0.0, 1.0)
    low = np.minimum(y.astype(int), _ROWS - 1)
    between = (y - low)[:, None, None].astype(np.float32)
    # Rows of the table at each height, then along them.
    lines = table[low] * (1.0 - between) + table[np.minimum(low + 1, _ROWS - 1)] * between
    return _along(lines, sun)


def _along(lines: np.ndarray, sun: np.ndarray) -> np.ndarray:
    """Lines (rows or 1, _COLUMNS, 4) of the table at cosines (rows, columns)."""
    x = (_COLUMNS - 1.0) * np.clip(0.5 * sun + 0.5, 0.0, 1.0)
    left = np.minimum(x.astype(int), _COLUMNS - 1)
    between = (x - left)[..., None].astype(np.float32)
    row = np.arange(len(lines))[:, None] if len(lines) > 1 else np.zeros((1, 1), int)
    return lines[row, left] * (1.0 - between) + lines[row, np.minimum(left + 1, _COLUMNS - 1)] * between


def _multiple(table: np.ndarray, sun: np.ndarray, height: Array, radius: Array) -> np.ndarray:
    """(rows, columns, 4) light that has been scattered before, from the ground and from the air."""
    omega = 2.0 * np.pi * (1.0 - np.sqrt(np.maximum(1.0 - (_EARTH_RADIUS / radius) ** 2, 0.0)))
    y = (_ROWS - 1.0) * np.clip(height, 0.0, 1.0)
    low = np.minimum(y.astype(int), _ROWS - 1)
    between = (y - low)[:, None]
    zenith = table[low, -1] * (1.0 - between) + table[np.minimum(low + 1, _ROWS - 1), -1] * between
    from_ground = 0.25 / np.pi * _GROUND_ALBEDO / np.pi * omega[:, None] * table[0, -1] / zenith
    ground = from_ground.astype(np.float32)[:, None] * _along(table[:1], sun) * sun[..., None]
    air = 0.02 / (1.0 + 5.0 * np.exp(-17.92 * sun))
    return ground + air[..., None] * np.array((0.217, 0.347, 0.594, 1.0), np.float32)
