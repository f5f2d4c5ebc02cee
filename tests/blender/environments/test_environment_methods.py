# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Environment lookups beside the plain one, in small scenes where what they have to show is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.catalog import METHODS
from curvrefl.curvrefl_addon.optics.environment import (
    axis_frame,
    parallax_directions,
    sphere_map_directions,
    sphere_map_places,
)
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import nearest_texel, sample_cube
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import read_cube
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.shading.lookup import Environment
from curvrefl.curvrefl_addon.renderer.shown.environment import ShownEnvironment
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import MIRROR, Room, radial_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([0.8, -4.0, 1.0])
VIEW = look_at(EYE, np.zeros(3), 120, 90, np.radians(36))
FLAT = look_at(EYE, np.zeros(3), 120, 90, np.radians(36), orthographic=True)
SIZE = 64
ENVIRONMENTS = [name for name, method in METHODS.items() if method.is_environment]


def renderer_of(scene: SceneArrays, method: str, size: int = SIZE) -> Renderer:
    return Renderer(scene, Settings(method=method, samples=1, environment_resolution=size))


def shell(radius: float, segments: int = 128) -> SceneArrays:
    """A mirror ball of radius 1 in the middle of a ball that the eye does not see."""
    room = Room()
    room.add_mirror(Ellipsoid(), segments)
    room.add_ball((0.0, 0.0, 0.0), radius, visible_camera=False)
    return room.arrays()


def mixed(segments: int = 128) -> SceneArrays:
    """A mirror ball on a floor, with a ball beside it."""
    room = Room()
    room.add_mirror(Ellipsoid(), segments)
    room.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    room.add_ball((1.3, -1.6, 0.1), 0.5)
    return room.arrays()


def own_rays(frame: Frame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mask (h, w), point (h, w, 3) and reflected ray (h, w, 3) of the mirror's pixels."""
    point, normal = frame.surfaces["seen_position"][..., :3], frame.surfaces["seen_normal"][..., :3]
    incoming = unit(point * frame.view.eye[3] - frame.view.eye[:3])
    return frame.mask() > 0, point, incoming - 2.0 * (incoming * normal).sum(-1, keepdims=True) * normal


def degrees_between(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    one, other = unit(one), unit(other)
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), (one * other).sum(-1)))


def angle_errors(frame: Frame) -> np.ndarray:
    """Degrees between each mirror pixel's reflected ray and the way to what is shown there."""
    mask, point, ray = own_rays(frame)
    shown = frame.reflected_position()
    assert (shown[mask][:, 3] == 1.0).all()
    return degrees_between(shown[mask][:, :3] - point[mask], ray[mask])


def test_parallax_is_exact_where_all_is_at_one_distance() -> None:
    frames = {
        method: renderer_of(shell(3.0), method).render(VIEW) for method in ("environment_cube", "environment_parallax")
    }
    errors = {method: angle_errors(frame) for method, frame in frames.items()}
    texel = np.degrees(2.0 / SIZE)
    # Half a texel's diagonal, as seen from points up to a third of the way to what they see.
    assert errors["environment_parallax"].max() < 1.5 * 0.75 * texel
    assert np.median(errors["environment_cube"]) > 8.0


def test_parallax_beats_the_plain_lookup_among_balls_at_one_distance() -> None:
    room = Room()
    room.add_mirror(Ellipsoid())
    for turn in np.linspace(0.0, 2.0 * np.pi, 9, endpoint=False):
        for height in (-0.8, 0.8):
            x, y, z = 2.6 * unit(np.array([np.cos(turn), np.sin(turn), height]))
            room.add_ball((x, y, z), 0.4, visible_camera=False)
    on_ball, hit, _ = room.seen_in_ball(VIEW)
    wrong = {}
    for method in ("environment_cube", "environment_parallax"):
        frame = renderer_of(room.arrays(), method, 128).render(VIEW)
        inner = on_ball & (frame.mask() > 0)
        wrong[method] = (frame.reflected_object() != hit)[inner].mean()
    assert wrong["environment_parallax"] < 0.08
    assert wrong["environment_cube"] > 3.0 * wrong["environment_parallax"]


