# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry on the GPU follows the scene, and does no more than it has to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.device.records import read_records
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, only_features
from curvrefl.curvrefl_addon.renderer.geometry.placed_instances import Sight
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import CHUNK_TRIANGLES, SceneGeometry
from curvrefl.curvrefl_addon.renderer.geometry.split import has_long_edges
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays

pytestmark = pytest.mark.usefixtures("gpu")


def soup(triangles: int, seed: int, size: float = 1.0) -> MeshArrays:
    """Triangles anywhere, with normals of their own."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(3 * triangles, 3))
    return MeshArrays(
        name=f"soup {seed}",
        positions=(size * rng.uniform(-1, 1, (3 * triangles, 3))).astype(np.float32),
        corner_vertex=np.arange(3 * triangles, dtype=np.int32),
        corner_normals=(normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32),
        corner_uv=None,
        triangles=np.arange(3 * triangles, dtype=np.int32).reshape(-1, 3),
        triangle_slot=np.zeros(triangles, np.int32),
        signature=seed,
    )


def matrix(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    result = np.eye(4)
    result[:3, :3] = rng.normal(size=(3, 3)) + 2.0 * np.eye(3)
    result[:3, 3] = rng.uniform(-5, 5, 3)
    return result


def a_scene(meshes: list[MeshArrays], count: int) -> SceneArrays:
    return SceneArrays(
        meshes=tuple(meshes),
        instances=tuple(InstanceArrays(f"object {i}", i + 1, i % len(meshes), matrix(i), (0,)) for i in range(count)),
        materials=(MaterialArrays("plain"),),
        images=(),
        lights=(),
        world=WorldArrays(),
        reflectors=(1,),
    )


def with_instance(scene: SceneArrays, index: int, **changes: object) -> SceneArrays:
    instances = list(scene.instances)
    instances[index] = replace(instances[index], **changes)  # type: ignore[arg-type]
    return replace(scene, instances=tuple(instances))


def world_triangles(geometry: SceneGeometry) -> dict[int, np.ndarray]:
    """Per object_id, (triangles, 3, 3) positions and normals next to each other (…, 6), read back."""
    found: dict[int, list[np.ndarray]] = {}
    for chunk in geometry.chunks:
        positions = read_records(chunk.positions, chunk.position_count)
        corners = read_records(chunk.corners, 2 * len(chunk.corner_position))[::2]
        places = positions[np.rint(corners[:, 3]).astype(int)]
        both = np.concatenate([places[:, :3], corners[:, :3]], axis=1)[chunk.triangles]
        ids = np.rint(places[chunk.triangles][:, 0, 3]).astype(int)
        for number in np.unique(ids):
            found.setdefault(int(number), []).append(both[ids == number])
    return {number: np.concatenate(parts) for number, parts in found.items()}


def expected_triangles(scene: SceneArrays) -> dict[int, np.ndarray]:
    found = {}
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        places = mesh.positions @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        normals = mesh.corner_normals @ np.linalg.inv(instance.matrix[:3, :3])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        found[instance.object_id] = np.concatenate([places[mesh.corner_vertex], normals], axis=1)[mesh.triangles]
    return found


def assert_is_scene(geometry: SceneGeometry, scene: SceneArrays) -> None:
    found, expected = world_triangles(geometry), expected_triangles(scene)
    assert found.keys() == expected.keys()
    for number, triangles in expected.items():
        np.testing.assert_allclose(found[number], triangles, rtol=1e-4, atol=1e-4)


def move(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 2, matrix=matrix(99))


def move_many(scene: SceneArrays) -> SceneArrays:
    for index in range(1, 20):
        scene = with_instance(scene, index, matrix=matrix(100 + index))
    return scene


def move_mirror(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 0, matrix=matrix(98))


def bend(scene: SceneArrays) -> SceneArrays:
    """A mesh of eight instances, of which one moves as well."""
    bent = replace(scene.meshes[2], positions=np.sin(2.0 * scene.meshes[2].positions))
    return with_instance(replace(scene, meshes=(*scene.meshes[:2], bent, *scene.meshes[3:])), 6, matrix=matrix(96))


def bend_mirror(scene: SceneArrays) -> SceneArrays:
    bent = replace(scene.meshes[0], corner_normals=scene.meshes[0].corner_normals[::-1].copy())
    return replace(scene, meshes=(bent, *scene.meshes[1:]))


def edit(scene: SceneArrays) -> SceneArrays:
    return replace(scene, meshes=(scene.meshes[0], soup(7, 50), *scene.meshes[2:]))


def remove(scene: SceneArrays) -> SceneArrays:
    return replace(scene, instances=scene.instances[:3] + scene.instances[4:])


def add(scene: SceneArrays) -> SceneArrays:
    return replace(scene, instances=(*scene.instances, InstanceArrays("new", 999, 1, matrix(97), (0,))))


def unseen_by_mirrors(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, 3, visible_glossy=False)


@pytest.mark.parametrize(
    ("act", "placed", "built"),
    [
        (lambda scene: scene, 0, 0),
        (bend, 0, 0),
        (bend_mirror, 0, 0),
        (move, 1, 0),
        (move_many, 19, 0),
        (move_mirror, 1, 0),
        (edit, 0, 1),
        (remove, 0, 1),
        (add, 0, 1),
        (unseen_by_mirrors, 0, 2),
    ],
)
def test_least_work(act: Callable[[SceneArrays], SceneArrays], placed: int, built: int) -> None:
    scene = a_scene([soup(20, seed) for seed in range(4)], 30)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    assert_is_scene(geometry, scene)
    assert geometry.counters["chunks built"] == 2
    changed = act(scene)
    difference = geometry.update(changed, {0: 1})
    assert_is_scene(geometry, changed)
    assert geometry.counters["instances placed"] == placed
    assert geometry.counters["chunks built"] == 2 + built
    assert difference.structure == (built > 0)
    own, _ = geometry.of_instance(0)
    assert all(chunk is not own for chunk, _ in geometry.scenery(0))


def test_a_large_mesh_is_not_built_again_for_a_small_one() -> None:
    large, small = soup(CHUNK_TRIANGLES, 1), soup(5, 2)
    scene = a_scene([soup(4, 3), large, small], 6)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    kept = {id(chunk) for chunk in geometry.chunks if chunk.triangle_count >= CHUNK_TRIANGLES}
    geometry.update(replace(scene, meshes=(scene.meshes[0], large, soup(6, 4))), {0: 1})
    assert kept <= {id(chunk) for chunk in geometry.chunks}


def test_many_edits_leave_few_chunks() -> None:
    scene = a_scene([soup(20, seed) for seed in range(4)], 30)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    for turn in range(20):
        scene = replace(scene, meshes=(scene.meshes[0], soup(7, 50 + turn), *scene.meshes[2:]))
        scene = replace(scene, instances=(*scene.instances, InstanceArrays("new", 1000 + turn, 1, matrix(turn), (0,))))
        geometry.update(scene, {0: 1})
    assert len(geometry.chunks) <= 3
    assert_is_scene(geometry, scene)


class Unsearchable(list[int]):
    """May be gone through, not searched."""

    def __contains__(self, _item: object) -> bool:
        raise AssertionError("searched")


def test_instances_to_build_are_not_searched_for_each_one_that_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Eighteen thousand times two thousand took two seconds."""
    pack = SceneGeometry._pack
    monkeypatch.setattr(SceneGeometry, "_pack", lambda self, indices, kind: pack(self, Unsearchable(indices), kind))
    scene = a_scene([soup(20, seed) for seed in range(4)], 30)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    changed = unseen_by_mirrors(add(scene))
    geometry.update(changed, {0: 1})
    assert_is_scene(geometry, changed)


