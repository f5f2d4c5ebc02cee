# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies of meshes that deform are fitted where they are, to the bit of what numpy makes of the same tree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.records import read_records
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, only_features
from curvrefl.curvrefl_addon.renderer.geometry.mesh_facts import MeshFactsCache
from curvrefl.curvrefl_addon.renderer.geometry.vertex_uploads import VertexUploads
from curvrefl.curvrefl_addon.renderer.rays import mesh_trees
from curvrefl.curvrefl_addon.renderer.rays.hierarchy_fit import JUDGED, LARGEST_NUMBER, HierarchyFit
from curvrefl.curvrefl_addon.renderer.rays.mesh_rays import MeshRays, MeshTree, triangle_boxes
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RayScene
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays

pytestmark = pytest.mark.usefixtures("gpu")


def sheet(triangles: int, has_seams: bool = False) -> MeshArrays:
    """A strip of triangles that share vertices; with seams every corner is one of its own."""
    rng = np.random.default_rng(triangles)
    positions = rng.normal(size=(triangles + 2, 3)).astype(np.float32)
    positions[:, 0] = 0.3 * np.arange(triangles + 2)
    vertices = np.arange(triangles, dtype=np.int32)[:, None] + np.arange(3, dtype=np.int32)
    corner_vertex = vertices.reshape(-1) if has_seams else np.arange(triangles + 2, dtype=np.int32)
    normals = rng.normal(size=(len(corner_vertex), 3)).astype(np.float32)
    return MeshArrays(
        name="sheet",
        positions=positions,
        corner_vertex=corner_vertex,
        corner_normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        corner_uv=None,
        triangles=np.arange(3 * triangles, dtype=np.int32).reshape(-1, 3) if has_seams else vertices,
        triangle_slot=np.zeros(triangles, np.int32),
    )


def waved(mesh: MeshArrays, phase: float) -> MeshArrays:
    """Its vertices elsewhere, with other normals."""
    turned = np.roll(mesh.corner_normals, 1, axis=1)
    positions = mesh.positions + np.sin(mesh.positions[:, [1, 2, 0]] + np.float32(phase), dtype=np.float32)
    return replace(mesh, positions=positions, corner_normals=turned)


def scene_of(*meshes: MeshArrays) -> SceneArrays:
    instances = [InstanceArrays(f"sheet {i}", i + 1, i, np.eye(4), (0,)) for i in range(len(meshes))]
    return SceneArrays(meshes, tuple(instances), (MaterialArrays("gray"),), (), (), WorldArrays())


def rays_of(scene: SceneArrays) -> RayScene:
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {})
    return rays


def item_of(rays: RayScene, mesh: MeshArrays) -> MeshRays:
    return rays._meshes[id(mesh)]


def assert_holds(rays: RayScene, mesh: MeshArrays) -> None:
    """Records of its tree are those that numpy makes of the tree as it is now."""
    item = item_of(rays, mesh)
    tree = item.hierarchy.fitted(*triangle_boxes(mesh, item.kept))
    expected = MeshTree(mesh, item.kept, tree, tree.cost(), True).records()
    found = read_records(rays.regions.texture, rays.regions.texture.width * rays.regions.texture.height)
    for start, records in zip(item.starts, expected, strict=True):
        np.testing.assert_array_equal(found[start : start + len(records)], records)


@pytest.mark.parametrize("has_seams", [False, True], ids=["smooth", "seams"])
@pytest.mark.parametrize("triangles", [1, 4, 5, 40, 3001])
def test_records_are_those_of_the_tree_fitted_by_numpy(
    triangles: int, has_seams: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh_trees, "FEW", 100)
    mesh, other = sheet(triangles, has_seams), sheet(7)
    rays = rays_of(scene_of(other, mesh))
    start = item_of(rays, mesh).starts
    assert item_of(rays, mesh).fit is None, "nothing is kept where nothing deforms"
    for phase in (0.0, 1.0, 2.0):
        mesh = waved(mesh, phase)
        rays.follow(scene_of(other, mesh), {})
        assert item_of(rays, mesh).starts == start, "where it was"
        assert_holds(rays, mesh)
    assert_holds(rays, other)
    assert rays.counters["hierarchies built"] == 2 and rays.counters["hierarchies fitted"] == 3


