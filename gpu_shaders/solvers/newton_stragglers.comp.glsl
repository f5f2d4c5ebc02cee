// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The clean-up pass of `newton`: vertices of the list climb the ladder of starts. Mirrors optics/solvers/newton.py.
#include "solver_pieces/newton_start.glsl"
#from optics.solvers.newton import ENTRIES, ON_HORIZON, BISECTIONS as BISECTIONS_OF_ARC, RUNG_COUNT, ANY_KIND

#define STEP_BITS 1023

// Where the path length stops falling on the great circle from eye to vertex.
vec3 arc_minimum(vec4 eye, vec3 vertex)
{
  vec3 a = safe_unit(eye.xyz);
  vec3 across;
  float low = 0.0;
  float high = arc(a, safe_unit(vertex), across);
  for (int i = 0; i < BISECTIONS_OF_ARC; i++) {
    float middle = 0.5 * (low + high);
    vec3 u = cos(middle) * a + sin(middle) * across;
    vec3 along = cos(middle) * across - sin(middle) * a;
    if (dot(path_gradient(eye, vertex, u, sample_surface(u)), along) < 0.0) {
      low = middle;
    }
    else {
      high = middle;
    }
  }
  float end = 0.5 * (low + high);
  return cos(end) * a + sin(end) * across;
}

vec3 start_of_rung(int rung, vec4 eye, vec3 vertex)
{
  if (rung == 0) {
    return first_guess(eye, vertex);
  }
  vec3 u = rung == 2 ? guess_between(eye, vertex) :
           rung == 3 ? safe_unit(vertex) :
           rung == 4 ? safe_unit(eye.xyz) :
                       arc_minimum(eye, vertex);
  return solver.side < 0.0 ? on_hollow_side(eye, vertex, u) : u;
}

// As `minimize` with the full number of steps, and on from where the way to a point seen from behind enters the
// mirror: the path by way of that entry is shorter.
bool descend(vec4 eye, vec3 vertex, bool any_kind, inout vec3 u, inout int iterations)
{
  float side = solver.side;
  for (int entry = 0; entry <= ENTRIES; entry++) {
    if (!minimize(
            eye, solver.focal_pixels, vertex, solver.newton_steps, solver.tolerance, any_kind, u, iterations)) {
      return false;
    }
    SurfaceSample at = sample_surface(u);
    vec3 point;
    if (side < 0.0 || is_reflection_side(eye, vertex, at, side) || is_straight(eye, vertex, at.position, STRAIGHT) ||
        entry == ENTRIES || !pierce(eye, at.position, solver.bound, point)) {
      return true;
    }
    u = safe_unit(point);
  }
  return true;
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  float side = solver.side;
  // The first pass left nothing but its steps.
  int iterations = solver.steps;
  vec3 point;
  if (side > 0.0 && pierce(eye, vertex, solver.bound, point)) {
    return as_hidden_at(iterations, vertex, in_world(point), surface_normal(sample_surface(safe_unit(point))));
  }
  bool ended = false;
  vec3 u = first_guess(eye, vertex);
  vec3 end = u;
  for (int rung = solver.first_rung; rung < RUNG_COUNT; rung++) {
    // On where the first rung has ended, to a zero of the gradient of any kind: where the map's texels meet with a
    // kink, above all at corners of the cube, the curvature there may be negative.
    if (rung != ANY_KIND) {
      u = start_of_rung(rung, eye, vertex);
    }
    bool converged = descend(eye, vertex, side < 0.0 || rung == ANY_KIND, u, iterations);
    SurfaceSample at = sample_surface(u);
    if (converged && is_reflection_side(eye, vertex, at, side)) {
      return as_reflected_at(min(iterations, STEP_BITS), vertex, in_world(at.position));
    }
    // Where a descent fails on the horizon reflected and hidden are one, and the map's texels hold neither.
    if (side > 0.0 && is_straight(eye, vertex, at.position, converged ? STRAIGHT : ON_HORIZON)) {
      return as_hidden_at(iterations, vertex, in_world(at.position), surface_normal(at));
    }
    // On a hollow mirror nothing proves that a vertex is hidden: other rungs may still find its reflection.
    if (converged && side < 0.0) {
      ended = true;
      end = u;
    }
  }
  SurfaceSample at = sample_surface(ended ? end : u);
  return ended ? as_hidden_at(iterations, vertex, in_world(at.position), side * surface_normal(at)) :
                 as_unsolved(iterations, vertex, at.position);
}
