# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that shine are asked as often as they are strong: chances and densities add up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.indirect.emitters import (
    MOST_EMITTERS,
    RECORDS,
    EmitterTable,
    emitter_table,
    strength_of,
)
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from hypothesis import given, settings
from hypothesis import strategies as st

DARK = MaterialArrays("dark")


def shining(*emission: float) -> MaterialArrays:
    return MaterialArrays("shining", emission=(emission[0], emission[1], emission[2]))


def soup(count: int, seed: int = 0, slots: int = 1) -> MeshArrays:
    """Triangles of all sizes."""
    random = np.random.default_rng(seed)
    size = 10.0 ** random.uniform(-3.0, 1.0, (count, 1, 1))
    corners = random.normal(size=(count, 1, 3)) + size * random.normal(size=(count, 3, 3))
    return MeshArrays(
        "soup",
        corners.reshape(-1, 3).astype(np.float32),
        np.arange(3 * count, dtype=np.int32),
        np.tile(np.array([0, 0, 1], np.float32), (3 * count, 1)),
        None,
        np.arange(3 * count, dtype=np.int32).reshape(-1, 3),
        random.integers(0, slots, count).astype(np.int32),
    )


def placed(
    mesh: int, matrix: np.ndarray | None = None, materials: tuple[int, ...] = (1,), **flags: bool
) -> InstanceArrays:
    return InstanceArrays("thing", 1, mesh, np.eye(4) if matrix is None else matrix, materials, **flags)


def scene(meshes: list[MeshArrays], instances: list[InstanceArrays], *materials: MaterialArrays) -> SceneArrays:
    return SceneArrays(tuple(meshes), tuple(instances), (DARK, *materials), (), (), WorldArrays())


