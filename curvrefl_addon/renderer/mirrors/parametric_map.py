# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes a placed mesh into textures of its UV map (Roger & Holzschuch 2005, section 3.3.2: f, df/du and df/dv).

The derivatives are those of the mesh, averaged at its vertices and interpolated between them as shading normals are,
and then made perpendicular to the shading normal: so the path is stationary exactly where Cycles reflects.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...optics.surfaces.cube_map import texel_directions
from ...optics.surfaces.parametric_surfaces import SampledMap
from ...optics.surfaces.radial_surfaces import unit
from ...optics.surfaces.star_center import solid_angles
from ...scene.arrays import Float32Array, Float64Array, InstanceArrays, Int32Array, MeshArrays
from ..device.batches import vertex_batch
from ..device.context import gpu_cache, require_gpu
from ..device.cubes import cube_texture
from ..device.frame_buffers import frame_buffer, read_colors
from ..device.shaders import Piece, build_shader, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture, texture_2d
from .cube_raster import CubeRaster
from .reflector_map import percent
from .uv_fill import filled_texels, joins_around

RESOLUTION = 512
"""Texels along u and along v"""
DIRECTIONS = 64
"""Texels along an edge of a face of the map of directions"""
LEAST_COVER = 0.7
"""Share of the unit square that a UV map must cover; the poles of a UV sphere of 4 rings leave out a quarter"""
MOST_OVERLAP = 0.02
"""Share of the unit square that a UV map may cover twice, or have outside"""
SAME_UV = 1e-5
"""Corners of a vertex that are no farther apart are one"""
STAR_SHAPED = 0.02
"""Share of directions that may leave a closed mesh never or more than once"""
RIM = 4096
"""Holes of the map of directions take the nearest of about so many texels"""


class ParametricMap:
    """The textures of one reflector, in the map frame (meters about its center)."""

    def __init__(self, surface: SampledMap, cover: float) -> None:
        self.surface = surface
        self.cover = cover
        """Share of the unit square that the UV map covers"""

    def samplers(self) -> dict[str, Any]:
        """Textures by the names they have in `parametric_map.glsl`."""
        return self._textures

    @cached_property
    def _textures(self) -> dict[str, Any]:
        textures = {}
        for name in ("surface_point", "surface_du", "surface_dv"):
            texture = texture_2d(getattr(self.surface, name), linear=True)
            texture.extend_mode_x("REPEAT" if self.surface.wraps[0] else "EXTEND")
            texture.extend_mode_y("REPEAT" if self.surface.wraps[1] else "EXTEND")
            textures[name] = texture
        textures["uv_of_direction"] = cube_texture(self.surface.directions)
        return textures


def bake_parametric(
    mesh: MeshArrays, instance: InstanceArrays, world_to_map: Float64Array, resolution: int = RESOLUTION
) -> ParametricMap:
    """Bake an instance into textures of `resolution` x `resolution` texels; `world_to_map` (4, 4) is rigid.

    Raises InputError for a mesh without UV map, and for a UV map that overlaps itself, is in several islands, or does
    not fill the unit square; GpuUnavailableError without a GPU context.
    """
    require_gpu()
    name = instance.object_name
    if mesh.corner_uv is None or len(mesh.triangles) == 0:
        raise InputError(
            f'"{name}" has no UV map: unwrap it as one grid that fills the unit square, as a UV sphere is, or choose '
            "another method.",
            instance.object_id,
        )
    uv = mesh.corner_uv.astype(np.float64)
    to_map = world_to_map @ instance.matrix
    positions = mesh.positions @ to_map[:3, :3].T + to_map[:3, 3]
    normals = unit(mesh.corner_normals @ np.linalg.inv(to_map[:3, :3]))
    corners = positions[mesh.corner_vertex]
    _refuse_bad_uv(instance, uv, mesh)
    poles = [_is_pole(mesh.corner_vertex, uv, axis) for axis in (0, 1)]
    du, dv = _tangents(corners, uv, mesh.corner_vertex, mesh.triangles)
    # f does not change with u, or v, there.
    du[poles[0]], dv[poles[1]] = 0.0, 0.0

    layers = _draw([uv, corners, normals, du, dv], mesh.triangles, resolution)
    hit = layers[0][..., 3] > 0.5
    cover = float(hit.mean())
    overlap = _uv_areas(uv, mesh.triangles).sum() - cover
    if overlap > MOST_OVERLAP:
        raise InputError(
            f'The UV map of "{name}" overlaps itself ({percent(overlap)} of the unit square): unwrap it so that every '
            "point of the square belongs to one face, or choose another method.",
            instance.object_id,
        )
    if cover < LEAST_COVER:
        raise InputError(
            f'The UV map of "{name}" covers only {percent(cover)} of the unit square: unwrap it as one grid that fills '
            "the square, as a UV sphere is, or choose another method.",
            instance.object_id,
        )
    values = np.concatenate([layer[..., :3] for layer in layers], axis=-1).astype(np.float64)
    wraps = (joins_around(values, hit, 0), joins_around(values, hit, 1))
    point, normal, along_u, along_v = np.split(
        filled_texels(values, hit, wraps, [bool(pole.any()) for pole in poles]), 4, axis=-1
    )
    # Outwards on the whole: the integral of f . n over a closed surface is three times its volume.
    outwards = np.sign(_flux(corners, normals, mesh.triangles)) or 1.0
    normal = outwards * unit(normal)

    def packed(vectors: Float64Array, component: int) -> Float32Array:
        across = vectors - (vectors * normal).sum(axis=-1, keepdims=True) * normal
        return np.concatenate([across, normal[..., component : component + 1]], axis=-1).astype(np.float32)

    is_solid = _is_star_shaped(corners[mesh.triangles])
    is_open = not is_solid and _has_border(positions, mesh.corner_vertex[mesh.triangles])
    flags = wraps[0] + 2 * wraps[1] + 4 * is_open
    surface = SampledMap(
        np.concatenate([point, normal[..., :1]], axis=-1).astype(np.float32),
        packed(along_u, 1),
        packed(along_v, 2),
        _directions(corners, uv, mesh.triangles, is_solid, flags),
    )
    return ParametricMap(surface, cover)


