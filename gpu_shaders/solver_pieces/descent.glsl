// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Safeguarded Newton descent on the path length; mirrors optics/solvers/descent.py step for step.
#include "solver_pieces/fermat.glsl"
#include "solver_pieces/guess.glsl"
#from optics.solvers.descent import DIFFERENCE, FLATTEST, LONGEST_STEP as LONGEST_NEWTON_STEP, TRIALS, SHORTENING
#from optics.solvers.descent import SUFFICIENT, ROUNDING, CONTRACTION, SLACKENED, AT_REST, LEFT_OVER, QUADRATIC
#from optics.solvers.descent import NEARNESS

// (P_i . P_j - (P_i . t) (P_j . t)) / d for xx, xy, yy.
vec3 leg_derivative(vec3 moved_1, vec3 moved_2, vec3 t, float distance_to_end)
{
  float along_1 = dot(moved_1, t);
  float along_2 = dot(moved_2, t);
  return vec3(dot(moved_1, moved_1) - along_1 * along_1,
              dot(moved_1, moved_2) - along_1 * along_2,
              dot(moved_2, moved_2) - along_2 * along_2) /
         max(distance_to_end, 1e-30);
}

// Of the path length in the frame at u: xx, xy, yy.
vec3 second_derivative(vec4 eye, vec3 vertex, vec3 u, SurfaceSample at, vec3 first, vec3 second)
{
  vec3 t_vertex = safe_unit(vertex - at.position);
  vec3 t_eye = towards_eye(eye, at.position);
  vec3 h = t_eye + VERTEX_INDEX * t_vertex;
  vec3 by_first = (sample_surface(safe_unit(u + DIFFERENCE * first)).gradient - at.gradient) / DIFFERENCE;
  vec3 by_second = (sample_surface(safe_unit(u + DIFFERENCE * second)).gradient - at.gradient) / DIFFERENCE;
  vec2 slope = vec2(dot(at.gradient, first), dot(at.gradient, second));
  vec2 h_across = vec2(dot(h, first), dot(h, second));
  float h_u = dot(h, u);
  vec3 derivative = -vec3(
      (dot(by_first, first) - at.radius) * h_u + 2.0 * slope.x * h_across.x,
      0.5 * (dot(by_first, second) + dot(by_second, first)) * h_u + slope.x * h_across.y + slope.y * h_across.x,
      (dot(by_second, second) - at.radius) * h_u + 2.0 * slope.y * h_across.y);
  vec3 moved_1 = slope.x * u + at.radius * first;
  vec3 moved_2 = slope.y * u + at.radius * second;
  derivative += leg_derivative(moved_1, moved_2, t_vertex, length(vertex - at.position) / VERTEX_INDEX);
  if (eye.w > 0.0) {
    derivative += leg_derivative(moved_1, moved_2, t_eye, length(eye.xyz - at.position));
  }
  return derivative;
}

// Makes the second derivative positive; whether it was so as it was. With `any_kind` only whether it can be inverted.
bool shift_derivative(inout vec3 derivative, bool any_kind)
{
  if (any_kind) {
    return derivative.x * derivative.z - derivative.y * derivative.y != 0.0;
  }
  float middle = 0.5 * (derivative.x + derivative.z);
  float spread = length(vec2(0.5 * (derivative.x - derivative.z), derivative.y));
  float lowest = middle - spread;
  float highest = middle + spread;
  float shift = max(0.0, max(abs(lowest), FLATTEST * abs(highest)) - lowest);
  derivative.x += shift;
  derivative.z += shift;
  return shift == 0.0 && lowest > 0.0;
}

// The Newton step for gradient g; none where the derivative is singular.
vec3 newton_step(vec3 derivative, vec3 g, vec3 first, vec3 second)
{
  float determinant = derivative.x * derivative.z - derivative.y * derivative.y;
  if (determinant == 0.0) {
    return vec3(0.0);
  }
  float x = dot(g, first);
  float y = dot(g, second);
  return -((derivative.z * x - derivative.y * y) * first + (derivative.x * y - derivative.y * x) * second) /
         determinant;
}

// Descends from u; returns whether it converged and adds its steps to `iterations`. With `any_kind` to a zero of the
// gradient that may be a maximum or a saddle.
bool minimize(
    vec4 eye, float focal, vec3 vertex, int steps, float tolerance, bool any_kind, inout vec3 u, inout int iterations)
{
  SurfaceSample at = sample_surface(u);
  vec3 g = path_gradient(eye, vertex, u, at);
  for (int i = 0; i < steps; i++) {
    vec3 first, second;
    tangent_frame(u, first, second);
    vec3 derivative = second_derivative(eye, vertex, u, at, first, second);
    bool regular = shift_derivative(derivative, any_kind);
    vec3 newton = newton_step(derivative, g, first, second);
    float newton_length = length(newton);
    vec3 step_taken = newton * min(1.0, LONGEST_NEWTON_STEP / max(newton_length, 1e-30));
    iterations++;
    // Pixels of an angle that nothing foreshortens: the line of sight may hide a step, but not the error it leaves.
    float nearest = length(vertex - at.position);
    float to_eye = 1.0;
    if (eye.w > 0.0) {
      to_eye = max(length(eye.xyz - at.position), 1e-30);
      nearest = min(nearest, to_eye);
    }
    float per_angle = at.radius * focal / to_eye;
    float least = ROUNDING * at.radius * (1.0 + at.radius / max(nearest, 1e-30));
    float gradient_length = length(g);
    if (regular &&
        (newton_length * per_angle < AT_REST * tolerance ||
         (gradient_length < least && length(in_pixels(eye, focal, at.position, at.radius * newton)) < tolerance))) {
      return true;
    }
    float slope = dot(g, step_taken);
    float factor = 1.0;
    bool accepted = false;
    bool whole = false;
    vec3 from_point = at.position;
    float from_radius = at.radius;
    for (int k = 0; k < TRIALS && !accepted; k++) {
      vec3 trial = safe_unit(u + factor * step_taken);
      SurfaceSample there = sample_surface(trial);
      vec3 gradient_there = path_gradient(eye, vertex, trial, there);
      float change = path_change(eye, vertex, from_point, there.position);
      bool descends = !any_kind && change <= SUFFICIENT * factor * slope + ROUNDING * from_radius;
      float share = any_kind ? SLACKENED : CONTRACTION;
      accepted = descends || (regular && length(gradient_there) < share * gradient_length);
      if (accepted) {
        u = trial;
        at = there;
        g = gradient_there;
        whole = k == 0;
      }
      factor *= SHORTENING;
    }
    if (!accepted) {
      // Where texels meet with a kink nothing may come closer than this.
      return regular && length(in_pixels(eye, focal, from_point, from_radius * newton)) < tolerance;
    }
    if (whole && regular && newton_length < LONGEST_NEWTON_STEP && newton_length * from_radius < NEARNESS * nearest) {
      vec3 correction = newton_step(derivative, g, first, second);
      float left = length(correction);
      float ratio = left / max(newton_length, 1e-30);
      bool quadratic = ratio < QUADRATIC && left * ratio * per_angle < LEFT_OVER * tolerance;
      float pixels = length(in_pixels(eye, focal, from_point, from_radius * correction));
      if (left * per_angle < AT_REST * tolerance || (pixels < tolerance && (quadratic || length(g) < least))) {
        u = safe_unit(u + correction);
        return true;
      }
    }
  }
  return false;
}
