# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs give at the pixels of a tile of the board."""

from __future__ import annotations

from functools import cache
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.scene.materials.node_links import source_of
from curvrefl.curvrefl_addon.scene.programs.builder import Builder
from curvrefl.curvrefl_addon.scene.programs.program import UV, Attribute, Program, Shape
from curvrefl.curvrefl_addon.scene.programs.registry import HANDLERS
from curvrefl.gpu_shaders.loader import Snippet

from .stage import CAMERA_DISTANCE, CORNERS, FRAME, SIDE, judged_input

INSTANCE_RECORDS = 12
"""Before those of values by name"""
PLACE, POSITION, NORMAL, INCOMING, FIRST_ATTRIBUTE = range(5)
"""Quantities of corners; INCOMING has the distance of the camera too"""
LIBRARY = """
#include "programs/shading_point.glsl"
#include "programs/instances.glsl"
#include "programs/material.glsl"
"""
MAIN = """
vec4 corner(int quantity, int triangle, int k)
{
  return fetch_record(corners, 6 * quantity + 3 * triangle + k);
}

// Of the corners of a triangle, at a place of the tile (which may lie outside).
vec3 corner_weights(int triangle, vec2 place)
{
  vec2 a = corner(PLACE, triangle, 0).xy;
  vec2 b = corner(PLACE, triangle, 1).xy - a;
  vec2 c = corner(PLACE, triangle, 2).xy - a;
  place -= a;
  vec2 uv = vec2(place.x * c.y - place.y * c.x, b.x * place.y - b.y * place.x) / (b.x * c.y - b.y * c.x);
  return vec3(1.0 - uv.x - uv.y, uv);
}

vec4 at_weights(int quantity, int triangle, vec3 w)
{
  return w.x * corner(quantity, triangle, 0) + w.y * corner(quantity, triangle, 1) +
         w.z * corner(quantity, triangle, 2);
}

void main()
{
  float step = 2.0 / SIDE;
  vec2 place = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xy;
  vec3 w = corner_weights(0, place);
  int triangle = min(w.x, min(w.y, w.z)) < 0.0 ? 1 : 0;
  w = corner_weights(triangle, place);
  vec3 across = corner_weights(triangle, place + vec2(step, 0.0)) - w;
  vec3 up = corner_weights(triangle, place + vec2(0.0, step)) - w;
  ShadingPoint s;
  s.position = at_weights(POSITION, triangle, w).xyz;
  s.normal = normalize(at_weights(NORMAL, triangle, w).xyz);
  s.true_normal = at_weights(INCOMING, triangle, w).xyz;
  s.incoming = s.true_normal;
  s.is_back = false;
  s.instance = 0;
  s.parametric = w.yz;
  s.ray = RAY_IS_CAMERA;
  s.ray_length = at_weights(INCOMING, triangle, w).w;
  s.depths = vec3(0.0);
  s.more_depths = vec2(0.0);
  s.random = 0.5;
  s.records = FIRST_RECORD;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, w);
  }
#ifdef PROGRAM_BUMP
  s.position_across = at_weights(POSITION, triangle, across).xyz;
  s.position_up = at_weights(POSITION, triangle, up).xyz;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes_across[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, across);
    s.attributes_up[k] = at_weights(FIRST_ATTRIBUTE + k, triangle, up);
  }
#endif
  Material m;
  m.emission = vec3(0.0);
  material_program(s, m);
  color = vec4(m.emission, 1.0);
}
"""


class NoImages:
    """Stands for the images of a scene that has none."""

    def index_of(self, node: Any, note: Any, splits_alpha: bool) -> int | None:
        return None


def compiled(material: bpy.types.Material) -> tuple[Program, list[str]]:
    """The program of what a tile's material sends out, and the notes of what is left out."""
    notes: list[str] = []
    builder = Builder(HANDLERS, NoImages(), notes)
    value = builder.value(source_of(judged_input(material)), "color")
    return builder.finished({"emission": value}), notes


def evaluated(program: Program, tile: bpy.types.Object, places: np.ndarray) -> np.ndarray:
    """(SIDE, SIDE, 3) of what a program gives on a tile at places (SIDE, SIDE, 2) of it, rows from below."""
    where = np.concatenate([places, np.zeros_like(places)], axis=2)
    head = [(float(k), 0.0, 0.0, 0.0) for k in reversed(range(len(program.instance_attributes)))]
    head += [(float(k), 0.0, 0.0, 0.0) for k in reversed(range(len(program.attributes)))]
    records = np.array([*head, *program.records.tolist()], np.float32).reshape(-1, 4)
    textures = {
        "program_records": record_texture(records),
        "places": texture_2d(where),
        "corners": record_texture(_corner_records(program, tile)),
        "instance_table": record_texture(_instance_records(program, tile)),
    }
    shader = _shader(program.shape, len(program.instance_attributes))
    target = empty_texture(SIDE, SIDE)
    with drawing_state(), frame_buffer(target).bind():
        set_viewport(0, 0, SIDE, SIDE)
        shader.bind()
        for name, texture in textures.items():
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    return read_texture(target)[..., :3]


