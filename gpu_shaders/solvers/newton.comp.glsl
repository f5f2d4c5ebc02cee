// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The first pass of `newton`: a few steps per vertex; what they do not settle is left to the second pass
// (newton_stragglers). Mirrors optics/solvers/newton.py.
#include "solver_pieces/newton_start.glsl"

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  float side = solver.side;
  bool convex = solver.is_convex != 0;
  int iterations = 0;
  vec3 world_point = vec3(0.0);
  vec3 u;
  bool warm = false;
  if (solver.has_last_frame != 0) {
    bool stays;
    Solved shown;
    vec4 before = fetch_record(previous_points, index), seemed = fetch_record(previous_virtual, index);
    warm = starts_warm(before, seemed, vertex, convex, world_point, u, stays, shown);
    if (stays) {
      return shown;
    }
  }
  if (!warm) {
    u = first_guess(eye, vertex);
  }
  vec3 start = u;
  bool converged = minimize(
      eye, solver.focal_pixels, vertex, solver.steps, solver.tolerance, side < 0.0, u, iterations);
  SurfaceSample at = sample_surface(u);
  if (!keeps_point(warm, start, u)) {
    world_point = in_world(at.position);
  }
  if (converged && is_reflection_side(eye, vertex, at, side)) {
    return as_reflected_at(iterations, vertex, world_point);
  }
  if (converged && side > 0.0 && is_straight(eye, vertex, at.position, STRAIGHT)) {
    vec3 normal = surface_normal(at);
    vec3 point = at.position;
    // The way into a convex mirror leads over one front and one back; elsewhere another front may come before.
    bool is_entry = convex && dot(normal, towards_eye(eye, point)) > 0.0;
    if (!is_entry && pierce(eye, vertex, solver.bound, point)) {
      world_point = in_world(point);
      normal = surface_normal(sample_surface(safe_unit(point)));
    }
    return as_hidden_at(iterations, vertex, world_point, normal);
  }
  return as_unsolved(iterations, vertex, at.position);
}