def test_parallax_is_the_float64_reference() -> None:
    """Both where a thing is shown and where the background is, which the finite radius moves, too."""
    renderer = renderer_of(mixed(), "environment_parallax")
    (cube,) = renderer.environment_cubes()
    faces = cube.geometry()
    for view in (VIEW, FLAT):
        frame = renderer.render(view)
        mask, point, ray = own_rays(frame)
        directions = unit(parallax_directions(point[mask], ray[mask], cube.radius))
        shown = frame.reflected_position()[mask]
        background = shown[:, 3] == 0.0
        assert 0.2 < background.mean() < 0.8
        assert degrees_between(shown[background][:, :3], directions[background]).max() < 0.01
        expected = faces[nearest_texel(SIZE, directions)]
        same = np.abs(shown[:, :3] - expected[:, :3]).max(axis=1) == 0.0
        assert same[~background].mean() > 0.99, "but for directions on the border of two texels"
        assert np.median(degrees_between(directions, ray[mask])) > 5.0


def test_radius_of_the_ball_about_the_mirror() -> None:
    assert renderer_of(shell(3.0), "environment_parallax").environment_cubes()[0].radius == pytest.approx(3.0, rel=0.01)
    room = Room()
    room.add_mirror(Ellipsoid(2.0, 1.0, 0.5))
    room.add_ball((0.0, 0.0, 0.8), 0.1)
    renderer = renderer_of(room.arrays(), "environment_parallax")
    shape = renderer.mirrors[0].shape(renderer.settings.map_resolution)
    assert renderer.environment_cubes()[0].radius == shape.bound == pytest.approx(2.0, rel=0.01)


def test_parallax_with_nothing_in_sight_is_the_plain_lookup() -> None:
    room = Room()
    room.add_mirror(Ellipsoid())
    room.add_ball((1.3, -1.6, 0.1), 0.5, visible_glossy=False)
    plain, parallax = (
        renderer_of(room.arrays(), method).render(VIEW) for method in ("environment_cube", "environment_parallax")
    )
    np.testing.assert_array_equal(plain.color(), parallax.color())
    np.testing.assert_array_equal(plain.reflected_position(), parallax.reflected_position())
    assert (parallax.mask() == MIRROR).sum() > 1000


def test_sphere_map_is_the_cube_seen_in_a_mirror_ball() -> None:
    renderer = renderer_of(mixed(), "environment_sphere")
    (cube,) = renderer.environment_cubes()
    for view in (VIEW, FLAT, look_at(np.array([0.0, 0.5, 5.0]), np.zeros(3), 8, 8, 0.5)):
        environment = cube.environment("environment_sphere", view)
        place = (2.0 * np.arange(SIZE) + 1.0) / SIZE - 1.0
        s, t = np.meshgrid(place, place)
        inside = s**2 + t**2 < 0.99
        axis = unit(view.eye[:3])
        directions = sphere_map_directions(np.stack([s, t], -1)[inside]) @ axis_frame(axis)
        expected = sample_cube(read_cube(cube.color), directions)[:, :3]
        assert np.ptp(expected) > 0.2
        # The GPU filters with weights of eight bits.
        np.testing.assert_allclose(read_texture(environment.radiance)[inside][:, :3], expected, atol=0.01)
        faces = cube.geometry()
        nearest = faces[nearest_texel(SIZE, directions)]
        same = np.abs(read_texture(environment.positions())[inside] - nearest).max(axis=1) == 0.0
        assert same.mean() > 0.995, "but for directions on the border of two texels"


def test_sphere_map_is_as_the_cube_but_at_its_rim() -> None:
    """Away from the rim both show the same within their texels; the rim's texels cover ever wider angles."""
    frames = {
        method: renderer_of(shell(3.0), method).render(FLAT) for method in ("environment_cube", "environment_sphere")
    }
    mask, _, ray = own_rays(frames["environment_cube"])
    cube, sphere = (frame.reflected_position()[mask][:, :3] for frame in frames.values())
    differ = np.radians(degrees_between(cube, sphere))
    radius = np.linalg.norm(sphere_map_places(ray[mask] @ axis_frame(FLAT.eye[:3]).T), axis=1)
    half_diagonal = np.sqrt(2.0) / SIZE
    slope = 2.0 / np.sqrt(1.0 - np.minimum(radius + half_diagonal, 0.999) ** 2)
    away = radius < 0.95
    assert away.sum() > 2000
    assert (differ < (2.0 + slope) * half_diagonal)[away].all()
    assert np.median(differ[away]) < 2.0 / SIZE * 1.5
    # The orthographic eye sees the mirror's own rim there, whose rays all but go straight on.
    at_rim = radius > 0.995
    assert at_rim.sum() > 30
    assert differ[at_rim].max() > 6.0 * half_diagonal


