# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scatter() draws from the density that it says, and its weight is the value over it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.glass import refracted, refracted_density
from curvrefl.curvrefl_addon.optics.scattering.microfacet import (
    ggx_density,
    reflected_value,
    shadowing,
    surface_frame,
)
from curvrefl.curvrefl_addon.optics.scattering.scatter import ENDS, PASSES, scatter, scattered
from unit.scattering.surfaces import EAST, MATERIALS, TABLE, UP, spread, viewer_at

ROWS, COLUMNS, WITHIN = 16, 16, 12


def _sphere() -> np.ndarray:
    """(rows, columns, within^2, 3) directions: of bins of equal solid angle, evenly within each."""
    steps = (np.arange(WITHIN) + 0.5) / WITHIN
    z = -1.0 + 2.0 * (np.arange(ROWS)[:, None] + steps) / ROWS
    phi = 2.0 * np.pi * (np.arange(COLUMNS)[:, None] + steps) / COLUMNS
    z, phi = np.broadcast_arrays(z[:, None, :, None], phi[None, :, None, :])
    sine = np.sqrt(1.0 - z * z)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=-1).reshape(ROWS, COLUMNS, -1, 3)


@pytest.mark.parametrize("is_back", [False, True])
@pytest.mark.parametrize("name", list(MATERIALS))
def test_samples_are_of_the_density(name: str, is_back: bool) -> None:
    """By bins of the sphere; and the mean weight of a bin's samples is the integral of the value there."""
    m = replace(MATERIALS[name], roughness=0.6)
    count = 1 << 16
    viewer = viewer_at(0.55)
    s = scatter(m, UP, EAST, is_back, np.tile(viewer, (count, 1)), spread(count), TABLE)
    assert (s.pdf[(s.kind != ENDS) & (s.kind != PASSES)] > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(s.direction, axis=1), 1.0, atol=1e-9)
    goes = (s.kind != ENDS) & (s.kind != PASSES)
    row = np.clip((s.direction[:, 2] + 1.0) * 0.5 * ROWS, 0, ROWS - 1e-9).astype(int)
    column = np.clip(np.arctan2(s.direction[:, 1], s.direction[:, 0]) / (2.0 * np.pi) % 1.0 * COLUMNS, 0, COLUMNS - 1)
    number = row * COLUMNS + column.astype(int)
    sphere = _sphere()
    flat = sphere.reshape(-1, 3)
    value, pdf = scattered(m, UP, EAST, is_back, np.tile(viewer, (len(flat), 1)), flat, TABLE)
    solid_angle = 4.0 * np.pi / (ROWS * COLUMNS)
    shares = m.alpha * solid_angle * pdf.reshape(ROWS * COLUMNS, -1).mean(axis=1)
    counts = np.bincount(number[goes], minlength=ROWS * COLUMNS) / count
    # (An even sequence misses a bin's share by less than chance would; bins at the horizon are cut.)
    assert np.abs(counts - shares).max() < 1e-3 + 0.02 * shares.max()
    assert abs(counts.sum() - shares.sum()) < 5e-3
    integral = m.alpha * solid_angle * value.reshape(ROWS * COLUMNS, -1, 3).mean(axis=1)
    for channel in range(3):
        sums = np.bincount(number[goes], s.weight[goes, channel], ROWS * COLUMNS) / count
        assert np.abs(sums - integral[:, channel]).max() < 1e-3 + 0.02 * integral.max()


def test_normals_project_to_one() -> None:
    """The density of normals times their cosine, over the hemisphere, also stretched."""
    z, phi = np.meshgrid((np.arange(2000) + 0.5) / 2000, 2 * np.pi * np.arange(256) / 256, indexing="ij")
    sine = np.sqrt(1.0 - z * z)
    h = np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=-1).reshape(-1, 3)
    for alpha in ([0.3, 0.3], [0.2, 0.9], [1.0, 1.0]):
        density = ggx_density(h, np.array(alpha)) * h[:, 2]
        assert density.mean() * 2.0 * np.pi == pytest.approx(1.0, abs=2e-3)


def test_single_reflection_is_reciprocal() -> None:
    """Value over the cosine to the light is the same the other way round."""
    rng = np.random.default_rng(5)
    viewer, light = (rng.normal(size=(1000, 3)) for _ in range(2))
    viewer, light = (np.abs(w) / np.linalg.norm(w, axis=1, keepdims=True) for w in (viewer, light))
    h = (viewer + light) / np.linalg.norm(viewer + light, axis=1, keepdims=True)
    for alpha in ([0.3, 0.3], [0.2, 0.9]):
        there, back = (
            reflected_value(a, b, h, np.array(alpha)) / b[:, 2] for a, b in ((viewer, light), (light, viewer))
        )
        np.testing.assert_allclose(there, back, rtol=1e-9)


