# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs set channels of materials to, computed on the GPU at places of one's choice."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.geometry.chunk_attributes import LACKING_BY_NAME, places_of
from curvrefl.curvrefl_addon.renderer.programs.image_pages import ImagePages
from curvrefl.curvrefl_addon.renderer.programs.instance_table import InstanceTable
from curvrefl.curvrefl_addon.scene.arrays import (
    Float32Array,
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.programs.program import IMAGE_RECORDS
from curvrefl.gpu_shaders.loader import Snippet

LIBRARY = """
#include "programs/shading_point.glsl"
#include "programs/instances.glsl"
#include "programs/material.glsl"
"""
MAIN = """
void main()
{
  int n = int(gl_FragCoord.x);
  vec4 place = texelFetch(places, ivec2(n, 0), 0);
  float cosine = texelFetch(places, ivec2(n, 1), 0).x;
  ShadingPoint s;
  s.position = place.xyz;
  s.normal = s.true_normal = vec3(0.0, 0.0, 1.0);
  s.incoming = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
  s.is_back = false;
  s.instance = INSTANCE;
  s.parametric = vec2(0.25);
  s.ray = RAY_IS_CAMERA;
  s.ray_length = 1.0;
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.origin = vec3(0.0);
  s.random = place.w;
  s.records = FIRST_RECORD;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] = texelFetch(places, ivec2(n, 2 + k), 0);
  }
#ifdef PROGRAM_BUMP
  // Of this place and those that come one and two after it.
  s.position_across = texelFetch(places, ivec2(n + 1, 0), 0).xyz - s.position;
  s.position_up = texelFetch(places, ivec2(n + 2, 0), 0).xyz - s.position;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes_across[k] = texelFetch(places, ivec2(n + 1, 2 + k), 0) - s.attributes[k];
    s.attributes_up[k] = texelFetch(places, ivec2(n + 2, 2 + k), 0) - s.attributes[k];
  }
#endif
  Material m;
  material_program(s, m);
  color = vec4(vec3(m.CHANNEL), 1.0);
}
"""


@dataclass(frozen=True)
class _Points:
    """n points of an instance."""

    positions: Float32Array
    """(n, 3) world space"""
    attributes: Float32Array
    """(n, attributes, 4)"""
    random: Any
    cosine: Any


def channel(material: MaterialArrays, name: str, u: Any, v: Any, random: Any = 0.5, cosine: Any = 1.0) -> Float32Array:
    """(n, 3) at n places of a plane whose coordinates of all kinds are (u, v); a number is three times the same.

    `random`: which sample it is. `cosine`: of the angle at which the plane is seen.
    """
    u, v, random, cosine = np.broadcast_arrays(*np.atleast_1d(u, v, random, cosine))
    places = np.column_stack([u, v, np.zeros_like(u)]).astype(np.float32)
    attributes = np.zeros((len(u), 0 if material.program is None else len(material.program.attributes), 4), np.float32)
    attributes[..., :2] = places[:, None, :2]
    attributes[..., 3] = 1.0
    instance = InstanceArrays("plane", 1, 0, np.eye(4), (0,), generated=((1.0,) * 3, (0.0,) * 3))
    scene = SceneArrays((), (instance,), (material,), (), (), WorldArrays())
    return _evaluated(scene, 0, material, name, _Points(places, attributes, random, cosine))


def channel_on(scene: SceneArrays, name: str, of: str, places: Any, random: Any = 0.5) -> Float32Array:
    """(n, 3) the channel `of` of the one instance of the object called `name`, a flat one, at (n, 2) places of its own
    plane, XY or XZ; it is seen from straight ahead."""
    (index,) = (k for k, instance in enumerate(scene.instances) if instance.object_name == name)
    instance = scene.instances[index]
    mesh, material = scene.meshes[instance.mesh], scene.materials[instance.materials[0]]
    places = np.asarray(places, np.float64)
    axes = np.sort(np.argsort(np.ptp(mesh.positions, axis=0))[1:])
    rows, weights = _corners(mesh, places, axes)
    local = np.tile((0.0, 0.0, 0.0, 1.0), (len(places), 1))
    local[:, axes] = places
    attributes = np.zeros((len(places), 0 if material.program is None else len(material.program.attributes), 4))
    if material.program is not None:
        for number, place in enumerate(places_of(material.program.attributes, mesh.attributes)):
            if place >= 0:
                attributes[:, number] = np.einsum("nk,nkc->nc", weights, mesh.corner_attributes[rows, place])
            elif place == LACKING_BY_NAME:
                attributes[:, number, 3] = 1.0
    positions = (local @ instance.matrix.T)[:, :3].astype(np.float32)
    points = _Points(positions, attributes.astype(np.float32), random, 1.0)
    return _evaluated(scene, index, material, of, points)


def _corners(mesh: MeshArrays, places: Any, axes: Any) -> tuple[Any, Any]:
    """(n, 3) corners of the triangles that places are in, and their weights."""
    rows, weights = np.zeros((len(places), 3), int), np.full((len(places), 3), -np.inf)
    for triangle in mesh.triangles:
        a, b, c = (mesh.positions[mesh.corner_vertex[corner]][axes].astype(np.float64) for corner in triangle)
        to_weights = np.linalg.inv(np.column_stack([b - a, c - a]))
        uv = (places - a) @ to_weights.T
        found = np.column_stack([1.0 - uv.sum(axis=1), uv])
        is_inside = found.min(axis=1) > weights.min(axis=1)
        rows[is_inside], weights[is_inside] = triangle, found[is_inside]
    return rows, weights


def _evaluated(scene: SceneArrays, index: int, material: MaterialArrays, name: str, points: _Points) -> Float32Array:
    count = len(points.positions)
    if material.program is None or name not in material.program.shape.channels:
        return np.broadcast_to(np.array(getattr(material, name), np.float32), (count, 3))
    program, shape = material.program, material.program.shape
    pages, instances = ImagePages(), InstanceTable()
    pages.follow(scene.images)
    pages.fill()
    instances.follow(scene)
    records = np.array(program.records, np.float32)
    for use in program.images:
        records[use.record : use.record + IMAGE_RECORDS] = pages.records(use.image)
    numbers = [*range(len(program.attributes)), *map(instances.names.index, program.instance_attributes)][::-1]
    head = np.array([(number, 0.0, 0.0, 0.0) for number in numbers], np.float32).reshape(-1, 4)
    places = np.zeros((2 + len(program.attributes), count, 4), np.float32)
    places[0, :, :3], places[0, :, 3] = points.positions, points.random
    places[1] = np.broadcast_to(points.cosine, count)[:, None]
    places[2:] = points.attributes.transpose(1, 0, 2)
    includes = LIBRARY + "".join(f'#include "{file}"\n' for file in shape.files)
    shader = build_shader(
        "program of a test",
        FULL_SCREEN,
        pages.piece,
        instances.piece,
        Piece(
            samplers=named("FLOAT_2D", "program_records", "places"),
            outputs={"color": "VEC4"},
            defines={
                "ATTRIBUTES": shape.attributes,
                "INSTANCE": index,
                "FIRST_RECORD": len(numbers),
                "CHANNEL": name,
                **flags(*sorted(shape.needs - {"PROGRAM_INSTANCE"})),
            },
            fragment=Snippet("program of a test", includes + shape.text + MAIN),
        ),
    )
    target, parameters = empty_texture(count, 1), record_texture(np.concatenate([head, records]))
    sampled = texture_2d(places, "RGBA32F", False, "EXTEND")
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, count, 1)
        shader.bind()
        pages.bind(shader)
        instances.bind(shader)
        shader.uniform_sampler("program_records", parameters)
        shader.uniform_sampler("places", sampled)
        full_screen_triangle().draw(shader)
    return read_texture(target)[0, :, :3]
