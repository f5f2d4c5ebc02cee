// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: Blender Foundation and contributors (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes Mapping and Vector Rotate.
#include "values/math.glsl"

// Columns of a rotation about X, then Y, then Z.
mat3 rotation_from_euler(vec3 euler)
{
  vec3 c = cos(euler);
  vec3 s = sin(euler);
  return mat3(c.y * c.z, c.y * s.z, -s.y,
              s.y * s.x * c.z - c.x * s.z, s.y * s.x * s.z + c.x * c.z, c.y * s.x,
              s.y * c.x * c.z + s.x * s.z, s.y * c.x * s.z - s.x * c.z, c.y * c.x);
}

vec3 mapping_point(vec3 v, vec3 location, vec3 rotation, vec3 scale)
{
  return rotation_from_euler(rotation) * (v * scale) + location;
}

vec3 mapping_texture(vec3 v, vec3 location, vec3 rotation, vec3 scale)
{
  return math_divide((v - location) * rotation_from_euler(rotation), scale);
}

vec3 mapping_vector(vec3 v, vec3 rotation, vec3 scale)
{
  return rotation_from_euler(rotation) * (v * scale);
}

vec3 mapping_normal(vec3 v, vec3 rotation, vec3 scale)
{
  return math_normalize(rotation_from_euler(rotation) * math_divide(v, scale));
}

vec3 rotation_about_axis(vec3 v, vec3 center, vec3 axis, float angle)
{
  float size = length(axis);
  if (size == 0.0) {
    return v;
  }
  axis /= size;
  v -= center;
  return cos(angle) * v + (1.0 - cos(angle)) * dot(axis, v) * axis + sin(angle) * cross(axis, v) + center;
}

vec3 rotation_by_euler(vec3 v, vec3 center, vec3 euler)
{
  return rotation_from_euler(euler) * (v - center) + center;
}

vec3 rotation_by_inverse_euler(vec3 v, vec3 center, vec3 euler)
{
  return (v - center) * rotation_from_euler(euler) + center;
}
