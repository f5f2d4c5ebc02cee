// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The node Bump: heights at the point and at two neighbors tilt the normal.
#include "programs/shading_point.glsl"

// Makes the ways to the neighbors as long as a pixel is wide, and puts them where Cycles has them: at right angles on
// the surface, wherever it is looked at from. (Gives nothing.)
float bump_aligned(inout ShadingPoint s)
{
  vec3 across = s.position_across, up = s.position_up;
  float size = 0.5 * (length(across - dot(across, s.incoming) * s.incoming) +
                      length(up - dot(up, s.incoming) * s.incoming));
  vec3 n = s.true_normal;
  vec3 aside = n.x != n.y || n.x != n.z ? vec3(n.z - n.y, n.x - n.z, n.y - n.x) :
                                          vec3(n.z - n.y, n.x + n.z, -n.y - n.x);
  aside = size * normalize(aside);
  vec3 ahead = cross(n, aside);
  // Both as sums of the ways that are known.
  vec3 facing = cross(across, up);
  float square = dot(facing, facing);
  if (size == 0.0 || square == 0.0) {
    return 0.0;
  }
  vec2 first = vec2(dot(cross(aside, up), facing), dot(cross(across, aside), facing)) / square;
  vec2 second = vec2(dot(cross(ahead, up), facing), dot(cross(across, ahead), facing)) / square;
  s.position_across = aside;
  s.position_up = ahead;
  for (int k = 0; k < ATTRIBUTES; k++) {
    vec4 right = s.attributes_across[k], top = s.attributes_up[k];
    s.attributes_across[k] = first.x * right + first.y * top;
    s.attributes_up[k] = second.x * right + second.y * top;
  }
  return 0.0;
}

// Makes an attribute the same at the neighbors. (Gives nothing.)
float bump_kept(inout ShadingPoint s, int number)
{
  s.attributes_across[number] = s.attributes_up[number] = vec4(0.0);
  return 0.0;
}

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
