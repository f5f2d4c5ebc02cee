# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scatter.glsl against its reference in double precision, and against what shades materials without new layers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering import scatter as reference
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from paths.programs import FEATURES, scatter_program, scattering
from unit.scattering.surfaces import MATERIALS, TABLE, material

pytestmark = pytest.mark.usefixtures("gpu")

COUNT = 2048
NORMAL = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
TANGENT = np.array([0.9, 0.1, 0.2]) / np.linalg.norm([0.9, 0.1, 0.2])


@pytest.fixture(scope="module")
def program(gpu: Any) -> Any:
    return scatter_program()


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def directions(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Viewers above the surface, and lights all around."""
    viewers, lights = (unit(rng.normal(size=(COUNT, 3))) for _ in range(2))
    below = viewers @ NORMAL
    return unit(viewers - 2.0 * np.minimum(below, 0.0)[:, None] * NORMAL), lights


@pytest.mark.parametrize("is_back", [False, True])
@pytest.mark.parametrize("name", list(MATERIALS))
def test_shader_and_reference_agree(name: str, is_back: bool, program: Any) -> None:
    """Decisions, directions, weights, densities, and values towards lights, of roughness 0 to 1."""
    rng = np.random.default_rng(3)
    for roughness in (0.0, 0.05, 0.3, 1.0):
        m = replace(MATERIALS[name], roughness=roughness)
        viewers, lights = directions(rng)
        randoms = rng.random((COUNT, 4)).astype(np.float32).astype(float)
        tangents = np.tile(TANGENT, (COUNT, 1))
        index = np.zeros(COUNT, int)
        found = scattering([m], index, viewers, lights, randoms, is_back, tangents, tuple(NORMAL), program)
        truth = reference.scatter(m, NORMAL, TANGENT, is_back, viewers, randoms, TABLE)
        value, pdf = reference.scattered(m, NORMAL, TANGENT, is_back, viewers, lights, TABLE)
        same = found.kind == truth.kind
        # (A random number may fall on either side of a chance, a direction of the horizon.)
        assert same.mean() > 0.998
        assert np.abs(found.direction - truth.direction)[same].max() < 2e-3
        assert np.quantile(np.abs(found.direction - truth.direction)[same], 0.99) < 2e-5
        for mine, his in ((found.weight, truth.weight), (found.pdf[:, None], truth.pdf[:, None])):
            relative = np.abs(mine - his)[same] / (0.01 + his[same])
            assert np.quantile(relative, 0.99) < 2e-3
        for mine, his in ((found.value, value), (found.value_pdf[:, None], pdf[:, None])):
            relative = np.abs(mine - his) / (1e-3 + his)
            assert np.quantile(relative, 0.99) < 2e-3
        cosine = viewers @ NORMAL
        np.testing.assert_allclose(found.base, reference.base_share(m, is_back, cosine, TABLE), atol=2e-5)
        passes = reference.coat_passes(m, cosine, TABLE)[:, 1]
        np.testing.assert_allclose(found.coat_passes, passes, atol=2e-5)


def test_nothing_is_no_number(program: Any) -> None:
    """At the ends of all ranges, also where the viewer is at the horizon or a little below it."""
    extremes = {
        "roughness": (0.0, 1e-3, 0.0265, 1.0),
        "ior": (1e-5, 0.9999, 1.0, 1.00005, 1.001, 1.5, 1000.0),
        "metallic": (0.0, 0.5, 1.0),
        "transmission": (0.0, 0.5, 1.0),
        "coat_weight": (0.0, 1.0),
        "coat_roughness": (0.0, 0.03, 1.0),
        "coat_ior": (1.0, 4.0),
        "base_color": ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        "specular_level": (0.0, 0.5, 1.0),
        "thin_wall": (False, True),
        "glass": (0, 1, 2),
        "anisotropy": (0.0, 0.5, 1.0),
        "glossy_only": (False, False, True),
        "film_thickness": (0.0, 0.5, 400.0),
    }
    rng = np.random.default_rng(9)
    materials = [
        replace(MATERIALS["metal"], **{key: ends[rng.integers(len(ends))] for key, ends in extremes.items()})
        for _ in range(256)
    ]
    index = np.arange(256).repeat(64)
    cosine = rng.choice([-1e-3, 0.0, 1e-7, 1e-4, 1e-2, 0.5, 1.0], len(index))
    azimuth = rng.uniform(0.0, 6.3, len(index))
    sine = np.sqrt(1.0 - cosine * cosine)
    viewers = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], axis=1)
    randoms = rng.choice([0.0, 1e-7, 0.3, 0.5, 1.0 - 2.0**-24], (len(index), 4))
    lights = unit(rng.normal(size=(len(index), 3)))
    lights[::3] = -viewers[::3]
    for is_back in (False, True):
        found = scattering(materials, index, viewers, lights, randoms, is_back, program=program)
        for array in (found.direction, found.weight, found.pdf, found.value, found.value_pdf, found.base):
            assert np.isfinite(array).all()
        np.testing.assert_allclose(np.linalg.norm(found.direction, axis=1), 1.0, atol=1e-3)
        assert found.weight.min() >= 0.0
        assert found.value.min() >= 0.0
        assert found.weight.max() < 100.0


OF_TODAY = """
#include "common/records.glsl"
#include "lighting/ggx.glsl"
#include "lighting/mirror_tint.glsl"
#include "paths/scatter.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 viewer = texelFetch(viewers, pixel, 0);
  vec4 light = texelFetch(lights, pixel, 0);
  int index = int(viewer.w + 0.5);
  vec3 color = texelFetch(colors, pixel, 0).rgb;
  Material m = material_at(pixel, index, color);
  Facing f = Facing(normal, normal, false);
  float cosine = dot(viewer.xyz, normal);
  Surface s = Surface(vec3(0.0), normal, color, m.metallic, m.roughness, m.ior, m.specular_level, vec3(0.0),
                      m.glossy_only);
  Lobes lobes = lobes_of(s, cosine);
  direction_out = vec4(scatter(m, f, viewer.xyz, texelFetch(randoms, pixel, 0)).weight, 0.0);
  weight_out = vec4(mirror_tint(index, color, cosine), 0.0);
  vec3 h = normalize(viewer.xyz + light.xyz);
  float pdf;
  vec3 value = scattered(m, f, viewer.xyz, light.xyz, pdf);
  vec3 today = glossy_lobe(lobes, lobes.alpha, normal, viewer.xyz, light.xyz, max(dot(light.xyz, normal), 0.0));
  value_out = vec4(abs(value - today) / (today + 1e-3), 0.0);
  base_out = vec4(abs(base_share(m, f, cosine) - lobes.diffuse), 0.0);
}
"""


def test_materials_of_before_are_what_they_were() -> None:
    """The base is `lobes_of`'s, the lobe `glossy_lobe`, and a sharp mirror's weight is `mirror_tint`."""
    rng = np.random.default_rng(4)
    color = (0.8, 0.4, 0.1)
    kinds: list[MaterialArrays] = [
        material(base_color=color, metallic=metallic, roughness=roughness, ior=ior, specular_level=level)
        for metallic in (0.0, 0.4, 1.0)
        for roughness in (0.0, 0.2, 0.7)
        for ior in (1.5, 2.4, 0.8)
        for level in (0.5, 0.9)
    ]
    kinds += [material(base_color=color, roughness=roughness, glossy_only=True) for roughness in (0.0, 0.2, 0.7)]
    index = np.arange(len(kinds)).repeat(32)
    viewers, lights = (unit(np.abs(rng.normal(size=(len(index), 3)))) for _ in range(2))
    randoms = rng.random((len(index), 4))
    for features in (("ROUGH",), FEATURES):
        shader = scatter_program(features, OF_TODAY)
        found = scattering(kinds, index, viewers, lights, randoms, program=shader)
        sharp = np.array([kinds[number].roughness == 0.0 for number in index])
        np.testing.assert_allclose(found.direction[sharp], found.weight[sharp], atol=2e-6)
        assert found.value[~sharp].max() < 2e-3
        assert found.base.max() < 2e-6
