// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Normals and tangents in the spaces of objects: Normal Map, Tangent, Vector Displacement.
#include "programs/instances.glsl"
#include "values/math.glsl"

vec3 tangent_unit_normal(ShadingPoint s, vec3 normal)
{
  return math_normalize(to_world_normal(s, normal));
}

vec3 tangent_object_normal(ShadingPoint s, vec3 normal)
{
  return math_normalize(to_object_normal(s, normal));
}

// Across the normal, closest to a tangent in object space.
vec3 tangent_across(ShadingPoint s, vec3 tangent)
{
  return cross(s.normal, normalize(cross(to_world_normal(s, tangent), s.normal)));
}

vec3 normal_map_decoded(vec3 color)
{
  return 2.0 * color - 1.0;
}

vec3 normal_map_or(vec3 found, vec3 normal)
{
  return dot(found, found) > 0.0 ? found : normal;
}

// `tangent`: in object space, the sign of the bitangent in w.
vec3 normal_map_tangent(ShadingPoint s, vec3 color, float strength, vec4 tangent)
{
  vec3 part = normal_map_decoded(color);
  part = vec3(part.xy * strength, mix(1.0, part.z, clamp(strength, 0.0, 1.0)));
  float side = s.is_back ? -1.0 : 1.0;
  vec3 normal = tangent_object_normal(s, side * s.normal);
  vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
  vec3 found = part.x * tangent.xyz + part.y * bitangent + part.z * normal;
  return normal_map_or(side * tangent_unit_normal(s, found), s.normal);
}

vec3 normal_map_blended(ShadingPoint s, vec3 found, float strength)
{
  vec3 normal = s.is_back ? -found : found;
  normal = strength == 1.0 ? normal : math_normalize(s.normal + (normal - s.normal) * max(strength, 0.0));
  return normal_map_or(normal, s.normal);
}

vec3 normal_map_object(ShadingPoint s, vec3 color, float strength)
{
  return normal_map_blended(s, tangent_unit_normal(s, normal_map_decoded(color)), strength);
}

vec3 normal_map_world(ShadingPoint s, vec3 color, float strength)
{
  return normal_map_blended(s, math_normalize(normal_map_decoded(color)), strength);
}

// Displacement along a normal in object space, as a vector in world space.
vec3 displacement_object(ShadingPoint s, vec3 normal, float height)
{
  return to_world_direction(s, height * tangent_object_normal(s, normal));
}

vec3 displacement_tangent(ShadingPoint s, vec3 vector, vec4 tangent)
{
  vec3 normal = tangent_object_normal(s, s.normal);
  vec3 bitangent = math_normalize(cross(normal, tangent.xyz)) * tangent.w;
  return to_world_direction(s, vector.x * tangent.xyz + vector.y * normal + vector.z * bitangent);
}
