# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair of curves and of particles, and points, as meshes and beside Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene
from curvrefl.curvrefl_addon.scene.programs.program import GEOMETRY, UV, Attribute
from curvrefl.curvrefl_addon.scene.strands.particles import hair_systems
from curvrefl.curvrefl_addon.scene.strands.reading import read_strands
from curvrefl.curvrefl_addon.scene.strands.strands import INTERCEPT, LENGTH, RANDOM, THICKNESS
from extraction import add, add_square, cycles_picture, empty_scene, extracted, link, look_down, new_material


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def shining(obj: Any) -> None:
    new_material(obj, "ShaderNodeEmission")


def hair_of(points: np.ndarray, radii: np.ndarray) -> Any:
    """Curves through points (strands, n, 3) with radii (strands, n)."""
    curves: Any = bpy.data.hair_curves.new("Hair")
    curves.add_curves([points.shape[1]] * len(points))
    curves.points.foreach_set("position", points.astype(np.float32).reshape(-1))
    curves.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii.astype(np.float32).reshape(-1))
    obj = link(bpy.data.objects.new("Hair", curves))
    shining(obj)
    return obj


def mesh_called(scene: SceneArrays, name: str) -> MeshArrays:
    (mesh,) = {
        id(scene.meshes[item.mesh]): scene.meshes[item.mesh] for item in scene.instances if item.object_name == name
    }.values()
    return mesh


def pictures(width: int = 96, samples: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """(h, w, 3) ours and Cycles' from above, of what shines."""
    mirror = add("Mirror", [(50, 50, 0), (51, 50, 0), (51, 51, 0)], [(0, 1, 2)])
    scene, _ = bpy.context.scene, look_down(4.0)
    arrays, view = read_render_scene(scene, bpy.context.view_layer, [mirror.name], width, width)
    ours = np.asarray(Renderer(arrays, Settings(method="exact", samples=samples)).render(view).color())[..., :3]
    return ours, cycles_picture(width, width, samples)


def bent(count: int) -> np.ndarray:
    """(count, 6, 3)"""
    random = np.random.default_rng(1)
    t = np.linspace(0.0, 1.0, 6)
    roots = random.uniform(-1.5, 1.5, (count, 3)) * (1.0, 1.0, 0.1)
    steps = np.stack([t, 0.4 * np.sin(4.0 * t), 0.0 * t], axis=1)
    turns = random.uniform(0.0, 2.0 * np.pi, count)
    turn = np.array([[np.cos(turns), -np.sin(turns), 0 * turns], [np.sin(turns), np.cos(turns), 0 * turns]])
    turned = np.concatenate([np.einsum("ijn,kj->nki", turn, steps), np.zeros((count, 6, 1))], axis=2)
    return roots[:, None] + turned


def test_few_strands_are_where_cycles_has_them(gpu: None) -> None:
    points = bent(8)
    hair_of(points, np.tile(np.linspace(0.12, 0.02, 6), (8, 1)))
    ours, cycles = pictures()
    assert 0.05 < cycles.mean() < 0.5
    off = np.abs(ours - cycles).mean(axis=2)
    assert off.mean() < 0.02 * cycles.mean() * 4.0
    assert np.count_nonzero(off > 0.5) < 0.002 * off.size


def test_many_strands_cover_as_much_as_those_of_cycles(gpu: None) -> None:
    points = bent(9000)
    hair_of(points, np.full((9000, 6), 0.0005))
    ours, cycles = pictures()
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.03)


def test_points_are_balls(gpu: None) -> None:
    random = np.random.default_rng(2)
    cloud: Any = bpy.data.pointclouds.new("Cloud")
    cloud.resize(20)
    places = random.uniform(-1.5, 1.5, (20, 3)).astype(np.float32)
    cloud.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    radii = random.uniform(0.1, 0.4, 20).astype(np.float32)
    cloud.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
    shining(link(bpy.data.objects.new("Cloud", cloud)))
    ours, cycles = pictures()
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.01)
    assert np.count_nonzero(np.abs(ours - cycles).mean(axis=2) > 0.5) < 0.002 * ours[..., 0].size
    mesh = mesh_called(extracted(), "Cloud")
    assert np.allclose(np.linalg.norm(mesh.corner_normals, axis=1), 1.0, atol=1e-5)


