# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics in closed form against traced rays that are counted, energy, and what is known of their shapes."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.caustics import RoundMirror, ring_irradiance, sphere_caustic

INSIDE = RoundMirror("INSIDE", 2.0, 1.2)
OUTSIDE = RoundMirror("OUTSIDE", 1.0, 0.995)
DISH = RoundMirror("PARABOLOID", 4.0, 1.0)
RADIUS, HEIGHT = 1.0, 0.5
SUN = np.array([np.cos(0.6), 0.0, -np.sin(0.6)])


def counted(mirror: RoundMirror, plane: float, edges: np.ndarray) -> np.ndarray:
    """Irradiance between radii by rays in rings of equal area, mirrored by vectors."""
    rho = mirror.rim * np.sqrt((np.arange(200_000) + 0.5) / 200_000)
    step = 1e-6
    heights = [mirror._profile(rho + shift)[0] for shift in (-step, 0.0, step)]
    slope = (heights[2] - heights[0]) / (2.0 * step)
    normal = np.stack([-slope, np.ones_like(slope)], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    down = np.array([0.0, -1.0])
    way = down - 2.0 * (normal @ down)[:, None] * normal
    distance = (plane - heights[1]) / way[:, 1]
    place = np.abs(rho + distance * way[:, 0])[distance > 0.0]
    counts, _ = np.histogram(place, edges)
    return counts * mirror.rim**2 / 200_000 / np.diff(edges**2)


@pytest.mark.parametrize(
    ("mirror", "plane", "low", "high"),
    [(INSIDE, -1.3, 0.02, 0.2), (INSIDE, -0.8, 0.05, 0.3), (OUTSIDE, -1.5, 2.0, 6.0), (DISH, 1.2, 0.02, 0.38)],
)
def test_against_counted_rays(mirror: RoundMirror, plane: float, low: float, high: float) -> None:
    edges = np.linspace(low, high, 13)
    middles = np.linspace(low, high, 12 * 16, endpoint=False) + (high - low) / (24 * 16)
    exact = mirror.irradiance(middles, plane).reshape(12, 16)
    mean = (exact * middles.reshape(12, 16)).sum(axis=1) / middles.reshape(12, 16).sum(axis=1)
    # (Next to a fold the mean over points is a poor integral.)
    smooth = exact.max(axis=1) < 4.0 * exact.min(axis=1) + 1e-9
    assert smooth.sum() >= 6
    np.testing.assert_allclose(counted(mirror, plane, edges)[smooth], mean[smooth], rtol=0.02)


def test_paraboloid_is_even_between_radii() -> None:
    """All rays go to the focus: what is on a plane before it is the dish made smaller about that."""
    focus, plane = 2.0, 0.8
    rho = np.linspace(0.1, 0.9, 9)
    height = rho**2 / (4.0 * focus)
    place, _, _ = DISH.landing(rho, plane)
    np.testing.assert_allclose(place, rho * (focus - plane) / (focus - height), rtol=1e-12)
    share = (focus - height) ** 3 / ((focus - plane) ** 2 * (focus - height + rho**2 / (2.0 * focus)))
    np.testing.assert_allclose(DISH.irradiance(place, plane), share, rtol=1e-6)


def test_fold_of_the_sphere_is_a_nephroid() -> None:
    """Where light piles up on a plane is where the caustic passes through it; its cusp is half way down."""
    angles = np.linspace(0.01, 0.6, 40)
    for radius, height in sphere_caustic(INSIDE.radius, angles)[10::10]:
        near = INSIDE.irradiance(np.array([radius - 1e-6, radius + 1e-6]), height)
        assert near[0] > 50.0 * max(near[1], 0.5)
    np.testing.assert_allclose(sphere_caustic(2.0, np.zeros(1)), [[0.0, -1.0]])


def test_ring_against_counted_rays() -> None:
    random = np.random.default_rng(3)
    count = 1_000_000
    turn, z = np.arcsin(random.uniform(-1.0, 1.0, count)), random.uniform(0.0, HEIGHT, count)
    # (Places are even as the sun sees them: each brings as much.)
    power = 2.0 * RADIUS * HEIGHT * SUN[0] / count
    wall = RADIUS * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    way = np.array([1.0, 0.0]) - 2.0 * np.cos(turn)[:, None] * wall / RADIUS
    landed = wall + (z * SUN[0] / -SUN[2])[:, None] * way
    for x, y in ((0.2, 0.1), (0.35, 0.2), (0.6, 0.0), (0.72, 0.3)):
        half = 0.01
        inside = (np.abs(landed - (x, y)) < half).all(axis=1).sum()
        grid = np.stack(np.meshgrid(*(np.linspace(-half, half, 4) * 0.9,) * 2), axis=-1).reshape(-1, 2)
        exact = ring_irradiance(grid + np.array([x, y]), RADIUS, HEIGHT, SUN)
        if exact.max() < 1.5 * exact.min() + 1e-9:
            assert inside * power / (2.0 * half) ** 2 == pytest.approx(exact.mean(), rel=0.05, abs=0.01)


def test_no_light_is_lost() -> None:
    """What lands within a radius is what came down within the beam."""
    plane, rho = -1.3, 0.7
    place, change, _ = INSIDE.landing(np.linspace(1e-6, rho, 20_000), plane)
    assert (change > 0.0).all()
    radii = np.linspace(0.0, place[-1], 401)
    middles = 0.5 * (radii[1:] + radii[:-1])
    light = RoundMirror("INSIDE", 2.0, rho).irradiance(middles, plane)
    assert (light * np.diff(np.pi * radii**2)).sum() == pytest.approx(np.pi * rho**2, rel=1e-3)