def test_single_refraction_is_reciprocal_but_for_the_index() -> None:
    """As the factor 1 / eta^2 of radiance is left out, the two ways differ by eta^2."""
    rng = np.random.default_rng(6)
    viewer = np.abs(rng.normal(size=(1000, 3)))
    viewer /= np.linalg.norm(viewer, axis=1, keepdims=True)
    h = rng.normal(size=(1000, 3)) * 0.2 + UP
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    eta = 1.5
    light = refracted(viewer, h, eta)
    is_seen = ((viewer * h).sum(axis=1) > 0.0) & (light[:, 2] < 0.0)
    viewer, light, h = viewer[is_seen], light[is_seen], h[is_seen]
    alpha = np.array([0.4, 0.4])
    there = refracted_density(viewer, light, h, 0.4, eta) * shadowing(viewer, light, alpha) / -light[:, 2]
    # The other side looks up from below: turned over.
    back = refracted_density(-light, -viewer, h, 0.4, 1.0 / eta) * shadowing(-light, -viewer, alpha) / viewer[:, 2]
    np.testing.assert_allclose(there, back * eta * eta, rtol=1e-9)


def test_sharp_samples_go_where_mirrors_and_snell_say() -> None:
    normal, tangent = surface_frame(np.array([0.6, 0.0, 0.8]), EAST)[:, 2], EAST
    viewers = np.tile(normal * 0.6 + np.array([0.0, 0.8, 0.0]), (64, 1))
    for name in ("metal", "glass", "pane", "lacquer"):
        m = replace(MATERIALS[name], roughness=0.0, coat_roughness=0.0)
        s = scatter(m, normal, tangent, False, viewers, spread(64), TABLE)
        assert (s.pdf == 0.0).all()
        assert (s.kind != ENDS).all()
        mirrored, through = s.direction[s.kind == 1], s.direction[s.kind == 2]
        np.testing.assert_allclose(mirrored, np.tile(normal * 0.6 - [0.0, 0.8, 0.0], (len(mirrored), 1)), atol=1e-12)
        if name == "glass":
            np.testing.assert_allclose(through[:, 1], -0.8 / 1.5, atol=1e-12)
        if name == "pane":
            np.testing.assert_allclose(through, -viewers[: len(through)], atol=1e-12)
        assert (len(through) > 0) == (name in ("glass", "pane"))


def test_refracted_light_is_totally_reflected_inside() -> None:
    m = replace(MATERIALS["glass"], roughness=0.0)
    s = scatter(m, UP, EAST, True, np.tile(viewer_at(0.5), (64, 1)), spread(64), TABLE)
    assert (s.kind == 1).all()
    np.testing.assert_allclose(s.weight, 1.0, atol=1e-12)


def test_alpha_lets_its_share_pass() -> None:
    m = MATERIALS["all at once"]
    viewers = np.tile(viewer_at(0.7), (4096, 1))
    s = scatter(m, UP, EAST, False, viewers, spread(4096), TABLE)
    passes = s.kind == PASSES
    assert passes.mean() == pytest.approx(1.0 - m.alpha, abs=1e-3)
    np.testing.assert_array_equal(s.direction[passes], -viewers[passes])
    np.testing.assert_array_equal(s.weight[passes], np.tile(m.transparent_tint, (passes.sum(), 1)))


def test_nothing_is_no_number() -> None:
    """At the ends of all ranges; weights stay within what a white surface could need."""
    rng = np.random.default_rng(7)
    extremes = {
        "roughness": (0.0, 1e-3, 0.0265, 1.0),
        "ior": (1e-5, 0.9999, 1.0, 1.00005, 1.5, 1000.0),
        "metallic": (0.0, 0.5, 1.0),
        "transmission": (0.0, 0.5, 1.0),
        "coat_weight": (0.0, 1.0),
        "coat_ior": (1.0, 4.0),
        "base_color": ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        "thin_wall": (False, True),
        "glass": (0, 1, 2),
        "anisotropy": (0.0, 1.0),
    }
    cosines = np.array([0.0, 1e-9, 1e-5, 1e-2, 0.5, 1.0])
    viewers = np.array([viewer_at(float(cosine)) for cosine in cosines]).repeat(32, axis=0)
    randoms = rng.random((len(viewers), 4)) * rng.integers(0, 2, (len(viewers), 4))
    lights = rng.normal(size=(len(viewers), 3))
    lights /= np.linalg.norm(lights, axis=1, keepdims=True)
    for _ in range(200):
        m = replace(
            MATERIALS["metal"], **{name: viewer[rng.integers(len(viewer))] for name, viewer in extremes.items()}
        )
        is_back = bool(rng.integers(2))
        s = scatter(m, UP, EAST, is_back, viewers, randoms, TABLE)
        assert np.isfinite(s.direction).all()
        assert np.isfinite(s.weight).all()
        assert s.weight.min() >= 0.0
        value, pdf = scattered(m, UP, EAST, is_back, viewers, lights, TABLE)
        assert np.isfinite(value).all()
        assert np.isfinite(pdf).all()
