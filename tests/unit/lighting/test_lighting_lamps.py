# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on lamps, shadow views and the GGX table, against what geometry and integrals say."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.fresnel import fresnel_dielectric
from curvrefl.curvrefl_addon.renderer.geometry.mesh_pieces import mesh_pieces
from curvrefl.curvrefl_addon.renderer.lighting.ggx import IOR_SLICES, TABLE_SIZE, ggx_table
from curvrefl.curvrefl_addon.renderer.lighting.lamp_views import plan_lamps
from curvrefl.curvrefl_addon.renderer.lighting.lamps import lamp_points, lamp_records
from curvrefl.curvrefl_addon.renderer.lighting.shadow_views import SceneExtent
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, MeshArrays
from curvrefl.curvrefl_addon.scene.meshes.made import smooth_mesh


def lamp(kind: str, **more: object) -> LightArrays:
    matrix = np.eye(4)
    matrix[:3, 3] = (1.0, 2.0, 3.0)
    return LightArrays("lamp", kind, (1.0, 1.0, 1.0), matrix, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "light",
    [
        lamp("POINT", radius=0.5),
        lamp("SPOT", radius=0.5, spot_angle=1.0),
        lamp("AREA", size=(2.0, 1.0)),
        lamp("AREA", size=(2.0, 1.0), ellipse=True),
    ],
)
def test_points_lie_in_the_lamp_about_its_middle(light: LightArrays) -> None:
    points = lamp_points(light, 16, seed=3)
    offsets = points[:, :3] - light.matrix[:3, 3]
    assert np.all(points[:, 3] == 1.0)
    assert np.allclose(offsets.mean(axis=0), 0.0, atol=1e-12)
    if light.kind == "AREA":
        scaled = offsets[:, :2] / (0.5 * np.array(light.size))
        assert np.all(offsets[:, 2] == 0.0)
        assert np.all((np.linalg.norm(scaled, axis=1) if light.ellipse else np.abs(scaled).max(axis=1)) <= 1.0)
        assert len({tuple(cell) for cell in np.floor(2 * scaled).astype(int)}) >= 12  # spread out
    else:
        assert np.linalg.norm(offsets, axis=1).max() <= light.radius


def test_ball_looks_like_an_even_disk_from_every_side() -> None:
    """Half of the disk's area lies beyond 1/sqrt(2) of its radius."""
    points = lamp_points(lamp("POINT", radius=1.0), 4096, seed=0)[:, :3] - (1.0, 2.0, 3.0)
    for axis in ((1, 0, 0), (0, 0, 1), (0.6, 0.0, 0.8)):
        across = np.linalg.norm(np.cross(points, axis), axis=1)
        assert abs((across < np.sqrt(0.5)).mean() - 0.5) < 0.03


def test_hard_lamps_have_one_point() -> None:
    assert lamp_points(lamp("POINT"), 16, 0).shape == (1, 4)
    assert np.allclose(lamp_points(lamp("SUN"), 16, 0), [[0, 0, 1, 0]])
    assert np.allclose(lamp_points(lamp("AREA", size=(1, 1)), 1, 0), [[1, 2, 3, 1]])


def test_sun_points_are_directions_within_its_disk() -> None:
    points = lamp_points(lamp("SUN", angle=0.2), 16, 0)
    assert np.all(points[:, 3] == 0.0)
    assert np.allclose(np.linalg.norm(points[:, :3], axis=1), 1.0)
    assert points[:, 2].min() >= np.cos(0.1) - 1e-9


def test_lamp_bodies_carry_the_power() -> None:
    """Radiance of the body times its area and pi, or the ball's four pi, is the lamp's power."""
    area = lamp_records(lamp("AREA", size=(2.0, 0.5)), np.zeros(4), 1)
    assert np.isclose(area[6, 0] * np.pi * 1.0, 1.0)
    ball = lamp_records(lamp("POINT", radius=0.5), np.zeros(4), 1)
    assert np.isclose(ball[6, 0] * np.pi * 0.25 * 4 * np.pi, 1.0)


def floor_and_box() -> tuple[np.ndarray, np.ndarray]:
    """A floor of 40 m at z = 0 and a box of 1 m that stands 1 m above it."""
    floor = np.array([[-20, -20, 0], [20, -20, 0], [20, 20, 0], [-20, 20, 0]], float)
    box = np.array([[x, y, z] for z in (1, 2) for y in (0, 1) for x in (0, 1)], float)
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return np.concatenate([floor, box]), np.concatenate([[[0, 1, 2], [0, 2, 3]], faces + 4]).astype(np.int32)


def extent_of(positions: np.ndarray, triangles: np.ndarray) -> SceneExtent:
    """As one instance, where it is."""
    return SceneExtent([(mesh_pieces(mesh_of(positions, triangles)), np.eye(4), True)])


def mesh_of(positions: np.ndarray, triangles: np.ndarray) -> MeshArrays:
    return smooth_mesh("mesh", positions, np.zeros_like(positions), triangles)


def test_floor_does_not_widen_the_map_of_a_sun_above_or_below() -> None:
    positions, triangles = floor_and_box()
    extent = extent_of(positions, triangles)
    pieces = mesh_pieces(mesh_of(positions, triangles)).triangle_piece
    assert pieces[0] == pieces[1] != 0
    assert any(plane.pieces == ((0, pieces[0]),) for plane in extent.hull)
    for height in (1.0, -1.0):
        direction = np.array([0.6, 0.0, 0.8 * height])
        view = extent.parallel_view(direction, 512)
        assert view is not None
        box = np.column_stack([positions[4:], np.ones(8)]) @ view.world_to_clip.T
        assert np.abs(box[:, :2]).max() <= 1.0
        assert np.abs(box[:, :2]).max() > 0.98
        assert ((0, pieces[0]) in extent.pieces_in_planes(view.idle_planes)) == (height > 0.0)
        clip = np.column_stack([positions, np.ones(len(positions))]) @ view.world_to_clip.T
        assert np.abs(clip[4:, 2]).max() <= 1.0


