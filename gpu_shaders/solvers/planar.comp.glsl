// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A flat mirror (McReynolds 1996): the vertex seems to be at its mirror image in the plane, the reflection point is
// where the line of sight to that meets the plane. Exact where the mirror is flat.
#include "solver_pieces/solver.glsl"

Solved solve(int index, vec3 vertex)
{
  vec3 normal = solver.plane.xyz;
  float height = dot(normal, vertex) - solver.plane.w;
  float eye_height = dot(normal, solver.eye.xyz) - solver.plane.w * solver.eye.w;
  vec3 image = vertex - 2.0 * height * normal;
  // Both on the front: the sight from the eye to the image crosses the plane between them.
  if (height > 0.0 && eye_height > 0.0) {
    // For an eye at infinity its "height" is the cosine of its direction: the line through the image along it.
    float back = solver.eye.w > 0.0 ? height / (height + eye_height) : height / eye_height;
    vec3 towards = solver.eye.w > 0.0 ? solver.eye.xyz - image : solver.eye.xyz;
    return as_reflected(1, vertex, image + back * towards);
  }
  return as_hidden(1, vertex, vertex - height * normal, normal);
}
