// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Searches that start from the last frame's points, and vertices that stay where they were to the last bit.
#include "solver_pieces/solver.glsl"
#include "solver_pieces/descent.glsl"

// Tolerances that a Newton step from a point at rest may be long; between texels that meet with a kink it is not
// zero
#define MOST_AT_REST 2.0

float length_to(vec3 vertex, vec3 world_point)
{
  return length(vertex - in_map(world_point));
}

// `world_point` has been rounded as it is stored: a point that stays where it is keeps the bits of all that is stored.
Solved as_reflected_at(int iterations, vec3 vertex, vec3 world_point)
{
  vec3 point = in_map(world_point);
  float length_to_vertex = length_to(vertex, world_point);
  vec3 virtual_position = point - length_to_vertex * towards_eye(solver.eye, point);
  return Solved(REFLECTED, iterations, world_point, in_world(virtual_position), length_to_vertex);
}

// The last frame's reflection point, in world space and as a direction, or on a convex mirror where the way to a
// hidden vertex entered it; whether there is one.
bool last_point(vec4 before, bool convex, out vec3 world_point, out vec3 u)
{
  world_point = before.xyz;
  u = safe_unit(in_map(world_point));
  int status = int(before.w + 0.5) % 4;
  return (status == REFLECTED || (convex && status == HIDDEN)) && u != vec3(0.0);
}

// Whether the last frame's point is kept as it was stored, to the last bit: the search has not left its direction, and
// view and mirror are as they were. (Of a mirror that has moved it is no point any more.)
bool keeps_point(bool warm, vec3 start, vec3 u)
{
  return warm && solver.is_same_view != 0 && u == start;
}

// Whether a point still reflects the vertex, as far as a Newton step tells. The length alone may agree by chance where
// a vertex has moved about its reflection point.
bool still_reflects(vec4 eye, vec3 vertex, vec3 u)
{
  SurfaceSample at = sample_surface(u);
  vec3 first, second;
  tangent_frame(u, first, second);
  vec3 derivative = second_derivative(eye, vertex, u, at, first, second);
  vec3 step = newton_step(derivative, path_gradient(eye, vertex, u, at), first, second);
  return length(in_pixels(eye, solver.focal_pixels, at.position, at.radius * step)) < MOST_AT_REST * solver.tolerance;
}

// Whether there is a point of the last frame to start from (`before`, `convex`: see last_point; `seemed`: where the
// vertex was shown). `stays`: the vertex goes on to show `shown`.
bool starts_warm(vec4 before, vec4 seemed, vec3 vertex, bool convex, out vec3 world_point, out vec3 u, out bool stays,
                 out Solved shown)
{
  stays = false;
  bool warm = last_point(before, convex, world_point, u);
  // To the last bit: what a vertex that has not moved showed in the same view stays as it is.
  if (warm && solver.is_same_view != 0 && seemed.w == length_to(vertex, world_point) &&
      still_reflects(solver.eye, vertex, u)) {
    int code = int(before.w + 0.5);
    stays = true;
    shown = Solved(code % 4, code / 4, before.xyz, seemed.xyz, seemed.w);
  }
  return warm;
}
