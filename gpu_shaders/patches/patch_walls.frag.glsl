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
  int way = number - place * PATCH_WALLS;
  ivec3 first, second;
  axes_across(cell_side(normal), first, second);
  vec3 direction = vec3(way < 2 ? first : second) * ((way & 1) == 0 ? 1.0 : -1.0);
  // (Across the surface, however that is tilted.)
  direction = normalize(direction - normal * dot(normal, direction));
  vec3 start = origin + WALL_HEIGHT * size * normal;
  Hit hit = walk(start, direction, WALL_REACH * size, SEEN_BY_DIFFUSE, 0.0, false);
  if (hit.instance >= 0) {
    vec3 outward = normalize(normals_to_world(hit) * facing_of(hit));
    outward *= dot(outward, direction) > 0.0 ? -1.0 : 1.0;
    vec3 met = start + hit.range * direction;
    // (What only leans over the surface parts nothing.)
    if (dot(outward, direction) < -0.3) {
      wall_out = vec4(outward, dot(outward, met) - 1e-3 * size);
    }
  }
}
