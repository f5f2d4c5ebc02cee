# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that glTF files say of materials, as Blender's importer builds it: read without a warning, drawn as by Cycles."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.arrays import Glass, SceneArrays
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add, empty_scene, extracted, link, material_of, new_material
from materials.gltf_files import MATERIALS, PAINTED, export_gltf, import_gltf, write_gltf

COLUMNS, ROWS = 5, 4
TILE = 16
"""Pixels of a square's meter"""
COAT = 'Normals of material "bumpy coat" that are its coat\'s alone are left out.'
LIMIT = 0.012
LIMITS = {"anisotropy": 0.04}
"""Of mean errors; lamps shine on scenery's metal as if it were not brushed"""


@pytest.fixture
def imported(tmp_path: Path) -> Path:
    """The folder of the file, which is in the scene."""
    path = tmp_path / "made.gltf"
    write_gltf(path, MATERIALS, COLUMNS, PAINTED)
    empty_scene()
    import_gltf(path)
    return tmp_path


def said(scene: SceneArrays) -> list[str]:
    """Of materials, but for the one thing that is known to be left out."""
    about = [warning for warning in scene.warnings if any(word in warning for word in ("material", "mage", "node"))]
    return [warning for warning in about if warning != COAT]


def test_nothing_is_left_out(imported: Path) -> None:
    assert not said(extracted())


def test_nothing_is_left_out_of_what_blender_exports(imported: Path) -> None:
    path = imported / "exported.glb"
    export_gltf(path)
    empty_scene()
    import_gltf(path)
    scene = extracted()
    assert {instance.object_name for instance in scene.instances} == set(MATERIALS)
    assert not said(scene)


@pytest.mark.parametrize("name", MATERIALS)
def test_nothing_is_left_out_of_a_mirror(imported: Path, name: str) -> None:
    found = [warning for warning in said(extracted(bpy.data.objects[name])) if name in warning]
    assert not found


def test_constants_are_those_of_the_file(imported: Path) -> None:
    scene = extracted()
    volume = material_of(scene, "volume")
    assert (volume.transmission, volume.glass, volume.roughness) == (1.0, Glass.PRINCIPLED, 0.0)
    # (As the importer's Volume Absorption node has it.)
    np.testing.assert_allclose(volume.absorption, (1.0 - np.array((0.5, 0.25, 1.0))) / 2.0, rtol=1e-5)
    assert material_of(scene, "index of refraction").ior == 1.25
    assert material_of(scene, "blend").is_seen_through and not material_of(scene, "opaque").is_seen_through


@pytest.mark.usefixtures("gpu")
def test_squares_in_a_mirror_are_those_of_cycles(imported: Path) -> None:
    mirror = _mirrored_wall()
    scene = bpy.context.scene
    width, height = COLUMNS * TILE, ROWS * TILE
    view = view_of_camera(scene, scene.camera, width, height)
    ours = Renderer(extracted(mirror), Settings(method="exact", samples=64)).render(view).color()[..., :3]
    cycles = _mirrored_light(width, height)
    errors = np.abs(ours - cycles).reshape(ROWS, TILE, COLUMNS, TILE, 3).mean(axis=(1, 3, 4))
    wrong = {}
    for number, name in enumerate(MATERIALS):
        row, column = divmod(number, COLUMNS)
        # (In the mirror left is right.)
        error = float(errors[row, COLUMNS - 1 - column])
        if error > LIMITS.get(name, LIMIT):
            wrong[name] = error
    assert not wrong


def _mirrored_wall() -> Any:
    """The squares, seen in a flat mirror by an orthographic camera between both; a backdrop that shines, a sun."""
    scene = bpy.context.scene
    backdrop = add("backdrop", [(-2, 0.6, -2), (7, 0.6, -2), (7, 0.6, 6), (-2, 0.6, 6)], [(0, 1, 2, 3)])
    new_material(backdrop, "ShaderNodeEmission")[1][0].inputs["Color"].default_value = (0.3, 0.35, 0.4, 1.0)
    middle = ((COLUMNS - 1) / 2.0, (ROWS - 1) / 2.0)
    far = -6.0
    mirror = add("mirror", [(-2, far, -2), (-2, far, 6), (7, far, 6), (7, far, -2)], [(0, 1, 2, 3)])
    mirror.visible_shadow = False
    _, (metal,) = new_material(mirror, "ShaderNodeBsdfAnisotropic")
    metal.inputs["Roughness"].default_value = 0.0
    metal.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", float(COLUMNS)
    eye = link(bpy.data.objects.new("camera", camera))
    eye.location, eye.rotation_euler = (middle[0], -3.0, middle[1]), (math.pi / 2.0, 0.0, math.pi)
    scene.camera = eye
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 2.0, 0.1
    lamp = link(bpy.data.objects.new("sun", sun))
    lamp.rotation_euler = (0.9, 0.2, 0.3)
    # What shines lights nothing else, as in direct light.
    for material in bpy.data.materials:
        material.cycles.emission_sampling = "NONE"
    return mirror


def _mirrored_light(width: int, height: int) -> Any:
    """(height, width, 3): light straight from the sun, by one mirror and through what is clear."""
    scene = bpy.context.scene
    cycles: Any = scene.cycles
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 12, 0, 1, 12
    cycles.caustics_reflective = cycles.caustics_refractive = False
    still = render_reference(scene, bpy.context.view_layer, width, height, 256, "full")
    return np.asarray(still.pixels)[..., :3]
