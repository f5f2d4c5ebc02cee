// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Search along the projected bisector field (Estalella et al. 2005, section 4.3), one invocation per vertex; mirrors
// optics/bisector.py step for step.
#include "bisector.glsl"
#include "guess.glsl"
#include "fermat.glsl"

// The paper's threshold of the error function: 1e-4 radians.
#define SMALLEST_ERROR 2.5e-9
#define FIRST_STEP 1.0
#define SHORTEST_STEP 0.02
#define LONGEST_STEP 4.0
// A step is right where the field falls to a half over half of it.
#define SIMILAR 0.4
#define DIFFERENT 0.6
#define LONGEST_MOVE 0.5
// Cosine to u under which a direction meets the tangent plane too far away.
#define LEAST_COSINE 0.2

Bisector bisector_along(vec4 eye, vec3 vertex, vec3 u, bool inverse)
{
  SurfaceSample at = sample_surface(u);
  return bisector_at(eye, vertex, at.position, solver.screen.w * surface_normal(at), inverse);
}

// Where the line of a direction meets the plane that touches the sphere of directions at u: the cube's face, without seams.
vec3 on_plane(vec3 direction, vec3 u)
{
  float along = dot(direction, u);
  along = (along < 0.0 ? -1.0 : 1.0) * max(abs(along), LEAST_COSINE);
  return direction / along - u * (dot(direction, u) / along);
}

// The projected bisector direction.
vec3 field_at(Bisector b, vec3 u)
{
  return on_plane(b.bisector, u) - on_plane(b.normal, u);
}

vec3 moved(vec3 u, vec3 offset)
{
  return safe_unit(u + offset * min(1.0, LONGEST_MOVE / max(length(offset), 1e-30)));
}

Bisector follow_field(vec4 eye, vec3 vertex, bool inverse, int steps, inout vec3 u, inout int iterations)
{
  float step_length = FIRST_STEP;
  Bisector here = bisector_along(eye, vertex, u, inverse);
  for (int i = 0; i < steps && error_of(here) > SMALLEST_ERROR; i++) {
    vec3 first = field_at(here, u);
    vec3 middle = moved(u, 0.5 * step_length * first);
    vec3 second = field_at(bisector_along(eye, vertex, middle, inverse), middle);
    u = moved(u, step_length * second);
    here = bisector_along(eye, vertex, u, inverse);
    iterations++;
    float difference = length(second - first) / max(length(first), 1e-30);
    step_length *= difference > DIFFERENT ? 0.5 : difference < SIMILAR ? 1.5 : 1.0;
    step_length = clamp(step_length, SHORTEST_STEP, LONGEST_STEP);
  }
  return here;
}

void main()
{
  int index = invocation();
  if (index >= solver.counts.x) {
    return;
  }
  vec3 vertex = vertex_in_map(index);
  if (!is_finite(vertex)) {
    store_invalid(index);
    return;
  }
  vec4 eye = solver.eye;
  int iterations = 0;
  // Between eye and vertex, inside the region of interest of a convex reflector.
  vec3 u = guess_between(eye, vertex);
  if (solver.screen.w < 0.0) {
    u = on_hollow_side(eye, vertex, u);
  }
  Bisector b = follow_field(eye, vertex, false, solver.counts.y, u, iterations);
  bool inverse = !is_in_front(vertex, b);
  if (inverse) {
    b = follow_field(eye, vertex, true, solver.counts.y, u, iterations);
  }
  store_bisector(index, iterations, vertex, b, inverse);
}
