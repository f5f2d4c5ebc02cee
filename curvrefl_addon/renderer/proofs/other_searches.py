# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex methods that read other maps: each on a shape whose reflection points are known in closed form, or by a
float64 search."""

from __future__ import annotations

import numpy as np

from ...optics import status
from ...optics.screen import Screen
from ...optics.solvers import secant_uv
from ...optics.surfaces.cube_map import texel_directions
from ...optics.surfaces.parametric_surfaces import EllipsoidMap, SampledMap
from ...optics.surfaces.sphere import reflection_points
from ...scene.arrays import Float32Array, Float64Array, InstanceArrays
from ..device.records import read_records, record_texture
from ..device.textures import texture_2d
from ..geometry.chunk import Chunk, Placed
from ..mirrors.parametric_map import ParametricMap
from ..mirrors.screen_maps import map_to_texels
from ..vertices.grid_solve import ChunkGrid
from ..vertices.solution import VertexSolution
from ..vertices.solve import Reflector, solve_vertices
from .cases import EYE, ball, directions, lines_of_sight, records_of, vertices_around, view_of_origin
from .proof import Found, Work
from .searches import PIXELS, SPHERE, VERTICES, judged

U_TEXELS, V_TEXELS, DIRECTIONS = 128, 64, 32
PLANE = (0.0, 0.0, 1.0, -0.5)
MOST_TEXELS_OFF = 1.5
"""A search on the screen ends at a texel: so many pixels are the best that it can do between two near the silhouette"""


def prove_parametric() -> Work:
    """`secant_uv` on an ellipsoid."""
    surface = _sampled(EllipsoidMap(1.0, 0.8, 0.6))
    view, vertices = view_of_origin(EYE, *PIXELS), vertices_around(SPHERE, VERTICES)
    screen = Screen(view.eye, view.focal_pixels)
    expected = secant_uv.solve(surface, screen, vertices, tolerance=0.05)
    yield
    reflector = Reflector(np.eye(4), 2.0, ParametricMap(surface, 1.0).samplers())
    solution = solve_vertices("secant_uv", view, reflector, record_texture(records_of(vertices)), VERTICES)
    yield
    return judged(solution, screen, (expected.position, expected.status), 0.06)


def _sampled(shape: EllipsoidMap) -> SampledMap:
    u, v = ((np.arange(size) + 0.5) / size for size in (U_TEXELS, V_TEXELS))
    at = shape.sample(np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2))

    def packed(vectors: Float64Array, component: int) -> Float32Array:
        joined = np.column_stack([vectors, at.normal[:, component]])
        return joined.reshape(V_TEXELS, U_TEXELS, 4).astype(np.float32)

    towards = texel_directions(DIRECTIONS).reshape(-1, 3)
    radius, uv = shape.solid.radius(towards)[0], shape.uv_of_direction(towards)
    # (u wraps.)
    held = np.column_stack([radius, uv, np.ones(len(towards))]).reshape(6, DIRECTIONS, DIRECTIONS, 4)
    return SampledMap(packed(at.position, 0), packed(at.du, 1), packed(at.dv, 2), held.astype(np.float32))


def prove_screen() -> Work:
    """`bisector_screen` on pictures of a sphere, against the quartic."""
    view, vertices = view_of_origin(EYE, *PIXELS), vertices_around(SPHERE, VERTICES)
    rays = lines_of_sight(view)
    along = rays @ view.eye[:3]
    root = along**2 - view.eye[:3] @ view.eye[:3] + 1.0
    is_there = root > 0.0
    points = view.eye[:3] - (along + np.sqrt(np.maximum(root, 0.0)))[..., None] * rays
    maps = np.where(is_there[..., None], np.concatenate([points, np.ones((*root.shape, 1))], axis=-1), 0.0)
    yield
    texture = texture_2d(maps.astype(np.float32))
    start = (0.5 * view.width, 0.5 * view.height)
    textures = {"screen_position": texture, "screen_normal": texture}
    reflector = Reflector(np.eye(4), 1.0, textures, map_to_search=map_to_texels(view, np.eye(4)), start=start)
    solution = solve_vertices("bisector_screen", view, reflector, record_texture(records_of(vertices)), VERTICES)
    yield
    truth = reflection_points(view.eye[:3], vertices, 1.0)
    # Near the silhouette a texel covers many normals.
    cosine = np.einsum("ij,ij->i", truth, view.eye[:3] - truth) / np.linalg.norm(view.eye[:3] - truth, axis=1)
    clear = np.flatnonzero(cosine > 0.3)
    found, code, _, _ = solution.read()
    screen = Screen(view.eye, view.focal_pixels)
    off = np.linalg.norm(screen.pixels(truth[clear], found[clear] - truth[clear]), axis=1)
    off[code[clear] != status.REFLECTED] = np.inf
    return Found(float(off.max()) if len(off) else np.inf, MOST_TEXELS_OFF, "pixels")


def prove_planar() -> Work:
    """`planar` against the mirror image in a plane."""
    view, vertices = view_of_origin(EYE, *PIXELS), 3.0 * directions(VERTICES)
    positions = record_texture(records_of(vertices))
    solution = solve_vertices("planar", view, Reflector(np.eye(4), 2.0, plane=PLANE), positions, VERTICES)
    yield
    normal, offset = np.array(PLANE[:3]), PLANE[3]
    height, eye_height = vertices @ normal - offset, EYE @ normal - offset
    image = vertices - 2.0 * height[:, None] * normal
    points = image + (height / (height + eye_height))[:, None] * (EYE - image)
    code = np.where(height > 0.0, status.REFLECTED, status.HIDDEN)
    return judged(solution, Screen(view.eye, view.focal_pixels), (points, code), 0.0)


def prove_grid() -> Work:
    """`bisector_grid`: what is affine at a grid's corners is so between them."""
    mesh = ball(12)
    matrix = np.array([[0.4, 0.1, 0.0, 1.0], [0.0, 0.5, -0.2, -1.0], [0.1, 0.0, 0.6, 0.5], [0.0, 0.0, 0.0, 1.0]])
    chunk = Chunk([Placed(InstanceArrays("", 1, 0, matrix, (0,)), mesh, mesh, np.zeros(len(mesh.triangles), np.int8))])
    grid = ChunkGrid(chunk, 0.15)
    affine = np.array([[0.9, 0.2, 0.1, 0.3], [-0.3, 1.1, 0.2, -0.2], [0.1, 0.4, 0.7, 0.1], [0.2, 0.1, 0.3, 5.0]])

    def carried(points: Float64Array) -> Float64Array:
        return np.column_stack([points, np.ones(len(points))]) @ affine.T

    def search(positions: object, count: int) -> VertexSolution:
        there = carried(read_records(positions, count)[:, :3].astype(np.float64))
        # (One step each.)
        points = record_texture(np.column_stack([there[:, :3], np.full(count, status.REFLECTED + 4.0)]))
        return VertexSolution(points, record_texture(there), count)

    yield
    found, code, _, virtual = grid.solve(chunk, search).read()
    yield
    world = mesh.positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    truth = carried(world)
    off = np.maximum(np.abs(found - truth[:, :3]).max(axis=1), np.abs(virtual - truth).max(axis=1))
    off[code != status.REFLECTED] = np.inf
    return Found(float(off.max()), 1e-4, "of the mesh's size")
