// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// How a search on the radial map ends. Needs the sampler `radial`.
#include "solvers/solver.glsl"
#include "solvers/descent.glsl"
#include "solvers/pierce.glsl"

// After a search that ended at u: reflected, else hidden, else one more descent from between eye and vertex.
void finish(int index, vec3 vertex, vec3 u, bool converged, int iterations)
{
  vec4 eye = solver.eye;
  float side = solver.screen.w;
  SurfaceSample at = sample_surface(u);
  if (converged && is_reflection_side(eye, vertex, at, side)) {
    store_reflected(index, iterations, vertex, at.position);
    return;
  }
  vec3 point;
  // A hollow mirror is open: nothing is said of what the way from the eye pierces.
  if (side > 0.0 && pierce(eye, vertex, solver.screen.z, point)) {
    store_hidden(index, iterations, vertex, point, surface_normal(sample_surface(safe_unit(point))));
    return;
  }
  if (!converged) {
    u = guess_between(eye, vertex);
    if (side < 0.0) {
      u = on_hollow_side(eye, vertex, u);
    }
    converged = minimise(eye, solver.screen.x, vertex, solver.counts.z, solver.screen.y, side < 0.0, u, iterations);
    at = sample_surface(u);
    if (converged && is_reflection_side(eye, vertex, at, side)) {
      store_reflected(index, iterations, vertex, at.position);
      return;
    }
  }
  if (converged) {
    store_hidden(index, iterations, vertex, at.position, side * surface_normal(at));
  }
  else {
    store_unsolved(index, iterations, vertex, at.position);
  }
}
