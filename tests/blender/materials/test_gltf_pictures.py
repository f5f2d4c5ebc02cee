# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that glTF files say of materials, as Blender's importer builds it: read without a warning, drawn as by Cycles."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import Glass, SceneArrays
from extraction import empty_scene, extracted, material_of
from materials.gltf_files import MATERIALS, PAINTED, export_gltf, import_gltf, write_gltf
from materials.mirrored_wall import pictures_of_wall

COLUMNS, ROWS = 5, 4
OF_SCENERY = "left out where it is no mirror."
"""End of what is said of anisotropy and thin films"""
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
    """Of materials, but for what is known to be left out."""
    about = [warning for warning in scene.warnings if any(word in warning for word in ("material", "mage", "node"))]
    return [warning for warning in about if warning != COAT and not warning.endswith(OF_SCENERY)]


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
    wall = pictures_of_wall(COLUMNS, ROWS)
    errors = np.abs(wall.ours - wall.cycles).mean(axis=(2, 3, 4))
    wrong = {}
    for number, name in enumerate(MATERIALS):
        error = float(errors[divmod(number, COLUMNS)])
        if error > LIMITS.get(name, LIMIT):
            wrong[name] = error
    assert not wrong
