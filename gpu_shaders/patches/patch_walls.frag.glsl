// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What ends the surface that a patch stands for: planes of what stands about its points, found by rays across the
// surface (a fragment each: four of each patch). Normal towards the patch, distance; nothing: far below all.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"
#include "patches/cells.glsl"
#include "patches/patch_points.glsl"

// How high above the surface, and how far, in cells: what is lower hardly shadows a cell, what is nearer may part
// cells between which light is interpolated.
#define WALL_HEIGHT 0.1
#define WALL_REACH 1.8

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int number = (pixel.y << ROW_BITS) + pixel.x;
  int place = number / PATCH_WALLS;
  wall_out = vec4(vec3(0.0), -1e30);
  if (place >= patches) {
    return;
  }
  vec3 normal = patch_normal(place, 0);
  vec3 origin = patch_place(place, 0);
  float size = cell_size(max(cell_level(origin), 0.0));
  int along = cell_side(normal) / 2;
  int way = number - place * PATCH_WALLS;
  vec3 first = along == 0 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 second = along == 2 ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
  vec3 direction = (way < 2 ? first : second) * ((way & 1) == 0 ? 1.0 : -1.0);
  // (Across the surface, however that is tilted.)
  direction = normalize(direction - normal * dot(normal, direction));
  Hit hit = walk(origin + WALL_HEIGHT * size * normal, direction, WALL_REACH * size, SEEN_BY_DIFFUSE, 0.0, false);
  if (hit.instance >= 0) {
    vec3 facing = cross(fetch_record(rays, hit.triangle + 1).xyz, fetch_record(rays, hit.triangle + 2).xyz);
    vec3 outward = normalize(facing.x * fetch_record(rays, hit.instance).xyz +
                             facing.y * fetch_record(rays, hit.instance + 1).xyz +
                             facing.z * fetch_record(rays, hit.instance + 2).xyz);
    outward *= dot(outward, direction) > 0.0 ? -1.0 : 1.0;
    vec3 met = origin + WALL_HEIGHT * size * normal + hit.range * direction;
    // (What only leans over the surface parts nothing.)
    if (dot(outward, direction) < -0.3) {
      wall_out = vec4(outward, dot(outward, met) - 1e-3 * size);
    }
  }
}
