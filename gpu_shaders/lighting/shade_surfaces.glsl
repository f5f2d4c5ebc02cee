// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces out of the buffers of renderer/surfaces/surfaces.py. Needs the uniform block `view` and the sampler
// `materials`.
#include "surfaces/material_records.glsl"

Surface surface_of(vec4 position, vec4 normal, vec3 color)
{
  int record = MATERIAL_RECORDS * max(int(normal.w + 0.5), 0);
  vec4 first = fetch_record(materials, record);
  vec4 second = fetch_record(materials, record + 1);
  Surface s;
  s.position = position.xyz;
  s.normal = normal.xyz;
  s.base_color = color;
  s.metallic = first.x;
  s.roughness = first.y;
  s.ior = first.z;
  s.specular_level = first.w;
  s.emission = second.xyz;
  s.glossy_only = second.w > 0.5;
#ifdef SURFACE_TINT
  s.specular_tint = fetch_record(materials, record + 7).rgb;
#endif
#ifdef SURFACE_SHEEN
  vec4 sheen = fetch_record(materials, record + 13);
  s.sheen = sheen.rgb;
  s.sheen_roughness = sheen.w;
#endif
#ifdef SURFACE_COAT
  vec4 coat = fetch_record(materials, record + 5);
  s.coat_weight = coat.x;
  s.coat_roughness = coat.y;
  s.coat_ior = coat.z;
  s.coat_tint = fetch_record(materials, record + 6).rgb;
#endif
#ifdef SURFACE_DIFFUSE_ROUGHNESS
  s.diffuse_roughness = fetch_record(materials, record + 14).x;
  s.subsurface = fetch_record(materials, record + 14).y;
#endif
#ifdef SURFACE_TRANSLUCENT
  s.translucency = fetch_record(materials, record + 14).z;
#endif
  return s;
}

bool is_holdout(vec4 normal)
{
  return normal.w < -0.5;
}

vec3 world_point(vec2 ndc, float depth)
{
  vec4 point = view.clip_to_world * vec4(ndc, depth, 1.0);
  return point.xyz / point.w;
}

// The ray through this pixel: where it leaves the picture plane, and its unit direction.
void pixel_ray(ivec2 size, out vec3 origin, out vec3 direction)
{
  vec2 ndc = 2.0 * gl_FragCoord.xy / vec2(size) - 1.0;
  origin = world_point(ndc, -1.0);
  direction = normalize(world_point(ndc, 1.0) - origin);
}
