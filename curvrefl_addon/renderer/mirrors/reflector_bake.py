# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes placed meshes into radial cube maps (Roger & Holzschuch 2006, section 3.3.1: r and grad r in a texture)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import InputError
from ...optics.surfaces.cube_holes import fill_holes
from ...optics.surfaces.cube_map import CubeMapSurface, texel_directions
from ...optics.surfaces.radial_surfaces import unit
from ...optics.surfaces.star_center import find_star_center
from ...scene.arrays import Float32Array, Float64Array, InstanceArrays, MeshArrays, SceneArrays
from ..device.context import require_gpu
from .cube_raster import CubeRaster
from .placed_mesh import PlacedMesh, place_mesh, samples_of
from .reflector_map import ReflectorMap, Spread, percent

MIN_RESOLUTION = 8
MAX_RESOLUTION = 2048
LEAST_COSINE = 0.05
"""Between direction and shading normal; at flatter angles the gradient is clamped to its length there (20 r)"""
SAME_HIT = 1e-3
"""Two hits along a direction count as one when their radii differ by less than this share"""
COARSE = 0.01
"""Error of the radius (95 of 100 points) from which on a warning says that the map is too coarse"""
ERROR_POINTS = 4096
"""The map is compared with the mesh at so many points"""


@dataclass(frozen=True, slots=True)
class Limits:
    """Past these shares of all directions a mesh is refused; 1 refuses nothing but what cannot be baked at all.

    Where a ray leaves the mesh twice the map shows the farther surface only, and holes are filled: both show false
    reflections there, of about that share of the reflector. Half of a limit earns a warning.
    """

    multiple_hits: float = 0.02
    holes: float = 0.02


def bake_reflectors(
    scene: SceneArrays,
    object_id: int,
    resolution: int = 128,
    center: ArrayLike | None = None,
    limits: Limits | None = None,
) -> list[ReflectorMap]:
    """One map per instance of an object; see `bake_instance`.

    Raises InputError when the scene shows no such object.
    """
    chosen = [i for i, instance in enumerate(scene.instances) if instance.object_id == object_id]
    if not chosen:
        raise InputError(
            f"The scene shows no mesh of the chosen reflector (object {object_id}): make it visible in renders.",
            object_id,
        )
    return [bake_instance(scene, index, resolution, center, limits) for index in chosen]


def bake_reflector(
    scene: SceneArrays,
    object_id: int,
    resolution: int = 128,
    center: ArrayLike | None = None,
    limits: Limits | None = None,
) -> ReflectorMap:
    """The map of an object that the scene shows exactly once; see `bake_instance`.

    Raises InputError when it shows it never or more than once.
    """
    maps = bake_reflectors(scene, object_id, resolution, center, limits)
    if len(maps) > 1:
        raise InputError(
            f'"{maps[0].object_name}" is shown {len(maps)} times: choose one of its instances, or make it single.',
            object_id,
        )
    return maps[0]


def bake_instance(
    scene: SceneArrays,
    instance_index: int,
    resolution: int = 128,
    center: ArrayLike | None = None,
    limits: Limits | None = None,
) -> ReflectorMap:
    """Bake `scene.instances[instance_index]`; see `bake_placed`."""
    instance = scene.instances[instance_index]
    return bake_placed(scene.meshes[instance.mesh], instance, resolution, center, limits)


def bake_placed(
    mesh: MeshArrays,
    instance: InstanceArrays,
    resolution: int = 128,
    center: ArrayLike | None = None,
    limits: Limits | None = None,
) -> ReflectorMap:
    """Bake a placed mesh into cube maps of `resolution` x `resolution` texels a face.

    The star center is `center` (3,), in world space, or else found. Raises InputError for a resolution out of range,
    an empty or non-finite mesh, a matrix without inverse, a center that sees nothing of the mesh, and a mesh past
    the `limits`; GpuUnavailableError without a GPU context.
    """
    if not MIN_RESOLUTION <= resolution <= MAX_RESOLUTION:
        raise InputError(f"A map of {resolution} texels is out of range: choose {MIN_RESOLUTION} to {MAX_RESOLUTION}.")
    limits = limits or Limits()
    require_gpu()
    placed = place_mesh(mesh, instance)
    corners = placed.triangle_positions()
    if (corners == corners[0, 0]).all():
        raise InputError(
            f'"{placed.name}" is a single point: choose a mesh with a surface as reflector.', instance.object_id
        )
    if center is None:
        found = find_star_center(corners, np.zeros(3))
        origin, center_name = found.position, found.name
    else:
        origin, center_name = placed.from_world(center), "given"
    corners -= origin

    raster = CubeRaster(
        (placed.positions - origin)[placed.corner_vertex].astype(np.float32),
        placed.normals.astype(np.float32),
        placed.triangles,
        resolution,
    )
    hits, hit_normals = raster.farthest()
    hit = hits[..., 3] != 0.0
    if not hit.any():
        raise InputError(
            f'"{placed.name}" is flat or has nothing around its star center: choose a closed, curved mesh as '
            "reflector.",
            instance.object_id,
        )
    weights = _solid_angle_weights(resolution)
    # An inverted mesh turns its inside outwards all around: then that counts as the outside.
    raster.inverted = float((weights * hits[..., 3]).sum()) < 0.0
    first = raster.nearest_outside()
    directions = texel_directions(resolution)
    radii = np.einsum("...i,...i->...", hits[..., :3].astype(np.float64), directions)
    first_radii = np.einsum("...i,...i->...", first[..., :3].astype(np.float64), directions)
    leaves_twice = hit & (first[..., 3] != 0.0) & (first_radii < (1.0 - SAME_HIT) * radii)

    gradients, outward, clamped = _gradients(directions, radii, hit_normals[..., :3], hit)
    radial = np.concatenate([radii[..., None], gradients], axis=-1)
    multiple_hits = float(weights[leaves_twice].sum())
    holes = float(weights[~hit].sum())
    warnings = _refuse_or_warn(instance, multiple_hits, holes, limits)
    if not hit.all():
        radial = fill_holes(radial, hit)
    radial = radial.astype(np.float32)

    map_to_world = placed.map_to_world.copy()
    map_to_world[:3, 3] += map_to_world[:3, :3] @ origin
    radius_error, normal_error, error_points = _measure(placed, corners, raster.inverted, radial)
    # Where the mesh has a second surface under the first, that one is off at any resolution.
    if radius_error.p95 > COARSE > multiple_hits:
        warnings += (
            f'"{placed.name}" is too long or too jagged for a map of {resolution} texels (5 of 100 points lie off by '
            f"{percent(radius_error.p95)} or more): raise the map's resolution.",
        )
    return ReflectorMap(
        object_name=placed.name,
        resolution=resolution,
        world_to_map=_rigid_inverse(map_to_world),
        center_name=center_name,
        radial=radial,
        positions=np.concatenate([radial[..., :1] * directions, hit[..., None]], axis=-1).astype(np.float32),
        normals=np.concatenate([outward, hit[..., None]], axis=-1).astype(np.float32),
        r_min=float(radial[..., 0].min()),
        r_max=float(radial[..., 0].max()),
        multiple_hits=multiple_hits,
        holes=holes,
        grazing=float(weights[clamped].sum()),
        radius_error=radius_error,
        normal_error_degrees=normal_error,
        error_points=error_points,
        warnings=warnings,
    )


