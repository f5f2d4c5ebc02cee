// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One more image of each vertex, in one region of a mirror that bends both ways; mirrors
// optics/solvers/newton_region.py.
#include "solver_pieces/newton_start.glsl"
#from optics.solvers.newton_region import STARTS, MARCH_STEPS as MARCH_STEPS_FROM_POINT, INSIDE
#from optics.surfaces.curvature_regions import SEEDS

bool is_way_free(vec3 point, vec3 way)
{
  vec3 through = min(length(way), 2.0 * solver.bound) * safe_unit(way);
  for (int i = 1; i <= MARCH_STEPS_FROM_POINT; i++) {
    float share = float(i) / float(MARCH_STEPS_FROM_POINT);
    vec3 here = point + share * share * through;
    float from_center = length(here);
    vec3 u = from_center > 0.0 ? here / from_center : vec3(0.0, 0.0, 1.0);
    if (from_center < (1.0 - INSIDE) * textureLod(radial, u, 0.0).x) {
      return false;
    }
  }
  return true;
}

bool is_in_region(int region, vec3 u)
{
  return ((int(textureLod(region_masks, u, 0.0).x + 0.5) >> region) & 1) == 1;
}

float error_at(vec4 eye, vec3 vertex, vec3 u)
{
  SurfaceSample at = sample_surface(u);
  return -dot(safe_unit(towards_eye(eye, at.position) + safe_unit(vertex - at.position)), surface_normal(at));
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  int region = solver.region;
  vec3 start[STARTS];
  float error[STARTS];
  for (int k = 0; k < STARTS; k++) {
    start[k] = vec3(0.0, 0.0, 1.0);
    error[k] = 2.0;
  }
  for (int i = 0; i < SEEDS; i++) {
    vec3 u = fetch_record(region_seeds, region * SEEDS + i).xyz;
    float here = error_at(eye, vertex, u);
    if (here < error[0]) {
      start[1] = start[0];
      error[1] = error[0];
      start[0] = u;
      error[0] = here;
    }
    else if (here < error[1]) {
      start[1] = u;
      error[1] = here;
    }
  }
  int iterations = 0;
  vec3 u = start[0];
  for (int k = 0; k < STARTS; k++) {
    u = start[k];
    if (!minimize(eye, solver.focal_pixels, vertex, solver.steps, solver.tolerance, true, u, iterations) ||
        !is_in_region(region, u)) {
      continue;
    }
    SurfaceSample at = sample_surface(u);
    if (is_reflection_side(eye, vertex, at, 1.0) && is_way_free(at.position, vertex - at.position) &&
        is_way_free(at.position, eye.xyz - eye.w * at.position)) {
      return as_reflected_at(iterations, vertex, in_world(at.position));
    }
  }
  return as_unsolved(iterations, vertex, sample_surface(u).position);
}
