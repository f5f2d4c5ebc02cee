// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bisector condition of Estalella et al. (2005, section 4.2): at the reflection point the bisector of the
// directions to the eye and to the vertex is the normal. Whoever includes this defines LARGEST_MISS: radians between
// bisector and normal from which on the end of a search is no reflection point.
#include "solver_pieces/solver.glsl"

struct Bisector {
  vec3 point;
  vec3 normal;  // towards the side that reflects
  vec3 bisector;
};

// A vertex behind the tangent plane takes part as its mirror image in that plane (2005, section 6.1; 2006, section
// 5.1): the inverse search. V' = R + 2 N ((V - R) . N) - (V - R) is its image about the normal line; what the eye
// would have to see of it lies on the other side of the plane.
vec3 seen_vertex(vec3 vertex, vec3 point, vec3 normal, bool inverse)
{
  return inverse ? vertex - 2.0 * dot(vertex - point, normal) * normal : vertex;
}

Bisector bisector_at(vec4 eye, vec3 vertex, vec3 point, vec3 normal, bool inverse)
{
  Bisector b;
  b.point = point;
  b.normal = normal;
  b.bisector = safe_unit(towards_eye(eye, point) + safe_unit(seen_vertex(vertex, point, normal, inverse) - point));
  return b;
}

// (1 - B . N) / 2 (2005, equation 1), without the cancellation.
float error_of(Bisector b)
{
  vec3 difference = b.bisector - b.normal;
  return 0.25 * dot(difference, difference);
}

bool is_in_front(vec3 vertex, Bisector b)
{
  return dot(b.normal, vertex - b.point) > 0.0;
}

bool sees_eye(vec4 eye, Bisector b)
{
  return dot(b.normal, towards_eye(eye, b.point)) > 0.0;
}

bool is_miss(Bisector b)
{
  // error = sin^2(angle / 2)
  return error_of(b) > 0.25 * LARGEST_MISS * LARGEST_MISS;
}

// Forward search first, then the inverse one where the vertex is behind the tangent plane it ended at.
Solved as_bisector(int iterations, vec3 vertex, Bisector b, bool inverse)
{
  if (is_miss(b)) {
    return as_unsolved(iterations, vertex, b.point);
  }
  if (inverse) {
    return as_hidden(iterations, vertex, b.point, b.normal);
  }
  return sees_eye(solver.eye, b) ? as_reflected(iterations, vertex, b.point) :
                                   as_unsolved(iterations, vertex, b.point);
}
