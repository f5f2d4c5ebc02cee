// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Secant search on a star-shaped reflector (Roger & Holzschuch 2006, section 3.3), one invocation per vertex;
// mirrors optics/solvers/secant_star.py step for step.
#include "solver_pieces/star_ending.glsl"
#from optics.solvers.secant_star import SMALL_DETERMINANT, LONGEST_STEP as LONGEST_SECANT_STEP, SEARCH_TOLERANCE
#from optics.solvers.secant_star import SMALLEST_START

vec3 gradient_at(vec4 eye, vec3 vertex, vec3 u)
{
  return path_gradient(eye, vertex, u, sample_surface(u));
}

// A towards the vertex, B towards the eye, C equilateral (section 3.3.4).
void start_triangle(vec4 eye, vec3 vertex, out vec3 u[3])
{
  vec3 a = safe_unit(vertex);
  vec3 b = safe_unit(eye.xyz);
  vec3 first, second;
  tangent_frame(a, first, second);
  vec3 across = cross(a, b);
  across = length(across) < 1e-3 ? first : safe_unit(across);
  // Half way on the great circle; `across` leads the way where A and B are opposite.
  vec3 middle = safe_unit(a + b + 1e-6 * second);
  middle = safe_unit(middle - dot(middle, across) * across);
  float half_edge = 0.5 * length(a - b);
  if (half_edge < SMALLEST_START) {
    vec3 along = cross(across, middle);
    a = safe_unit(middle + SMALLEST_START * along);
    b = safe_unit(middle - SMALLEST_START * along);
  }
  u[0] = a;
  u[1] = b;
  u[2] = safe_unit(middle + sqrt(3.0) * clamp(half_edge, SMALLEST_START, 0.6) * across);
}

// Weights (alpha, beta) of A and B that minimize the interpolated gradient; whether that is ill-conditioned.
bool least_squares(vec3 g[3], out vec2 weights)
{
  vec3 a = g[0] - g[2];
  vec3 b = g[1] - g[2];
  float aa = dot(a, a);
  float bb = dot(b, b);
  float ab = dot(a, b);
  float ac = dot(a, g[2]);
  float bc = dot(b, g[2]);
  // aa bb - ab ab by Lagrange's identity, which float32 can hold.
  vec3 normal = cross(a, b);
  float determinant = dot(normal, normal);
  weights = determinant > 1e-12 * aa * bb ? vec2(ab * bc - bb * ac, ab * ac - aa * bc) / determinant : vec2(0.0);
  return determinant <= SMALL_DETERMINANT * aa * bb;
}

vec3 secant_search(vec4 eye, float focal, vec3 vertex, int steps, inout int iterations)
{
  vec3 u[3];
  vec3 g[3];
  start_triangle(eye, vertex, u);
  if (solver.side < 0.0) {
    vec3 middle = safe_unit(u[0] + u[1] + u[2]);
    float turned = sign(dot(on_hollow_side(eye, vertex, middle), middle));
    for (int k = 0; k < 3; k++) {
      u[k] *= turned;
    }
  }
  for (int k = 0; k < 3; k++) {
    g[k] = gradient_at(eye, vertex, u[k]);
  }
  vec3 discarded_u = vec3(0.0);
  vec3 discarded_g = vec3(0.0);
  bool has_discarded = false;
  int newest = -1;
  vec3 best = u[0];
  for (int i = 0; i < steps; i++) {
    vec2 weights;
    if (least_squares(g, weights) && has_discarded) {
      // The point that came back must not be the newest again, or the search would never end.
      int worst = -1;
      for (int k = 0; k < 3; k++) {
        if (k != newest && (worst < 0 || dot(g[k], g[k]) > dot(g[worst], g[worst]))) {
          worst = k;
        }
      }
      u[worst] = discarded_u;
      g[worst] = discarded_g;
      has_discarded = false;
      least_squares(g, weights);
    }
    int largest = 0;
    int smallest = 0;
    for (int k = 1; k < 3; k++) {
      largest = dot(g[k], g[k]) > dot(g[largest], g[largest]) ? k : largest;
      smallest = dot(g[k], g[k]) < dot(g[smallest], g[smallest]) ? k : smallest;
    }
    vec3 nearest = u[smallest];
    float least = dot(g[smallest], g[smallest]);
    vec3 move = weights.x * u[0] + weights.y * u[1] + (1.0 - weights.x - weights.y) * u[2] - nearest;
    move *= min(1.0, LONGEST_SECANT_STEP / max(length(move), 1e-30));
    vec3 d = safe_unit(nearest + move);
    SurfaceSample at = sample_surface(d);
    vec3 gradient_d = path_gradient(eye, vertex, d, at);
    iterations++;

    discarded_u = u[largest];
    discarded_g = g[largest];
    has_discarded = true;
    newest = largest;
    u[largest] = d;
    g[largest] = gradient_d;
    best = dot(gradient_d, gradient_d) <= least ? d : nearest;

    vec3 edge_1 = in_pixels(eye, focal, at.position, at.radius * (u[1] - u[0]));
    vec3 edge_2 = in_pixels(eye, focal, at.position, at.radius * (u[2] - u[0]));
    float area = 0.5 * length(cross(edge_1, edge_2));
    float moved = length(in_pixels(eye, focal, at.position, at.radius * (d - nearest)));
    if (area < SEARCH_TOLERANCE * SEARCH_TOLERANCE && moved < SEARCH_TOLERANCE) {
      break;
    }
  }
  return best;
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  float focal = solver.focal_pixels;
  int iterations = 0;
  vec3 u = secant_search(eye, focal, vertex, solver.steps, iterations);
  bool converged = minimize(
      eye, focal, vertex, solver.newton_steps, solver.tolerance, solver.side < 0.0, u, iterations);
  return finish(vertex, u, converged, iterations);
}