def floor() -> MeshArrays:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    return MeshArrays(
        "floor",
        corners,
        np.arange(4, dtype=np.int32),
        np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
        None,
        np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        np.zeros(2, np.int32),
    )


def test_splitting_follows_the_mirror() -> None:
    """The floor is split where the mirror is near, again when it comes nearer, not when it moves a little."""
    scene = a_scene([soup(4, 3), floor()], 2)
    wide = np.diag([6.0, 6.0, 1.0, 1.0])
    scene = with_instance(scene, 1, matrix=wide)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})

    def refine(height: float, angle: float = 0.2) -> int:
        geometry.refine([Sight((0.0, 0.0, height), angle, 0)])
        drawn = geometry.placed[1].drawn
        relative = (drawn.positions * np.array([6, 6, 1], np.float32) - np.array([0, 0, height])).astype(np.float32)
        assert not has_long_edges(drawn, relative, angle)
        return geometry.counters["meshes split"]

    assert refine(1.0) == 1
    count = len(geometry.placed[1].drawn.triangles)
    assert count > 100
    assert refine(1.0) == 1
    assert refine(1.5) == 1, "farther away nothing is too long"
    assert refine(0.7) == 2
    assert refine(0.68) == 2, "split with some slack, as it moves"
    assert len(geometry.placed[1].drawn.triangles) > count
    geometry.update(with_instance(scene, 1, matrix=wide @ np.diag([1.0, 1.0, -1.0, 1.0])), {0: 1})
    assert refine(0.68) == 2
    assert refine(0.68, 0.9) == 3, "far too fine now"
    assert len(geometry.placed[1].drawn.triangles) < count


