// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the searches of `newton_refraction` start; mirrors optics/solvers/refraction_start.py. Needs REFRACTS and the
// sampler `radial`.
#include "solver_pieces/last_frame.glsl"
#include "solver_pieces/snell.glsl"
#include "solver_pieces/pierce.glsl"
#from optics.solvers.refraction_start import SCANNED, HALVINGS, SEEDS, GOLDEN_ANGLE, SUPPORT_STEPS, SUPPORT_TRIALS

#define PI 3.14159265358979
// No angle.
#define NO_ZERO 10.0

// The great circle of directions from the eye towards the vertex, by signed angle from the eye's direction.
struct Circle {
  vec3 start;
  vec3 across;
  float angle;  // of the vertex
};

Circle circle_towards(vec3 vertex)
{
  Circle circle;
  circle.start = safe_unit(solver.eye.xyz);
  circle.angle = arc(circle.start, safe_unit(vertex), circle.across);
  return circle;
}

vec3 on_circle(Circle circle, float x)
{
  return cos(x) * circle.start + sin(x) * circle.across;
}

// Slope of the path along the circle, of a sphere of this radius or, where that is 0, of the map; whether eye and
// vertex see the surface there from their sides.
float circle_slope(Circle circle, vec3 vertex, float radius, float x, out bool valid)
{
  if (radius == 0.0) {
    vec3 u = on_circle(circle, x);
    SurfaceSample at = sample_surface(u);
    valid = is_refraction_side(vertex, at);
    return dot(path_gradient(solver.eye, vertex, u, at), cos(x) * circle.across - sin(x) * circle.start);
  }
  float w = solver.eye.w > 0.0 ? 1.0 : 0.0;
  float e = length(solver.eye.xyz) / (w > 0.0 ? radius : 1.0);
  float v = length(vertex) / radius;
  vec2 to_eye = vec2(e * cos(x) - w, -e * sin(x));
  vec2 to_vertex = vec2(v * cos(circle.angle - x) - 1.0, v * sin(circle.angle - x));
  valid = solver.side * to_eye.x > 0.0 && solver.side * to_vertex.x < 0.0;
  return -(to_eye.y / max(length(to_eye), 1e-30) + solver.index * to_vertex.y / max(length(to_vertex), 1e-30));
}

// The slope's zero between two angles where it differs in sign: false position, kept off the ends by halving in turn.
float refined(Circle circle, vec3 vertex, float radius, float a, float b, float at_a, float at_b, out bool valid)
{
  for (int turn = 0; turn <= HALVINGS; turn++) {
    float secant = a - at_a * (b - a) / (at_b == at_a ? 1.0 : at_b - at_a);
    float x = turn % 2 == 0 || turn == HALVINGS ? secant : 0.5 * (a + b);
    float here = circle_slope(circle, vertex, radius, x, valid);
    if (turn == HALVINGS) {
      return x;
    }
    if ((here < 0.0) == (at_a < 0.0)) {
      a = x;
      at_a = here;
    }
    else {
      b = x;
      at_b = here;
    }
  }
  return a;
}

// The first `count` zeros of the slope, three at most, between -reach and reach, from the middle outwards to positive
// angles and then to negative ones.
vec3 circle_zeros(Circle circle, vec3 vertex, float radius, float reach, int count)
{
  vec3 found = vec3(NO_ZERO);
  int number = 0;
  bool valid;
  for (int half_circle = 0; half_circle < 2; half_circle++) {
    float sign_of_angle = half_circle == 0 ? 1.0 : -1.0;
    float before = 0.0;
    float value = circle_slope(circle, vertex, radius, before, valid);
    for (int k = 1; k <= SCANNED / 2 && number < count; k++) {
      // Denser towards the horizon, where the path's slope turns fastest.
      float x = sign_of_angle * reach * sin(0.5 * PI * float(k) / float(SCANNED / 2));
      float here = circle_slope(circle, vertex, radius, x, valid);
      if ((value < 0.0) != (here < 0.0)) {
        float zero = refined(circle, vertex, radius, before, x, value, here, valid);
        if (valid) {
          found = number == 0 ? vec3(zero, NO_ZERO, NO_ZERO) : number == 1 ? vec3(found.x, zero, NO_ZERO) :
                                                                            vec3(found.xy, zero);
          number++;
        }
      }
      before = x;
      value = here;
    }
  }
  return found;
}

