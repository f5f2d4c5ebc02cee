// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// What strands and points know of themselves, in world space.
#include "programs/instances.glsl"
#include "values/math.glsl"

// A length in object space, scaled as a diagonal.
float parts_size(ShadingPoint s, float size)
{
  return length(to_world_direction(s, vec3(size * 0.57735026918962576)));
}

// Towards the ray's origin, across a strand along a direction in object space; 0 where there is none.
vec3 parts_facing(ShadingPoint s, vec3 along)
{
  vec3 way = to_world_direction(s, along);
  float square = dot(way, way);
  return square > 0.0 ? math_normalize(s.incoming - way * dot(way, s.incoming) / square) : vec3(0.0);
}
