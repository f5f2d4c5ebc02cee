# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through the hierarchies, against rays in numpy."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...optics.surfaces.mesh_rays import MeshRays
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from ..device.context import gpu_cache
from ..device.shaders import FULL_SCREEN, Piece, build_shader, named
from ..device.textures import texture_2d
from ..geometry.mesh_facts import MeshFactsCache
from ..geometry.vertex_uploads import VertexUploads
from ..rays.ray_scene import RAYS, RayScene
from ..surfaces.materials import TABLE, Materials
from .cases import as_stored, ball, directions, square
from .proof import Found, Work, drawn_square

SIDE = 24
"""Rays are a square of so many"""
MOST_OFF = 1e-4
"""Of a hit, in parts of the scene's size, and of its normal in radians"""
TWIST = 0.9
"""Radians a meter, in `deformed`"""
OUTLIERS = 0.01
"""Share of the rays that may do anything: along edges rounding decides"""


def prove_walk() -> Work:
    """Three placed meshes, seen by rays from a sphere around them to its inside."""
    scene = things()
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {})
    yield
    return (yield from _compared(rays, scene))


def prove_fits() -> Work:
    """The same, where the meshes have deformed since their trees were built."""
    scene = things()
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {})
    yield
    scene = replace(scene, meshes=tuple(deformed(mesh) for mesh in scene.meshes))
    rays.follow(scene, {})
    yield
    return (yield from _compared(rays, scene))


def deformed(mesh: MeshArrays) -> MeshArrays:
    """Turned more the higher up, and stretched; each vertex has a corner."""
    x, y, z = mesh.positions.T.astype(np.float64)
    cosine, sine = np.cos(TWIST * z), np.sin(TWIST * z)
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y, 1.2 * z + 0.1 * x], axis=1)
    along_x = np.stack([cosine, sine, np.full_like(x, 0.1)], axis=1)
    along_y = np.stack([-sine, cosine, np.zeros_like(x)], axis=1)
    along_z = np.stack([-TWIST * turned[:, 1], TWIST * turned[:, 0], np.full_like(x, 1.2)], axis=1)
    normals = np.linalg.solve(np.stack([along_x, along_y, along_z], axis=1), mesh.corner_normals[..., None])[..., 0]
    return replace(mesh, positions=turned.astype(np.float32), corner_normals=unit(normals).astype(np.float32))


def _compared(rays: RayScene, scene: SceneArrays) -> Work:
    """Rays through the hierarchies and those in numpy."""
    origins = as_stored(5.0 * directions(SIDE * SIDE))
    ways = as_stored(unit(2.2 * np.roll(directions(SIDE * SIDE), 97, axis=0) * [1.0, 1.0, 0.8] - origins))
    place, facing = _walked(rays, Materials(scene), origins, ways)
    yield
    mesh, owner = joined(scene)
    hits = mesh.first_hits(origins, ways)
    met = hits.triangle >= 0
    expected = np.where(met, owner[np.maximum(hits.triangle, 0)], 0)
    points = origins + np.where(met, hits.distance, 0.0)[:, None] * ways
    normal = hits.normal * -np.sign(np.einsum("ij,ij->i", hits.normal, ways))[:, None]
    off = np.where(place[:, 3] == expected, 0.0, np.inf)
    on = met & (place[:, 3] == expected)
    off[on] = np.abs(place[on, :3] - points[on]).max(axis=1) / 5.0
    # A hit is on the side of its triangle that the ray comes from; the normal between corners may lean over.
    clear = on & (np.abs(np.einsum("ij,ij->i", hits.normal, ways)) > 0.2)
    off[clear] = np.maximum(off[clear], np.linalg.norm(facing[clear, :3] - normal[clear], axis=1))
    off[np.isnan(off)] = np.inf
    kept = np.sort(off)[: int(len(off) * (1.0 - OUTLIERS))]
    return Found(float(kept[-1]) if on.any() and (~met).any() else np.inf, MOST_OFF, "of the scene's size")


def things() -> SceneArrays:
    """A ball, the same turned and stretched, and a floor."""
    stretched = np.array([[0.5, -0.4, 0.0, 1.2], [0.3, 0.6, 0.1, -0.8], [0.0, 0.2, 0.9, 0.5], [0.0, 0.0, 0.0, 1.0]])
    moved = np.diag([0.8, 0.8, 0.8, 1.0])
    moved[:3, 3] = -0.9, 0.4, 0.1
    instances = [
        InstanceArrays(f"{number}", number, mesh, matrix, (0,))
        for number, (mesh, matrix) in enumerate([(0, moved), (0, stretched), (1, np.eye(4))], 1)
    ]
    return SceneArrays(
        (ball(24), square(2.5, -1.0)), tuple(instances), (MaterialArrays("gray"),), (), (), WorldArrays()
    )


def joined(scene: SceneArrays) -> tuple[MeshRays, np.ndarray]:
    """All triangles of a scene in world space, and the object_id (n,) of each."""
    positions: list[Float64Array] = []
    normals: list[Float64Array] = []
    triangles, owners, first = [], [], 0
    for instance in scene.instances:
        mesh, matrix = scene.meshes[instance.mesh], instance.matrix
        positions.append(mesh.positions @ matrix[:3, :3].T + matrix[:3, 3])
        # (As long as this makes them: between corners they are mixed in object space.)
        normals.append(mesh.corner_normals @ np.linalg.inv(matrix[:3, :3]))
        triangles.append(mesh.triangles + first)
        owners.append(np.full(len(mesh.triangles), instance.object_id))
        first += len(mesh.positions)
    return MeshRays(np.concatenate(positions), np.concatenate(normals), np.concatenate(triangles)), np.concatenate(
        owners
    )


def _walked(rays: RayScene, materials: Materials, origins: Float64Array, ways: Float64Array) -> list[np.ndarray]:
    """Both outputs (n, 4) of `walk.frag.glsl`."""
    textures = [
        texture_2d(np.dstack([array.reshape(SIDE, SIDE, 3), np.ones((SIDE, SIDE))])) for array in (origins, ways)
    ]
    samplers = {"ray_origins": textures[0], "ray_directions": textures[1], "materials": materials.table}
    return [found.reshape(-1, 4) for found in drawn_square(_shader(), SIDE, samplers, 2, rays.bind)]


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "proof of rays",
        FULL_SCREEN,
        RAYS,
        TABLE,
        Piece(
            samplers=named("FLOAT_2D", "ray_origins", "ray_directions"),
            outputs=named("VEC4", "hit_place", "hit_facing"),
            fragment="proofs/walk.frag.glsl",
        ),
    )
