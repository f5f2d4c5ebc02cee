// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the descents of `newton` start, and how they end; mirrors optics/solvers/newton.py. Needs the sampler
// `radial`.
#include "solver_pieces/solver.glsl"
#include "solver_pieces/descent.glsl"
#include "solver_pieces/pierce.glsl"
#include "solver_pieces/last_frame.glsl"
#from optics.solvers.newton import SPHERE_ROUNDS, SMALLEST_HEIGHT, STRAIGHT

// Incidence at angle x from an end that is `over` radii over a sphere, and its derivative.
vec2 incidence(float x, float over)
{
  float sine = sin(x);
  float half_sine = sin(0.5 * x);
  // k - cos x without its cancellation
  float away = over + 2.0 * half_sine * half_sine;
  return vec2(x + atan(sine, away), 1.0 + (cos(x) * away - sine * sine) / (away * away + sine * sine));
}

// Where a sphere about the star center, as large as the mirror is there, would reflect.
vec3 sphere_guess(vec4 eye, vec3 vertex)
{
  vec3 a = safe_unit(eye.xyz);
  vec3 b = safe_unit(vertex);
  vec3 across;
  float angle = arc(a, b, across);
  float radius_a = textureLod(radial, a, 0.0).x;
  float radius_b = textureLod(radial, b, 0.0).x;
  float radius = 0.5 * (radius_a + radius_b);
  bool is_near = eye.w > 0.0;
  float over_eye = max((length(eye.xyz) - radius_a) / radius, SMALLEST_HEIGHT);
  float over_vertex = max((length(vertex) - radius_b) / radius, SMALLEST_HEIGHT);
  float near_eye = is_near ? 1.0 + 1.0 / over_eye : 1.0;
  float near_vertex = 1.0 + 1.0 / over_vertex;
  float x = angle * near_vertex / (near_eye + near_vertex);
  for (int i = 0; i < SPHERE_ROUNDS; i++) {
    vec2 at_eye = is_near ? incidence(x, over_eye) : vec2(x, 1.0);
    vec2 at_vertex = incidence(angle - x, over_vertex);
    x = clamp(x - (at_eye.x - at_vertex.x) / (at_eye.y + at_vertex.y), 0.0, angle);
  }
  return cos(x) * a + sin(x) * across;
}

vec3 first_guess(vec4 eye, vec3 vertex)
{
  return solver.side < 0.0 ? on_hollow_side(eye, vertex, guess_between(eye, vertex)) : sphere_guess(eye, vertex);
}

// Whether the path by way of a point is the straight segment, which pierces the mirror there.
bool is_straight(vec4 eye, vec3 vertex, vec3 point, float longest)
{
  return length(towards_eye(eye, point) + safe_unit(vertex - point)) < longest;
}

// Of a vertex that the mirror hides (see `as_hidden`).
Solved as_hidden_at(int iterations, vec3 vertex, vec3 world_point, vec3 normal)
{
  vec3 mirrored = vertex - 2.0 * dot(normal, vertex - in_map(world_point)) * normal;
  return Solved(HIDDEN, iterations, world_point, in_world(mirrored), length_to(vertex, world_point));
}