def environment_of(renderer: Renderer, view: View) -> Environment:
    """What the only mirror shows in a view."""
    (shown,) = renderer.reflect(view).shown
    assert isinstance(shown, ShownEnvironment)
    return shown.environment


def test_sphere_map_is_drawn_again_only_for_another_axis() -> None:
    renderer = renderer_of(mixed(), "environment_sphere")
    first = environment_of(renderer, VIEW)
    before = read_texture(first.radiance)
    closer = look_at(0.8 * EYE, np.zeros(3), 60, 50, np.radians(50))
    same = environment_of(renderer, replace(VIEW, width=64))
    assert same.radiance is first.radiance and same.positions() is first.positions()
    near = environment_of(renderer, closer)
    np.testing.assert_allclose(read_texture(near.radiance), before, atol=1e-4)
    other = environment_of(renderer, look_at(-EYE, np.zeros(3), 60, 50, np.radians(36)))
    assert np.abs(read_texture(other.radiance) - before).max() > 0.1
    np.testing.assert_array_equal(read_texture(first.radiance), before, "another region may still show it")


def visible_triangles(mesh: MeshArrays, count: int, offset: float = 0.0) -> np.ndarray:
    """(count, 3) corners of triangles that face the eye, spread over the mirror."""
    corners = mesh.positions[mesh.triangles].astype(np.float64)
    corners[..., 0] += offset
    normal = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    facing = np.flatnonzero((normal * unit(EYE - corners.mean(axis=1))).sum(-1) > 0.5)
    return mesh.triangles[facing[np.linspace(0, len(facing) - 1, count).astype(int)]]


def aimed(point: np.ndarray) -> View:
    """A picture whose middle pixel's center is a point."""
    return look_at(EYE, point, 9, 9, np.radians(6))


def cube_at_corners(faces: np.ndarray, mesh: MeshArrays, corners: np.ndarray, geometry: bool = False) -> np.ndarray:
    """(n, 4) what a cube has in the reflected directions of a mesh's corners; of `geometry`, for the background, those
    directions."""
    incoming = unit(mesh.positions[corners] - EYE)
    normal = mesh.corner_normals[corners].astype(np.float64)
    rays = incoming - 2.0 * (incoming * normal).sum(-1, keepdims=True) * normal
    if not geometry:
        return sample_cube(faces, rays)
    shown = faces[nearest_texel(faces.shape[1], rays)]
    shown[:, :3] = np.where(shown[:, 3:] > 0.0, shown[:, :3], rays)
    return shown


def test_vertices_show_what_the_cube_has_and_triangles_blend_it() -> None:
    mesh = radial_mesh(Ellipsoid(), 16)
    by_vertex, by_pixel = (renderer_of(mixed(16), name) for name in ("environment_cube_vertex", "environment_cube"))
    faces = read_cube(by_vertex.environment_cubes()[0].color)
    blended = []
    for triangle in visible_triangles(mesh, 8):
        corners = mesh.positions[triangle].astype(np.float64)
        colors = cube_at_corners(faces, mesh, triangle)
        at_vertex = aimed(corners[0])
        np.testing.assert_allclose(by_vertex.render(at_vertex).color()[4, 4, :3], colors[0, :3], atol=0.02)
        np.testing.assert_allclose(by_pixel.render(at_vertex).color()[4, 4, :3], colors[0, :3], atol=0.02)
        for weights in ([1 / 3, 1 / 3, 1 / 3], [0.7, 0.2, 0.1]):
            aim = aimed(np.array(weights) @ corners)
            color = by_vertex.render(aim).color()[4, 4, :3]
            np.testing.assert_allclose(color, np.array(weights) @ colors[:, :3], atol=0.02)
            blended.append(np.abs(color - by_pixel.render(aim).color()[4, 4, :3]).max())
    assert max(blended) > 0.1, "somewhere the blend is not what a pixel would have looked up"


def test_geometry_of_the_vertex_lookup_is_the_nearest_corners() -> None:
    mesh = radial_mesh(Ellipsoid(), 16)
    renderer = renderer_of(mixed(16), "environment_cube_vertex")
    faces = renderer.environment_cubes()[0].geometry()
    found = []
    for triangle in visible_triangles(mesh, 5):
        expected = cube_at_corners(faces, mesh, triangle, geometry=True)
        for place in range(3):
            weights = np.roll([0.5, 0.25, 0.25], place)
            frame = renderer.render(aimed(weights @ mesh.positions[triangle].astype(np.float64)))
            assert frame.reflected_object()[4, 4] == int(expected[place, 3])
            np.testing.assert_allclose(frame.reflected_position()[4, 4, :3], expected[place, :3], atol=1e-5)
            found.append(int(expected[place, 3]))
    assert len(set(found)) > 1