def read(table: EmitterTable | None) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Triangles (n, 3, 3), areas, chances and densities over area (n,)."""
    assert table is not None
    records = table.records.reshape(-1, RECORDS, 4).astype(np.float64)
    a, ab, ac = (records[:, k, :3] for k in range(3))
    chances = np.diff(np.minimum(records[:, 0, 3], 1.0), prepend=0.0)
    return (
        np.stack([a, a + ab, a + ac], axis=1),
        0.5 * np.linalg.norm(np.cross(ab, ac), axis=1),
        chances,
        records[:, 1, 3],
    )


@given(seed=st.integers(0, 10_000), count=st.integers(1, 300), power=st.floats(-4.0, 4.0))
@settings(max_examples=30)
def test_chances_and_densities_add_up(seed: int, count: int, power: float) -> None:
    random = np.random.default_rng(seed)
    matrix = np.diag([*(10.0**power * random.uniform(0.1, 3.0, 3) * random.choice([-1.0, 1.0], 3)), 1.0])
    matrix[:3, 3] = random.normal(size=3) * 10.0**power
    mesh = soup(count, seed, slots=3)
    made = scene([mesh], [placed(0, matrix, (1, 0, 2))], shining(1.0, 2.0, 3.0), shining(0.0, 0.0, 50.0))
    if not np.isin(mesh.triangle_slot, (0, 2)).any():
        assert emitter_table(made) is None
        return
    _, areas, chances, densities = read(emitter_table(made))
    assert len(areas) == np.isin(mesh.triangle_slot, (0, 2)).sum()
    assert chances.min() >= 0.0
    assert chances.sum() == pytest.approx(1.0, abs=1e-6)
    # What a place's density says of a triangle is how often that is chosen.
    assert (areas * densities).sum() == pytest.approx(1.0, rel=1e-4)
    assert np.allclose(areas * densities, chances, rtol=1e-3, atol=1e-6)


def test_areas_are_those_of_the_world() -> None:
    """Of a stretched and turned thing."""
    c, s = np.cos(0.7), np.sin(0.7)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.diag([5.0, 0.2, -3.0])
    mesh = soup(200)
    triangles, areas, chances, _ = read(emitter_table(scene([mesh], [placed(0, matrix)], shining(1, 1, 1))))
    world = mesh.positions.astype(np.float64) @ matrix[:3, :3].T
    corners = world.reshape(-1, 3, 3)
    assert np.allclose(triangles, corners, atol=1e-4)
    expected = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert np.allclose(areas, expected, rtol=1e-3)
    assert np.allclose(chances, expected / expected.sum(), rtol=1e-3, atol=1e-6)


def test_densities_of_materials_are_those_of_their_triangles() -> None:
    made = scene([soup(50), soup(40, 1)], [placed(0), placed(1, materials=(2,))], shining(1, 1, 1), shining(9, 0, 0))
    table = emitter_table(made)
    assert table is not None
    _, _, _, densities = read(table)
    assert table.densities.shape == (3,)
    assert table.densities[0] == 0.0
    assert np.allclose(densities[:50], table.densities[1])
    assert np.allclose(densities[50:], table.densities[2])
    assert table.densities[2] == pytest.approx(3.0 * table.densities[1])


def test_the_last_triangle_is_found_by_every_number() -> None:
    """A search for a number below 1 ends at a triangle."""
    table = emitter_table(scene([soup(1000)], [placed(0)], shining(1, 1, 1)))
    assert table is not None
    ends = table.records.reshape(-1, RECORDS, 4)[:, 0, 3]
    assert (np.diff(ends) >= 0.0).all()
    assert np.searchsorted(ends, np.float32(1.0) - np.float32(2.0**-24), side="right") < table.count
    assert ends[-1] > 1.0


def test_nothing_that_shines_is_nothing() -> None:
    mesh = soup(10)
    assert emitter_table(scene([mesh], [placed(0)], DARK)) is None
    assert emitter_table(scene([mesh], [placed(0)], shining(0, 0, 0))) is None
    assert emitter_table(scene([mesh], [placed(0, materials=(0,))], shining(1, 1, 1))) is None
    for flags in ({"visible_diffuse": False}, {"holdout": True}):
        assert emitter_table(scene([mesh], [placed(0, **flags)], shining(1, 1, 1))) is None
    flat = replace(mesh, positions=np.zeros_like(mesh.positions))
    assert emitter_table(scene([flat], [placed(0)], shining(1, 1, 1))) is None


def test_what_is_hidden_has_no_density() -> None:
    """Rays that meet it, if any, count as the only ones to find it."""
    made = scene(
        [soup(10)], [placed(0), placed(0, materials=(2,), visible_diffuse=False)], shining(1, 1, 1), shining(5, 5, 5)
    )
    _, areas, chances, densities = read(emitter_table(made))
    assert len(areas) == 10
    assert (areas * densities).sum() == pytest.approx(1.0, rel=1e-4)
    assert chances.sum() == pytest.approx(1.0, abs=1e-6)


def test_of_too_many_the_strongest_are_lights() -> None:
    """Their chances add up to 1 all the same."""
    count = MOST_EMITTERS + 5000
    corners = np.tile(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), (count, 1, 1))
    corners[:5000] *= 1e-3
    mesh = replace(
        soup(1),
        positions=corners.reshape(-1, 3),
        corner_vertex=np.arange(3 * count, dtype=np.int32),
        triangles=np.arange(3 * count, dtype=np.int32).reshape(-1, 3),
        triangle_slot=np.zeros(count, np.int32),
    )
    _, areas, chances, _ = read(emitter_table(scene([mesh], [placed(0)], shining(1, 1, 1))))
    assert len(areas) == MOST_EMITTERS
    assert areas.min() > 0.4
    assert chances.sum() == pytest.approx(1.0, abs=1e-6)
    assert chances.min() > 0.0


def test_strength_is_the_mean_of_what_is_sent() -> None:
    assert strength_of(shining(1.0, 2.0, 6.0)) == pytest.approx(3.0)
    assert strength_of(DARK) == 0.0
    assert strength_of(shining(-1.0, -1.0, -1.0)) == 0.0
