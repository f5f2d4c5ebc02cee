// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How a search on the radial map ends. Needs the sampler `radial`.
#include "solver_pieces/solver.glsl"
#include "solver_pieces/descent.glsl"
#include "solver_pieces/pierce.glsl"

// After a search that ended at u: reflected, else hidden, else one more descent from between eye and vertex.
Solved finish(vec3 vertex, vec3 u, bool converged, int iterations)
{
  vec4 eye = solver.eye;
  float side = solver.side;
  SurfaceSample at = sample_surface(u);
  if (converged && is_reflection_side(eye, vertex, at, side)) {
    return as_reflected(iterations, vertex, at.position);
  }
  vec3 point;
  // A hollow mirror is open: nothing is said of what the way from the eye pierces.
  if (side > 0.0 && pierce(eye, vertex, solver.bound, point)) {
    return as_hidden(iterations, vertex, point, surface_normal(sample_surface(safe_unit(point))));
  }
  if (!converged) {
    u = guess_between(eye, vertex);
    if (side < 0.0) {
      u = on_hollow_side(eye, vertex, u);
    }
    converged = minimize(
        eye, solver.focal_pixels, vertex, solver.newton_steps, solver.tolerance, side < 0.0, u, iterations);
    at = sample_surface(u);
    if (converged && is_reflection_side(eye, vertex, at, side)) {
      return as_reflected(iterations, vertex, at.position);
    }
  }
  return converged ? as_hidden(iterations, vertex, at.position, side * surface_normal(at)) :
                     as_unsolved(iterations, vertex, at.position);
}