@cache
def _shader(shape: Shape, instance_values: int) -> Any:
    includes = LIBRARY + "".join(f'#include "{file}"\n' for file in shape.files)
    return build_shader(
        "program of a test",
        FULL_SCREEN,
        Piece(
            samplers=named("FLOAT_2D", "program_records", "places", "corners", "instance_table"),
            outputs={"color": "VEC4"},
            defines={
                "ATTRIBUTES": shape.attributes,
                "INSTANCE_VALUES": INSTANCE_RECORDS + instance_values,
                "FIRST_RECORD": shape.attributes + instance_values,
                "SIDE": f"{SIDE}.0",
                "PLACE": PLACE,
                "POSITION": POSITION,
                "NORMAL": NORMAL,
                "INCOMING": INCOMING,
                "FIRST_ATTRIBUTE": FIRST_ATTRIBUTE,
                **flags(*sorted(shape.needs | {"PROGRAM_INSTANCE"})),
            },
            fragment=Snippet("program of a test", includes + shape.text + MAIN),
        ),
    )


def _corner_records(program: Program, tile: bpy.types.Object) -> np.ndarray:
    """(6 * quantities, 4): of the corners of both triangles."""
    mesh = tile.data
    mesh.calc_loop_triangles()
    loops = np.array([triangle.loops[:] for triangle in mesh.loop_triangles]).ravel()
    vertices = np.array([loop.vertex_index for loop in mesh.loops])
    matrix = tile.matrix_world
    to_normals = matrix.to_3x3().inverted().transposed()
    quantities = [
        np.array(CORNERS),
        np.array([matrix @ vertex.co for vertex in mesh.vertices]),
        np.array([(to_normals @ normal.vector).normalized() for normal in mesh.corner_normals]),
        np.tile((*FRAME.col[2], CAMERA_DISTANCE), (4, 1)),
        *(_of_corners(mesh, attribute, to_normals) for attribute in program.attributes),
    ]
    # (The corners of its one face are its vertices, in order.)
    assert vertices.tolist() == [0, 1, 2, 3]
    records = np.zeros((len(quantities), 6, 4), np.float32)
    for row, values in zip(records, quantities, strict=True):
        row[:, : values.shape[1]] = values[loops]
    return records.reshape(-1, 4)


def _of_corners(mesh: bpy.types.Mesh, attribute: Attribute, to_normals: Any) -> np.ndarray:
    """(4, 4)"""
    result = np.zeros((4, 4))
    result[:, 3] = 1.0
    if attribute.kind == UV or (attribute.kind == "GEOMETRY" and attribute.name in mesh.uv_layers):
        layer = mesh.uv_layers[attribute.name or 0]
        result[:, :2] = [corner.uv for corner in layer.data]
    elif attribute.kind == "TANGENT":
        mesh.calc_tangents(uvmap=attribute.name or mesh.uv_layers[0].name)
        result[:] = [(*loop.tangent, loop.bitangent_sign) for loop in mesh.loops]
    elif attribute.name in mesh.attributes or (not attribute.name and mesh.color_attributes):
        found = mesh.attributes[attribute.name or mesh.color_attributes[0].name]
        for row, value in zip(result, [*found.data] * (4 // len(found.data)), strict=True):
            parts = getattr(value, "color", None) or getattr(value, "vector", None) or (value.value,) * 3
            row[: len(parts)] = parts
    else:
        result[:] = 0.0
    return result


def _instance_records(program: Program, tile: bpy.types.Object) -> np.ndarray:
    """The tile's row of instance_table (`gpu_shaders/programs/instances.glsl`)."""
    matrix = np.array(tile.matrix_world)
    size = np.array(tile.data.texspace_size)
    scale = 0.5 / np.where(size == 0.0, 0.5, size)
    offset = 0.5 - np.array(tile.data.texspace_location) * scale
    values = []
    for name in program.instance_attributes:
        value = tile.get(name, 0.0)
        row = [value] * 3 if isinstance(value, int | float) else [*value, 0.0, 0.0]
        values.append((*row[:3], 1.0))
    return np.array(
        [
            *matrix[:3],
            *np.linalg.inv(matrix)[:3],
            tuple(tile.color),
            (cycles_random(tile.name), tile.pass_index, 0.0, 0.0),
            (*scale, 0.0),
            (*offset, 0.0),
            (0.0,) * 4,
            (0.0,) * 4,
            *values,
        ],
        np.float32,
    )


def cycles_random(name: str) -> float:
    """Object Info's random number of an object that is no instance."""
    number = 0
    for letter in name.encode():
        number = (number * 37 + letter) & 0xFFFFFFFF
    return _hash(number, 0) / 0xFFFFFFFF


def _hash(x: int, y: int) -> int:
    """hash_uint2 of Cycles."""
    start = 0xDEADBEEF + (2 << 2) + 13
    values = [(start + x) & 0xFFFFFFFF, (start + y) & 0xFFFFFFFF, start & 0xFFFFFFFF]
    for step, bits in enumerate((14, 11, 25, 16, 4, 14, 24)):
        changed, by = (2 + step) % 3, values[(1 + step) % 3]
        turned = (by << bits) | (by >> (32 - bits))
        values[changed] = ((values[changed] ^ by) - turned) & 0xFFFFFFFF
    return values[2]
