// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
// SPDX-License-Identifier: GPL-3.0-or-later
// Fibers on a surface, as optics/scattering/sheen.py: a clamped cosine, linearly transformed. Zeltner, Burley and
// Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines" (2022), as Cycles has it.
// Directions are in a frame whose z is the normal and whose x is towards the viewer.
#include "common/ggx_table.glsl"

// Transform (x, y) and albedo (z) of fibers that cover the surface and are white.
vec3 sheen_lobe(float roughness, float cosine)
{
  vec3 lobe = sheen_table(clamp(roughness, 1e-3, 1.0), cosine);
  bool is_none = abs(lobe.x) < 1e-5 || lobe.z < 1e-5;
  return is_none ? vec3(1.0, 0.0, 0.0) : lobe;
}

// The share of the albedo that goes to a direction, per solid angle, times its cosine.
float sheen_value(vec2 transform, vec3 light)
{
  vec3 cosine_way = vec3(transform.x * light.x + transform.y * light.z, transform.x * light.y, light.z);
  float share = transform.x / max(dot(cosine_way, cosine_way), 1e-12);
  return max(light.z, 0.0) * share * share / LIGHTING_PI;
}

// Where the lobe sends what the undistorted cosine sends to this place of the unit disk.
vec3 sheen_direction(vec2 transform, vec2 disk)
{
  float up = sqrt(max(1.0 - dot(disk, disk), 0.0));
  return normalize(vec3(disk.x - up * transform.y, disk.y, up * transform.x));
}