def _gradients(
    directions: Float64Array, radii: Float64Array, normals: Float32Array, hit: NDArray[np.bool_]
) -> tuple[Float64Array, Float64Array, NDArray[np.bool_]]:
    """Gradients (6, n, n, 3), unit normals turned outwards, and where the gradient had to be clamped.

    The surface r(u) u has its normal along r u - grad r, so grad r = r (u - N / (N . u)).
    """
    outward = unit(normals.astype(np.float64))
    cosines = np.einsum("...i,...i->...", outward, directions)
    # Flat towards the direction or away from it is the same to Cycles, which reflects on both sides.
    outward = np.where((cosines < 0.0)[..., None], -outward, outward)
    cosines = np.abs(cosines)
    sines = np.sqrt(np.maximum(1.0 - cosines**2, 1e-30))
    steepest = np.sqrt(1.0 - LEAST_COSINE**2) / LEAST_COSINE
    sideways = outward - cosines[..., None] * directions
    slopes = np.minimum(sines / np.maximum(cosines, 1e-30), steepest) / sines
    clamped = hit & (cosines < LEAST_COSINE)
    return -(radii * slopes)[..., None] * sideways, outward, clamped


def _refuse_or_warn(instance: InstanceArrays, multiple_hits: float, holes: float, limits: Limits) -> tuple[str, ...]:
    name = instance.object_name
    twice = (
        f'"{name}" is not star-shaped ({percent(multiple_hits)} of directions from its center leave it more than once)'
    )
    open_ = f'"{name}" is open or not star-shaped ({percent(holes)} of directions from its center meet no surface)'
    if multiple_hits > limits.multiple_hits:
        raise InputError(
            f"{twice}: split it into parts that are, or use its convex hull or a smoothed remesh as reflector.",
            instance.object_id,
        )
    if holes > limits.holes:
        raise InputError(
            f"{open_}: fill its holes, split it into star-shaped parts, or use its convex hull as reflector.",
            instance.object_id,
        )
    warnings = []
    if multiple_hits > 0.5 * limits.multiple_hits:
        warnings.append(f"{twice}: what is in front of its farthest surface reflects wrongly.")
    if holes > 0.5 * limits.holes:
        warnings.append(f"{open_}: the gap is bridged smoothly, and reflections near its rim may be wrong.")
    return tuple(warnings)


def _solid_angle_weights(resolution: int) -> Float64Array:
    """Share (6, n, n) of all directions that each texel covers; sums to 1."""
    centers = (2.0 * np.arange(resolution) + 1.0) / resolution - 1.0
    weights = (1.0 + centers[:, None] ** 2 + centers[None, :] ** 2) ** -1.5
    return np.broadcast_to(weights / (6.0 * weights.sum()), (6, resolution, resolution))


def _measure(
    placed: PlacedMesh, corners: Float64Array, inverted: bool, radial: Float32Array
) -> tuple[Spread, Spread, Float32Array]:
    """Errors of the map against the mesh's outside, at points spread evenly over its area."""
    samples = samples_of(placed, corners, inverted, ERROR_POINTS)
    points, normals = samples.points, samples.normals
    if len(points) == 0:
        return Spread(), Spread(), np.zeros((0, 4), np.float32)
    radii = np.linalg.norm(points, axis=1)
    directions = points / radii[:, None]
    map_radii, gradients = CubeMapSurface(radial).radius(directions)
    map_normals = unit(map_radii[:, None] * directions - gradients)
    crossed = np.linalg.norm(np.cross(map_normals, normals), axis=1)
    angles = np.degrees(np.arctan2(crossed, np.abs(np.einsum("ij,ij->i", map_normals, normals))))
    error_points = np.column_stack([points, map_radii]).astype(np.float32)
    return Spread.of(np.abs(map_radii / radii - 1.0)), Spread.of(angles), error_points


def _rigid_inverse(matrix: Float64Array) -> Float64Array:
    result = np.eye(4)
    result[:3, :3] = matrix[:3, :3].T
    result[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return result