// Angles at which a sphere about the star center, as large as the surface towards the eye, refracts.
vec3 sphere_zeros(Circle circle, vec3 vertex, int count)
{
  float radius = textureLod(radial, solver.side * circle.start, 0.0).x;
  float reach = PI;
  if (solver.side > 0.0) {
    float e = length(solver.eye.xyz) / radius;
    reach = (1.0 - 1e-6) * (solver.eye.w > 0.0 ? acos(min(1.0 / max(e, 1e-30), 1.0)) : 0.5 * PI);
  }
  return circle_zeros(circle, vertex, radius, reach, count);
}

// One of SEEDS unit vectors, evenly along a golden spiral.
vec3 spread_direction(int number)
{
  float z = 1.0 - (2.0 * float(number) + 1.0) / float(SEEDS);
  float ring = sqrt(1.0 - z * z);
  float longitude = GOLDEN_ANGLE * float(number);
  return vec3(ring * cos(longitude), ring * sin(longitude), z);
}

// Where the surface is farthest out along a normal, by Newton on normal . r u from u.
vec3 support_direction(vec3 normal, vec3 u)
{
  SurfaceSample at = sample_surface(u);
  for (int i = 0; i < SUPPORT_STEPS; i++) {
    vec3 first, second;
    tangent_frame(u, first, second);
    float along = dot(normal, u);
    vec2 across = vec2(dot(normal, first), dot(normal, second));
    vec2 slope = vec2(dot(at.gradient, first), dot(at.gradient, second));
    vec3 by_first = (sample_surface(safe_unit(u + DIFFERENCE * first)).gradient - at.gradient) / DIFFERENCE;
    vec3 by_second = (sample_surface(safe_unit(u + DIFFERENCE * second)).gradient - at.gradient) / DIFFERENCE;
    // Of minus the height: that is to be made small.
    vec3 derivative = -vec3(
        (dot(by_first, first) - at.radius) * along + 2.0 * slope.x * across.x,
        0.5 * (dot(by_first, second) + dot(by_second, first)) * along + slope.x * across.y + slope.y * across.x,
        (dot(by_second, second) - at.radius) * along + 2.0 * slope.y * across.y);
    shift_derivative(derivative, false);
    vec2 g = -(slope * along + at.radius * across);
    vec3 taken = newton_step(derivative, g.x * first + g.y * second, first, second);
    taken *= min(1.0, LONGEST_NEWTON_STEP / max(length(taken), 1e-30));
    float height = dot(normal, at.position);
    float factor = 1.0;
    bool accepted = false;
    for (int k = 0; k < SUPPORT_TRIALS && !accepted; k++) {
      vec3 trial = safe_unit(u + factor * taken);
      SurfaceSample there = sample_surface(trial);
      if (dot(normal, there.position) > height) {
        u = trial;
        at = there;
        accepted = true;
      }
      factor *= SHORTENING;
    }
    if (!accepted) {
      break;
    }
  }
  return u;
}

// The direction of the normal that Snell's law asks for between eye and vertex as seen from a point.
vec3 normal_asked_for(vec3 vertex, vec3 point)
{
  vec3 bent = safe_unit(towards_eye(solver.eye, point) + solver.index * safe_unit(vertex - point));
  return (solver.index < 1.0) == (solver.side > 0.0) ? bent : -bent;
}

// Descends from u; whether it has ended at a refraction point.
bool refracts_from(vec3 vertex, int steps, inout vec3 u, inout int iterations)
{
  return minimize(solver.eye, solver.focal_pixels, vertex, steps, solver.tolerance, true, u, iterations) &&
         is_refraction_side(vertex, sample_surface(u));
}
