// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What programs read where a ray has hit: attributes of the mesh by `number` in the scene's list, and the instance.
// Needs what ray_walk.glsl does (renderer/rays/ray_scene.py).
#include "common/records.glsl"

// The row of instance_table, of an instance by its first record.
int row_of_instance(int instance)
{
  return int(fetch_record(rays, instance + 5).w + 0.5);
}

// `triangle`: its first record; `weights` of its corners. What the mesh lacks: 0, or (0, 0, 0, 1) of what has a name.
vec4 hit_attribute(int instance, int triangle, vec3 weights, int number)
{
  vec4 about = fetch_record(rays, instance + 5);
  int list = rays_top.z + int(about.z + 0.5);
  int place = int(round(fetch_record(rays, list + (number + 1) / 4)[(number + 1) % 4]));
  if (place < 0) {
    return vec4(0.0, 0.0, 0.0, place == LACKING_BY_NAME ? 1.0 : 0.0);
  }
  int count = int(fetch_record(rays, list).x + 0.5);
  int first = REGION_UNIT * int(about.y + 0.5) + place;
  vec4 corners = fetch_record(rays, triangle + 3);
  return weights.x * fetch_record(rays, first + count * int(corners.x + 0.5)) +
         weights.y * fetch_record(rays, first + count * int(corners.y + 0.5)) +
         weights.z * fetch_record(rays, first + count * int(corners.z + 0.5));
}
