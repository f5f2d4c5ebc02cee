# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheen, coat, tints, rough and translucent bases of what lamps and world light: the shaders against their reference in
double precision, and against Cycles."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.shaded import shaded_value
from curvrefl.curvrefl_addon.renderer.paths.surface_features import surface_features_of
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays, WorldArrays
from lighting.cycles import cycles_picture
from lighting.harness import our_picture
from lighting.stage import Stage, lamp, plane
from lighting.test_lighting import sky
from paths.programs import scatter_program, scattering
from unit.scattering.surfaces import TABLE, material

pytestmark = pytest.mark.usefixtures("gpu")

COLOR, TINT = (0.8, 0.4, 0.1), (0.3, 0.9, 0.6)
COAT = {"coat_weight": 0.7, "coat_roughness": 0.3, "coat_ior": 1.8, "coat_tint": TINT}
SHEEN = {"sheen_weight": 0.8, "sheen_roughness": 0.4, "sheen_tint": (0.9, 0.5, 0.7)}
SURFACES = {
    "plain": material(base_color=COLOR),
    "tinted plastic": material(base_color=COLOR, roughness=0.4, specular_tint=TINT, specular_level=0.9),
    "tinted metal": material(base_color=COLOR, metallic=1.0, roughness=0.5, specular_tint=TINT),
    "velvet": material(base_color=COLOR, roughness=0.6, **SHEEN),
    "fine velvet": material(base_color=COLOR, specular_level=0.0, sheen_weight=1.0, sheen_roughness=0.15),
    "coat": material(base_color=COLOR, roughness=0.6, **COAT),
    "coated metal": material(base_color=COLOR, roughness=0.3, metallic=0.7, **COAT),
    "all above": material(base_color=COLOR, emission=(0.1, 0.2, 0.3), roughness=0.6, **SHEEN, **COAT),
    "clay": material(base_color=COLOR, specular_level=0.0, diffuse_roughness=1.0),
    "half clay": material(base_color=COLOR, roughness=0.6, diffuse_roughness=0.4, **SHEEN),
    "leaf": material(base_color=COLOR, specular_level=0.0, translucency=1.0),
    "half leaf": material(base_color=COLOR, specular_level=0.0, translucency=0.4),
}
MAIN = """
#include "common/records.glsl"
#include "lighting/ggx.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 viewer = texelFetch(viewers, pixel, 0);
  vec3 light = texelFetch(lights, pixel, 0).xyz;
  Material m;
  FIELDS
  m.emission = vec3(0.0);
  m.glossy_only = false;
  Surface s = surface_made_of(m, vec3(0.0), normal);
  float cosine = dot(light, normal);
  Lobes lobes = lobes_of(s, dot(viewer.xyz, normal));
  vec3 value = diffuse_lobes(s, lobes, viewer.xyz, light, cosine);
  if (cosine > 0.0) {
    value += glossy_lobe(lobes, lobes.alpha, normal, viewer.xyz, light, cosine);
#ifdef SURFACE_COAT
    value += vec3(coat_lobe(lobes, lobes.coat_alpha, normal, viewer.xyz, light, cosine));
#endif
  }
#ifdef SURFACE_TRANSLUCENT
  value += lobes.translucent * (max(-cosine, 0.0) / LIGHTING_PI);
#endif
  direction_out = weight_out = texelFetch(randoms, pixel, 0) + fetch_record(materials, 0);
  base_out = texelFetch(colors, pixel, 0) + texelFetch(tangents, pixel, 0);
  value_out = vec4(value, 0.0);
}
"""


FLOATS = ("metallic", "roughness", "ior", "specular_level", "coat_weight", "coat_roughness", "coat_ior")
FLOATS = (*FLOATS, "sheen_weight", "sheen_roughness", "diffuse_roughness", "subsurface", "translucency")
COLORS = ("base_color", "specular_tint", "coat_tint", "sheen_tint")


def fields(m: MaterialArrays) -> str:
    """GLSL that sets a Material."""
    numbers = [f"m.{name} = {float(getattr(m, name))};" for name in FLOATS]
    colors = [f"m.{name} = vec3{tuple(map(float, getattr(m, name)))};" for name in COLORS]
    return " ".join(numbers + colors)


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def eye_at(angle: float) -> tuple[float, float, float]:
    return (6 * np.sin(np.radians(angle)), 0.3, 6 * np.cos(np.radians(angle)))


@pytest.mark.parametrize("name", list(SURFACES))
def test_lamps_lobes_are_the_references(name: str) -> None:
    m = SURFACES[name]
    features = tuple(sorted(surface_features_of(m)))
    rng = np.random.default_rng(5)
    count = 4096
    viewers, lights = unit(rng.normal(size=(count, 3))), unit(rng.normal(size=(count, 3)))
    viewers[:, 2] = np.maximum(np.abs(viewers[:, 2]), 0.02)
    viewers = unit(viewers)
    program = scatter_program((), MAIN.replace("FIELDS", fields(m)), features)
    found = scattering([m], np.zeros(count, int), viewers, lights, rng.random((count, 4)), program=program).value
    truth = shaded_value(m, viewers, lights, TABLE)
    assert np.abs(found - truth).max() / truth.max() < 2e-3
    assert np.quantile(np.abs(found - truth) / (truth + 1e-2), 0.99) < 2e-3


@pytest.mark.parametrize("name", list(SURFACES))
def test_under_a_sun_and_in_a_white_world_as_cycles(name: str) -> None:
    m = SURFACES[name]
    for angle in (5.0, 75.0):
        world = Stage(
            [plane(40.0, material=m)], world=WorldArrays((1.0, 1.0, 1.0)), eye=eye_at(angle), width=1, pixels=4
        )
        suns = [lamp("SUN", (3, 3, 3), place) for place in ((-1, 0.5, 2), (2, 0.2, 0.6), (0.3, 1.0, -1.5))]
        lit = [Stage([plane(40.0, material=m)], [sun], eye=eye_at(angle), width=1, pixels=4) for sun in suns]
        for stage, samples in ((world, 512), *((one, 4) for one in lit)):
            ours = our_picture(stage, 1)[0].mean(axis=(0, 1))
            theirs = cycles_picture(stage, samples).mean(axis=(0, 1))
            assert ours == pytest.approx(theirs, rel=0.015, abs=1e-3), (angle, stage.lights)


@pytest.mark.parametrize("name", ["velvet", "fine velvet", "coat", "clay", "half leaf"])
def test_under_a_sky_as_cycles(name: str) -> None:
    m = SURFACES[name]
    for angle, tolerance in ((5.0, 0.06), (50.0, 0.06), (80.0, 0.12)):
        stage = Stage(
            [plane(40.0, material=m)], world=WorldArrays((1.0, 1.0, 1.0), sky()), eye=eye_at(angle), width=1, pixels=4
        )
        ours = our_picture(stage)[0].mean(axis=(0, 1))
        theirs = cycles_picture(stage, 1024).mean(axis=(0, 1))
        assert ours == pytest.approx(theirs, rel=tolerance), angle


def test_nothing_is_compiled_for_plain_materials() -> None:
    assert not surface_features_of(MaterialArrays("plain"))