def _refuse_bad_uv(instance: InstanceArrays, uv: Float64Array, mesh: MeshArrays) -> None:
    name = instance.object_name
    used = uv[mesh.triangles].reshape(-1, 2)
    if not np.isfinite(used).all():
        raise InputError(
            f'The UV map of "{name}" has values that are not finite numbers: unwrap it anew.', instance.object_id
        )
    if used.min() < -MOST_OVERLAP or used.max() > 1.0 + MOST_OVERLAP:
        raise InputError(
            f'The UV map of "{name}" reaches out of the unit square: scale it into the square, or choose another '
            "method.",
            instance.object_id,
        )
    islands = _islands(_groups(mesh.corner_vertex, uv)[mesh.triangles], _uv_areas(uv, mesh.triangles))
    if islands > 1:
        raise InputError(
            f'The UV map of "{name}" is in {islands} islands: unwrap it as one grid that fills the unit square, as a '
            "UV sphere is, or choose another method.",
            instance.object_id,
        )


def _uv_areas(uv: Float64Array, triangles: Int32Array) -> Float64Array:
    """(triangles,)"""
    a, b, c = (uv[triangles[:, k]] for k in range(3))
    return 0.5 * np.abs(_cross(b - a, c - a))


def _cross(p: Float64Array, q: Float64Array) -> Float64Array:
    return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]


def _groups(corner_vertex: Int32Array, uv: Float64Array) -> NDArray[np.int64]:
    """Number (corners,) that corners share which are one point of the map; u and v of 0 and of 1 are the same."""
    steps = round(1.0 / SAME_UV)
    whole = np.rint(uv * steps).astype(np.int64) % steps
    return np.unique((corner_vertex * steps + whole[:, 0]) * steps + whole[:, 1], return_inverse=True)[1]


def _islands(groups: NDArray[np.int64], areas: Float64Array) -> int:
    """Number of connected parts of triangles (n, 3) that have more than a sliver of the map's area."""
    label = np.arange(int(groups.max()) + 1)
    while True:
        # Labels are roots here: of the roots that a triangle joins, the lowest becomes that of the others.
        roots = label[groups]
        lowest = roots.min(axis=1)
        if (roots == lowest[:, None]).all():
            break
        np.minimum.at(label, roots.ravel(), np.repeat(lowest, 3))
        while not np.array_equal(parent := label[label], label):
            label = parent
    shares = np.bincount(label[groups[:, 0]], weights=areas, minlength=len(label))
    return int((shares > MOST_OVERLAP * areas.sum()).sum())


def _tangents(
    corners: Float64Array, uv: Float64Array, corner_vertex: Int32Array, triangles: Int32Array
) -> tuple[Float64Array, Float64Array]:
    """df/du and df/dv (corners, 3), averaged over the triangles at each corner, weighted by their area on the map."""
    a, b, c = (triangles[:, k] for k in range(3))
    edge_1, edge_2 = corners[b] - corners[a], corners[c] - corners[a]
    span_1, span_2 = uv[b] - uv[a], uv[c] - uv[a]
    determinant = _cross(span_1, span_2)[:, None]
    sign = np.sign(determinant)
    # Times the area, which is the weight.
    by_u = sign * (edge_1 * span_2[:, 1:] - edge_2 * span_1[:, 1:])
    by_v = sign * (edge_2 * span_1[:, :1] - edge_1 * span_2[:, :1])
    groups = _groups(corner_vertex, uv)
    sums = np.zeros((int(groups.max()) + 1, 7))
    contributions = np.concatenate([by_u, by_v, np.abs(determinant)], axis=1)
    for k in range(3):
        np.add.at(sums, groups[triangles[:, k]], contributions)
    means = (sums[:, :6] / np.maximum(sums[:, 6:], 1e-30))[groups]
    return means[:, :3], means[:, 3:]


