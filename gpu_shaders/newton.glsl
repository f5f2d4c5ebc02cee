// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Safeguarded Newton descent on the path length; mirrors optics/newton.py step for step.
#include "fermat.glsl"
#include "guess.glsl"

#define DIFFERENCE 1e-3
#define SMALLEST_DIFFERENCE 1e-5
#define FLATTEST 1e-5
#define LONGEST_NEWTON_STEP 0.5
#define LONGEST_LAST_STEP 0.005
#define TRIALS 6
#define SHORTENING 0.35
#define SUFFICIENT 1e-4
#define ROUNDING 2e-7
#define CONTRACTION 0.7
#define SLACKENED 0.98

vec3 gradient_difference(vec4 eye, vec3 vertex, vec3 u, vec3 direction, float delta, vec3 g)
{
  vec3 moved = safe_unit(u + delta * direction);
  return (path_gradient(eye, vertex, moved, sample_surface(moved)) - g) / delta;
}

vec3 newton_step(vec4 eye, vec3 vertex, vec3 u, SurfaceSample at, vec3 g, bool any_kind, out bool regular)
{
  vec3 first, second;
  tangent_frame(u, first, second);
  float nearest = length(vertex - at.position);
  if (eye.w > 0.0) {
    nearest = min(nearest, length(eye.xyz - at.position));
  }
  float delta = DIFFERENCE * min(1.0, 3.0 * nearest / at.radius) + SMALLEST_DIFFERENCE;
  vec3 by_first = gradient_difference(eye, vertex, u, first, delta, g);
  vec3 by_second = gradient_difference(eye, vertex, u, second, delta, g);
  float gx = dot(g, first);
  float gy = dot(g, second);
  float hxx = dot(by_first, first);
  float hyy = dot(by_second, second);
  float hxy = 0.5 * (dot(by_first, second) + dot(by_second, first));
  float middle = 0.5 * (hxx + hyy);
  float spread = length(vec2(0.5 * (hxx - hyy), hxy));
  float lowest = middle - spread;
  float highest = middle + spread;
  float shift = any_kind ? 0.0 : max(0.0, max(abs(lowest), FLATTEST * abs(highest)) - lowest);
  hxx += shift;
  hyy += shift;
  float determinant = hxx * hyy - hxy * hxy;
  bool solvable = any_kind ? determinant != 0.0 : determinant > 0.0;
  regular = shift == 0.0 && solvable;
  if (!solvable) {
    return vec3(0.0);
  }
  vec2 s = -vec2(hyy * gx - hxy * gy, hxx * gy - hxy * gx) / determinant;
  s *= min(1.0, LONGEST_NEWTON_STEP / max(length(s), 1e-30));
  return s.x * first + s.y * second;
}

// Descends from u; returns whether it converged and adds its steps to `iterations`. With `any_kind` to a zero of the
// gradient that may be a maximum or a saddle.
bool minimise(
    vec4 eye, float focal, vec3 vertex, int steps, float tolerance, bool any_kind, inout vec3 u, inout int iterations)
{
  SurfaceSample at = sample_surface(u);
  vec3 g = path_gradient(eye, vertex, u, at);
  for (int i = 0; i < steps; i++) {
    bool regular;
    vec3 step_taken = newton_step(eye, vertex, u, at, g, any_kind, regular);
    bool done = regular && length(step_taken) < LONGEST_LAST_STEP &&
                length(in_pixels(eye, focal, at.position, at.radius * step_taken)) < tolerance;
    iterations++;
    float slope = dot(g, step_taken);
    float gradient_length = length(g);
    float factor = 1.0;
    bool accepted = false;
    for (int k = 0; k < TRIALS && !accepted; k++) {
      vec3 trial = safe_unit(u + factor * step_taken);
      SurfaceSample there = sample_surface(trial);
      vec3 gradient_there = path_gradient(eye, vertex, trial, there);
      float change = path_change(eye, vertex, at.position, there.position);
      bool descends = !any_kind && change <= SUFFICIENT * factor * slope + ROUNDING * at.radius;
      float share = any_kind ? SLACKENED : CONTRACTION;
      accepted = descends || (regular && length(gradient_there) < share * gradient_length);
      if (accepted) {
        u = trial;
        at = there;
        g = gradient_there;
      }
      factor *= SHORTENING;
    }
    if (done) {
      return true;
    }
    if (!accepted) {
      return false;
    }
  }
  return false;
}