def test_what_no_mirror_sees_is_not_split() -> None:
    scene = with_instance(a_scene([soup(4, 3), floor()], 2), 1, matrix=np.eye(4), visible_glossy=False)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    geometry.refine([Sight((0.0, 0.0, 0.1), 0.1, 0)])
    assert geometry.counters["meshes split"] == 0


@pytest.mark.parametrize("device", [Features(), Features(compute=False)], ids=["compute", "fragments"])
def test_what_deforms_is_uploaded_once_and_moves_as_it_is(device: Features) -> None:
    """One mesh of eight instances, in a chunk with others; then few of them move, many, and what is made anew."""
    with only_features(device):
        scene = a_scene([soup(20, seed) for seed in range(4)], 30)
        geometry = SceneGeometry()
        geometry.update(scene, {0: 1})
        assert geometry.uploads.count == 0, "nothing is kept where nothing deforms"
        scene = bend(scene)
        difference = geometry.update(scene, {0: 1})
        assert sorted(difference.elsewhere) == sorted(difference.deformed) == [2, 6, 10, 14, 18, 22, 26]
        assert geometry.uploads.count == 2, "positions and normals"
        for act in (move, move_many, bend, bend_mirror, unseen_by_mirrors, bend):
            scene = act(scene)
            geometry.update(scene, {0: 1})
            assert_is_scene(geometry, scene)
        assert geometry.uploads.count == 6, "two meshes' positions more, whose normals stay, and two of the mirror's"
        fresh = SceneGeometry()
        fresh.update(scene, {0: 1})
        found, expected = world_triangles(geometry), world_triangles(fresh)
        for number, triangles in expected.items():
            np.testing.assert_array_equal(found[number], triangles)
        np.testing.assert_array_equal(geometry.box_corners(range(30)), fresh.box_corners(range(30)))


def test_another_topology_is_built_anew() -> None:
    scene = a_scene([soup(20, seed) for seed in range(4)], 30)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    scene = bend(scene)
    geometry.update(scene, {0: 1})
    turned = replace(scene.meshes[2], triangles=scene.meshes[2].triangles[:, ::-1].copy())
    scene = replace(scene, meshes=(*scene.meshes[:2], turned, *scene.meshes[3:]))
    assert geometry.update(scene, {0: 1}).deformed == []
    assert_is_scene(geometry, scene)


def test_boxes_of_chunks_hold_what_has_deformed() -> None:
    scene = a_scene([soup(20, seed) for seed in range(4)], 30)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    geometry.chunk_balls(geometry.chunks)
    grown = replace(scene.meshes[2], positions=9.0 * scene.meshes[2].positions)
    scene = replace(scene, meshes=(*scene.meshes[:2], grown, *scene.meshes[3:]))
    geometry.update(scene, {0: 1})
    centers, radii = geometry.chunk_balls(geometry.chunks)
    for chunk, center, radius in zip(geometry.chunks, centers, radii, strict=True):
        places = read_records(chunk.positions, chunk.position_count)[:, :3]
        assert np.linalg.norm(places - center, axis=1).max() <= radius * 1.0001


def test_bounds_of_what_moved_are_those_of_geometry_made_anew() -> None:
    meshes = [soup(20, 1), soup(30, 2, size=3.0)]
    scene = a_scene(meshes, 12)
    geometry = SceneGeometry()
    geometry.update(scene, {0: 1})
    before = [geometry.balls(), geometry.box_corners(range(12))]
    kept = [before[0][0].copy(), before[0][1].copy(), before[1].copy()]
    scene = move(move(scene))
    geometry.update(scene, {0: 1})
    fresh = SceneGeometry()
    fresh.update(scene, {0: 1})
    for known, found in zip(geometry.balls(), fresh.balls(), strict=True):
        np.testing.assert_array_equal(known, found)
    np.testing.assert_array_equal(geometry.box_corners(range(12)), fresh.box_corners(range(12)))
    # Arrays that were given out stay as they were.
    for held, copy in zip((*before[0], before[1]), kept, strict=True):
        np.testing.assert_array_equal(held, copy)
    assert not np.array_equal(geometry.balls()[0], kept[0])
