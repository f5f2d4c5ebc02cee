# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scatter.glsl against Cycles: what a plane of a material sends to the eye, mean over its samples.

The world is not sampled in Cycles: there its rough glass takes in light from where nothing would be refracted to, and
is brighter by up to 30 % than by paths alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays
from paths import cycles_plane
from paths.programs import scatter_program, scattering
from unit.scattering.surfaces import material, spread

pytestmark = pytest.mark.usefixtures("gpu")

COLOR, TINT = (0.8, 0.4, 0.1), (0.3, 0.9, 0.6)
PRINCIPLED = "ShaderNodeBsdfPrincipled"
SOCKETS = {
    "base_color": "Base Color",
    "metallic": "Metallic",
    "roughness": "Roughness",
    "ior": "IOR",
    "specular_level": "Specular IOR Level",
    "specular_tint": "Specular Tint",
    "transmission": "Transmission Weight",
    "thin_wall": "Thin Wall",
    "coat_weight": "Coat Weight",
    "coat_roughness": "Coat Roughness",
    "coat_ior": "Coat IOR",
    "coat_tint": "Coat Tint",
    "anisotropy": "Anisotropic",
    "anisotropic_rotation": "Anisotropic Rotation",
    "film_thickness": "Thin Film Thickness",
    "film_ior": "Thin Film IOR",
}
COATED = {"coat_weight": 0.7, "coat_roughness": 0.2, "coat_ior": 1.8, "coat_tint": TINT}
LACQUERED = {"metallic": 0.5, "roughness": 0.4, "coat_weight": 1.0, "coat_roughness": 0.0}
BY_PRINCIPLED: dict[str, dict[str, Any]] = {
    "metal": {"metallic": 1.0, "roughness": 0.8, "specular_tint": TINT},
    "plastic": {"roughness": 0.3, "specular_tint": TINT, "specular_level": 0.9},
    "half metal": {"metallic": 0.4, "roughness": 0.5},
    "coat": {"roughness": 0.6, **COATED},
    "lacquered metal": LACQUERED,
    "glass": {"transmission": 1.0, "roughness": 0.4},
    "half glass": {"transmission": 0.5, "metallic": 0.3, "roughness": 0.8, "ior": 1.8},
    "pane": {"transmission": 0.8, "roughness": 0.3, "thin_wall": True, "specular_tint": TINT},
    "brushed": {"metallic": 1.0, "roughness": 0.5, "anisotropy": 0.8, "anisotropic_rotation": 0.1},
    "heated metal": {"metallic": 1.0, "roughness": 0.3, "film_thickness": 400.0, "film_ior": 1.8},
    "filmed glass": {"transmission": 1.0, "roughness": 0.0, "film_thickness": 300.0, "film_ior": 2.0},
}
GLOSSY = {"distribution": "MULTI_GGX"}
OTHERS: dict[str, tuple[str, dict[str, Any], dict[str, Any], MaterialArrays]] = {
    "brushed glossy": (
        "ShaderNodeBsdfAnisotropic",
        {"Color": COLOR, "Roughness": 0.5, "Anisotropy": -0.6, "Rotation": 0.2},
        GLOSSY,
        material(base_color=COLOR, roughness=0.5, glossy_only=True, anisotropy=-0.6, anisotropic_rotation=0.2),
    ),
    "metallic": (
        "ShaderNodeBsdfMetallic",
        {"Base Color": COLOR, "Edge Tint": TINT, "Roughness": 0.4, "Anisotropy": 0.5},
        {**GLOSSY, "fresnel_type": "F82"},
        material(base_color=COLOR, specular_tint=TINT, roughness=0.4, metallic=1.0, anisotropy=0.5),
    ),
    "glass of its own": (
        "ShaderNodeBsdfGlass",
        {"Color": COLOR, "Roughness": 0.5, "IOR": 1.9},
        GLOSSY,
        material(base_color=COLOR, roughness=0.5, ior=1.9, transmission=1.0, glass=Glass.GLASS),
    ),
    "refraction": (
        "ShaderNodeBsdfRefraction",
        {"Color": COLOR, "Roughness": 0.6, "IOR": 1.45},
        {"distribution": "GGX"},
        material(base_color=COLOR, roughness=0.6, ior=1.45, transmission=1.0, glass=Glass.REFRACTION),
    ),
}


