# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""UV-mapped meshes are baked against shapes that are known, and the shader is held to its float64 reference."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import secant_uv
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.parametric_surfaces import SampledMap
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.mirrors.parametric_map import (
    MOST_OVERLAP,
    ParametricMap,
    _islands,
    bake_parametric,
)
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import SAMPLERS, Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MeshArrays
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds, read_mesh
from curvrefl.curvrefl_addon.scene.view import View
from scenes.star_meshes import inverted, mesh_of
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([2.3, -2.9, 1.8])


def grid_mesh(shape: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], cells: int = 64) -> MeshArrays:
    """`shape` gives points and normals at u and v; corners on a seam are two vertices at one place."""
    steps = np.linspace(0.0, 1.0, cells + 1)
    v, u = (part.ravel() for part in np.meshgrid(steps, steps, indexing="ij"))
    points, normals = shape(u, v)
    row, column = (part.ravel() for part in np.meshgrid(*[np.arange(cells)] * 2, indexing="ij"))
    a = row * (cells + 1) + column
    b, c, d = a + 1, a + cells + 2, a + cells + 1
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return replace(mesh_of(points, normals, triangles), corner_uv=np.column_stack([u, v]).astype(np.float32))


def torus_section(angle: float = np.pi / 2.0) -> MeshArrays:
    surface = secant_uv.TorusSection(angle=angle)

    def shape(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = surface.sample(np.column_stack([u, v]))
        return at.position, at.normal

    return grid_mesh(shape)


def sheet(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A dented sheet, its hollow below."""
    x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
    return np.column_stack([x, y, 0.2 - 0.2 * (x**2 + y**2)]), np.column_stack([0.4 * x, 0.4 * y, np.ones_like(x)])


def uv_sphere(segments: int = 128, rings: int = 64) -> MeshArrays:
    """Blender's own, with its own UV map, shaded smooth."""
    import bmesh
    import bpy

    made = bmesh.new()
    made.loops.layers.uv.new("UVMap")
    bmesh.ops.create_uvsphere(made, u_segments=segments, v_segments=rings, radius=1.0, calc_uvs=True)
    for face in made.faces:
        face.smooth = True
    mesh = bpy.data.meshes.new("Ball")
    made.to_mesh(mesh)
    made.free()
    read = read_mesh(mesh, MeshNeeds(uv_map="")).mesh
    bpy.data.meshes.remove(mesh)
    return read


def bake(mesh: MeshArrays, matrix: np.ndarray | None = None, world_to_map: np.ndarray | None = None) -> ParametricMap:
    identity = np.eye(4)
    instance = InstanceArrays("Ball", 1, 0, identity if matrix is None else matrix, (0,))
    return bake_parametric(mesh, instance, identity if world_to_map is None else world_to_map)


def normals_of(surface: SampledMap) -> np.ndarray:
    textures = (surface.surface_point, surface.surface_du, surface.surface_dv)
    return np.stack([texture[..., 3] for texture in textures], axis=-1).astype(float)


def rigid(seed: int, place: tuple[float, float, float]) -> np.ndarray:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn * np.sign(np.linalg.det(turn)), place
    return matrix


def solve(
    baked: ParametricMap, view: View, vertices: np.ndarray, world_to_map: np.ndarray, steps: int = 0
) -> VertexSolution:
    reflector = Reflector(world_to_map, 2.0, baked.samplers())
    records = np.column_stack([vertices, np.ones(len(vertices))]).astype(np.float32)
    return solve_vertices("secant_uv", view, reflector, record_texture(records), len(vertices), steps)


def vertices_around(count: int, nearest: float = 1e-2) -> np.ndarray:
    rng = np.random.default_rng(7)
    u = unit(rng.normal(size=(count, 3)))
    return (u * (1.0 + 10 ** rng.uniform(np.log10(nearest), 1, count))[:, None]).astype(np.float32).astype(np.float64)


def test_uv_sphere_is_baked() -> None:
    baked = bake(uv_sphere())
    surface = baked.surface
    points, normals = surface.surface_point[..., :3].astype(float), normals_of(surface)
    # Chords of 2.8 degrees lie within 1 - cos(2 deg) of the sphere, the diagonals of its quads included.
    radius = np.linalg.norm(points, axis=-1)
    assert radius.max() <= 1.0 + 1e-6 and radius.min() > 0.9993
    np.testing.assert_allclose(normals, points / radius[..., None], atol=2e-3)
    # The pole rows leave out every second triangle.
    assert baked.cover == pytest.approx(1.0 - 1.0 / 64.0, abs=1e-3)
    assert surface.wraps == (True, False) and not surface.is_open and surface.solid is not None

    # Away from the poles f is longitude and latitude, up to where the longitude begins and which way it runs.
    rows = slice(32, 480)
    v = (np.arange(512) + 0.5)[rows, None] / 512.0
    np.testing.assert_allclose(points[rows, :, 2], -np.cos(np.pi * v) + np.zeros((1, 512)), atol=2e-3)
    up = np.array([0.0, 0.0, 1.0])
    eastwards = np.cross(up, points[rows])
    du, dv = surface.surface_du[rows, :, :3], surface.surface_dv[rows, :, :3]
    np.testing.assert_allclose(du, 2.0 * np.pi * eastwards, atol=0.03)
    northwards = unit(up - normals[rows, :, 2:] * normals[rows])
    np.testing.assert_allclose(dv, np.pi * northwards, atol=0.03)


def test_tangents_are_perpendicular_to_shading_normals() -> None:
    """Also where those are not the surface's own, as Cycles reflects about them."""
    mesh = uv_sphere(32, 16)
    bent = unit(mesh.corner_normals + 0.3 * np.sin(7.0 * mesh.positions[mesh.corner_vertex]))
    surface = bake(replace(mesh, corner_normals=bent.astype(np.float32))).surface
    normals = normals_of(surface)
    assert np.linalg.norm(normals - surface.surface_point[..., :3], axis=-1).max() > 0.1
    for tangent in (surface.surface_du, surface.surface_dv):
        np.testing.assert_allclose((tangent[..., :3] * normals).sum(axis=-1), 0.0, atol=1e-5)


def test_poles_close() -> None:
    """What the map leaves out at a pole is filled so that f goes around it without a step, and f_u vanishes at it."""
    surface = bake(uv_sphere(32, 16)).surface
    points = surface.surface_point[..., :3].astype(float)
    for row in (0, -1):
        assert np.linalg.norm(points[row] - [0.0, 0.0, np.sign(points[row, 0, 2])], axis=-1).max() < 0.02
    steps = np.linalg.norm(points - np.roll(points, 1, axis=1), axis=-1)
    # The middle of the triangles' sides at the pole is where they are twice as wide as the whole row's mean step.
    assert steps.max() < 2.1 * np.pi * 2.0 / 512.0
    ring = np.linalg.norm(surface.surface_du[..., :3], axis=-1).mean(axis=1)
    assert ring[0] < 0.05 * ring[256] and ring[-1] < 0.05 * ring[256]


SHAPES = {
    "torus": (lambda: torus_section(2.0 * np.pi), (True, True), False),
    "torus section": (torus_section, (False, True), True),
    "sheet": (lambda: grid_mesh(sheet), (False, False), True),
}


@pytest.mark.parametrize("name", SHAPES)
def test_grids_are_baked(name: str) -> None:
    make, wraps, is_open = SHAPES[name]
    mesh = make()
    surface = bake(mesh).surface
    assert surface.wraps == wraps and surface.is_open == is_open and surface.solid is None
    assert mesh.corner_uv is not None
    uv = mesh.corner_uv.astype(float)
    inner = ((uv > 0.01) & (uv < 0.99)).all(axis=1)
    at = surface.sample(uv[inner])
    np.testing.assert_allclose(at.position, mesh.positions[inner], atol=5e-3)
    np.testing.assert_allclose(at.normal, mesh.corner_normals[inner], atol=5e-3)
    step = 1.0 / 64.0
    for tangent, offset in ((at.du, [step, 0.0]), (at.dv, [0.0, step])):
        ahead, behind = (surface.sample(uv[inner] + sign * np.array(offset)).position for sign in (1, -1))
        error = np.linalg.norm(tangent - (ahead - behind) / (2.0 * step), axis=1) / np.linalg.norm(tangent, axis=1)
        clear = ((uv[inner] > 0.03) & (uv[inner] < 0.97)).all(axis=1)
        assert error[clear].max() < 0.02


def test_directions_lead_to_their_points() -> None:
    surface = bake(uv_sphere()).surface
    u = unit(np.random.default_rng(2).normal(size=(1000, 3)))
    found = unit(surface.sample(surface.uv_of_direction(u)).position)
    # Half the diagonal of a texel of 90 / 64 degrees; a pole's parameters are anything.
    assert np.degrees(np.arccos((found * u).sum(axis=1)))[np.abs(u[:, 2]) < 0.99].max() < 1.5
    assert surface.solid is not None
    np.testing.assert_allclose(surface.solid.radius(u)[0], 1.0, atol=2e-3)


@pytest.mark.parametrize("mirrored", [False, True], ids=["stretched", "mirrored"])
def test_placed_meshes_are_baked_in_the_map_frame(mirrored: bool) -> None:
    matrix, world_to_map = rigid(3, (4.0, -1.0, 2.0)), rigid(4, (0.3, 0.2, 0.1))
    stretch = np.diag([2.0, 1.0, -0.5 if mirrored else 0.5, 1.0])
    world_to_map = world_to_map @ np.linalg.inv(matrix)
    surface = bake(uv_sphere(), matrix @ stretch, world_to_map).surface
    back = np.linalg.inv(world_to_map @ matrix @ stretch)
    on_ball = surface.surface_point[..., :3] @ back[:3, :3].T + back[:3, 3]
    radius = np.linalg.norm(on_ball, axis=-1)
    assert radius.max() < 1.0 + 1e-5 and radius.min() > 0.999
    outwards = unit((on_ball / radius[..., None]) @ back[:3, :3])
    assert (normals_of(surface) * outwards).sum(axis=-1).min() > 0.999
    # df/du is the placed surface's: taken back to the ball it runs eastwards.
    east = surface.surface_du[128:384, :, :3] @ back[:3, :3].T
    np.testing.assert_allclose(east, 2.0 * np.pi * np.cross([0, 0, 1], on_ball[128:384]), atol=0.05)


def test_normals_point_outwards_of_an_inverted_mesh() -> None:
    surface = bake(inverted(uv_sphere(32, 16))).surface
    assert (normals_of(surface) * surface.surface_point[..., :3]).sum(axis=-1).min() > 0.9


def test_an_unwelded_seam_still_wraps() -> None:
    half = grid_mesh(lambda u, v: (2 * [np.column_stack([np.cos(np.pi * u), np.sin(np.pi * u), v])])[:2])
    whole = grid_mesh(lambda u, v: (2 * [np.column_stack([np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), v])])[:2])
    assert bake(half).surface.wraps == (False, False)
    assert bake(whole).surface.wraps == (True, False)


def with_uv(change: Callable[[np.ndarray], np.ndarray]) -> MeshArrays:
    mesh = uv_sphere(32, 16)
    assert mesh.corner_uv is not None
    return replace(mesh, corner_uv=change(mesh.corner_uv.astype(np.float64)).astype(np.float32))


def islands() -> MeshArrays:
    """Two sheets that share the square."""
    left, right = grid_mesh(sheet, 8), grid_mesh(sheet, 8)
    assert left.corner_uv is not None and right.corner_uv is not None
    count = len(left.positions)
    joined = mesh_of(
        np.concatenate([left.positions, right.positions + 3.0]),
        np.concatenate([left.corner_normals, right.corner_normals]),
        np.concatenate([left.triangles, right.triangles + count]),
    )
    uv = np.concatenate([left.corner_uv * [0.49, 1.0], right.corner_uv * [0.49, 1.0] + [0.51, 0.0]])
    return replace(joined, corner_uv=uv.astype(np.float32))


REFUSED = {
    "has no UV map": lambda: replace(uv_sphere(8, 4), corner_uv=None),
    "overlaps itself": lambda: with_uv(
        lambda uv: np.column_stack([np.minimum(2.0 * uv[:, 0], 2.0 - 2.0 * uv[:, 0]), uv[:, 1]])
    ),
    "covers only": lambda: with_uv(lambda uv: 0.8 * uv),
    "reaches out of the unit square": lambda: with_uv(lambda uv: uv * [2.0, 1.0]),
    "not finite": lambda: with_uv(lambda uv: np.where(uv > 0.9, np.nan, uv)),
    "in 2 islands": islands,
}


@pytest.mark.parametrize("words", REFUSED)
def test_unfit_maps_are_refused(words: str) -> None:
    with pytest.raises(InputError) as refusal:
        bake(REFUSED[words]())
    text = str(refusal.value)
    assert (
        words in text and text.startswith(("The UV map of", '"Ball"')) and text.endswith(".") and text.count(". ") == 0
    )


def test_textures_are_those_the_solver_binds() -> None:
    baked = bake(uv_sphere(16, 8))
    assert set(baked.samplers()) == {name for _, name in SAMPLERS["parametric"]}
    assert baked.samplers() is baked.samplers()


@pytest.mark.parametrize("orthographic", [False, True], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("name", ["uv sphere", *SHAPES])
def test_shader_follows_the_reference(name: str, orthographic: bool) -> None:
    baked = bake(uv_sphere() if name == "uv sphere" else SHAPES[name][0]())
    vertices = vertices_around(6000)
    # The reflector stands turned and away from the origin: the map's frame is not the world's.
    world_to_map = rigid(3, (3.0, -2.0, 5.0))
    to_world = np.linalg.inv(world_to_map)
    place = to_world[:3, 3]
    world = (vertices @ to_world[:3, :3].T + place).astype(np.float32)
    view = look_at(place + EYE, place, 640, 480, np.radians(40), orthographic=orthographic)
    points, code, iterations, virtual = solve(baked, view, world, world_to_map).read()
    eye = world_to_map @ view.eye
    in_map = world.astype(np.float64) @ world_to_map[:3, :3].T + world_to_map[:3, 3]
    reference = secant_uv.solve(baked.surface, Screen(eye, view.focal_pixels), in_map, tolerance=0.05)
    assert (code == reference.status).mean() > 0.995
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.15
    expected = reference.position @ to_world[:3, :3].T + place
    error = np.linalg.norm(view.project(points) - view.project(expected), axis=1)[both]
    assert np.median(error) < 0.02
    # A search that has not converged after five steps turns on the last bits.
    assert np.percentile(error, 98) < 0.25
    assert abs(iterations[both].mean() - reference.iterations[both].mean()) < 0.1
    hidden = (code == status.HIDDEN) & (reference.status == status.HIDDEN)
    assert hidden.mean() > 0.05
    assert np.percentile(np.linalg.norm(points - expected, axis=1)[hidden], 95) < 1e-3
    # A hidden vertex is its mirror image in the tangent plane.
    normal = reference.normal @ to_world[:3, :3].T
    image = world - 2.0 * ((world - expected) * normal).sum(axis=1, keepdims=True) * normal
    assert np.percentile(np.linalg.norm(virtual[:, :3] - image, axis=1)[hidden], 95) < 0.01
    # A reflected vertex seems to be behind its reflection point, on the same line of sight.
    same_pixel = np.linalg.norm(view.project(virtual[:, :3]) - view.project(points), axis=1)[both]
    assert same_pixel.max() < 0.05


def test_sphere_against_the_quartic() -> None:
    baked, vertices = bake(uv_sphere()), vertices_around(4000, 0.3)
    view = look_at(EYE, np.zeros(3), 640, 480, np.radians(40))
    truth = sphere.reflection_points(EYE, vertices, 1.0)
    reflects = np.isfinite(truth[:, 0])
    for steps, lost, p95 in ((0, 0.1, 2.0), (12, 0.07, 0.3)):
        points, code, iterations, _ = solve(baked, view, vertices, np.eye(4), steps).read()
        assert iterations.max() == (steps or 5)
        both = reflects & (code == status.REFLECTED)
        assert (reflects & ~both).sum() < lost * reflects.sum()
        error = np.linalg.norm(view.project(points) - view.project(truth), axis=1)[both]
        assert np.percentile(error, 95) < p95
        # On the horizon the mesh, whose faces lie inside the sphere, reflects a little more.
        assert (~reflects & (code == status.REFLECTED)).mean() < 0.005


def test_broken_vertices_are_marked() -> None:
    places = np.array([[np.nan, 0, 0], [np.inf, 0, 0], [0.6, -1.5, 1.0], [0, 0, 0], EYE], np.float32)
    view = look_at(EYE, np.zeros(3), 320, 240, np.radians(40))
    points, code, _, virtual = solve(bake(uv_sphere()), view, places, np.eye(4)).read()
    assert code[:4].tolist() == [status.INVALID, status.INVALID, status.REFLECTED, status.HIDDEN]
    assert np.isfinite(points).all() and np.isfinite(virtual).all()


def test_same_input_same_bits() -> None:
    baked, vertices = bake(uv_sphere(32, 16)), vertices_around(3000)
    view = look_at(EYE, np.zeros(3), 320, 240, np.radians(40))
    first, second = (solve(baked, view, vertices, np.eye(4)).read() for _ in range(2))
    for one, other in zip(first, second, strict=True):
        assert np.array_equal(one, other)


def test_islands_are_counted_as_by_flooding() -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        points = int(random.integers(3, 120))
        groups = random.integers(points, size=(int(random.integers(1, 60)), 3))
        parts: list[set[int]] = []
        for triangle in groups.tolist():
            joined = [part for part in parts if part & set(triangle)]
            parts = [part for part in parts if not part & set(triangle)] + [set(triangle).union(*joined)]
        assert _islands(groups, np.ones(len(groups))) == sum(
            sum(bool(part & set(triangle)) for triangle in groups.tolist()) > MOST_OVERLAP * len(groups)
            for part in parts
        )