def test_the_top_level_holds_what_has_deformed() -> None:
    mesh, other = sheet(300), sheet(7)
    rays = rays_of(scene_of(other, mesh))
    bent = replace(mesh, positions=5.0 * mesh.positions)
    rays.follow(scene_of(other, bent), {})
    top = rays._top
    assert top is not None
    assert (top.low[0] <= bent.positions.min(axis=0)).all() and (top.high[0] >= bent.positions.max(axis=0)).all()
    assert (top.high[0] < 1.01 * bent.positions.max(axis=0) + 0.01).all()


def test_the_cost_is_that_of_the_tree() -> None:
    mesh = sheet(3001)
    rays = rays_of(scene_of(mesh))
    bent = waved(mesh, 0.5)
    rays.follow(scene_of(bent), {})
    item = item_of(rays, bent)
    assert item.fit is not None and item.is_judged
    assert item.fit.cost() == pytest.approx(item.present_hierarchy.cost(), rel=1e-4)
    assert not item.is_judged, "read once"
    for turn in range(1, JUDGED + 1):
        bent = waved(bent, 0.1 * turn)
        rays.follow(scene_of(bent), {})
        assert item_of(rays, bent).is_judged == (turn == JUDGED)


def shuffled(mesh: MeshArrays) -> MeshArrays:
    """No vertex is near those that were its neighbors."""
    order = np.random.default_rng(0).permutation(len(mesh.positions))
    return replace(mesh, positions=mesh.positions[order])


@pytest.mark.parametrize("rests", [False, True], ids=["deforms on", "rests"])
def test_a_tree_that_has_become_bad_is_built_anew(rests: bool) -> None:
    mesh = sheet(3001)
    rays = rays_of(scene_of(mesh))
    before = item_of(rays, mesh).cost
    bad = shuffled(mesh)
    rays.follow(scene_of(bad), {})
    assert item_of(rays, bad).present_hierarchy.cost() > 10.0 * before
    assert rays.counters["hierarchies built"] == 1
    if rests:
        assert rays.can_improve
        rays.improve()
    else:
        bad = waved(bad, 0.0)
        rays.follow(scene_of(bad), {})
    assert rays.counters["hierarchies built"] == 2
    expected = rays_of(scene_of(bad))
    assert item_of(rays, bad).cost == item_of(expected, bad).cost
    assert_holds(rays, bad)
    again = waved(bad, 0.3)
    rays.follow(scene_of(again), {})
    assert_holds(rays, again)
    assert rays.counters["hierarchies built"] == 2


def test_a_better_tree_that_is_under_way_is_of_the_shape_that_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_trees, "FEW", 0)
    mesh = sheet(3001)
    rays = rays_of(scene_of(mesh))
    rays.improve()
    rays.improve()
    bent = waved(mesh, 0.4)
    rays.follow(scene_of(bent), {})
    rays.finish()
    assert rays.counters["hierarchies improved"] == 1
    assert_holds(rays, bent)
    assert item_of(rays, bent).cost == item_of(rays, bent).hierarchy.cost()


def test_what_cannot_be_fitted_where_it_is_goes_the_other_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another topology, other attributes, a device without compute shaders, numbers that single precision lacks."""
    mesh = sheet(300)
    rays = rays_of(scene_of(mesh))
    turned = replace(waved(mesh, 0.1), triangles=mesh.triangles[:, ::-1].copy())
    painted = replace(waved(turned, 0.2), triangle_slot=mesh.triangle_slot.copy())
    for changed in (turned, painted):
        rays.follow(scene_of(changed), {})
        assert item_of(rays, changed).fit is None
        assert_holds(rays, changed)
    bent = waved(painted, 0.3)
    with only_features(Features(compute=False)):
        rays.follow(scene_of(bent), {})
    assert item_of(rays, bent).fit is None
    assert_holds(rays, bent)
    assert HierarchyFit.serves(item_of(rays, bent).hierarchy, bent)
    large = np.broadcast_to(np.int64(0), (LARGEST_NUMBER,))
    assert not HierarchyFit.serves(replace(item_of(rays, bent).hierarchy, order=large), bent)
    far = replace(bent, positions=1e19 * bent.positions)
    rays.follow(scene_of(far), {})
    assert rays.warnings
