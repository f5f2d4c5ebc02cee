// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// First point where the segment from the eye to a vertex enters the reflector; mirrors optics/solvers/pierce.py.
#include "solver_pieces/fermat.glsl"
#from optics.solvers.pierce import MARCH_STEPS, BISECTIONS

float height_over_surface(vec3 point)
{
  float from_center = length(point);
  // The star center itself has no direction; any will do, it is inside.
  vec3 u = from_center > 0.0 ? point / from_center : vec3(0.0, 0.0, 1.0);
  return from_center - textureLod(radial, u, 0.0).x;
}

bool pierce(vec4 eye, vec3 vertex, float bound, out vec3 point)
{
  point = vertex;
  vec3 direction = safe_unit(vertex * eye.w - eye.xyz);
  float nearest = dot(vertex, direction);
  float miss_squared = dot(vertex, vertex) - nearest * nearest;
  float half_chord = sqrt(max(bound * bound - miss_squared, 0.0));
  // Distances along the segment, measured from the vertex back towards the eye.
  float last = max(nearest - half_chord, 0.0);
  float first = nearest + half_chord;
  if (eye.w > 0.0) {
    first = min(first, length(eye.xyz - vertex));
  }
  if (miss_squared >= bound * bound || first <= last) {
    return false;
  }
  float outside = first;
  for (int i = 1; i <= MARCH_STEPS; i++) {
    float inside = first + (last - first) * float(i) / float(MARCH_STEPS);
    if (height_over_surface(vertex - inside * direction) < 0.0) {
      for (int k = 0; k < BISECTIONS; k++) {
        float middle = 0.5 * (outside + inside);
        if (height_over_surface(vertex - middle * direction) < 0.0) {
          inside = middle;
        }
        else {
          outside = middle;
        }
      }
      point = vertex - outside * direction;
      return true;
    }
    outside = inside;
  }
  return false;
}
