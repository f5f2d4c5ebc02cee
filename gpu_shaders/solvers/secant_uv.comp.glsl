// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Secant search in the parameters of the reflector (Roger & Holzschuch 2005, section 3.3), one invocation per vertex;
// mirrors optics/solvers/secant_uv.py step for step.
#include "solver_pieces/solver.glsl"
#include "solver_pieces/parametric_map.glsl"
// The map of directions holds the radius first, as a radial map does.
#define radial uv_of_direction
#include "solver_pieces/pierce.glsl"
#from optics.solvers.secant_uv import FLATTEST, LONGEST_STEP, SMALLEST_START, LARGEST_START, LARGEST_MISS

vec2 gradient_at(vec4 eye, vec3 vertex, ParametricSample at)
{
  vec3 h = towards_eye(eye, at.position) + safe_unit(vertex - at.position);
  return -vec2(dot(at.du, h), dot(at.dv, h));
}

// A towards the vertex, B towards the eye (section 3.3.1), C beside their middle, where the point half way lies.
void start_triangle(vec4 eye, vec3 vertex, vec2 wraps, out vec2 uv[3])
{
  vec3 to_vertex = safe_unit(vertex);
  vec3 to_eye = safe_unit(eye.xyz);
  vec3 first, second;
  tangent_frame(to_vertex, first, second);
  vec2 a = map_texel(to_vertex).yz;
  vec2 b = map_texel(to_eye).yz;
  vec2 half_way = map_texel(safe_unit(to_vertex + to_eye + 1e-6 * first)).yz;
  vec2 edge = nearer(wraps, b - a);
  vec2 middle = a + 0.5 * edge;
  vec2 bend = nearer(wraps, half_way - middle);
  float edge_length = length(edge);
  b = a + edge;
  vec2 along = edge_length > 0.0 ? edge / edge_length : vec2(1.0, 0.0);
  if (edge_length < SMALLEST_START) {
    a = middle - 0.5 * SMALLEST_START * along;
    b = middle + 0.5 * SMALLEST_START * along;
  }
  vec2 across = vec2(-along.y, along.x);
  across *= dot(across, bend) < 0.0 ? -1.0 : 1.0;
  float height = clamp(sqrt(0.75) * edge_length, SMALLEST_START, LARGEST_START);
  vec2 c = middle + height * across;
  if (clamped(wraps, c) != c) {
    c = middle - height * across;
  }
  uv[0] = clamped(wraps, a);
  uv[1] = clamped(wraps, b);
  uv[2] = clamped(wraps, c);
}

float cross_2d(vec2 p, vec2 q)
{
  return p.x * q.y - p.y * q.x;
}

int smallest_of(vec2 g[3])
{
  int smallest = 0;
  for (int k = 1; k < 3; k++) {
    smallest = dot(g[k], g[k]) < dot(g[smallest], g[smallest]) ? k : smallest;
  }
  return smallest;
}

vec2 secant_search(vec4 eye, vec3 vertex, vec2 wraps, inout int iterations)
{
  float focal = solver.focal_pixels;
  float tolerance = solver.tolerance;
  vec2 uv[3];
  vec2 g[3];
  start_triangle(eye, vertex, wraps, uv);
  for (int k = 0; k < 3; k++) {
    g[k] = gradient_at(eye, vertex, sample_parametric(uv[k]));
  }
  vec2 last = uv[smallest_of(g)];
  for (int i = 0; i < solver.steps; i++) {
    // Where the interpolated gradient vanishes (equation 3.2).
    vec2 b = g[1] - g[0];
    vec2 c = g[2] - g[0];
    float determinant = cross_2d(b, c);
    if (abs(determinant) <= FLATTEST * length(b) * length(c)) {
      break;
    }
    float alpha = -cross_2d(g[0], c) / determinant;
    float beta = -cross_2d(b, g[0]) / determinant;
    vec2 nearest = uv[smallest_of(g)];
    vec2 move = (1.0 - alpha - beta) * uv[0] + alpha * uv[1] + beta * uv[2] - nearest;
    move *= min(1.0, LONGEST_STEP / max(length(move), 1e-30));
    last = clamped(wraps, nearest + move);
    ParametricSample at = sample_parametric(last);
    iterations++;
    int farthest = 0;
    for (int k = 1; k < 3; k++) {
      vec2 offset = uv[k] - last;
      vec2 largest = uv[farthest] - last;
      farthest = dot(offset, offset) > dot(largest, largest) ? k : farthest;
    }
    uv[farthest] = last;
    g[farthest] = gradient_at(eye, vertex, at);
    float size = 0.0;
    for (int k = 0; k < 3; k++) {
      vec2 edge = uv[k] - last;
      size = max(size, length(in_pixels(eye, focal, at.position, at.du * edge.x + at.dv * edge.y)));
    }
    if (size < tolerance) {
      break;
    }
  }
  return last;
}

// Parameters of a point on the surface: those of its direction, and one Newton step from there.
vec2 nearest_on_map(vec2 wraps, vec3 point)
{
  vec2 uv = map_texel(safe_unit(point)).yz;
  ParametricSample at = sample_parametric(uv);
  vec3 offset = point - at.position;
  float uu = dot(at.du, at.du);
  float vv = dot(at.dv, at.dv);
  float product = dot(at.du, at.dv);
  float determinant = uu * vv - product * product;
  // Nothing to gain beside a pole.
  if (determinant > 1e-4 * vv * vv) {
    vec2 slopes = vec2(dot(at.du, offset), dot(at.dv, offset));
    vec2 step_taken = vec2(vv * slopes.x - product * slopes.y, uu * slopes.y - product * slopes.x) / determinant;
    uv = clamped(wraps, uv + clamp(step_taken, -SMALLEST_START, SMALLEST_START));
  }
  return uv;
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  MapKind kind = map_kind();
  int iterations = 0;
  vec2 uv = secant_search(eye, vertex, kind.wraps, iterations);
  ParametricSample at = sample_parametric(uv);
  vec3 to_eye = towards_eye(eye, at.position);
  vec3 to_vertex = vertex - at.position;
  vec3 normal = at.normal;
  if (kind.is_open && dot(normal, to_eye) < 0.0) {
    normal = -normal;
  }
  vec3 h = to_eye + safe_unit(to_vertex);
  float sine = length(cross(h, normal));
  bool seen = dot(normal, to_eye) > 0.0 && dot(normal, to_vertex) > 0.0;
  if (seen && atan(sine, dot(h, normal)) <= LARGEST_MISS) {
    return as_reflected(iterations, vertex, at.position);
  }
  vec3 point;
  if (pierce(eye, vertex, solver.bound, point)) {
    return as_hidden(iterations, vertex, point, sample_parametric(nearest_on_map(kind.wraps, point)).normal);
  }
  // The path is stationary too where the segment from the eye to the vertex pierces the reflector.
  return !seen && sine <= LARGEST_MISS ? as_hidden(iterations, vertex, at.position, normal) :
                                         as_unsolved(iterations, vertex, at.position);
}
