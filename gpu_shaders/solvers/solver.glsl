// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every vertex solver shares: fetching the vertex, storing the result. Needs the uniform block `solver`
// (renderer/vertices/solve.py), the sampler `positions` and the images `reflection_points` and `virtual_positions`.
#include "common/status.glsl"
#include "common/invocation.glsl"
#include "common/records.glsl"
#include "common/vectors.glsl"

vec3 in_map(vec3 world_point)
{
  return (solver.world_to_map * vec4(world_point, 1.0)).xyz;
}

vec3 in_world(vec3 point)
{
  return (solver.map_to_world * vec4(point, 1.0)).xyz;
}

vec3 vertex_in_map(int index)
{
  return in_map(fetch_record(positions, index).xyz);
}

// Everything is stored in world space. reflection_points: P and status + 4 iterations.
// virtual_positions: where the vertex seems to be, and |PV|.
void store(int index, int status, int iterations, vec3 point, vec3 virtual_position, float length_to_vertex)
{
  ivec2 texel = texel_of_record(index);
  imageStore(reflection_points, texel, vec4(in_world(point), float(status + 4 * iterations)));
  imageStore(virtual_positions, texel, vec4(in_world(virtual_position), length_to_vertex));
}

void store_invalid(int index)
{
  store(index, INVALID, 0, vec3(0.0), vec3(0.0), 0.0);
}

// The vertex of this invocation, in the map frame; false where there is none to solve, which is stored then.
bool begin(out int index, out vec3 vertex)
{
  vertex = vec3(0.0);
  index = invocation();
  if (index >= solver.counts.x) {
    return false;
  }
  vertex = vertex_in_map(index);
  if (!is_finite(vertex)) {
    store_invalid(index);
    return false;
  }
  return true;
}

void store_reflected(int index, int iterations, vec3 vertex, vec3 point)
{
  float length_to_vertex = length(vertex - point);
  vec3 virtual_position = point - length_to_vertex * towards_eye(solver.eye, point);
  store(index, REFLECTED, iterations, point, virtual_position, length_to_vertex);
}

// A hidden vertex has no image. It is placed as its mirror image in the tangent plane at `point`, where the reflection of
// the triangles that cross the horizon goes on: on the horizon itself both agree.
void store_hidden(int index, int iterations, vec3 vertex, vec3 point, vec3 normal)
{
  vec3 offset = vertex - point;
  store(index, HIDDEN, iterations, point, vertex - 2.0 * dot(normal, offset) * normal, length(offset));
}

// For a search that failed.
void store_unsolved(int index, int iterations, vec3 vertex, vec3 point)
{
  store(index, UNSOLVED, iterations, point, vertex, length(vertex - point));
}
