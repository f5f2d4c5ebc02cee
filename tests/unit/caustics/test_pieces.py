# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches that are cut, pieces of light where they land, and the lists that have these by place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.sampler import hash_array
from curvrefl.curvrefl_addon.renderer.caustics.casters import casters_of
from curvrefl.curvrefl_addon.renderer.caustics.left_out import not_followed
from curvrefl.curvrefl_addon.renderer.caustics.lists import PIECE_RECORDS, records_of
from curvrefl.curvrefl_addon.renderer.caustics.patches import patches_of
from curvrefl.curvrefl_addon.renderer.caustics.pieces import Landed, pieces_of
from curvrefl.curvrefl_addon.renderer.geometry.mesh_facts import MeshFactsCache
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.meshes.made import quad_mesh

CHROME = MaterialArrays("chrome", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
ROUGH = replace(CHROME, roughness=0.6)
GLASS = replace(CHROME, metallic=0.0, transmission=1.0)
STRIP = np.array([[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.1, 0.0], [0.0, 0.1, 0.0]])
ABOVE = (LightArrays("sun", "SUN", (1.0, 1.0, 1.0), np.eye(4)), np.array([0.0, 0.0, 1.0, 0.0]))


def scene_of(*materials: MaterialArrays) -> SceneArrays:
    mesh = quad_mesh("strip", STRIP, (0.0, 0.0, 1.0))
    things = tuple(InstanceArrays("strip", k + 1, 0, np.eye(4), (k,)) for k in range(len(materials)))
    return SceneArrays((mesh,), things, materials, (), (), WorldArrays(), (1,))


def landed(positions: np.ndarray, normals: np.ndarray | None = None) -> Landed:
    """Patches (n, 3, 3) under light that comes straight down, of power 1."""
    count = len(positions)
    up = np.tile([0.0, 0.0, 1.0], (count, 3, 1))
    ones = np.ones((count, 3))
    return Landed(positions, ones, up if normals is None else normals, -up, np.ones((count, 3, 3)), ones)


def test_what_throws() -> None:
    """Chosen mirrors and glass; not what is rough, and no metal that nobody chose."""
    facts = MeshFactsCache()
    for materials, expected in (((CHROME,), {0}), ((ROUGH,), set()), ((CHROME, CHROME, GLASS), {0, 2})):
        found = casters_of(scene_of(*materials), {0: 1}, facts)
        assert (set() if found is None else set(found.instances.tolist())) == expected


def test_what_is_not_followed_is_named() -> None:
    shining = replace(CHROME, metallic=0.0, emission=(1.0, 1.0, 1.0))
    scene = scene_of(CHROME, CHROME, ROUGH, GLASS)
    assert not_followed(scene) == ('Caustics of "strip" are left out: of metal only chosen mirrors throw them.',)
    assert not_followed(scene_of(CHROME, ROUGH, GLASS)) == ()
    (sentence,) = not_followed(scene_of(CHROME, shining))
    assert sentence == 'Caustics of the light of "strip" are spread evenly: only lamps\' are followed.'


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_patches_are_even_and_whole(turn: int) -> None:
    """A strip eighty times as long as it is wide is cut into what is nearly square, without gaps."""
    casters = casters_of(scene_of(CHROME), {0: 1}, MeshFactsCache())
    assert casters is not None
    patches = patches_of(casters, [ABOVE], 1000, turn)
    assert 700 <= patches.count <= 2000
    ends = np.einsum("nkw,nwc->nkc", patches.weights, casters.corners[patches.triangles])
    area = 0.5 * np.linalg.norm(np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0]), axis=1)
    np.testing.assert_allclose(area, patches.areas, rtol=1e-9)
    assert area.sum() == pytest.approx(0.8)
    longest = np.linalg.norm(np.roll(ends, -1, axis=1) - ends, axis=2).max(axis=1)
    # (A cut into like pieces would leave all of them at 160. At the tips of the triangles some stay thin.)
    assert np.median(longest**2 / area) < 25.0
    points = patches.points
    places = np.einsum("nw,nwc->nc", points.weights, casters.corners[points.triangles])
    np.testing.assert_allclose(places[patches.corners], ends, atol=1e-12)
    # A lamp behind a closed thing's back, or below a floor's edge, gets no patches.
    below = (ABOVE[0], np.array([1.0, 0.0, 0.0, 0.0]))
    assert patches_of(casters, [below], 1000, turn).count == 0


