// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The first pass of `newton_refraction`: a few steps per vertex; what they do not settle is left to the second pass
// (newton_refraction_stragglers). Mirrors optics/solvers/newton_refraction.py.
#include "solver_pieces/refraction_start.glsl"

Solved solve(int index, vec3 vertex)
{
  int iterations = 0;
  vec3 world_point = vec3(0.0);
  vec3 u;
  bool warm = false;
  if (solver.has_last_frame != 0) {
    bool stays;
    Solved shown;
    vec4 before = fetch_record(previous_points, index), seemed = fetch_record(previous_virtual, index);
    warm = starts_warm(before, seemed, vertex, false, world_point, u, stays, shown);
    if (stays) {
      return shown;
    }
  }
  if (!warm) {
    Circle circle = circle_towards(vertex);
    float x = sphere_zeros(circle, vertex, 1).x;
    u = x == NO_ZERO ? solver.side * circle.start : on_circle(circle, x);
  }
  vec3 start = u;
  if (refracts_from(vertex, solver.steps, u, iterations)) {
    if (!keeps_point(warm, start, u)) {
      world_point = in_world(sample_surface(u).position);
    }
    return as_reflected_at(iterations, vertex, world_point);
  }
  return as_unsolved(iterations, vertex, sample_surface(u).position);
}