def test_what_has_no_radius_is_as_thick_as_in_cycles(gpu: None) -> None:
    hair = hair_of(bent(40), np.zeros((40, 6)))
    hair.data.attributes.remove(hair.data.attributes["radius"])
    cloud: Any = bpy.data.pointclouds.new("Cloud")
    cloud.resize(300)
    cloud.attributes["position"].data.foreach_set(
        "vector", np.random.default_rng(2).uniform(-2.0, 2.0, 900).astype(np.float32)
    )
    obj = link(bpy.data.objects.new("Cloud", cloud))
    shining(obj)
    hair.hide_render = True
    ours, cycles = pictures(samples=64)
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.1)
    hair.hide_render, obj.hide_render = False, True
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    ours, cycles = pictures(samples=64)
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.1)


def particles(**settings: Any) -> Any:
    square = add_square("Bed", 3.0)
    shining(square)
    modifier: Any = square.modifiers.new("Hair", "PARTICLE_SYSTEM")
    own = modifier.particle_system.settings
    own.type, own.count, own.hair_length = "HAIR", 40, 1.0
    own.radius_scale = 0.08
    for name, value in settings.items():
        setattr(own, name, value)
    return square


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"shape": 0.6, "root_radius": 0.6, "tip_radius": 0.2, "use_close_tip": False},
        {"child_type": "SIMPLE", "rendered_child_count": 5, "kink": "CURL", "kink_amplitude": 0.2},
    ],
)
def test_hair_of_particles_is_that_of_cycles(settings: dict[str, Any], gpu: None) -> None:
    bed = particles(**settings)
    bed.rotation_euler = (1.2, 0.3, 0.0)
    bed.show_instancer_for_render = False
    ours, cycles = pictures()
    assert cycles.mean() > 0.02
    assert ours.mean() == pytest.approx(cycles.mean(), rel=0.04)
    assert np.abs(ours - cycles).mean() < 0.2 * cycles.mean()


def test_strands_have_attributes() -> None:
    hair = hair_of(bent(3), np.tile(np.linspace(0.1, 0.0, 6), (3, 1)))
    hair.data.attributes.new("tint", "FLOAT", "CURVE").data.foreach_set("value", [0.25, 0.5, 0.75])
    hair.data.attributes.new("surface_uv_coordinate", "FLOAT2", "CURVE").data.foreach_set("vector", [0.1, 0.2] * 3)
    names = [Attribute(GEOMETRY, name) for name in ("tint", INTERCEPT, LENGTH, THICKNESS, RANDOM)]
    wanted = tuple(sorted([*names, Attribute(UV, ""), Attribute(GEOMETRY, "none")]))
    mesh = read_strands(hair, MeshNeeds(attributes=wanted)).mesh
    assert mesh.attributes == tuple(sorted([*names, Attribute(UV, "")]))
    assert mesh.corner_attributes is not None
    found = {item.name: mesh.corner_attributes[:, number] for number, item in enumerate(mesh.attributes)}
    assert set(found["tint"][:, 0].tolist()) == {0.25, 0.5, 0.75}
    assert np.allclose(found[""], (0.1, 0.2, 0.0, 1.0))
    assert found[INTERCEPT][:, 0].min() == 0.0
    assert found[INTERCEPT][:, 0].max() == 1.0
    assert np.allclose(found[LENGTH][:, 0], found[LENGTH][0, 0])
    assert found[THICKNESS][:, 0].max() == pytest.approx(0.2)
    assert len(set(found[RANDOM][:, 0].tolist())) == 3


def test_hair_of_particles_has_the_coordinates_of_its_roots() -> None:
    particles()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for item in depsgraph.object_instances:
        for hair in hair_systems(item, bpy.context.view_layer, False):
            mesh = read_strands(hair, MeshNeeds(attributes=(Attribute(UV, ""),))).mesh
            assert mesh.corner_attributes is not None
            roots = mesh.corner_attributes[mesh.positions[:, 2] < 0.1, 0, :2]
            places = mesh.positions[mesh.positions[:, 2] < 0.1, :2]
            assert len(roots) >= 40
            assert np.abs(roots - (places / 3.0 + 0.5)).max() < 0.1


def test_hair_follows_its_emitter_and_is_no_mirror() -> None:
    bed = particles()
    scene = extracted(bed)
    assert len(scene.instances) == 2
    assert [item.object_id in scene.reflectors for item in scene.instances].count(True) == 1
    hair = next(item for item in scene.instances if item.object_id not in scene.reflectors)
    bed.location.x = 5.0
    moved = next(item for item in extracted().instances if len(scene.meshes[item.mesh].triangles) > 10)
    assert moved.matrix[0, 3] == hair.matrix[0, 3] + 5.0


def test_a_reflector_has_a_surface() -> None:
    hair = hair_of(bent(3), np.full((3, 6), 0.1))
    with pytest.raises(InputError, match="surface"):
        extracted(hair)
