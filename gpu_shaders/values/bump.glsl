// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The node Bump: heights at the point and at two neighbors tilt the normal.
#include "programs/shading_point.glsl"

// Neighbors a part of a pixel away.
ShadingPoint bump_across(ShadingPoint s, float width)
{
  s.position += width * s.position_across;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] += width * s.attributes_across[k];
  }
  return s;
}

ShadingPoint bump_up(ShadingPoint s, float width)
{
  s.position += width * s.position_up;
  for (int k = 0; k < ATTRIBUTES; k++) {
    s.attributes[k] += width * s.attributes_up[k];
  }
  return s;
}

// `heights`: here, across, up. `width`: of the neighbors, in pixels.
vec3 bump_normal(ShadingPoint s, vec3 normal, vec3 heights, float scale, float strength, float width)
{
  vec3 across = cross(s.position_up, normal);
  vec3 up = cross(normal, s.position_across);
  float area = dot(s.position_across, across);
  vec3 slope = (heights.y - heights.x) * across + (heights.z - heights.x) * up;
  vec3 tilted = width * abs(area) * normal - scale * (area < 0.0 ? -1.0 : 1.0) * slope;
  float size = length(tilted);
  if (size == 0.0) {
    return normal;
  }
  strength = max(strength, 0.0);
  return normalize(strength * (tilted / size) + (1.0 - strength) * normal);
}
