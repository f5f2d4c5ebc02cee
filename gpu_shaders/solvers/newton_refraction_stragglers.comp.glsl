// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The clean-up pass of `newton_refraction`: vertices of the list climb the ladder of starts. Mirrors
// optics/solvers/newton_refraction.py.
#include "solver_pieces/refraction_start.glsl"
#from optics.solvers.newton_refraction import STEPS, HORIZON_BISECTIONS
#from optics.solvers.refraction_start import STARTS, ROOTS, NORMAL_STARTS, NORMAL_ROUNDS
#from optics.solvers.refraction_start import FIRST_GUESS, ENTRY, CIRCLE, NORMAL, SEEDED, RUNG_COUNT

#define STEP_BITS 1023

// Of a vertex that no search has found: hidden where it is beyond the last line of sight that passes the surface on
// its side, or before the surface; it is placed as far past the horizon as it is past that ray.
Solved not_found(int iterations, vec3 vertex, Circle circle)
{
  float low = 0.0;
  float high = PI;
  vec3 ray;
  for (int i = 0; i < HORIZON_BISECTIONS; i++) {
    float middle = 0.5 * (low + high);
    if (refracted_at(sample_surface(on_circle(circle, middle)), ray)) {
      low = middle;
    }
    else {
      high = middle;
    }
  }
  SurfaceSample at = sample_surface(on_circle(circle, low));
  refracted_at(at, ray);
  vec3 normal = surface_normal(at);
  vec3 way = vertex - at.position;
  vec3 outward = safe_unit(normal - dot(normal, ray) * ray);
  SurfaceSample middle_at = sample_surface(circle.start);
  bool is_hidden = solver.side < 0.0 ? solver.index < 1.0 :
                                       dot(way, outward) > 0.0 ||
                                           dot(surface_normal(middle_at), vertex - middle_at.position) > 0.0;
  if (!is_hidden) {
    return as_unsolved(iterations, vertex, at.position);
  }
  vec3 sight = -towards_eye(solver.eye, at.position);
  vec3 past = safe_unit(normal - dot(normal, sight) * sight);
  float angle = max(atan(dot(way, outward), dot(way, ray)), 0.0);
  float distance_to_vertex = length(way);
  vec3 seeming = at.position + distance_to_vertex * (cos(angle) * sight + sin(angle) * past);
  return Solved(HIDDEN, iterations, in_world(at.position), in_world(seeming), distance_to_vertex);
}

// What the starts of a rung after its first one go on from.
struct Rung {
  vec3 zeros;
  vec3 point;
  float last_error;
  int last_seed;
};

int starts_of(int rung)
{
  return rung == CIRCLE ? ROOTS : rung == NORMAL ? NORMAL_STARTS : rung == SEEDED ? STARTS : 2;
}

// The seed whose ray passes the vertex closest of those that are worse than the last one, the later of equal ones.
int next_seed(vec3 vertex, inout Rung rung)
{
  float least = 2.0;
  int best = -1;
  for (int i = 0; i < SEEDS; i++) {
    float error = snell_error(vertex, sample_surface(spread_direction(i)));
    bool is_new = error > rung.last_error || (error == rung.last_error && i > rung.last_seed);
    if (is_new && error < least) {
      least = error;
      best = i;
    }
  }
  rung.last_error = least;
  rung.last_seed = best;
  return best;
}

// The start numbered k of a rung; false where there is none.
bool start_of(int number, int k, vec3 vertex, Circle circle, inout Rung rung, out vec3 u)
{
  u = safe_unit(vertex);
  if (number == FIRST_GUESS || number == CIRCLE) {
    if (k == 0) {
      rung.zeros = number == CIRCLE ? circle_zeros(circle, vertex, 0.0, PI, ROOTS) : sphere_zeros(circle, vertex, 2);
    }
    float x = rung.zeros[k];
    u = on_circle(circle, x);
    return x != NO_ZERO;
  }
  if (number == ENTRY) {
    vec3 point;
    if (k == 1) {
      return true;
    }
    bool enters = solver.side > 0.0 && pierce(solver.eye, vertex, solver.bound, point);
    u = enters ? safe_unit(point) : u;
    return enters;
  }
  if (number == NORMAL) {
    for (int i = 0; i < (k == 0 ? 1 : NORMAL_ROUNDS); i++) {
      vec3 normal = normal_asked_for(vertex, rung.point);
      u = support_direction(normal, rung.point == vec3(0.0) ? normal : safe_unit(rung.point));
      rung.point = sample_surface(u).position;
    }
    return true;
  }
  int seed = next_seed(vertex, rung);
  u = spread_direction(max(seed, 0));
  return seed >= 0;
}

Solved solve(int index, vec3 vertex)
{
  // The first pass left nothing but its steps.
  int iterations = solver.steps;
  Circle circle = circle_towards(vertex);
  Rung rung = Rung(vec3(NO_ZERO), vec3(0.0), -2.0, -1);
  for (int number = solver.first_rung; number < RUNG_COUNT; number++) {
    for (int k = 0; k < starts_of(number); k++) {
      vec3 u;
      if (start_of(number, k, vertex, circle, rung, u) && refracts_from(vertex, STEPS, u, iterations)) {
        return as_reflected_at(min(iterations, STEP_BITS), vertex, in_world(sample_surface(u).position));
      }
    }
  }
  return not_found(min(iterations, STEP_BITS), vertex, circle);
}
