// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every vertex solver shares. A method's file (solvers/<method>.comp.glsl) defines
//   Solved solve(int index, vec3 vertex)
// for the vertex of a record in the map frame; solver_main.glsl, which follows it, calls that and stores the result.
// Needs the uniform block `solver` (renderer/vertices/solve.py) and the sampler `positions`.
#include "common/status.glsl"
#include "common/invocation.glsl"
#include "common/vectors.glsl"

// How the search for a reflection point ended; world space.
struct Solved {
  int status;
  int iterations;
  vec3 point;
  vec3 virtual_position;  // where the vertex seems to be
  float length_to_vertex;
};

vec3 in_map(vec3 world_point)
{
  return (solver.world_to_map * vec4(world_point, 1.0)).xyz;
}

vec3 in_world(vec3 point)
{
  return (solver.map_to_world * vec4(point, 1.0)).xyz;
}

Solved as_reflected(int iterations, vec3 vertex, vec3 point)
{
  float length_to_vertex = length(vertex - point);
  vec3 virtual_position = point - length_to_vertex * towards_eye(solver.eye, point);
  return Solved(REFLECTED, iterations, in_world(point), in_world(virtual_position), length_to_vertex);
}

// A hidden vertex has no image. It is placed as its mirror image in the tangent plane at `point`, where the reflection
// of the triangles that cross the horizon goes on: on the horizon itself both agree.
Solved as_hidden(int iterations, vec3 vertex, vec3 point, vec3 normal)
{
  vec3 offset = vertex - point;
  vec3 mirrored = vertex - 2.0 * dot(normal, offset) * normal;
  return Solved(HIDDEN, iterations, in_world(point), in_world(mirrored), length(offset));
}

// For a search that failed.
Solved as_unsolved(int iterations, vec3 vertex, vec3 point)
{
  return Solved(UNSOLVED, iterations, in_world(point), in_world(vertex), length(vertex - point));
}

// For a vertex that has no finite position.
Solved as_invalid()
{
  return Solved(INVALID, 0, in_world(vec3(0.0)), in_world(vec3(0.0)), 0.0);
}
