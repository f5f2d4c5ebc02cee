// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Search along the projected bisector field (Estalella et al. 2005, section 4.3), one invocation per vertex; mirrors
// optics/solvers/bisector.py step for step, which says what the paper leaves open.
#from optics.solvers.bisector import LARGEST_MISS, SMALLEST_ERROR, FIRST_STEP, SHORTEST_STEP, LONGEST_STEP
#from optics.solvers.bisector import RIGHT_FALL, LARGEST_FALL, LEAST_FACTOR, LARGEST_FACTOR, REJECTED, HALVINGS
#from optics.solvers.bisector import LONGEST_MOVE, LEAST_COSINE
#include "solver_pieces/bisector.glsl"
#include "solver_pieces/fermat.glsl"

Bisector bisector_along(vec4 eye, vec3 vertex, vec3 u, bool inverse)
{
  SurfaceSample at = sample_surface(u);
  return bisector_at(eye, vertex, at.position, solver.side * surface_normal(at), inverse);
}

// Where the line of a direction meets the plane that touches the sphere of directions at u, from u: the cube's face,
// without seams.
vec3 on_plane(vec3 direction, vec3 u)
{
  float along = dot(direction, u);
  float bounded = (along < 0.0 ? -1.0 : 1.0) * max(abs(along), LEAST_COSINE);
  return direction / bounded - u * (along / bounded);
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
  float sense = 1.0;
  Bisector here = bisector_along(eye, vertex, u, inverse);
  for (int i = 0; i < steps && error_of(here) > SMALLEST_ERROR; i++) {
    iterations++;
    vec3 first = sense * field_at(here, u);
    vec3 middle_u = moved(u, 0.5 * step_length * first);
    Bisector middle = bisector_along(eye, vertex, middle_u, inverse);
    vec3 second = sense * field_at(middle, middle_u);
    float fall = length(second - first) / max(length(first), 1e-30);
    step_length *= clamp(RIGHT_FALL / max(fall, 1e-9), LEAST_FACTOR, LARGEST_FACTOR);
    step_length = clamp(step_length, SHORTEST_STEP, LONGEST_STEP);
    vec3 there_u = moved(u, step_length * (fall > LARGEST_FALL ? first : second));
    Bisector there = bisector_along(eye, vertex, there_u, inverse);
    bool taken = inverse || (error_of(there) <= error_of(here) && sees_eye(eye, there));
    // Of a concave piece the point may be a source of the field.
    if (solver.side < 0.0 && !inverse && i == 0 && error_of(middle) > error_of(here)) {
      sense = -1.0;
      taken = false;
    }
    if (taken) {
      u = there_u;
      here = there;
    }
    else {
      step_length *= REJECTED;
    }
  }
  return here;
}

// Height over the reflector as 0 (contact) to 1 (far away).
float height_weight(float distance, float radius)
{
  float height = max(distance - radius, 0.0);
  return height / (height + radius);
}

// Between eye and vertex in the region of interest.
vec3 start_direction(vec4 eye, vec3 vertex)
{
  vec3 a = safe_unit(eye.xyz);
  vec3 b = safe_unit(vertex);
  float eye_weight = eye.w > 0.0 ? height_weight(length(eye.xyz), sample_surface(a).radius) : 1.0;
  float vertex_weight = height_weight(length(vertex), sample_surface(b).radius);
  float share = eye_weight / max(eye_weight + vertex_weight, 1e-30);
  float cosine = clamp(dot(a, b), -1.0, 1.0);
  vec3 across = b - cosine * a;
  float sine = length(across);
  if (sine < 1e-6) {
    vec3 other;
    tangent_frame(a, other, across);
  }
  across = safe_unit(across);
  float angle = share * atan(sine, cosine);
  vec3 u = cos(angle) * a + sin(angle) * across;
  if (solver.side < 0.0) {
    return on_hollow_side(eye, vertex, u);
  }
  for (int i = 0; i < HALVINGS; i++) {
    SurfaceSample at = sample_surface(u);
    angle *= dot(surface_normal(at), towards_eye(eye, at.position)) > 0.0 ? 1.0 : 0.5;
    u = cos(angle) * a + sin(angle) * across;
  }
  return u;
}

Solved solve(int index, vec3 vertex)
{
  vec4 eye = solver.eye;
  int iterations = 0;
  vec3 u = start_direction(eye, vertex);
  Bisector b = follow_field(eye, vertex, false, solver.steps, u, iterations);
  bool inverse = !is_in_front(vertex, b) || !sees_eye(eye, b);
  if (inverse) {
    b = follow_field(eye, vertex, true, solver.steps, u, iterations);
  }
  return as_bisector(iterations, vertex, b, inverse);
}
