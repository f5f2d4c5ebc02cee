// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// For design/ways.py: where lines of sight get to by mirrors, one for each pixel, as the exact method follows them.
// ray_origins: xyz, how far it sees; ray_directions: unit. first_mirror: place, number of the mirror that is met first
// (0: none is). last_place: place of what is met last, its object_id (0: nothing). last_way: direction there, mirrors
// on the way. last_corners: numbers of the triangle's corners there, that of the instance (-1: nothing);
// last_weights: barycentric, of the second and the third of them.
#include "rays/ray_walk.glsl"
#include "rays/ray_surface.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 start = texelFetch(ray_origins, pixel, 0);
  vec3 origin = start.xyz;
  vec3 direction = texelFetch(ray_directions, pixel, 0).xyz;
  first_mirror = last_place = last_weights = vec4(0.0);
  last_corners = vec4(0.0, 0.0, 0.0, -1.0);
  float met = 0.0;
  bool goes_on = true;
  Hit hit = walk(origin, direction, start.w, SEEN_BY_CAMERA, 0.0, false);
  while (goes_on) {
    goes_on = false;
    last_place = vec4(0.0);
    if (hit.instance >= 0) {
      RaySurface surface = surface_of_hit(hit, origin, direction);
      last_place = vec4(surface.position, surface.object_id);
      goes_on = surface.mirror > 0.5 && met < most_mirrors;
      if (met < 0.5) {
        first_mirror = vec4(surface.position, surface.mirror);
      }
      if (goes_on) {
        met += 1.0;
        origin = surface.position;
        direction = reflect(direction, surface.normal);
        hit = walk(origin, direction, 3e38, SEEN_IN_MIRRORS, surface.mirror, false);
      }
    }
  }
  last_way = vec4(direction, met);
  if (hit.instance >= 0) {
    float instance = float((hit.instance - rays_top.y) / INSTANCE_RECORDS);
    last_corners = vec4(fetch_record(rays, hit.triangle + 3).xyz, instance);
    last_weights = vec4(hit.place, 0.0, 0.0);
  }
}
