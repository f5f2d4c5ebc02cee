# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lamps do to opaque surfaces, in double precision: nothing is lost or made, lobes are where they should be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.oren_nayar import (
    oren_nayar_albedo,
    oren_nayar_share,
    oren_nayar_tilt,
    oren_nayar_value,
)
from curvrefl.curvrefl_addon.optics.scattering.shaded import in_viewers_plane, shaded_value
from curvrefl.curvrefl_addon.optics.scattering.sheen import sheen_direction, sheen_lobe, sheen_value
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from unit.scattering.surfaces import TABLE, material, viewer_at

WHITE = (1.0, 1.0, 1.0)
ROUGH = {"roughness": 0.7, "base_color": WHITE}
SURFACES = {
    "plain": material(**ROUGH),
    "sheen": material(sheen_weight=1.0, sheen_roughness=0.5, **ROUGH),
    "coat": material(coat_weight=1.0, coat_roughness=0.4, **ROUGH),
    "sheen over coat over half metal": material(
        sheen_weight=0.6, sheen_roughness=0.8, coat_weight=0.8, coat_roughness=0.5, metallic=0.5, **ROUGH
    ),
    "chalk": material(diffuse_roughness=1.0, specular_level=0.0, **ROUGH),
    "half chalk": material(diffuse_roughness=0.6, subsurface=0.4, **ROUGH),
    "leaf": material(translucency=0.4, **ROUGH),
}
STEPS = 256


def sphere() -> tuple[np.ndarray, float]:
    """(n, 3) directions all around, and the solid angle of each."""
    z, phi = np.meshgrid(
        -1.0 + (np.arange(STEPS) + 0.5) * 2.0 / STEPS, (np.arange(STEPS) + 0.5) * 2.0 * np.pi / STEPS, indexing="ij"
    )
    sine = np.sqrt(1.0 - z * z)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=-1).reshape(-1, 3), 4.0 * np.pi / STEPS**2


def furnace(m: MaterialArrays, cosine: float) -> np.ndarray:
    lights, each = sphere()
    viewers = np.broadcast_to(viewer_at(cosine), lights.shape)
    return shaded_value(m, viewers, lights, TABLE).sum(axis=0) * each


@pytest.mark.parametrize("name", list(SURFACES))
@pytest.mark.parametrize("cosine", [0.9, 0.4])
def test_white_furnace(name: str, cosine: float) -> None:
    assert furnace(SURFACES[name], cosine) == pytest.approx(np.ones(3), abs=0.012)


def test_colors_take_light() -> None:
    """The check above can fail."""
    assert furnace(replace(SURFACES["sheen"], base_color=(0.5, 0.5, 0.5)), 0.4).max() < 0.85


def test_sheen_is_a_density() -> None:
    lights, each = sphere()
    for roughness in (0.2, 0.5, 1.0):
        for cosine in (0.2, 0.8):
            transform, albedo = sheen_lobe(TABLE, roughness, np.array([cosine]))
            assert 0.0 < albedo[0] < 0.75
            assert sheen_value(np.tile(transform, (len(lights), 1)), lights).sum() * each == pytest.approx(
                1.0, abs=0.02
            )


def test_four_directions_stand_for_the_lobe_of_sheen() -> None:
    """Their mean direction is that of the lobe, which leans back to the viewer."""
    lights, each = sphere()
    disk = np.array([[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]])
    for roughness in (0.3, 0.8):
        for cosine in (0.2, 0.8):
            transform = sheen_lobe(TABLE, roughness, np.array([cosine]))[0]
            value = sheen_value(np.tile(transform, (len(lights), 1)), lights)
            mean = (value[:, None] * lights).sum(axis=0) * each
            of_four = sheen_direction(np.tile(transform, (4, 1)), disk).mean(axis=0)
            assert mean[0] >= 0.0
            assert of_four == pytest.approx(mean, abs=0.06), (roughness, cosine)


def test_rough_bases_moments() -> None:
    """The albedo and the mean direction are those of the values."""
    lights, each = sphere()
    color = (0.9, 0.5, 0.2)
    for roughness in (0.3, 1.0):
        for cosine in (0.1, 0.5, 0.95):
            viewer = viewer_at(cosine)
            one = np.full(len(lights), cosine)
            value = oren_nayar_value(color, roughness, one, lights[:, 2], lights @ viewer)
            albedo = value.sum(axis=0) * each
            assert oren_nayar_albedo(color, roughness, one[:1])[0] == pytest.approx(albedo, abs=3e-3)
            turned = in_viewers_plane(np.broadcast_to(viewer, lights.shape), lights)
            mean = (value.mean(axis=1)[:, None] * turned).sum(axis=0) * each
            tilt = oren_nayar_tilt(color, roughness, one[:1])[0]
            assert tilt == pytest.approx(mean[[0, 2]], abs=2e-3)
            assert mean[1] == pytest.approx(0.0, abs=1e-3)


def test_even_bases_are_lambertian() -> None:
    cosine = np.array([0.3, 0.9])
    value = oren_nayar_value((0.5, 0.5, 0.5), 0.0, cosine, cosine, cosine)
    np.testing.assert_allclose(value, np.tile(cosine[:, None] / np.pi, 3), rtol=1e-12)
    assert oren_nayar_share(np.array([0.0]))[0] == pytest.approx(np.pi / 2.0 - 2.0 / 3.0)