def test_nothing_to_cast_needs_no_map() -> None:
    positions, triangles = floor_and_box()
    extent = extent_of(positions[:4], triangles[:2])
    assert extent.parallel_view(np.array([0.0, 0.0, 1.0]), 256) is None
    assert extent.point_views(np.array([0.0, 0.0, 1.0]), 256) == ()
    empty = SceneExtent([])
    assert empty.parallel_view(np.array([0.0, 0.0, 1.0]), 256) is None


def test_far_lamp_gets_one_map_and_a_lamp_among_the_casters_a_cube() -> None:
    positions, triangles = floor_and_box()
    extent = extent_of(positions, triangles)
    (view,) = extent.point_views(np.array([0.5, 0.5, 6.0]), 512)
    assert view is not None
    clip = np.column_stack([positions[4:], np.ones(8)]) @ view.world_to_clip.T
    assert np.abs(clip[:, :3] / clip[:, 3:]).max() <= 1.0
    around = extent.point_views(np.array([0.5, 0.5, 1.5]), 512)
    assert len(around) == 6
    assert all(face is not None for face in around)


@pytest.mark.parametrize("distance", [20.0, 2e3, 2e5])
def test_a_map_of_a_lamp_far_away_tells_depths_apart(distance: float) -> None:
    """In single precision a hundredth of the box's height is still a difference."""
    positions, triangles = floor_and_box()
    place = distance * np.array([0.48, 0.6, 0.64])
    (view,) = extent_of(positions, triangles).point_views(place, 512)
    assert view is not None
    above = positions[4:].mean(axis=0)
    height = float(np.ptp(positions[4:, 2]))
    ways = np.stack([above, above + 0.01 * height * place / distance])
    clip = np.column_stack([ways, np.ones(2)]) @ view.world_to_clip.T
    depths = (0.5 + 0.5 * clip[:, 2] / clip[:, 3]).astype(np.float32)
    assert depths[0] - depths[1] > 1e-4


def test_depth_terms_are_the_projections() -> None:
    positions, triangles = floor_and_box()
    extent = extent_of(positions, triangles)
    place = np.array([0.5, 0.5, 1.5])
    view = extent.point_views(place, 512)[0]  # +X
    assert view is not None
    clip = view.world_to_clip @ np.append(place + np.array([2.0, 0.3, -0.4]), 1.0)
    depth = 0.5 + 0.5 * clip[2] / clip[3]
    assert np.isclose(view.depth_terms[0] + view.depth_terms[1] / 2.0, depth)


def test_ggx_table_at_its_known_ends() -> None:
    table = ggx_table()[:TABLE_SIZE].reshape(TABLE_SIZE, IOR_SLICES + 1, TABLE_SIZE, 4)
    assert np.allclose(table[0, 0, 1:, 0], 1.0, atol=2e-3)  # a mirror loses nothing
    assert np.all(np.diff(table[:, 0, -1, 0]) < 1e-3)  # a rougher lobe loses more
    assert abs(float(table[-1, 0, -1, 0]) - (1.0 - np.log(2.0))) < 0.003  # roughness 1, head on: 1 - ln 2 remains
    cosine = np.linspace(0.0, 1.0, TABLE_SIZE)
    z = 6 / (IOR_SLICES - 1)
    ior = (1 + z * z) / (1 - z * z)
    f0 = ((ior - 1) / (ior + 1)) ** 2
    share = (fresnel_dielectric(cosine, ior) - f0) / (1 - f0)
    assert np.allclose(table[0, 6, 2:, 2], share[2:], atol=5e-3)
    assert np.allclose(table[:, 5, :, 3], table[:, 6, :, 2])
    # the lobe of a mirror is its ray; head on a lobe is about the normal and of its own roughness, as near as the
    # sampled normals give its long tails; at the rim it bends to the normal
    assert np.allclose(table[0, -1, 1:, 0], cosine[1:], atol=0.01)
    assert np.allclose(table[:, -1, -1, 0], 1.0, atol=0.01)
    assert np.allclose(table[4:, -1, -1, 1], np.linspace(0.0, 1.0, TABLE_SIZE)[4:], atol=0.04)
    assert np.all(table[16, -1, :24, 0] > cosine[:24])


def test_points_of_a_lamp_take_turns_with_its_maps() -> None:
    """What a sub-frame needs is never drawn over by what it needs itself; sixteen sub-frames share nothing."""
    extent = extent_of(*floor_and_box())
    lights = [lamp("SUN", angle=0.2), lamp("POINT", radius=0.3), lamp("AREA", size=(1.0, 1.0))]
    planned = plan_lamps(extent, lights, [lamp_points(light, 64, row) for row, light in enumerate(lights)], 16)
    of_sub_frames = []
    for number in range(64):
        views = [view for places in planned.places for view in places[number][1] if view >= 0]
        of_sub_frames.append([planned.layers[view] for view in views])
        assert len(set(of_sub_frames[-1])) == len(of_sub_frames[-1]) >= 3
    first = [layer for layers in of_sub_frames[:16] for layer in layers]
    assert len(set(first)) == len(first)
    assert max(planned.layers) + 1 < 2 * len(first)
