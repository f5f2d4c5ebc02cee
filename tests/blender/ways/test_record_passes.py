# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices without compute shaders or image atomics solve, place and copy the same records another way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.curvature_regions import curvature_regions
from curvrefl.curvrefl_addon.renderer.device.record_regions import RecordRegions
from curvrefl.curvrefl_addon.renderer.device.records import TEXTURE_WIDTH, read_records
from curvrefl.curvrefl_addon.renderer.device.shaders import ShaderError
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, features, only_features, use_features
from curvrefl.curvrefl_addon.renderer.geometry.chunk import Chunk, Placed
from curvrefl.curvrefl_addon.renderer.vertices.grid_solve import ChunkGrid
from curvrefl.curvrefl_addon.renderer.vertices.solve import RegionTextures, solve_region, solve_vertices
from scenes.mirror_room import Room
from scenes.radial_maps import SURFACES, radial_map
from ways.lacking import EYE, LACKING, WHOLE, Ellipsoids, eyed

pytestmark = pytest.mark.usefixtures("gpu")

COUNT = 5000
"""More than two rows of records"""
ROUNDED = 1e-5
"""Compilers of compute and fragment shaders may round sums in another order"""


def same_solution(found: list[np.ndarray], usual: list[np.ndarray]) -> None:
    """Statuses of all but a few in ten thousand; points of the others."""
    points, code, _, virtual = found
    expected, expected_code, _, expected_virtual = usual
    alike = code == expected_code
    assert alike.mean() >= 0.9995
    for one, other in ((points, expected), (virtual, expected_virtual)):
        scale = np.maximum(np.abs(other[alike]), 1.0)
        assert np.quantile(np.abs(one[alike] - other[alike]) / scale, 0.999) < ROUNDED


@pytest.mark.parametrize("lacks", ["compute", "atomics"])
@pytest.mark.parametrize("method", ["newton", "newton_refraction", "secant_star", "bisector_cube", "planar"])
def test_solvers(method: str, lacks: str) -> None:
    around = Ellipsoids(COUNT)
    usual = around.solve(method, WHOLE)
    found = around.solve(method, LACKING[lacks])
    same_solution(list(found.read()), list(usual.read()))
    assert found.read()[1][COUNT // 2] == status.INVALID
    # Padding is nobody's record.
    assert usual.reflection_points.height == found.reflection_points.height


@pytest.mark.parametrize("lacks", ["compute", "atomics"])
@pytest.mark.parametrize("method", ["newton", "newton_refraction"])
def test_stragglers_alone_are_solved_again(method: str, lacks: str) -> None:
    """After one step of the first pass nearly all are left to the second, and what that has settled stays."""
    around = Ellipsoids(COUNT)
    usual, found = (list(around.solve(method, device, steps=1).read()) for device in (WHOLE, LACKING[lacks]))
    same_solution(found, usual)
    _, code, iterations, _ = found
    assert (iterations > 1).mean() > 0.5
    settled = (code == status.REFLECTED) & (iterations == 1)
    assert settled.any()
    # (Of refraction some take another step or two: they end where rounding decides.)
    assert (iterations == usual[2]).mean() > 0.97


@pytest.mark.parametrize("lacks", ["compute", "atomics"])
def test_warm_starts_and_repeated_dispatches(lacks: str) -> None:
    around, device = Ellipsoids(COUNT), LACKING[lacks]
    last = [around.solve("newton", each) for each in (WHOLE, device)]
    turned = EYE + np.array([0.03, 0.02, 0.0])
    usual, found = (
        list(around.solve("newton", each, turned, before).read())
        for each, before in zip((WHOLE, device), last, strict=True)
    )
    same_solution(found, usual)
    assert found[2][found[1] == status.REFLECTED].mean() < 2.0
    same_solution(around.twice("newton", device), list(last[0].read()))


def test_regions_and_grids_by_fragments() -> None:
    faces = radial_map(SURFACES["bumpy"])
    around = Ellipsoids(COUNT)
    regions = RegionTextures(curvature_regions(CubeMapSurface(faces)))
    room = Room()
    room.add_mirror(SURFACES["ellipsoid"], 48)
    scene = room.arrays()
    found = []
    for device in (WHOLE, LACKING["compute"]):
        with only_features(device):
            region = solve_region(eyed(), around.reflector, regions, 0, around.positions, COUNT)
            mesh = scene.meshes[0]
            chunk = Chunk([Placed(scene.instances[0], mesh, mesh, np.zeros(len(mesh.triangles), np.int8))])
            grid = ChunkGrid(chunk, 0.1).solve(
                chunk,
                lambda positions, count: solve_vertices(
                    "bisector_cube", eyed(), around.reflector, positions, count, steps=9
                ),
            )
        found.append((list(region.read()), list(grid.read())))
    (usual_region, usual_grid), (region, grid) = found
    same_solution(region, usual_region)
    same_solution(grid, usual_grid)
    assert (region[1] == status.REFLECTED).any()


def test_chunks_are_placed_by_fragments_too() -> None:
    """All of them, and then one of three whose matrix has changed, in the middle of rows."""
    room = Room()
    room.add_mirror(SURFACES["ellipsoid"], 32)
    room.add_ball((2.0, 0.0, 0.0), 0.5)
    room.add_rectangle((0.0, 0.0, -1.0), (3.0, 0.0, 0.0), (0.0, 3.0, 0.0))
    scene = room.arrays()
    found = []
    for device in (WHOLE, LACKING["compute"]):
        with only_features(device):
            placed = [
                Placed(instance, mesh, mesh, np.zeros(len(mesh.triangles), np.int8), mirror=index)
                for index, instance in enumerate(scene.instances)
                for mesh in [scene.meshes[instance.mesh]]
            ]
            chunk = Chunk(placed)
            matrix = placed[1].instance.matrix.copy()
            matrix[:3, 3] += 1.0
            chunk.move({1: replace(placed[1], instance=replace(placed[1].instance, matrix=matrix), mirror=5)})
            corners = 2 * sum(len(mesh.corner_vertex) for mesh in scene.meshes)
            found.append((read_records(chunk.positions, chunk.position_count), read_records(chunk.corners, corners)))
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-6)
    assert {0.0, 5.0, 2.0} == set(found[1][1][1::2, 3])


def test_regions_of_records_are_copied_by_fragments_too() -> None:
    rng = np.random.default_rng(5)
    parts = [rng.normal(size=(size, 4)).astype(np.float32) for size in (100, 3 * TEXTURE_WIDTH + 7, 33)]
    more = rng.normal(size=(9 * TEXTURE_WIDTH, 4)).astype(np.float32)
    with only_features(LACKING["compute"]):
        regions = RecordRegions()
        starts = regions.put(parts)
        regions.replace(starts[2], parts[0][:20])
        starts += regions.put([more])
        records = read_records(regions.texture, regions.texture.height * TEXTURE_WIDTH)
    replaced = np.concatenate([parts[0][:20], parts[2][20:]])
    for start, part in zip(starts, (parts[0], parts[1], replaced, more), strict=True):
        assert np.array_equal(records[start : start + len(part)], part)


def test_what_is_used_is_put_back() -> None:
    before = features()
    with pytest.raises(ShaderError), only_features(LACKING["quads"]):
        assert features().missing == ("quads",)
        raise ShaderError
    assert features() is before
    use_features(Features())
    assert features().missing == () and features().lists
    assert not LACKING["compute"].lists