def test_every_mirror_looks_up_its_own_environment() -> None:
    """Two mirrors on a floor, 3.2 apart; the nearer part of each is aimed at."""
    mesh = radial_mesh(Ellipsoid(), 16)
    room = Room()
    room.add_mirror(Ellipsoid(), 16)
    room.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    room.add_ball((2.6, -1.5, 0.3), 0.5)
    scene = room.arrays()
    matrix = np.eye(4)
    matrix[0, 3] = 3.2
    second = replace(scene.instances[0], object_name="second", object_id=4, matrix=matrix)
    scene = replace(scene, instances=(*scene.instances, second), reflectors=(MIRROR, 4))
    renderer = renderer_of(scene, "environment_cube_vertex")
    cubes = [cube.geometry() for cube in renderer.environment_cubes()]
    moved = replace(mesh, positions=(mesh.positions + np.array([3.2, 0.0, 0.0])).astype(np.float32))
    seen = []
    for own, cube, number in ((mesh, cubes[0], MIRROR), (moved, cubes[1], 4)):
        for triangle in visible_triangles(own, 4):
            expected = cube_at_corners(cube, own, triangle, geometry=True)[0]
            frame = renderer.render(aimed(own.positions[triangle].astype(np.float64).T @ [0.6, 0.2, 0.2]))
            if frame.mask()[4, 4] != number:
                continue
            assert frame.reflected_object()[4, 4] == int(expected[3])
            np.testing.assert_allclose(frame.reflected_position()[4, 4, :3], expected[:3], atol=1e-5)
            seen.append(number)
    assert seen.count(MIRROR) > 1 and seen.count(4) > 1


@pytest.mark.parametrize("method", ENVIRONMENTS)
def test_from_inside_a_mirror_everything_is_black(method: str) -> None:
    inside = look_at(np.array([0.2, -0.3, 0.1]), np.array([3.0, 0.0, 0.0]), 16, 12, np.radians(36))
    frame = renderer_of(mixed(), method).render(inside)
    assert (frame.mask() == MIRROR).all()
    assert (frame.reflected_object() == 0).all() and (frame.color()[..., :3] == 0.0).all()
    assert any("The eye is inside of" in warning for warning in frame.warnings)


@pytest.mark.parametrize("method", [name for name in ENVIRONMENTS if name != "environment_cube_vertex"])
def test_light_and_geometry_are_of_one_lookup(method: str) -> None:
    """A room that shines by where a thing is: what is behind a pixel's light is where its geometry says."""
    room = Room()
    room.add_mirror(Ellipsoid(), 64)
    lights = [room.add_ball((x, -2.0, z), 0.5) for x in (-1.5, 0.0, 1.5) for z in (-1.2, 1.2)]
    scene = room.arrays()
    glow = [
        replace(scene.materials[0], name=f"glow {i}", base_color=(0.0, 0.0, 0.0), emission=(1.0 + i, 0.0, 0.0))
        for i in range(len(lights))
    ]
    instances = tuple(
        replace(item, materials=(2 + lights.index(item.object_id),)) if item.object_id in lights else item
        for item in scene.instances
    )
    scene = replace(scene, materials=(*scene.materials, *glow), instances=instances)
    frame = renderer_of(scene, method, 128).render(VIEW)
    numbers = frame.reflected_object()
    shown = numbers[1:-1, 1:-1]
    # Where all neighbors show the same, filters do not matter.
    for dy in range(-1, 2):
        for dx in range(-1, 2):
            moved = np.roll(numbers, (dy, dx), (0, 1))[1:-1, 1:-1]
            shown = np.where(moved == shown, shown, -1)
    red = frame.color()[1:-1, 1:-1, 0]
    checked = 0
    for i, number in enumerate(lights):
        here = shown == number
        checked += here.sum()
        assert (np.abs(red[here] - (1.0 + i)) < 0.05).all()
    assert checked > 40


@pytest.mark.parametrize("size", [0, 7, 5000])
def test_a_map_of_no_use_is_refused(size: int) -> None:
    with pytest.raises(InputError, match="choose 8 to 4096"):
        renderer_of(mixed(), "environment_sphere", size)