@pytest.fixture(scope="module")
def scene(gpu: Any) -> Iterator[bpy.types.Scene]:
    yield cycles_plane.new_scene(64)
    bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture(scope="module")
def program(gpu: Any) -> Any:
    return scatter_program()


def _mean_of_shader(m: MaterialArrays, cosine: float, is_back: bool, program: Any) -> np.ndarray:
    count = 1 << 14
    normal = np.array([0.0, 0.0, -1.0 if is_back else 1.0])
    viewers = np.tile(cycles_plane.viewer(cosine, is_back), (count, 1))
    found = scattering(
        [m],
        np.zeros(count, int),
        viewers,
        viewers,
        spread(count),
        is_back,
        normal=tuple(normal),
        program=program,
    )
    reflected = (found.weight * cycles_plane.world(found.direction)[:, None]).mean(axis=0)
    # What falls on the diffuse base: the mean of a ramp, cosine-weighted, is its value at 2/3 of the normal.
    return reflected + found.base[0] * cycles_plane.world(2.0 / 3.0 * normal[None])[0]


@pytest.mark.parametrize("name", [*BY_PRINCIPLED, *OTHERS])
def test_plane_is_as_bright_as_in_cycles(name: str, scene: Any, program: Any, tmp_path: Path) -> None:
    """Within 1 %, at two angles, of what lets light through also from inside."""
    if name in BY_PRINCIPLED:
        fields = {"base_color": COLOR, **BY_PRINCIPLED[name]}
        m = material(**fields)
        cycles_plane.set_material(PRINCIPLED, {SOCKETS[key]: value for key, value in fields.items()}, {})
    else:
        node, inputs, properties, m = OTHERS[name]
        cycles_plane.set_material(node, inputs, properties)
    views = [(0.9, False), (0.4, False)] if m.transmission == 0.0 else [(0.6, False), (0.7, True)]
    for cosine, is_back in views:
        truth = cycles_plane.mean_radiance(scene, cosine, is_back, tmp_path)
        found = _mean_of_shader(m, cosine, is_back, program)
        np.testing.assert_allclose(found, truth, rtol=0.01, atol=0.002)


def test_emission_shines_through_the_coat(scene: Any, program: Any, tmp_path: Path) -> None:
    """The green of it."""
    fields = {"base_color": COLOR, "metallic": 1.0, "roughness": 0.3, **COATED}
    emission = {"Emission Color": (1.0, 1.0, 1.0), "Emission Strength": 2.0}
    cycles_plane.set_material(PRINCIPLED, {**{SOCKETS[key]: value for key, value in fields.items()}, **emission}, {})
    truth = cycles_plane.mean_radiance(scene, 0.5, False, tmp_path)[1]
    m = material(**fields)
    viewers = cycles_plane.viewer(0.5, False)[None]
    passes = scattering([m], np.zeros(1, int), viewers, viewers, spread(1), program=program).coat_passes[0]
    assert passes < 0.9
    found = _mean_of_shader(m, 0.5, False, program)[1] + 2.0 * passes
    assert found == pytest.approx(truth, rel=0.005)


def test_the_comparison_can_fail(scene: Any, program: Any, tmp_path: Path) -> None:
    m = material(base_color=COLOR, metallic=1.0, roughness=0.5)
    cycles_plane.set_material(PRINCIPLED, {"Base Color": COLOR, "Metallic": 1.0, "Roughness": 0.5}, {})
    truth = cycles_plane.mean_radiance(scene, 0.5, False, tmp_path)
    found = _mean_of_shader(replace(m, roughness=0.3), 0.5, False, program)
    assert np.abs(found / truth - 1.0).max() > 0.015