def test_power_goes_to_the_area_across_the_light() -> None:
    """However steep the surface is, and where a patch lands on its own side or in one point."""
    flat = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    steep = flat + np.array([0.0, 0.0, 3.0]) * flat[:, :1]
    needle = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    point = np.zeros((3, 3))
    slope = np.tile(np.array([-3.0, 0.0, 1.0]) / np.sqrt(10.0), (3, 1))
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    there = landed(np.stack([flat, steep, needle, point]), np.stack([up, slope, up, up]))
    pieces = pieces_of(there, np.full(4, 0.5), np.tile([1.0, 1.0], (4, 1)))
    assert pieces.count == 4
    across = pieces.corners[..., :2]
    ab, ac = across[:, 1] - across[:, 0], across[:, 2] - across[:, 0]
    area = 0.5 * np.abs(ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])
    np.testing.assert_allclose(area * pieces.irradiance[:, 0], 0.5, rtol=1e-9)
    np.testing.assert_allclose(area[:2], 1.0, rtol=1e-9)
    assert (area[2:] < 0.1).all()


def test_edges_have_a_piece_on_each_side() -> None:
    """A patch over a table's edge lights the table and the floor, each as bright; one that is not whole lights none."""
    over = np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 0.0], [0.0, 0.1, 1.0]])
    pieces = pieces_of(landed(over[None]), np.array([0.005]), np.array([[0.1, 0.1]]))
    assert sorted(pieces.corners[..., 2].mean(axis=1).round(6).tolist()) == [0.0, 1.0]
    np.testing.assert_allclose(pieces.irradiance, 1.0, rtol=1e-9)
    lost = replace(landed(over[None]), objects=np.array([[1.0, 1.0, 0.0]]))
    assert lost.is_parted.all()
    assert pieces_of(lost, np.ones(1), np.ones((1, 2))).count == 0


def test_lists_have_all_pieces_at_a_place() -> None:
    """What the shader does, done in numpy, finds the pieces that a search through all of them does."""
    random = np.random.default_rng(5)
    middles = random.uniform(-2.0, 2.0, (4000, 1, 3)) * (1.0, 1.0, 0.0)
    sizes = 10.0 ** random.uniform(-2.5, -0.3, (4000, 1, 1))
    corners = middles + sizes * random.normal(size=(4000, 3, 3)) * (1.0, 1.0, 0.02)
    pieces = pieces_of(landed(corners), np.ones(4000), np.tile(sizes[:, 0], 2))
    records = records_of(pieces).astype(np.float64)
    head = records[0].astype(int)
    tables = records[head[2] :].reshape(-1, PIECE_RECORDS, 4)
    lists = records[head[1] : head[2]].ravel().astype(int)
    found_any = 0
    for place in random.uniform(-2.0, 2.0, (200, 3)) * (1.0, 1.0, 0.0):
        offset = place - tables[:, 0, :3]
        u, v, h = (
            np.einsum("nc,nc->n", row, offset) for row in (tables[:, 1, :3], tables[:, 2, :3], tables[:, 1:4, 3])
        )
        expected = np.flatnonzero((u >= 0) & (v >= 0) & (u + v <= 1) & (np.abs(h) <= tables[:, 0, 3]))
        listed: list[int] = []
        for size, first, mask, _ in records[1 : 1 + head[0]]:
            bits = np.floor(place / size).astype(np.int64).astype(np.uint32)[None]
            key = hash_array(bits[:, 0] ^ hash_array(bits[:, 1] ^ hash_array(bits[:, 2])))[0] & np.uint32(int(mask))
            start, count = records[int(first) + int(key), :2].astype(int)
            listed += lists[start : start + count].tolist()
        assert len(set(listed)) == len(listed)
        assert set(expected.tolist()) <= set(listed)
        found_any += len(expected)
    assert found_any > 500
