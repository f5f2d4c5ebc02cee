# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics in pictures against their closed forms: along sections, and all of their light."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from caustics.stage import CHROME_THING, GLASS_THING, Stage, drawn, irradiance, ring_mesh, round_mesh, sun_along
from curvrefl.curvrefl_addon.optics.caustics import RoundMirror, ring_irradiance
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import radial_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
SIZE = 128


def straight(height: float, half: float, away: float) -> View:
    """A view of a square about the z axis on the plane z = `height`, from so far above it, or below."""
    eye = np.array([0.0, -1e-3, height + away])
    return look_at(eye, np.array([0.0, 0.0, height]), SIZE, SIZE, 2.0 * np.arctan(half / abs(away)))


def screened(mirror: RoundMirror, plane: float, half: float) -> Frame:
    """What a round mirror throws on a screen, seen from behind the mirror."""
    stage = Stage()
    stage.add(round_mesh(mirror, 64, 128), CHROME_THING, visible_camera=False)
    stage.add_screen(plane, 1.2 * half)
    return drawn(stage.arrays(), straight(plane, half, -4.0))


def mean_between(mirror: RoundMirror, plane: float, low: float, high: float) -> float:
    """Over the area between two radii."""
    radii = low + (high - low) * (np.arange(8) + 0.5) / 8
    return float((mirror.irradiance(radii, plane) * radii).sum() / radii.sum())


@pytest.mark.parametrize(
    ("mirror", "plane", "half", "least", "most"),
    [
        (RoundMirror("INSIDE", 2.0, 1.3), -0.8, 0.6, 0.02, 0.58),
        (RoundMirror("PARABOLOID", 4.0, 1.0), 0.8, 0.8, 0.02, 0.58),
    ],
)
def test_sections(mirror: RoundMirror, plane: float, half: float, least: float, most: float) -> None:
    """Off a sphere, where it is brightest by far at the axis that it has crossed, and off a paraboloid."""
    frame = screened(mirror, plane, half)
    radius = np.linalg.norm(frame.surfaces["seen_position"][..., :2], axis=2)
    found = irradiance(frame)
    for low, high in pairwise(np.linspace(least, most, 13)):
        inside = (radius >= low) & (radius < high)
        assert found[inside].mean() == pytest.approx(mean_between(mirror, plane, low, high), rel=0.02), (low, high)
    if mirror.kind == "PARABOLOID":
        # All light of the beam lands there.
        area = (2.0 * half / SIZE) ** 2
        assert found.sum() * area == pytest.approx(np.pi * mirror.rim**2, rel=0.01)


def test_cusp() -> None:
    """Just above its cusp, half way down, a sphere's light is all within the fold, whose radius is in closed form."""
    sphere, plane = RoundMirror("INSIDE", 2.0, 0.8), -1.08
    frame = screened(sphere, plane, 0.05)
    angle = np.linspace(0.0, 0.6, 4001)
    # (of the nephroid)
    heights = -np.cos(angle) * (1.0 + 2.0 * np.sin(angle) ** 2)
    fold = np.interp(-plane, -heights, 2.0 * np.sin(angle) ** 3)
    radius = np.linalg.norm(frame.surfaces["seen_position"][..., :2], axis=2)
    found = irradiance(frame)
    bright = radius[found > 0.2 * np.quantile(found, 0.99)]
    assert fold == pytest.approx(np.quantile(bright, 0.98), rel=0.1)
    for low, high in pairwise(np.linspace(0.2, 0.8, 4) * fold):
        inside = (radius >= low) & (radius < high)
        assert found[inside].mean() == pytest.approx(mean_between(sphere, plane, low, high), rel=0.05)


def counted_through_ball(edges: np.ndarray, radius: float, below: float) -> np.ndarray:
    """Irradiance between radii on a plane so far below the middle of a glass ball in a beam from above, by rays."""
    count = 400_000
    rho = radius * np.sqrt((np.arange(count) + 0.5) / count)
    power = np.full(count, np.pi * radius**2 / count)
    place = np.stack([rho, np.sqrt(radius**2 - rho**2)], axis=1)
    way, total = np.tile([0.0, -1.0], (count, 1)), np.zeros(len(edges) - 1)
    eta, side = 1.5, 1.0
    for step in range(5):
        normal = side * place / radius
        cosine = -(way * normal).sum(axis=1)
        inner = np.sqrt(np.maximum(1.0 - (1.0 - cosine**2) / eta**2, 0.0))
        across, along = (cosine - eta * inner) / (cosine + eta * inner), (inner - eta * cosine) / (inner + eta * cosine)
        reflected = np.where(inner > 0.0, 0.5 * (across**2 + along**2), 1.0)
        bent = way / eta + (cosine / eta - inner)[:, None] * normal
        mirrored = way + 2.0 * cosine[:, None] * normal
        # (What is inside goes on there, and what is outside lands.)
        leaves, share = (mirrored, reflected) if step == 0 else (bent, 1.0 - reflected)
        down = leaves[:, 1] < 0.0
        landed = np.abs(place[:, 0] - (below + place[:, 1]) * leaves[:, 0] / np.where(down, leaves[:, 1], -1.0))
        total += np.histogram(landed[down], edges, weights=(power * share)[down])[0]
        way, power = (bent, power * (1.0 - reflected)) if step == 0 else (mirrored, power * reflected)
        eta, side = 1.0 / 1.5, -1.0
        place = place - 2.0 * (place * way).sum(axis=1)[:, None] * way
    return total / (np.pi * np.diff(edges**2))


def test_glass_ball() -> None:
    """A section of the light in a glass ball's shadow, against rays that are counted."""
    radius, height = 0.5, 0.75
    stage = Stage()
    mesh = radial_mesh(Ellipsoid(radius, radius, radius), 128)
    stage.add(mesh, GLASS_THING, (0.0, 0.0, height), visible_camera=False)
    stage.add_screen(0.0, 1.0)
    frame = drawn(stage.arrays(), straight(0.0, 0.5, 4.0), samples=8, caustic_patches=8192)
    places = np.linalg.norm(frame.surfaces["seen_position"][..., :2], axis=2)
    edges = np.array([0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.32])
    exact, found = counted_through_ball(edges, radius, height), irradiance(frame)
    for (low, high), expected in zip(pairwise(edges), exact, strict=True):
        inside = (places >= low) & (places < high)
        assert found[inside].mean() == pytest.approx(expected, rel=0.05), (low, high)


def test_ring() -> None:
    """On the floor inside of a ring: what comes off the wall once, beside the sun itself."""
    way = np.array([np.cos(0.6), 0.0, -np.sin(0.6)])
    stage = Stage((sun_along(way),))
    stage.add(ring_mesh(1.0, 0.5, 512), CHROME_THING, visible_camera=False)
    stage.add_screen(0.0, 1.0)
    frame = drawn(stage.arrays(), straight(0.0, 1.0, 4.0), bounces=1, samples=4, caustic_patches=65536)
    places = frame.surfaces["seen_position"][..., :2]
    found = irradiance(frame) - np.sin(0.6)
    for x, y in ((0.88, 0.0), (0.8, 0.2), (0.8, -0.3), (0.66, 0.05), (0.36, 0.0)):
        block = (np.abs(places - (x, y)) < 0.045).all(axis=2)
        exact = ring_irradiance(places[block], 1.0, 0.5, way)
        assert found[block].mean() == pytest.approx(exact.mean(), rel=0.05), (x, y)
    # In the middle no light off the wall is left.
    empty = (np.abs(places) < 0.2).all(axis=2)
    np.testing.assert_allclose(found[empty], 0.0, atol=1e-3)
