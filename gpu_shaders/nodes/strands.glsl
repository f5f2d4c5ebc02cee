// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2022 Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// What the Curves Info and Point Info nodes tell, by attributes in object space (scene/programs/nodes/strands.py).
#include "programs/instances.glsl"

// Across the strand, towards where the ray comes from; `along` has 0 in it where there is no strand.
vec3 strand_tangent_normal(ShadingPoint s, vec4 along)
{
  vec3 way = to_world_direction(s, along.xyz);
  float squared = dot(way, way);
  if (squared == 0.0) {
    return vec3(0.0);
  }
  vec3 across = s.incoming - way * (dot(way, s.incoming) / squared);
  return across / max(length(across), 1e-20);
}

// (What is no point has no radius.)
vec3 point_position(ShadingPoint s, vec4 place, vec4 radius)
{
  return radius.x > 0.0 ? to_world(s, place.xyz) : vec3(0.0);
}

float point_radius(ShadingPoint s, vec4 radius)
{
  return length(to_world_direction(s, vec3(radius.x * 0.57735027)));
}
