// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The surface where a ray of ray_walk.glsl has hit: attributes of its triangle's corners by barycentric weights.
#include "surfaces/reflecting_outward.glsl"

struct RaySurface {
  vec3 position;  // world space
  vec3 normal;    // unit shading normal, world space, towards where the ray comes from
  float object_id;
  float mirror;   // 1, 2, ... on a mirror
  bool is_back;   // seen from the inside
  int material;
};

// Of the triangle, in object space, as long as twice its area.
vec3 facing_of(Hit hit)
{
  return cross(fetch_record(rays, hit.triangle + 1).xyz, fetch_record(rays, hit.triangle + 2).xyz);
}

// Of the instance, from object to world space: normals go with the transposed inverse, whose columns are the rows from
// world to object space.
mat3 normals_to_world(Hit hit)
{
  return mat3(fetch_record(rays, hit.instance).xyz, fetch_record(rays, hit.instance + 1).xyz,
              fetch_record(rays, hit.instance + 2).xyz);
}

RaySurface surface_of_hit(Hit hit, vec3 origin, vec3 direction)
{
  vec4 about = fetch_record(rays, hit.instance + 3);
  vec4 regions = fetch_record(rays, hit.instance + 4);
  int materials_of_slots = rays_top.z + int(regions.w);
  int slots = int(fetch_record(rays, hit.instance + 5).x);
  vec4 numbers = fetch_record(rays, hit.triangle + 3);
  vec3 weights = vec3(1.0 - hit.place.x - hit.place.y, hit.place);
  vec3 normal = vec3(0.0);
  for (int k = 0; k < 3; k++) {
    normal += weights[k] * fetch_record(rays, REGION_UNIT * int(regions.z) + int(numbers[k])).xyz;
  }
  mat3 to_world = normals_to_world(hit);
  vec3 outward = to_world * facing_of(hit);
  bool is_mirrored = (int(about.z) & IS_MIRRORED) != 0;
  bool is_front = (dot(outward, direction) < 0.0) != is_mirrored;
  RaySurface surface;
  surface.position = origin + hit.range * direction;
  surface.normal = normalize(to_world * normal) * (is_front ? 1.0 : -1.0);
  int slot = min(int(numbers.w), slots - 1);
  surface.material = int(fetch_record(rays, materials_of_slots + slot / 4)[slot % 4]);
  bool is_followed = about.y > 0.5;
#ifdef PATH_STEP
  is_followed = is_followed || fetch_record(materials, MATERIAL_RECORDS * surface.material + 6).w > 0.5;
#endif
  if (is_followed) {
    vec3 facet = normalize(outward) * (dot(outward, direction) < 0.0 ? 1.0 : -1.0);
    surface.normal = reflecting_outward(facet, -direction, surface.normal);
  }
  surface.object_id = about.x;
  surface.mirror = about.y;
  surface.is_back = !is_front;
  return surface;
}

#ifdef WITH_HITS
// Number of the instance among those that rays know, of the triangle in its mesh, and the place on it.
vec4 packed_hit(Hit hit)
{
  int first = REGION_UNIT * int(fetch_record(rays, hit.instance + 4).y);
  return vec4(float((hit.instance - rays_top.y) / INSTANCE_RECORDS), float((hit.triangle - first) / TRIANGLE_RECORDS),
              hit.place);
}

Hit unpacked_hit(vec4 held)
{
  Hit hit;
  hit.instance = rays_top.y + INSTANCE_RECORDS * int(held.x + 0.5);
  int first = REGION_UNIT * int(fetch_record(rays, hit.instance + 4).y);
  hit.triangle = first + TRIANGLE_RECORDS * int(held.y + 0.5);
  hit.place = held.zw;
  hit.range = 0.0;
  return hit;
}
#endif