def _is_pole(corner_vertex: Int32Array, uv: Float64Array, axis: int) -> NDArray[np.bool_]:
    """(corners,) whether the vertex is at a pole of the map: at three or more places along `axis` in one line."""
    steps = round(1.0 / SAME_UV)
    whole = np.rint(uv * steps).astype(np.int64)
    line = corner_vertex * (2 * steps) + whole[:, 1 - axis]
    _, number = np.unique(line, return_inverse=True)
    places = np.unique(number * steps + whole[:, axis] % steps)
    count = np.bincount(places // steps, minlength=int(number.max()) + 1)
    return count[number] >= 3


def _draw(attributes: list[Float64Array], triangles: Int32Array, resolution: int) -> list[Float32Array]:
    """Position, normal, du and dv, each (resolution, resolution, 4), of the mesh drawn in its UV map."""
    names = ("uv", "position", "normal", "du", "dv")
    batch = vertex_batch(dict(zip(names, attributes, strict=True)), triangles)
    textures = [empty_texture(resolution, resolution) for _ in range(4)]
    target = frame_buffer(*textures)
    with target.bind(), drawing_state():
        set_viewport(0, 0, resolution, resolution)
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
        shader = _shader()
        shader.bind()
        batch.draw(shader)
        return [read_colors(target, resolution, resolution, slot) for slot in range(4)]


def _flux(corners: Float64Array, normals: Float64Array, triangles: Int32Array) -> float:
    """Integral of f . n over the mesh, shading normals n."""
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    mean = normals[triangles].mean(axis=1)
    return float((areas * np.einsum("ij,ij->i", mean, a + b + c)).sum())


def _is_star_shaped(triangles: Float64Array) -> bool:
    """Whether nearly every ray from the origin leaves the triangles (n, 3, 3) exactly once."""
    angles = solid_angles(triangles) / (4.0 * np.pi)
    return bool(abs(np.abs(angles).sum() - 1.0) < STAR_SHAPED and abs(abs(angles.sum()) - 1.0) < STAR_SHAPED)


def _has_border(positions: Float64Array, triangles: Int32Array) -> bool:
    """Whether an edge belongs to one triangle (n, 3) only; vertices at one place count as one."""
    size = np.ptp(positions, axis=0).max() or 1.0
    _, place = np.unique(np.rint(positions / (1e-6 * size)), axis=0, return_inverse=True)
    welded = place.reshape(-1)[triangles]
    edges = np.sort(np.concatenate([welded[:, (0, 1)], welded[:, (1, 2)], welded[:, (2, 0)]]), axis=1)
    edges = edges[edges[:, 0] != edges[:, 1]]
    _, count = np.unique(edges, axis=0, return_counts=True)
    return bool((count == 1).any())


def _directions(
    corners: Float64Array, uv: Float64Array, triangles: Int32Array, is_solid: bool, flags: int
) -> Float32Array:
    """The map of directions (6, n, n, 4) of `SampledMap`: the farthest point along each direction."""
    points = corners.astype(np.float32)
    result = np.zeros((6, DIRECTIONS, DIRECTIONS, 4), np.float32)
    result[..., 1:3] = 0.5
    result[..., 3] = flags
    if not points.any():
        return result
    # The raster's normals are but three numbers that it interpolates.
    parameters = np.column_stack([uv, np.zeros(len(uv))]).astype(np.float32)
    hits, hit_uv = CubeRaster(points, parameters, triangles, DIRECTIONS).farthest()
    hit = hits[..., 3] != 0.0
    if not hit.any():
        return result
    directions = texel_directions(DIRECTIONS)
    result[..., 1:3] = hit_uv[..., :2]
    if is_solid:
        result[..., 0] = np.linalg.norm(hits[..., :3], axis=-1)
    known = np.flatnonzero(hit)
    known = known[:: -(-len(known) // RIM)]
    flat, flat_directions = result.reshape(-1, 4), directions.reshape(-1, 3)
    holes = np.flatnonzero(~hit)
    for start in range(0, len(holes), RIM):
        some = holes[start : start + RIM]
        nearest = (flat_directions[some] @ flat_directions[known].T).argmax(axis=1)
        flat[some] = flat[known[nearest]]
    return result


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "parametric bake",
        Piece(
            inputs={"uv": "VEC2", **named("VEC3", "position", "normal", "du", "dv")},
            smooth=named("VEC3", "map_position", "map_normal", "map_du", "map_dv"),
            outputs=named("VEC4", "surface_point", "surface_normal", "surface_du", "surface_dv"),
            vertex="bake/parametric_bake.vert.glsl",
            fragment="bake/parametric_bake.frag.glsl",
        ),
    )
