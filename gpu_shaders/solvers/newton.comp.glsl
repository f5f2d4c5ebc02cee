// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The first pass of `newton`: a few steps per vertex; what they do not settle is put on a list. Mirrors optics/solvers/newton.py.
#include "solvers/newton_start.glsl"

// solver.counts.w is 0 without a last frame, 1 with one, 2 where it had the same view; solver.start.w is 1 on a closed
// convex mirror
#define SAME_VIEW 2
// Tolerances that a Newton step from a point at rest may be long; between texels that meet with a kink it is not zero
#define MOST_AT_REST 2.0

// The last frame's reflection point, in world space and as a direction, or on a convex mirror where the way to a hidden
// vertex entered it; whether there is one.
bool last_point(vec4 before, bool convex, out vec3 world_point, out vec3 u)
{
  world_point = before.xyz;
  u = safe_unit(in_map(world_point));
  int status = int(before.w + 0.5) % 4;
  return (status == REFLECTED || (convex && status == HIDDEN)) && u != vec3(0.0);
}

// Whether a point still reflects the vertex, as far as a Newton step tells. The length alone may agree by chance where a
// vertex has moved about its reflection point.
bool still_reflects(vec4 eye, vec3 vertex, vec3 u)
{
  SurfaceSample at = sample_surface(u);
  vec3 first, second;
  tangent_frame(u, first, second);
  vec3 derivative = second_derivative(eye, vertex, u, at, first, second);
  vec3 step = newton_step(derivative, path_gradient(eye, vertex, u, at), first, second);
  return length(in_pixels(eye, solver.screen.x, at.position, at.radius * step)) < MOST_AT_REST * solver.screen.y;
}

void main()
{
  int index;
  vec3 vertex;
  if (!begin(index, vertex)) {
    return;
  }
  vec4 eye = solver.eye;
  float side = solver.screen.w;
  bool convex = solver.start.w > 0.5;
  int iterations = 0;
  vec3 world_point = vec3(0.0);
  vec3 u;
  bool warm = false;
  if (solver.counts.w > 0) {
    vec4 before = fetch_record(previous_points, index);
    warm = last_point(before, convex, world_point, u);
    vec4 seemed = fetch_record(previous_virtual, index);
    // To the last bit: what a vertex that has not moved showed in the same view stays as it is.
    if (warm && solver.counts.w == SAME_VIEW && seemed.w == length_to(vertex, world_point) &&
        still_reflects(eye, vertex, u)) {
      imageStore(reflection_points, texel_of_record(index), before);
      imageStore(virtual_positions, texel_of_record(index), seemed);
      return;
    }
  }
  if (!warm) {
    u = first_guess(eye, vertex);
  }
  vec3 start = u;
  bool converged = minimise(eye, solver.screen.x, vertex, solver.counts.y, solver.screen.y, side < 0.0, u, iterations);
  SurfaceSample at = sample_surface(u);
  if (!warm || u != start) {
    world_point = in_world(at.position);
  }
  if (converged && is_reflection_side(eye, vertex, at, side)) {
    store_reflected_at(index, iterations, vertex, world_point);
  }
  else if (converged && side > 0.0 && is_straight(eye, vertex, at.position, STRAIGHT)) {
    vec3 normal = surface_normal(at);
    vec3 point = at.position;
    // The way into a convex mirror leads over one front and one back; elsewhere another front may come before.
    bool is_entry = convex && dot(normal, towards_eye(eye, point)) > 0.0;
    if (!is_entry && pierce(eye, vertex, solver.screen.z, point)) {
      world_point = in_world(point);
      normal = surface_normal(sample_surface(safe_unit(point)));
    }
    store_hidden_at(index, iterations, vertex, world_point, normal);
  }
  else {
    store_unsolved(index, iterations, vertex, at.position);
    uint place = imageAtomicAdd(straggler_count, ivec2(0), 1u);
    imageStore(stragglers, texel_of_record(int(place)), uvec4(uint(index)));
  }
}
